//! Contract: files as labs write them are read, and their numbers are those of the clean file. Each is made here, described by
//! `smam import` alone, and read by what it wrote.

use std::fmt::Write as _;
use std::fs;
use std::io::{Cursor, Write as _};
use std::path::Path;
use std::process::{Command, Output};

use smam::recording::{LoadedRun, RecordingSet, read_recording};
use tempfile::TempDir;
use zip::write::SimpleFileOptions;

const ROWS: usize = 120;
const CHANNELS: [&str; 4] = ["plunger_mm", "elongation_mm", "pressure_kpa", "force_n"];

/// What was measured: time in ms (whole), and the channels with four digits behind the point.
fn clean() -> Vec<(i64, [f64; 4])> {
    let four = |v: f64| (v * 1e4).round() / 1e4;
    let row = |i: usize| {
        let phase = 0.05 * i as f64;
        let plunger = 1.5 * (1.0 - phase.cos());
        (
            10 * i as i64,
            [plunger, 9.0 * plunger - 0.3 * phase.sin(), 600.0 * plunger - 20.0, 0.2 + 0.1 * plunger].map(four),
        )
    };
    (0..ROWS).map(row).collect()
}

/// How a table is written.
struct Style {
    names: [&'static str; 5],
    delimiter: &'static str,
    number: fn(f64) -> String,
    time: fn(i64) -> String,
    factors: [f64; 4],
    above: &'static str,
    below_names: &'static str,
    line_end: &'static str,
}

const PLAIN: Style = Style {
    names: ["time_s", "plunger_mm", "elongation_mm", "pressure_kpa", "force_n"],
    delimiter: ",",
    number: point,
    time: |ms| format!("{}.{:03}", ms / 1000, ms % 1000),
    factors: [1.0; 4],
    above: "",
    below_names: "",
    line_end: "\n",
};

const BRACKETS: [&str; 5] = ["Time [ms]", "Plunger [mm]", "Elongation [mm]", "Pressure [kPa]", "Force [N]"];

fn point(v: f64) -> String {
    v.to_string()
}

fn comma(v: f64) -> String {
    v.to_string().replace('.', ",")
}

fn ms(ms: i64) -> String {
    ms.to_string()
}

impl Style {
    fn text(&self) -> String {
        let mut text = self.above.to_owned();
        if self.names[0] != "-" {
            text += &(self.names.join(self.delimiter) + self.line_end);
        }
        text += self.below_names;
        for (at, values) in clean() {
            let numbers = values.iter().zip(self.factors).map(|(v, factor)| (self.number)(v / factor));
            let cells: Vec<String> = std::iter::once((self.time)(at)).chain(numbers).collect();
            text += &(cells.join(self.delimiter) + self.line_end);
        }
        text
    }
}

fn smam(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_smam")).args(arguments).current_dir(folder).output().expect("it starts")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Describes a file by `smam import` and reads it by that.
fn imported(name: &str, bytes: &[u8]) -> (TempDir, String, Vec<LoadedRun>) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join(name), bytes).expect("written");
    let output = smam(&["import", name, "--scene", "muscle_bench"], folder.path());
    let said = said(&output);
    let written = fs::read_to_string(folder.path().join("recordings.toml")).unwrap_or_default();
    assert!(output.status.success(), "{said}\n{written}");
    let set = RecordingSet::load(folder.path()).unwrap_or_else(|e| panic!("{e}\n{written}"));
    let parts = set.load_parts(&set.runs[0]).unwrap_or_else(|e| panic!("{e}\n{written}"));
    (folder, written, parts)
}

/// The rows of a part against those of the clean file; `None` where a value is missing.
fn same(part: &LoadedRun, expected: &[(f64, [Option<f64>; 4])]) {
    let recording = &part.recording;
    assert_eq!(recording.sample_count(), expected.len());
    for (row, (time_s, values)) in expected.iter().enumerate() {
        assert!((recording.time_s()[row] - time_s).abs() < 1e-9, "row {row}: {} s", recording.time_s()[row]);
        for (column, value) in CHANNELS.iter().zip(values) {
            let read = recording.channel(column).expect("declared").values[row];
            let value = value.unwrap_or(f64::NAN);
            let is_same = (read.is_nan() && value.is_nan()) || (read - value).abs() <= 1e-9 * value.abs().max(1.0);
            assert!(is_same, "row {row}, {column}: {read} for {value}");
        }
    }
}

fn expected() -> Vec<(f64, [Option<f64>; 4])> {
    clean().into_iter().map(|(ms, values)| (ms as f64 / 1000.0, values.map(Some))).collect()
}

/// Imported, and every number right.
fn holds(name: &str, bytes: &[u8]) -> String {
    let (_folder, written, parts) = imported(name, bytes);
    assert_eq!(parts.len(), 1, "{written}");
    same(&parts[0], &expected());
    written
}

#[test]
fn messy_01_decimal_commas_and_semicolons() {
    let style = Style { delimiter: ";", number: comma, time: |ms| comma(ms as f64 / 1000.0), ..PLAIN };
    let written = holds("a.csv", style.text().as_bytes());
    assert!(written.contains("delimiter = \";\"") && written.contains("decimal = \",\""), "{written}");
}

#[test]
fn messy_02_tabs() {
    holds("a.txt", Style { delimiter: "\t", ..PLAIN }.text().as_bytes());
}

#[test]
fn messy_03_milliseconds_and_units_in_brackets() {
    holds("a.csv", Style { names: BRACKETS, time: ms, ..PLAIN }.text().as_bytes());
}

#[test]
fn messy_04_minutes() {
    let names = ["Elapsed (min)", "Plunger (mm)", "Elongation (mm)", "Pressure (kPa)", "Force (N)"];
    holds("a.csv", Style { names, time: |ms| (ms as f64 / 60_000.0).to_string(), ..PLAIN }.text().as_bytes());
}

#[test]
fn messy_05_a_row_of_units() {
    let style = Style {
        names: ["Time", "Plunger", "Elongation", "Pressure", "Force"],
        below_names: "ms,mm,mm,bar,N\n",
        time: ms,
        factors: [1.0, 1.0, 100.0, 1.0],
        ..PLAIN
    };
    let written = holds("a.csv", style.text().as_bytes());
    assert!(written.contains("units_row = true") && written.contains("unit = \"bar\""), "{written}");
}

#[test]
fn messy_06_marks_of_missing_samples() {
    let text = Style { names: BRACKETS, time: ms, ..PLAIN }.text();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let mut rows = expected();
    for (row, mark) in [(10, "NaN"), (11, "n.a."), (12, "-"), (13, ""), (14, "#N/A"), (15, "N/A")] {
        let (head, _) = lines[row + 1].rsplit_once(',').expect("cells");
        lines[row + 1] = format!("{head},{mark}");
        rows[row].1[3] = None;
    }
    let (_folder, _, parts) = imported("a.csv", lines.join("\n").as_bytes());
    same(&parts[0], &rows);
}

#[test]
fn messy_07_comments() {
    let above = "# rig 3, Monday\n# operator: N. N.; gain 2,5\n% calibrated\n\n";
    let text = Style { above, ..PLAIN }.text().replace("\n0.5,", "\n# valve opened\n0.5,");
    holds("a.csv", text.as_bytes());
}

