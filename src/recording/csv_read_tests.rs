//! A good file is read whole; every mistake is refused with place and remedy.

use super::*;

fn read(text: &str) -> Result<Recording, RecordingError> {
    read_csv_from(text.as_bytes(), "a.csv")
}

fn refusal(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

#[test]
fn byte_order_mark_crlf_and_column_order_do_not_matter() {
    let recording = read("\u{feff}time_s, force_n\r\n0,1\r\n0.5,-2e-3\r\n").unwrap();
    assert_eq!(recording.time_s(), [0.0, 0.5]);
    assert_eq!(recording.channel("force_n").unwrap().values, [1.0, -2e-3]);
    let swapped = read("force_n,time_s\n1,0\n-0.002,0.5").unwrap();
    assert_eq!(swapped, recording);
}

#[test]
fn missing_cells_are_kept_as_nan() {
    let recording = read("time_s,a_n,b_n\n0,,1\n1,NaN,2\n2,nan,3\n").unwrap();
    assert!(recording.channels()[0].values.iter().all(|v| v.is_nan()));
    assert_eq!(recording.channels()[1].values, [1.0, 2.0, 3.0]);
}

#[test]
fn header_errors() {
    let needs = "a recording needs a header line with \"time_s\" and at least one line of numbers";
    assert_eq!(refusal(""), format!("a.csv: the file is empty\n  remedy: {needs}"));
    assert_eq!(refusal("time_s,a_n\n"), format!("a.csv: there is no row below the header\n  remedy: {needs}"));
    assert_eq!(
        refusal("t,a_n\n0,1\n"),
        "a.csv: line 1: no column \"time_s\" (found: t, a_n)\n  remedy: name the time column \"time_s\" and give \
             it in seconds, or say time_column = \"...\" in recordings.toml (`smam import` writes it); of rows at an even pace, their \
             interval: interval_s = 0.01"
    );
    assert_eq!(
        refusal("time_s,a_n,a_n\n0,1,2\n"),
        "a.csv: line 1: column \"a_n\" occurs twice\n  remedy: rename or remove one; or give the columns names in \
         recordings.toml, by header = false, skip_rows and names (`smam import` writes them)"
    );
    // A comma at the end makes a column that is none; one in the middle has to have a name.
    assert_eq!(read("time_s,a_n,\n0,1,\n").unwrap().columns(), ["a_n"]);
    assert_eq!(
        refusal("time_s,,a_n\n0,1,2\n"),
        "a.csv: line 1: column 2 has no name\n  remedy: name it, or remove it and its comma"
    );
    assert_eq!(
        refusal("time_s;a_n\n0,0;1,5\n"),
        "a.csv: line 1: the columns are separated by semicolons\n  remedy: say delimiter = \";\" in recordings.toml \
             (`smam import` writes it), or save the file with commas between the columns and points as decimal marks"
    );
}

#[test]
fn row_errors() {
    assert_eq!(
        refusal("time_s,a_n\n0,1\n1,1,5\n"),
        "a.csv: line 3: 3 cells where the header names 2 columns\n  remedy: fill up the row, leaving missing cells \
             empty between commas, and write decimals with a point"
    );
    assert_eq!(
        refusal("time_s,a_n\n0,1\n1,off\n"),
        "a.csv: line 3, column \"a_n\": \"off\" is not a finite number\n  remedy: write a number with a point as \
             decimal mark, or leave the cell empty where the sample is missing; if \"off\" marks missing samples, say missing = \
             [\"off\"] in recordings.toml"
    );
    assert!(refusal("time_s,a_n\n0,inf\n").contains("not a finite number"));
    assert_eq!(
        refusal("time_s,a_n\n0,1\n0.1,1\n0.1,1\n"),
        "a.csv: line 4, column \"time_s\": 0.1 is not after 0.1\n  remedy: remove repeated rows, sort the rows by \
             time, or split the file where its clock starts anew; or say merge_repeated = true in recordings.toml: the mean of \
             the rows of one stamp"
    );
    assert_eq!(
        refusal("time_s,a_n\n,1\n"),
        "a.csv: line 2, column \"time_s\": the time is missing\n  remedy: give every row its time, or remove the row"
    );
}

#[test]
fn what_spreadsheets_and_loggers_write_has_a_remedy_of_its_own() {
    assert_eq!(
        refusal("time_s,a_n\ns,N\n0,1\n"),
        "a.csv: line 2: words where the first numbers should be: \"s, N\"\n  remedy: remove the line (the end of a column's \
         name says its unit, as in plunger_mm), or say units_row = true in recordings.toml"
    );
    assert!(refusal("time_s,a_n\n0,\"0,5\"\n").contains("remedy: write decimals with a point: 0.5"));
    // Stamps that are no dispute are read, others are not.
    assert_eq!(read("time_s,a_n\n2026-03-01T10:00:00Z,1\n2026-03-01T10:00:00.5Z,1\n").unwrap().time_s(), [0.0, 0.5]);
    for clock in ["2026-03-01", "3/1/2026 10:00:01"] {
        assert!(refusal(&format!("time_s,a_n\n{clock},1\n")).contains("remedy: give the time in seconds as a number"));
    }
    let mixed = refusal("time_s,a_n\n2026-03-01T10:00:00Z,1\n2026-03-01T10:00:01,1\n");
    assert!(mixed.contains("remedy: write all with a zone or all without"), "{mixed}");
    assert!(read("time_s,a_n,b_n\n0,NaN,nan\n").is_ok());
}

#[test]
fn lines_count_blank_ones_and_text_must_be_utf8() {
    assert!(refusal("time_s,a_n\n0,1\n\n1,x\n").starts_with("a.csv: line 4, "));
    assert!(refusal("\u{feff}time_s,a_n\r\n0,1\r\n1,x\r\n").starts_with("a.csv: line 3, "));
    let error = read_csv_from(&b"time_s,a_n\n0,\xff\n"[..], "a.csv").unwrap_err();
    assert_eq!(
        error.to_string(),
        "a.csv: line 2: is not UTF-8 text\n  remedy: save the file as CSV in UTF-8, or say encoding = \"windows-1252\" in recordings.toml"
    );
}

#[test]
fn what_is_no_csv_is_said_with_its_cause() {
    assert!(refusal("0,0\n0.1,0.1\n").starts_with("a.csv: line 1: there are numbers where the names"));
    let utf16: Vec<u8> = "time_s,a_n\n0,1\n".bytes().flat_map(|byte| [byte, 0]).collect();
    let error = read_csv_from(&utf16[..], "a.csv").unwrap_err().to_string();
    assert!(error.starts_with("a.csv: line 1: is not UTF-8 text but UTF-16"), "{error}");
    // An open quote takes in all that follows: only its beginning is shown.
    let open = refusal(&format!("time_s,a_n\n0,\"1\n{}", "0.1,2\n".repeat(1000)));
    assert!(open.contains("\"1\\n0.1,2\\n") && open.len() < 300, "{open}");
    assert!(refusal("time_s,a_n\n0,1\n1e300,2\n").contains("1e6 s after 0"));
}

#[test]
fn absent_file_is_named() {
    let error = read_csv(Path::new("no/such.csv")).unwrap_err().to_string();
    assert!(error.starts_with("no/such.csv: cannot be read: "), "{error}");
}
