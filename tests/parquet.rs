//! Contract of Parquet: what others write is read where CSV is, and a sweep's table is enough to draw its page.

use std::fs;
use std::path::Path;
use std::process::Command;

use smam::recording::{RecordingSet, read_csv, read_recording};

const PANDAS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/recordings/pandas_snappy.parquet");

/// Eleven rows that pandas 3 wrote with its defaults: Snappy, dictionaries, float32 and int32 columns, one value missing.
#[test]
fn a_run_that_pandas_wrote_is_a_run_of_recordings_toml() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(PANDAS, folder.path().join("run.parquet")).expect("copied");
    let set = "format = 1\nscene = \"muscle_bench\"\n[[channel]]\ncolumn = \"plunger_mm\"\nrole = \"input\"\n\
               [[channel]]\ncolumn = \"elongation_mm\"\nrole = \"output\"\n[[run]]\nfile = \"run.parquet\"\n";
    fs::write(folder.path().join("recordings.toml"), set).expect("written");
    let set = RecordingSet::load(folder.path()).expect("recordings");
    let run = set.load_run(&set.runs[0]).expect("a run");
    assert_eq!(run.recording.columns(), ["plunger_mm", "elongation_mm", "count_ratio"]);
    assert_eq!(run.recording.time_s().len(), 11);
    let elongation = &run.recording.channel("elongation_mm").expect("there").values;
    assert!(elongation[5].is_nan() && (elongation[10] - 20.0).abs() < 1e-12, "{elongation:?}");
    assert!(run.notes[0].contains("count_ratio"), "{:?}", run.notes);
}

/// Polars compresses with zstd unless told otherwise.
#[test]
fn a_codec_that_is_not_read_is_named_as_writers_name_it() {
    for codec in ["zstd", "gzip"] {
        let packed = format!("{}/tests/recordings/polars_{codec}.parquet", env!("CARGO_MANIFEST_DIR"));
        let said = read_recording(Path::new(&packed)).expect_err("packed").to_string();
        assert!(said.starts_with(&format!("{packed}: compressed with {codec}, which is not read here")), "{said}");
        assert!(said.contains("\n  remedy: write it with compression=\"snappy\""), "{said}");
    }
}

/// Found by fuzzing: the pandas file with some bytes changed, on which the library that reads Parquet panics.
#[test]
fn a_file_damaged_inside_is_refused() {
    let damaged = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/recordings/damaged_inside.parquet");
    let said = read_recording(Path::new(damaged)).expect_err("damaged").to_string();
    assert!(said.starts_with(damaged) && said.contains("cannot be read as Parquet: "), "{said}");
    assert!(said.contains("\n  remedy: write the file again"), "{said}");
}

/// Found by fuzzing: a page of some hundred bytes that claims to be two gigabytes when unpacked, and a dictionary that claims to have
/// hundreds of millions of values. The library makes room for them first: 1.9 and 9.4 GB.
#[test]
fn pages_that_claim_too_much_are_refused() {
    for (name, claim) in
        [("claims_gigabytes", "bytes claims to be 2013265920 when unpacked"), ("claims_values", "bytes claims to have")]
    {
        let claiming = format!("{}/tests/recordings/{name}.parquet", env!("CARGO_MANIFEST_DIR"));
        let said = read_recording(Path::new(&claiming)).expect_err("a lie").to_string();
        assert!(said.contains(claim) && said.contains("\n  remedy: write the file again"), "{said}");
    }
}

/// Found by fuzzing: a page's header with more text than the file has, for which the library goes on asking for minutes.
#[test]
fn a_header_that_does_not_end_is_refused() {
    let endless = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/recordings/endless_header.parquet");
    let begun = std::time::Instant::now();
    let said = read_recording(Path::new(endless)).expect_err("no end").to_string();
    assert!(said.contains("\n  remedy: write the file again"), "{said}");
    assert!(begun.elapsed().as_secs() < 20, "{:?}", begun.elapsed());
}

/// Found by fuzzing: eighteen bytes that claim two thousand million booleans, which the library counts through.
#[test]
fn a_list_of_booleans_that_takes_no_room_is_refused() {
    let claims = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/recordings/claims_booleans.parquet");
    let said = read_recording(Path::new(claims)).expect_err("no recording").to_string();
    assert!(said.contains("list of booleans") && said.contains("\n  remedy: write the file again"), "{said}");
}

/// Found by fuzzing: a version that says to be a boolean, so that what the library reads next is another such list.
#[test]
fn a_known_field_of_another_kind_is_refused() {
    let hidden = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/recordings/claims_hidden_booleans.parquet");
    let said = read_recording(Path::new(hidden)).expect_err("no recording").to_string();
    assert!(
        said.contains("another kind than Parquet says") && said.contains("\n  remedy: write the file again"),
        "{said}"
    );
}

/// The same recording drives the same run, whichever way it is written.
#[test]
fn parquet_and_csv_drive_the_same_run() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let recording = read_recording(Path::new(PANDAS)).expect("a recording");
    recording.write_csv(Path::new(&at("run.csv"))).expect("written");
    let runs = [PANDAS, &at("run.csv")].map(|input| {
        let out = at("out.csv");
        let arguments = ["run", "muscle_bench", "--input", input, "--output", &out];
        let done = Command::new(env!("CARGO_BIN_EXE_smam")).args(arguments).output().expect("starts");
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        read_csv(Path::new(&out)).expect("a recording")
    });
    assert_eq!(runs[0], runs[1]);
}

#[test]
fn a_sweep_is_drawn_from_its_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    // The tail of the distribution is refused by the scene: a row with an error.
    let sweep = "format = 1\nname = \"t\"\nscene = \"muscle_bench\"\nduration_s = 0.3\n\
                 [sampling]\nmethod = \"monte_carlo\"\ncount = 8\nseed = 1\n\
                 [[vary]]\nkey = \"muscles.friction.m0_n\"\nmean = 0.1\nsd = 0.1\n\
                 [[measure]]\nname = \"top_mm\"\nof = \"max(elongation_mm)\"\n";
    fs::write(at("sweep.toml"), sweep).expect("written");
    let smam = |arguments: &[&str]| {
        Command::new(env!("CARGO_BIN_EXE_smam")).arg("sweep").args(arguments).output().expect("starts")
    };
    assert!(smam(&[&at("sweep.toml"), "--out", &at("out")]).status.success());
    let page = fs::read(at("out/sweep.html")).expect("a page");
    fs::create_dir(at("table")).expect("made");
    fs::copy(at("out/table.parquet"), at("table/table.parquet")).expect("copied");
    let drawn = smam(&["plot", &at("sweep.toml"), &at("table/table.parquet")]);
    assert!(drawn.status.success(), "{}", String::from_utf8_lossy(&drawn.stderr));
    assert!(fs::read(at("table/sweep.html")).expect("a page") == page);
    fs::write(at("sweep.toml"), sweep.replace("top_mm", "most_mm")).expect("written");
    let other = smam(&["plot", &at("sweep.toml"), &at("table/table.parquet")]);
    let said = String::from_utf8_lossy(&other.stderr).into_owned();
    assert!(other.status.code() == Some(2) && said.contains("those of the sweep"), "{said}");
}