#[test]
fn messy_08_utf8_with_a_byte_order_mark() {
    holds("a.csv", format!("\u{feff}{}", PLAIN.text()).as_bytes());
}

fn utf16(text: &str, big_endian: bool, mark: bool) -> Vec<u8> {
    let units = mark.then_some(0xfeff).into_iter().chain(text.encode_utf16());
    units.flat_map(|u| if big_endian { u.to_be_bytes() } else { u.to_le_bytes() }).collect()
}

#[test]
fn messy_09_utf16_little_endian() {
    let text = Style { delimiter: "\t", ..PLAIN }.text();
    holds("a.txt", &utf16(&text, false, true));
    let written = holds("b.txt", &utf16(&text, false, false));
    assert!(written.contains("encoding = \"utf-16le\""), "{written}");
}

#[test]
fn messy_10_utf16_big_endian() {
    holds("a.txt", &utf16(&PLAIN.text(), true, true));
    holds("b.txt", &utf16(&PLAIN.text(), true, false));
}

#[test]
fn messy_11_latin_1_with_a_degree_sign() {
    let names = ["Zeit [ms]", "Kolben [µm]", "Dehnung [mm]", "Druck [kPa]", "Kraft [N]"];
    let style = Style { names, time: ms, factors: [1e-3, 1.0, 1.0, 1.0], above: "# Ofen bei 21 °C\n", ..PLAIN };
    let latin: Vec<u8> = style.text().chars().map(|c| c as u8).collect();
    let written = holds("a.csv", &latin);
    assert!(written.contains("encoding = \"windows-1252\""), "{written}");
}

/// A workbook of one sheet with these rows of XML cells.
fn workbook(rows: &str) -> Vec<u8> {
    workbook_of(&[("Run 1", rows)])
}

/// A workbook of named sheets.
fn workbook_of(sheets: &[(&str, &str)]) -> Vec<u8> {
    let each = |part: &dyn Fn(usize) -> String| (1..=sheets.len()).map(part).collect::<String>();
    let types = each(&|i| {
        format!(
            "<Override PartName=\"/xl/worksheets/sheet{i}.xml\" ContentType=\"application/vnd.openxmlformats-officedocument.spreadsheetml.worksheet+xml\"/>"
        )
    });
    let named = each(&|i| format!("<sheet name=\"{}\" sheetId=\"{i}\" r:id=\"r{i}\"/>", sheets[i - 1].0));
    let main = "http://schemas.openxmlformats.org/spreadsheetml/2006/main";
    let office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships";
    let package = "http://schemas.openxmlformats.org/package/2006";
    let targets = each(&|i| {
        format!("<Relationship Id=\"r{i}\" Type=\"{office}/worksheet\" Target=\"worksheets/sheet{i}.xml\"/>")
    });
    let parts = [
        (
            "[Content_Types].xml".to_owned(),
            format!(
                "<Types xmlns=\"{package}/content-types\"><Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/><Default Extension=\"xml\" ContentType=\"application/xml\"/><Override PartName=\"/xl/workbook.xml\" ContentType=\"application/vnd.openxmlformats-officedocument.spreadsheetml.sheet.main+xml\"/>{types}</Types>"
            ),
        ),
        (
            "_rels/.rels".to_owned(),
            format!(
                "<Relationships xmlns=\"{package}/relationships\"><Relationship Id=\"r1\" Type=\"{office}/officeDocument\" Target=\"xl/workbook.xml\"/></Relationships>"
            ),
        ),
        (
            "xl/workbook.xml".to_owned(),
            format!("<workbook xmlns=\"{main}\" xmlns:r=\"{office}\"><sheets>{named}</sheets></workbook>"),
        ),
        (
            "xl/_rels/workbook.xml.rels".to_owned(),
            format!("<Relationships xmlns=\"{package}/relationships\">{targets}</Relationships>"),
        ),
    ];
    let tables = sheets.iter().enumerate().map(|(i, (_, rows))| {
        let table = format!("<worksheet xmlns=\"{main}\"><sheetData>{rows}</sheetData></worksheet>");
        (format!("xl/worksheets/sheet{}.xml", i + 1), table)
    });
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts.into_iter().chain(tables) {
        archive
            .start_file(name, SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored))
            .expect("a part");
        archive.write_all(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>{text}").as_bytes()).expect("written");
    }
    archive.finish().expect("an archive").into_inner()
}

/// Rows of XML cells: the clean file, each cell as `cell` writes its value in a row and column, and what stands beside.
fn sheet(cell: impl Fn(usize, usize, String) -> String, beside: impl Fn(usize) -> String) -> String {
    let name = |column: usize, text: &str| {
        format!("<c r=\"{}1\" t=\"inlineStr\"><is><t>{text}</t></is></c>", char::from(b'A' + column as u8))
    };
    let names: String = BRACKETS.iter().enumerate().map(|(i, t)| name(i, t)).collect();
    let row = |(index, (at, values)): (usize, (i64, [f64; 4]))| {
        let texts = std::iter::once(at.to_string()).chain(values.iter().map(f64::to_string));
        let cells: String = texts.enumerate().map(|(column, text)| cell(index + 2, column, text)).collect();
        format!("<row r=\"{0}\">{cells}{1}</row>", index + 2, beside(index + 2))
    };
    format!("<row r=\"1\">{names}</row>{}", clean().into_iter().enumerate().map(row).collect::<String>())
}

fn cell_name(row: usize, column: usize) -> String {
    format!("{}{row}", char::from(b'A' + column as u8))
}

fn number_cell(row: usize, column: usize, text: String) -> String {
    format!("<c r=\"{}\"><v>{text}</v></c>", cell_name(row, column))
}

fn text_cell(row: usize, column: usize, text: &str) -> String {
    format!("<c r=\"{}\" t=\"inlineStr\"><is><t>{text}</t></is></c>", cell_name(row, column))
}

/// What a program writes that does not calculate: neither dropped nor taken for missing samples.
#[test]
fn formulas_without_values_are_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let formula = |columns: std::ops::Range<usize>| {
        sheet(
            |row, column, text| match columns.contains(&column) {
                true => format!("<c r=\"{}\"><f>A{row}*2</f><v/></c>", cell_name(row, column)),
                false => number_cell(row, column, text),
            },
            |_| String::new(),
        )
    };
    for (columns, words) in [(3..4, "\"=A2*2\" is not a finite number"), (1..5, "its formulas have no saved values")] {
        fs::write(folder.path().join("a.xlsx"), workbook(&formula(columns))).expect("written");
        let output = smam(&["import", "a.xlsx", "--scene", "muscle_bench", "--force"], folder.path());
        assert!(!output.status.success(), "{}", said(&output));
        assert!(said(&output).contains(words) && said(&output).contains("let it calculate"), "{}", said(&output));
    }
}

#[test]
fn numbers_that_a_workbook_holds_as_texts_are_read() {
    let written = holds(
        "a.xlsx",
        &workbook(&sheet(|row, column, text| text_cell(row, column, &text.replace('.', ",")), |_| String::new())),
    );
    assert!(written.contains("decimal = \",\""), "{written}");
    holds("a.xlsx", &workbook(&sheet(|row, column, text| text_cell(row, column, &text), |_| String::new())));
}

#[test]
fn a_remark_beside_a_table_is_none_of_it() {
    let remark = |row: usize| if row == 5 { text_cell(row, 6, "valve sticks") } else { String::new() };
    let rows = sheet(number_cell, remark);
    holds("a.xlsx", &workbook(&rows));
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.xlsx"), workbook(&rows)).expect("written");
    let output = smam(&["import", "a.xlsx", "--scene", "muscle_bench"], folder.path());
    assert!(said(&output).contains("beside the table is not read: \"valve sticks\""), "{}", said(&output));
}

#[test]
fn messy_12_a_workbook() {
    let name = |column: usize, text: &str| {
        format!("<c r=\"{}1\" t=\"inlineStr\"><is><t>{text}</t></is></c>", char::from(b'A' + column as u8))
    };
    let mut rows =
        format!("<row r=\"1\">{}</row>", BRACKETS.iter().enumerate().map(|(i, t)| name(i, t)).collect::<String>());
    for (index, (at, values)) in clean().into_iter().enumerate() {
        let number = index + 2;
        write!(rows, "<row r=\"{number}\"><c r=\"A{number}\"><v>{at}</v></c>").expect("text");
        for (column, value) in values.iter().enumerate() {
            let letter = char::from(b'B' + column as u8);
            write!(rows, "<c r=\"{letter}{number}\"><v>{value}</v></c>").expect("text");
        }
        rows += "</row>";
    }
    holds("a.xlsx", &workbook(&rows));
}

/// Why a workbook with these rows is not read.
fn refusal(rows: &str) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("refused.xlsx");
    fs::write(&file, workbook(rows)).expect("written");
    read_recording(&file).expect_err("refused").to_string()
}

#[test]
fn a_stray_cell_far_away_is_refused() {
    let message = refusal("<row r=\"1048576\"><c r=\"XFD1048576\"><v>1</v></c></row>");
    assert!(message.contains("1048576 rows and 16384 columns"), "{message}");
    assert!(message.contains("delete the stray cells"), "{message}");
}

/// A damaged reference names a column in the hundred thousands: found by fuzzing, it took ten seconds to fill the row up to there.
#[test]
fn a_cell_where_no_sheet_has_one_is_refused() {
    let message = refusal("<row r=\"2\"><c r=\"ABCDE2\"><v>1</v></c></row>");
    assert!(message.contains("row 2, column 494265") && message.contains("remedy: save it again"), "{message}");
}

#[test]
fn messy_13_repeated_stamps() {
    // A clock of 20 ms: two rows a stamp.
    let style = Style { names: BRACKETS, time: |ms| (ms / 20 * 20).to_string(), ..PLAIN };
    let (_folder, written, parts) = imported("a.csv", style.text().as_bytes());
    assert!(written.contains("merge_repeated = true"), "{written}");
    let rows = clean();
    let mean = |pair: &[(i64, [f64; 4])]| {
        (pair[0].0 as f64 / 1000.0, std::array::from_fn(|c| Some((pair[0].1[c] + pair[1].1[c]) / 2.0)))
    };
    same(&parts[0], &rows.chunks(2).map(mean).collect::<Vec<_>>());
    assert!(
        parts[0].notes.iter().any(|n| n.contains("60 rows had the stamp of the row before")),
        "{:?}",
        parts[0].notes
    );
}

#[test]
fn messy_14_a_clock_that_starts_anew() {
    let style = Style { names: BRACKETS, time: |ms| (ms % 600).to_string(), ..PLAIN };
    let (folder, written, parts) = imported("a.csv", style.text().as_bytes());
    assert!(written.contains("split_at_restart = true"), "{written}");
    assert_eq!(parts.len(), 2);
    let shifted =
        |rows: &[(f64, [Option<f64>; 4])], by: f64| rows.iter().map(|(t, v)| (t - by, *v)).collect::<Vec<_>>();
    same(&parts[0], &expected()[..60]);
    same(&parts[1], &shifted(&expected()[60..], 0.6));
    let compared = smam(&["compare", "."], folder.path());
    assert!(said(&compared).contains("a.csv (part 2 of 2)"), "{}", said(&compared));
    assert!(said(&compared).contains("Each is simulated as a start from rest"), "{}", said(&compared));
    // Its remedy: one run with an even clock.
    assert!(said(&compared).contains("say interval_s = 0.01 in the place of split_at_restart"), "{}", said(&compared));
    let even = written.replace("split_at_restart = true", "interval_s = 0.01").replace("time_unit = \"ms\"\n", "");
    fs::write(folder.path().join("recordings.toml"), even).expect("written");
    let set = RecordingSet::load(folder.path()).expect("a set");
    same(&set.load_run(&set.runs[0]).expect("one run"), &expected());
}

#[test]
fn messy_15_date_columns() {
    let text: String = Style { names: BRACKETS, time: ms, ..PLAIN }
        .text()
        .lines()
        .enumerate()
        .map(|(i, line)| format!("{},{line}\n", if i == 0 { "Date" } else { "12/31/2026" }))
        .collect();
    let written = holds("a.csv", text.as_bytes());
    assert!(written.contains("time_column = \"Time [ms]\""), "{written}");
}

#[test]
fn messy_16_iso_stamps_with_a_zone() {
    let time = |ms: i64| format!("2026-03-01T23:59:{:02}.{:03}+01:00", 58 + ms / 1000, ms % 1000);
    let names = ["timestamp", "plunger_mm", "elongation_mm", "pressure_kpa", "force_n"];
    holds("a.csv", Style { names, time, ..PLAIN }.text().as_bytes());
}

#[test]
fn messy_17_iso_stamps_without_zone() {
    let time = |ms: i64| format!("2026-03-01 23:59:{:02}.{:03}", 58 + ms / 1000, ms % 1000);
    let names = ["Timestamp", "plunger_mm", "elongation_mm", "pressure_kpa", "force_n"];
    holds("a.csv", Style { names, time, ..PLAIN }.text().as_bytes());
}

#[test]
fn messy_18_text_columns() {
    let text: String = PLAIN
        .text()
        .lines()
        .enumerate()
        .map(|(i, line)| format!("{line},{}\n", if i == 0 { "state" } else { "moving \"slow\"" }))
        .collect();
    let (_folder, written, parts) = imported("a.csv", text.as_bytes());
    same(&parts[0], &expected());
    assert!(written.contains("\"state\" holds texts"), "{written}");
    assert!(parts[0].notes.iter().any(|n| n.contains("not read: state")), "{:?}", parts[0].notes);
}

#[test]
fn messy_19_labview() {
    let head = "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\nMulti_Headings\tNo\n\
                X_Columns\tOne\nTime_Pref\tRelative\nOperator\tlab\nDate\t2026/03/01\nTime\t10:00:00,5\n***End_of_Header***\t\n\t\n\
                Channels\t4\t\t\t\nSamples\t120\t120\t120\t120\nX_Dimension\tTime\tTime\tTime\tTime\nX0\t0\t0\t0\t0\n\
                Delta_X\t0,01\t0,01\t0,01\t0,01\n***End_of_Header***\t\t\t\t\n";
    let names = ["X_Value", "Plunger mm", "Elongation mm", "Pressure kPa", "Force N\tComment"];
    let style =
        Style { names, above: head, delimiter: "\t", number: comma, time: |ms| comma(ms as f64 / 1000.0), ..PLAIN };
    holds("a.lvm", style.text().as_bytes());
}

#[test]
fn messy_20_no_names() {
    let folder = tempfile::tempdir().expect("a folder");
    let style = Style { names: ["-", "", "", "", ""], ..PLAIN };
    fs::write(folder.path().join("a.csv"), style.text()).expect("written");
    let output = smam(&["import", "a.csv", "--scene", "muscle_bench"], folder.path());
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    // What it could not know is filled in as it says.
    let path = folder.path().join("recordings.toml");
    let mut written = fs::read_to_string(&path).expect("written");
    assert!(written.contains("header = false") && written.contains("time_column = \"column 1\""), "{written}");
    for (column, (name, role)) in
        CHANNELS.iter().zip([("2", "input"), ("3", "output"), ("4", "output"), ("5", "output")])
    {
        let lines =
            format!("\n[[channel]]\ncolumn = \"{column}\"\nrole = \"{role}\"\nname = \"column {name}\"\n\n[[run]]");
        written = written.replacen("\n[[run]]", &lines, 1);
    }
    fs::write(&path, &written).expect("written");
    let set = RecordingSet::load(folder.path()).unwrap_or_else(|e| panic!("{e}\n{written}"));
    same(&set.load_run(&set.runs[0]).unwrap_or_else(|e| panic!("{e}\n{written}")), &expected());
}

#[test]
fn messy_21_thousands_points() {
    fn grouped(v: f64) -> String {
        let text = comma(v);
        let (whole, rest) = text.split_once(',').map_or((text.as_str(), ""), |(w, r)| (w, r));
        let digits = whole.trim_start_matches('-');
        let sign = if digits.len() < whole.len() { "-" } else { "" };
        let cut = digits.len().saturating_sub(3);
        let mark = if cut > 0 { "." } else { "" };
        let comma = if rest.is_empty() { "" } else { "," };
        format!("{sign}{}{mark}{}{comma}{rest}", &digits[..cut], &digits[cut..])
    }
    let style = Style { names: BRACKETS, delimiter: ";", number: grouped, time: |ms| grouped(ms as f64), ..PLAIN };
    let written = holds("a.csv", style.text().as_bytes());
    assert!(written.contains("thousands = \".\""), "{written}");
}

#[test]
fn messy_22_a_stray_thousands_point_in_the_time() {
    // 1.190.000 is 1190 ms.
    fn stray(ms: i64) -> String {
        if ms < 1000 { format!("{ms}.000") } else { format!("{}.{:03}.000", ms / 1000, ms % 1000) }
    }
    holds("a.csv", Style { names: BRACKETS, delimiter: ";", time: stray, ..PLAIN }.text().as_bytes());
}

#[test]
fn messy_23_quoted_fields_and_a_trailing_delimiter() {
    // Decimal commas in quotes between commas: the quotes keep them apart.
    let row =
        |(at, values): (i64, [f64; 4])| format!("{at},{},\n", values.map(|v| format!("\"{}\"", comma(v))).join(","));
    let names = BRACKETS.map(|name| format!("\"{name}\"")).join(",");
    let text = format!("{names},\n{}", clean().into_iter().map(row).collect::<String>());
    holds("a.csv", text.replace(",\"", ";\"").replace(",\n", ";\n").as_bytes());
    holds("b.csv", text.as_bytes());
}

#[test]
fn messy_24_empty_rows_at_the_end_and_windows_line_ends() {
    let style = Style { names: BRACKETS, delimiter: ";", number: comma, time: ms, line_end: "\r\n", ..PLAIN };
    holds("a.csv", (style.text() + ";;;;\r\n;;;;\r\n\r\n").as_bytes());
}

#[test]
fn messy_25_psi_and_pounds() {
    let names = ["t / s", "plunger / in", "elongation / in", "pressure / psi", "force / lbf"];
    let factors = [25.4, 25.4, 6.894_757_293_168_361, 4.448_221_615_260_5];
    holds("a.csv", Style { names, factors, ..PLAIN }.text().as_bytes());
}

#[test]
fn messy_26_centimetres_millibar_and_volts() {
    let names = ["Time, s", "Piston (cm)", "Laser (cm)", "Druck (mbar)", "Load cell [V]"];
    let factors = [10.0, 10.0, 0.1, 2.5];
    let folder = tempfile::tempdir().expect("a folder");
    // A comma in a name: it is quoted.
    let text = Style { names, factors, ..PLAIN }.text().replace("Time, s", "\"Time, s\"");
    fs::write(folder.path().join("a.csv"), text).expect("written");
    let output = smam(&["import", ".", "--scene", "muscle_bench"], folder.path());
    let path = folder.path().join("recordings.toml");
    let written = fs::read_to_string(&path).unwrap_or_else(|_| panic!("{}", said(&output)));
    // Not silently with 1: neither here nor by whoever reads what was written.
    let open = "scale = \"to be filled in: the N of one V\"";
    assert!(output.status.code() == Some(1) && said(&output).contains("fill in scale of force_n"), "{}", said(&output));
    assert!(written.contains(open), "{written}");
    let refused = RecordingSet::load(folder.path()).expect_err("open").to_string();
    assert!(refused.contains("is still open") && refused.contains("remedy: write the number"), "{refused}");
    fs::write(&path, written.replace(open, "scale = 2.5")).expect("written");
    let set = RecordingSet::load(folder.path()).expect("a set");
    same(&set.load_run(&set.runs[0]).unwrap_or_else(|e| panic!("{e}\n{written}")), &expected());
}

/// Radians in a column of degrees' scene, by a scene with an angle.
#[test]
fn messy_27_radians_and_revolutions() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "t [s];Motor [rev];Tip [rad]\n0;0;0\n0,1;0,25;0,5\n0,2;0,5;1\n0,3;0,75;1,5\n";
    fs::write(folder.path().join("a.csv"), text).expect("written");
    let output = smam(&["import", "a.csv", "--scene", "tendon_sheath"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let set = RecordingSet::load(folder.path()).expect("a set");
    let read = set.load_run(&set.runs[0]).expect("a run").recording;
    assert_eq!(read.channel("drive_deg").expect("it").values, [0.0, 90.0, 180.0, 270.0]);
    let tip = &read.channel("tip_deg").expect("it").values;
    assert!((tip[3] - 1.5_f64.to_degrees()).abs() < 1e-9, "{tip:?}");
}

#[test]
fn messy_28_gbk() {
    let names = ["时间(ms)", "活塞(mm)", "位移(mm)", "压力(bar)", "力(N)"];
    let style = Style { names, time: ms, factors: [1.0, 1.0, 100.0, 1.0], ..PLAIN };
    let text = style.text();
    let written = holds("a.csv", &encoding_rs::GBK.encode(&text).0);
    assert!(written.contains("encoding = \"gbk\""), "{written}");
}

#[test]
fn what_is_there_is_not_written_over() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.csv"), PLAIN.text()).expect("written");
    fs::write(folder.path().join("recordings.toml"), "mine\n").expect("written");
    let refused = smam(&["import", "a.csv"], folder.path());
    assert!(refused.status.code() == Some(2) && said(&refused).contains("--force"), "{}", said(&refused));
    assert_eq!(fs::read_to_string(folder.path().join("recordings.toml")).expect("there"), "mine\n");
    // Its remedies: by force, or elsewhere. The scene is found by the names.
    assert!(smam(&["import", "a.csv", "--out", "elsewhere"], folder.path()).status.success());
    let elsewhere = RecordingSet::load(&folder.path().join("elsewhere")).expect("a set");
    assert_eq!(elsewhere.scene, "muscle_bench");
    same(&elsewhere.load_run(&elsewhere.runs[0]).expect("a run"), &expected());
    assert!(smam(&["import", "a.csv", "--force"], folder.path()).status.success());
}

/// Rows of the bench under a leak, so that there is something to diagnose: made by the program, renamed as a lab would.
fn recorded_bench(folder: &Path, arguments: &[&str]) -> String {
    let run = [&["run", "muscle_bench", "--duration", "4", "--output", "made.csv"], arguments].concat();
    let output = smam(&run, folder);
    assert!(output.status.success(), "{}", said(&output));
    fs::read_to_string(folder.join("made.csv")).expect("written")
}

fn first_rows(text: &str, rows: usize) -> String {
    text.lines().take(rows + 1).map(|line| format!("{line}\n")).collect()
}

/// One column of a made file multiplied.
fn scaled(text: &str, column: &str, factor: f64) -> String {
    let names: Vec<&str> = text.lines().next().expect("names").split(',').collect();
    let at = names.iter().position(|name| *name == column).expect("the column");
    let line = |line: &str| {
        let cells = line.split(',').enumerate();
        cells
            .map(
                |(i, c)| {
                    if i == at { (c.parse::<f64>().expect("a number") * factor).to_string() } else { c.to_owned() }
                },
            )
            .collect::<Vec<_>>()
            .join(",")
    };
    std::iter::once(names.join(",")).chain(text.lines().skip(1).map(line)).map(|l| l + "\n").collect()
}

#[test]
fn one_well_named_file_is_compared_and_diagnosed_as_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = recorded_bench(folder.path(), &["--set", "muscles.friction.m0_n=0.15"]);
    let renamed = made.replacen("time_s,plunger_mm,elongation_mm", "Time [s],Plunger [mm],Elongation [mm]", 1);
    fs::write(folder.path().join("sine.csv"), renamed.replace(',', ";").replace('.', ",")).expect("written");
    let compared = smam(&["compare", "sine.csv", "--scene", "muscle_bench"], folder.path());
    assert!(compared.status.success() && said(&compared).contains("elongation_mm"), "{}", said(&compared));
    // Too short for a verdict, which keeps it brief; but read.
    fs::write(
        folder.path().join("short.csv"),
        first_rows(&made, 40).replacen("time_s,plunger_mm", "Time [s],Plunger [mm]", 1),
    )
    .expect("written");
    let diagnosed = smam(&["diagnose", "short.csv", "--scene", "muscle_bench", "--out", "answer"], folder.path());
    assert!(said(&diagnosed).contains("samples: record at least"), "{}", said(&diagnosed));
    assert!(folder.path().join("answer/diagnosis.json").is_file());
    // A column nobody can know: refused, with the way.
    fs::write(folder.path().join("odd.csv"), made.replacen("plunger_mm", "a0", 1)).expect("written");
    let refused = said(&smam(&["diagnose", "odd.csv", "--scene", "muscle_bench"], folder.path()));
    assert!(refused.contains("no column is like the input plunger_mm") && refused.contains("smam import"), "{refused}");
}

/// The unit of a channel that moves 10, 25, 57, 100 or 1000 times too far or too little is named by both commands, and what they
/// say makes the numbers right.
#[test]
fn units_are_told_by_size_and_the_remedy_is_right() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = recorded_bench(folder.path(), &[]);
    for (column, unit, factor) in [
        ("elongation_mm", "cm", 0.1),
        ("elongation_mm", "m", 1e-3),
        ("pressure_kpa", "psi", 1.0 / 6.894_757_293_168_361),
        ("pressure_kpa", "bar", 0.01),
    ] {
        fs::write(folder.path().join("sine.csv"), scaled(&made, column, factor)).expect("written");
        assert!(smam(&["import", "sine.csv", "--force"], folder.path()).status.success());
        let wanted = format!("unit = \"{unit}\"");
        // What physics might do as well is warned of, not refused: a whole diagnosis would follow.
        let is_beyond_physics = !(0.05..=20.0).contains(&factor);
        let diagnose = is_beyond_physics.then_some(&["diagnose", ".", "--out", "answer"][..]);
        for command in std::iter::once(&["compare", "."][..]).chain(diagnose) {
            let said = said(&smam(command, folder.path()));
            assert!(said.contains(&wanted) && said.contains(column), "{column} in {unit}, {command:?}: {said}");
        }
        let path = folder.path().join("recordings.toml");
        let written = fs::read_to_string(&path).expect("written");
        let line = format!("column = \"{column}\"\n");
        fs::write(&path, written.replace(&line, &format!("{line}{wanted}\n"))).expect("written");
        let fixed = said(&smam(&["compare", "."], folder.path()));
        assert!(!fixed.contains("as far as the scene does"), "{fixed}");
    }
}

#[test]
fn rows_without_a_clock_are_read_and_the_verdict_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let made = recorded_bench(folder.path(), &[]);
    let bare: String = made.lines().map(|line| line.split_once(',').expect("cells").1.to_owned() + "\n").collect();
    fs::write(folder.path().join("sine.csv"), &bare).expect("written");
    let output = smam(&["import", "sine.csv", "--scene", "muscle_bench"], folder.path());
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    let path = folder.path().join("recordings.toml");
    let written = fs::read_to_string(&path).expect("written");
    assert!(written.contains("#   time = \"index\""), "{written}");
    let declared = |lines: &str| {
        fs::write(&path, written.replacen("\n# No column", &format!("\n[file]\n{lines}\n# No column"), 1))
            .expect("written")
    };
    declared("interval_s = 0.01");
    let even = said(&smam(&["compare", "."], folder.path()));
    assert!(even.contains("elongation_mm") && !even.contains("cannot be judged"), "{even}");
    declared("time = \"index\"\ninterval_s = 0.01");
    fs::write(folder.path().join("sine.csv"), first_rows(&bare, 40)).expect("written");
    let diagnosed = said(&smam(&["diagnose", ".", "--out", "answer"], folder.path()));
    assert!(diagnosed.contains("what depends on rate"), "{diagnosed}");
    let answer = fs::read_to_string(folder.path().join("answer/diagnosis.json")).expect("an answer");
    assert!(answer.contains("what depends on rate"), "{answer}");
    // Stamps that are there may be set aside.
    fs::write(folder.path().join("sine.csv"), &made).expect("written");
    declared("interval_s = 0.01");
    let aside = said(&smam(&["compare", "."], folder.path()));
    assert!(aside.contains("not read: time_s"), "{aside}");
}

/// A logger of the real recordings loses time between its blocks: said, where they are there.
#[test]
fn real_blocks_with_lost_time_are_said() {
    let set = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/recordings/real/cavatappi2022_sample1");
    if !set.is_dir() {
        eprintln!("skipped: {} is not there", set.display());
        return;
    }
    let set = RecordingSet::load(&set).expect("a set");
    let run = set.load_run(&set.runs[0]).expect("a run");
    let blocks = smam::recording::survey(&run.recording).blocks.expect("blocks of samples");
    assert_eq!(blocks.samples, 10);
    assert!(blocks.passed.is_some_and(|share| share > 0.5), "{blocks:?}");
}

/// Channels named by name alone; LabVIEW's header has their units in a row of its own.
#[test]
fn units_of_a_labview_header_are_read() {
    let head = "LabVIEW Measurement\t\nSeparator\tTab\nDecimal_Separator\t,\nX_Columns\tOne\n***End_of_Header***\t\n\t\n\
                Channels\t4\t\t\t\nSamples\t120\t120\t120\t120\nY_Unit_Label\tcm\tmm\tbar\tN\n***End_of_Header***\t\t\t\t\n";
    let names = ["X_Value", "Plunger", "Elongation", "Pressure", "Force\tComment"];
    let factors = [10.0, 1.0, 100.0, 1.0];
    let style = Style {
        names,
        above: head,
        delimiter: "\t",
        number: comma,
        time: |ms| comma(ms as f64 / 1000.0),
        factors,
        ..PLAIN
    };
    let written = holds("a.lvm", style.text().as_bytes());
    assert!(written.contains("unit = \"bar\"") && !written.contains("No unit is stated"), "{written}");
}

/// Files in a folder beside the recordings, and what is said of them.
#[test]
fn foreign_files_of_a_folder_are_left_out_and_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let rig = folder.path().join("rig");
    fs::create_dir(&rig).expect("made");
    fs::write(rig.join("a_notes.txt"), "Bled the line at noon.\nNothing else to say.\n").expect("written");
    fs::write(rig.join("b_scale.csv"), "volts,newtons\n0,0\n1,2.5\n2,5\n").expect("written");
    for name in ["sine.csv", "step.csv"] {
        fs::write(rig.join(name), PLAIN.text()).expect("written");
    }
    let output = smam(&["import", "rig"], folder.path());
    let text = said(&output);
    assert!(output.status.success(), "{text}");
    assert!(text.contains("left out: rig/a_notes.txt: no table of numbers is found in it"), "{text}");
    assert!(text.contains("left out: rig/b_scale.csv: no column \"time_s\", which rig/sine.csv has"), "{text}");
    let set = RecordingSet::load(&rig).expect("a set");
    assert_eq!(set.runs.iter().map(|r| r.file.as_str()).collect::<Vec<_>>(), ["sine.csv", "step.csv"]);
    let written = fs::read_to_string(rig.join("recordings.toml")).expect("written");
    assert!(
        written.contains("# Left out: rig/a_notes.txt") && written.contains("# Left out: rig/b_scale.csv"),
        "{written}"
    );
    // By its own name it is refused; the remedy for the other is to import it by itself.
    let refused = smam(&["import", "rig/a_notes.txt", "--force"], folder.path());
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
    let alone = smam(&["import", "rig/b_scale.csv", "--scene", "muscle_bench", "--out", "scale"], folder.path());
    assert!(folder.path().join("scale/recordings.toml").is_file(), "{}", said(&alone));
}

#[test]
fn a_scene_is_called_from_where_the_recordings_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("lab/monday")).expect("made");
    assert!(smam(&["scenes", "muscle_bench", "--copy-to", "lab/rig"], folder.path()).status.success());
    fs::write(at("lab/monday/a.csv"), PLAIN.text()).expect("written");
    let output = smam(&["import", "lab/monday", "--scene", "lab/rig/scenes/muscle_bench.toml"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    let set = RecordingSet::load(&at("lab/monday")).expect("a set");
    assert_eq!(set.scene, "../rig/scenes/muscle_bench.toml");
    // From anywhere else it is found as well.
    let compared = smam(&["compare", "monday"], &at("lab"));
    assert!(compared.status.success(), "{}", said(&compared));
    let elsewhere =
        smam(&["import", "monday", "--scene", "rig/scenes/muscle_bench.toml", "--out", "new/set"], &at("lab"));
    assert!(elsewhere.status.success(), "{}", said(&elsewhere));
    assert_eq!(RecordingSet::load(&at("lab/new/set")).expect("a set").scene, "../../rig/scenes/muscle_bench.toml");
}

/// What spreadsheets and loggers write below their samples.
#[test]
fn summary_rows_at_the_end_are_recognised_and_said() {
    for (below, shown) in [
        (
            "Mean;1,5;13;900;0,3\nMax;3;27;1800;0,5\n",
            "2 rows at the end are no samples and are left out: \"Mean\", \"Max\"",
        ),
        ("\nMittelwert:;1,5;13;900;0,3\n", "1 rows at the end"),
        ("595;1,5;13;900;0,3\n1190;3;27;1800;0,5\n", "2 rows at the end"),
        (";1,5;13;900;0,3\n", "1 rows at the end"),
        ("End of measurement\n", "1 rows at the end are no samples and are left out: \"End of measurement\""),
    ] {
        let style = Style { names: BRACKETS, delimiter: ";", number: comma, time: ms, ..PLAIN };
        let text = style.text() + below;
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("a.csv"), text.as_bytes()).expect("written");
        let output = smam(&["import", "a.csv", "--scene", "muscle_bench"], folder.path());
        assert!(said(&output).contains(shown), "{below}: {}", said(&output));
        let written = holds("a.csv", text.as_bytes());
        assert!(written.contains("skip_last_rows = "), "{written}");
        assert!(!written.contains("split_at_restart"), "{written}");
    }
    assert!(!holds("a.csv", PLAIN.text().as_bytes()).contains("skip_last_rows"));
    // Described by hand, the error names the key.
    let (folder, written, _) = imported("a.csv", (PLAIN.text() + "Mean,1.5,13,900,0.3\n").as_bytes());
    let file = folder.path().join("recordings.toml");
    fs::write(&file, written.replace("skip_last_rows = 1\n", "")).expect("written");
    let set = RecordingSet::load(folder.path()).expect("a set");
    let refused = set.load_run(&set.runs[0]).expect_err("no time").to_string();
    assert!(
        refused.contains("\"Mean\" is not a finite number") && refused.contains("say skip_last_rows = 1"),
        "{refused}"
    );
}

#[test]
fn german_compounds_are_guessed() {
    let names = ["Messzeit_ms", "Kolbenweg_mm", "Muskeldehnung_mm", "Leitungsdruck_kPa", "Federkraft_N"];
    holds("a.csv", Style { names, time: ms, ..PLAIN }.text().as_bytes());
    let names = ["Zeit", "Kolbenweg", "Weg_mm", "Druck", "Kraft"];
    holds("a.csv", Style { names, ..PLAIN }.text().as_bytes());
}

#[test]
fn columns_of_one_name_are_told_apart() {
    let names = ["time_s", "Plunger [mm]", "Laser [mm]", "Pressure [kPa]", "Pressure [kPa]"];
    let text = Style { names, ..PLAIN }.text();
    let (folder, written, parts) = imported("a.csv", text.as_bytes());
    assert!(written.contains("skip_rows = 1") && written.contains("\"Pressure [kPa] (2)\""), "{written}");
    assert_eq!(parts[0].recording.find("pressure_kpa").expect("the first").values.len(), ROWS);
    // Declared by hand it is refused, with that remedy.
    let by_hand = "format = 1\nscene = \"muscle_bench\"\n[[channel]]\ncolumn = \"plunger_mm\"\nrole = \"input\"\nname = \"Plunger [mm]\"\n\
                   [[channel]]\ncolumn = \"pressure_kpa\"\nrole = \"output\"\nname = \"Pressure [kPa]\"\n[[run]]\nfile = \"a.csv\"\n";
    fs::write(folder.path().join("recordings.toml"), by_hand).expect("written");
    let set = RecordingSet::load(folder.path()).expect("a set");
    let refused = set.load_run(&set.runs[0]).expect_err("twice").to_string();
    assert!(refused.contains("header = false, skip_rows and names (`smam import` writes them)"), "{refused}");
}

#[test]
fn a_sheet_is_chosen_and_others_are_named() {
    let name = |text: &str, at: &str| format!("<c r=\"{at}1\" t=\"inlineStr\"><is><t>{text}</t></is></c>");
    let mut rows = format!("<row r=\"1\">{}{}</row>", name("time_s", "A"), name("plunger_mm", "B"));
    for i in 0..5 {
        let at = i + 2;
        write!(rows, "<row r=\"{at}\"><c r=\"A{at}\"><v>{i}</v></c><c r=\"B{at}\"><v>{i}</v></c></row>").expect("text");
    }
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.xlsx"), workbook(&rows)).expect("written");
    fs::write(folder.path().join("a.csv"), PLAIN.text()).expect("written");
    let import = |arguments: &[&str]| {
        smam(&[&["import", "--scene", "muscle_bench", "--force"], arguments].concat(), folder.path())
    };
    let named = import(&["a.xlsx", "--sheet", "Run 1"]);
    let written = fs::read_to_string(folder.path().join("recordings.toml")).expect("written");
    assert!(written.contains("sheet = \"Run 1\""), "{}{written}", said(&named));
    for (arguments, words) in [
        (["a.xlsx", "--sheet", "Run 2"], "a.xlsx: has no sheet \"Run 2\"\n  remedy: write one of \"Run 1\""),
        (
            ["a.csv", "--sheet", "Run 1"],
            "a.csv: is no workbook, so it has no sheet \"Run 1\"\n  remedy: leave --sheet out",
        ),
    ] {
        let refused = import(&arguments);
        assert!(refused.status.code() == Some(2) && said(&refused).contains(words), "{}", said(&refused));
    }
    assert!(import(&["a.csv"]).status.success());
    // A folder without a workbook.
    fs::create_dir(folder.path().join("d")).expect("a folder");
    fs::write(folder.path().join("d/a.csv"), PLAIN.text()).expect("written");
    let refused = import(&["d", "--sheet", "Run 1"]);
    let words = "--sheet Run 1: none of the files is a workbook\n  remedy: leave --sheet out";
    assert!(refused.status.code() == Some(2) && said(&refused).contains(words), "{}", said(&refused));
    // What is to be copied into a shell is quoted.
    fs::rename(folder.path().join("d"), folder.path().join("my rig")).expect("renamed");
    assert!(said(&import(&["my rig"])).contains("next: smam compare 'my rig'"));
}

/// A cover sheet with a title and some masses is no recording; of several recordings the first is taken.
#[test]
fn a_cover_sheet_is_passed_over() {
    let table = sheet(number_cell, |_| String::new());
    let mass = |row: usize, name: &str, kg: f64| {
        format!("<row r=\"{row}\">{}{}</row>", text_cell(row, 0, name), number_cell(row, 1, kg.to_string()))
    };
    let cover = format!("{}{}", mass(1, "hanging mass, kg", 0.05), mass(2, "tube, kg", 0.012));
    for (sheets, taken) in [
        (vec![("Info", cover.as_str()), ("Run 1", &table), ("Run 2", &table)], Some("Run 1")),
        (vec![("Run 1", &table), ("Run 2", &table), ("Info", &cover)], None),
    ] {
        let book = workbook_of(&sheets);
        let written = holds("a.xlsx", &book);
        match taken {
            Some(taken) => assert!(written.contains(&format!("sheet = \"{taken}\"")), "{written}"),
            None => assert!(!written.contains("sheet = "), "{written}"),
        }
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("a.xlsx"), &book).expect("written");
        let words = said(&smam(&["import", "a.xlsx", "--scene", "muscle_bench"], folder.path()));
        assert!(words.contains("sheet \"Run 1\", the first") && words.contains("takes another: "), "{words}");
        // Without a word on sheets.
        let compared = smam(&["compare", "a.xlsx", "--scene", "muscle_bench", "--out", "out"], folder.path());
        assert!(compared.status.success(), "{}", said(&compared));
    }
}

/// What a refused file is told to declare holds wherever it is read, and a programme needs no outputs.
#[test]
fn a_declared_file_drives_a_run() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.csv"), "Zeit [ms];Kolben [cm]\n0;0,1\n10;0,2\n20;0,3\n").expect("written");
    let run = || smam(&["run", "muscle_bench", "--input", "a.csv", "--output", "o.csv"], folder.path());
    assert!(said(&run()).contains("say delimiter = \";\" in recordings.toml"), "{}", said(&run()));
    smam(&["import", "a.csv", "--scene", "muscle_bench"], folder.path());
    let mut declared = fs::read_to_string(folder.path().join("recordings.toml")).expect("written");
    declared.push_str("hanging_mass_kg = 0.05\n");
    fs::write(folder.path().join("recordings.toml"), declared).expect("written");
    let driven = run();
    assert!(driven.status.success(), "{}", said(&driven));
    let words = "a.csv: read as recordings.toml declares it, but its conditions (hanging_mass_kg = 0.05) are the scene's own here";
    assert!(said(&driven).contains(words), "{}", said(&driven));
    let played = smam::recording::read_csv(&folder.path().join("o.csv")).expect("a recording");
    assert_eq!(played.time_s(), [0.0, 0.01, 0.02]);
    assert_eq!(played.channel("plunger_mm").expect("a column").values, [1.0, 2.0, 3.0]);
}

/// An interval that is declared beside a column of times holds; that they differ is said.
#[test]
fn an_interval_against_the_files_own_times_is_noted() {
    let (folder, written, _) = imported("a.csv", PLAIN.text().as_bytes());
    for (interval_s, is_noted) in [("0.02", true), ("0.01", false)] {
        let text = written.replace("[[run]]", &format!("[file]\ninterval_s = {interval_s}\n\n[[run]]"));
        fs::write(folder.path().join("recordings.toml"), text).expect("written");
        let set = RecordingSet::load(folder.path()).expect("a set");
        let run = set.load_run(&set.runs[0]).expect("a run");
        let notes = run.notes.join("\n");
        assert_eq!(notes.contains("its column \"time_s\" are 0.010000 s apart"), is_noted, "{notes}");
    }
}

#[test]
fn the_unit_that_fits_the_numbers_is_named() {
    let names = ["Time [s]", "Plunger", "Elongation", "Pressure", "Force"];
    let style = Style { names, factors: [1000.0, 1.0, 1e-3, 1.0], ..PLAIN };
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.csv"), style.text()).expect("written");
    assert!(smam(&["import", "a.csv", "--scene", "muscle_bench"], folder.path()).status.success());
    let written = fs::read_to_string(folder.path().join("recordings.toml")).expect("written");
    assert!(written.contains("taken as mm. By their size they may be m: unit = \"m\""), "{written}");
    assert!(written.contains("taken as kPa. By their size they may be Pa: unit = \"Pa\""), "{written}");
    assert!(written.contains("taken as N, which fits their size"), "{written}");
    // The remedy: the lines filled in.
    let filled = written
        .lines()
        .map(|line| line.rsplit_once(": ").filter(|_| line.contains("By their size")).map_or(line, |(_, key)| key));
    fs::write(folder.path().join("recordings.toml"), filled.collect::<Vec<_>>().join("\n")).expect("written");
    let set = RecordingSet::load(folder.path()).expect("a set");
    same(&set.load_run(&set.runs[0]).expect("a run"), &expected());
}

/// A unit that is not known is never taken for the channel's own.
#[test]
fn unknown_units_have_to_be_filled_in() {
    for (name, remark) in
        [("Plunger [steps]", "steps"), ("Plunger (counts)", "counts"), ("Plunger [furlong]", "furlong")]
    {
        let folder = tempfile::tempdir().expect("a folder");
        let text = PLAIN.text().replace("plunger_mm", name);
        fs::write(folder.path().join("a.csv"), text).expect("written");
        let output = smam(&["import", "a.csv", "--scene", "muscle_bench"], folder.path());
        assert_eq!(output.status.code(), Some(1), "{}", said(&output));
        assert!(said(&output).contains(&format!("the mm of one \"{remark}\"")), "{}", said(&output));
        assert!(RecordingSet::load(folder.path()).is_err());
        let path = folder.path().join("recordings.toml");
        let open = format!("scale = \"to be filled in: the mm of one {remark}\"");
        let written = fs::read_to_string(&path).expect("written");
        fs::write(&path, written.replace(&open, "scale = 1.0")).expect("written");
        let set = RecordingSet::load(folder.path()).unwrap_or_else(|e| panic!("{e}\n{written}"));
        same(&set.load_run(&set.runs[0]).expect("a run"), &expected());
        // One file by itself is refused too, and says where to fill it in.
        let refused = said(&smam(&["compare", "a.csv", "--scene", "muscle_bench"], folder.path()));
        assert!(refused.contains("remedy: run `smam import`"), "{refused}");
    }
    let absolute = PLAIN.text().replace("pressure_kpa", "Pressure [kPa a]");
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.csv"), absolute).expect("written");
    assert_eq!(smam(&["import", "a.csv", "--scene", "muscle_bench"], folder.path()).status.code(), Some(1));
    let written = fs::read_to_string(folder.path().join("recordings.toml")).expect("written");
    assert!(written.contains("unit = \"kPa\" and zero = 101.3250000"), "{written}");
}

#[test]
fn newtons_per_square_millimetre_and_atmospheres_are_known() {
    for (name, factor) in [("Pressure [N/mm²]", 1000.0), ("Pressure [N/mm2]", 1000.0), ("Pressure [atm]", 101.325)] {
        let names = ["time_s", "plunger_mm", "elongation_mm", name, "force_n"];
        holds("a.csv", Style { names, factors: [1.0, 1.0, factor, 1.0], ..PLAIN }.text().as_bytes());
    }
}

/// One `unit` stands for all files of a folder: one in another unit is left out, or refused where it was named.
#[test]
fn files_with_other_units_are_not_read_in_those_of_the_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let names = ["time", "plunger", "elongation", "pressure", "force"];
    let in_units = |units: &'static str| Style { names, below_names: units, ..PLAIN }.text();
    fs::write(folder.path().join("a.csv"), in_units("s,mm,mm,kPa,N\n")).expect("written");
    fs::write(folder.path().join("b.csv"), in_units("s,cm,mm,kPa,N\n")).expect("written");
    let output = smam(&["import", ".", "--scene", "muscle_bench"], folder.path());
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("b.csv: the column \"plunger\" is in cm, and in mm in "), "{}", said(&output));
    let set = RecordingSet::load(folder.path()).expect("a set");
    assert_eq!(set.runs.len(), 1);
    let named = smam(&["import", "a.csv", "b.csv", "--scene", "muscle_bench", "--force"], folder.path());
    assert!(named.status.code() == Some(2) && said(&named).contains("import it by itself"), "{}", said(&named));
    // Its remedy.
    assert!(smam(&["import", "b.csv", "--scene", "muscle_bench", "--out", "b"], folder.path()).status.success());
}

/// Imports a text that has something wrong, and what is said of it, which ends with exit code 1.
fn incomplete(text: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.csv"), text).expect("written");
    let output = smam(&["import", "a.csv", "--scene", "muscle_bench"], folder.path());
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    said(&output)
}

#[test]
fn rows_in_a_wrong_order_are_to_be_sorted() {
    let lines: Vec<String> = PLAIN.text().lines().map(str::to_owned).collect();
    let mut swapped = lines.clone();
    swapped.swap(40, 41);
    let text = incomplete(&(swapped.join("\n") + "\n"));
    assert!(text.contains("is not after") && text.contains("remedy: sort the rows by time"), "{text}");
    assert!(!text.contains("starts anew: split"), "{text}");
    let falling: Vec<String> = lines[..1].iter().chain(lines[1..].iter().rev()).cloned().collect();
    let text = incomplete(&(falling.join("\n") + "\n"));
    assert!(text.contains("\"time_s\" goes back 119 times in 120 rows: sort the rows by time"), "{text}");
}

#[test]
fn what_stands_in_the_place_of_times_is_named() {
    let text = PLAIN.text();
    let without: String = text.lines().map(|l| format!("{}\n", l.split_once(',').expect("cells").1)).collect();
    assert!(incomplete(&without).contains("interval_s = 0.01"));
    for (name, stamp) in [("date", "03/29/2026 01:59:50.0"), ("clock", "12:59:50.0 PM")] {
        let rows = without.lines().enumerate();
        let text: String =
            rows.map(|(i, l)| if i == 0 { format!("{name},{l}\n") } else { format!("{stamp},{l}\n") }).collect();
        let said = incomplete(&text);
        assert!(said.contains(&format!("\"{name}\" holds \"{stamp}\": stamps are read as 2026-03-29")), "{said}");
        assert!(said.contains("interval_s"), "{said}");
    }
}

#[test]
fn whole_seconds_of_many_rows_are_said() {
    let text: String = PLAIN
        .text()
        .lines()
        .map(|line| {
            let (time, rest) = line.split_once(',').expect("cells");
            let whole = time.split('.').next().expect("seconds");
            format!("{},{rest}\n", if time == "time_s" { time.to_owned() } else { whole.to_owned() })
        })
        .collect();
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("a.csv"), text).expect("written");
    let output = smam(&["import", "a.csv", "--scene", "muscle_bench"], folder.path());
    assert!(said(&output).contains("interval_s = 0.0"), "{}", said(&output));
}

#[test]
fn a_loggers_word_for_missing_and_a_lost_end() {
    let lines: Vec<String> = PLAIN.text().lines().map(str::to_owned).collect();
    let over =
        PLAIN.text().replace(&lines[60], &format!("{},OVER,1,1,1", lines[60].split(',').next().expect("a time")));
    assert!(incomplete(&over).contains("missing = [\"OVER\"]"));
    holds("a.csv", PLAIN.text().replace('-', "\u{2212}").as_bytes());
    // The loss of power cut the row after the last whole one.
    let cut = PLAIN.text() + "1.2,0.1\0\0\0\0\0\0\0\0";
    let (_, written, parts) = imported("a.csv", cut.as_bytes());
    same(&parts[0], &expected());
    assert!(parts[0].notes.iter().any(|note| note.contains("8 NUL bytes")), "{written}: {:?}", parts[0].notes);
}
