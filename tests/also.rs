//! Contract: a run whose channels lie in two files, each with a clock of its own, is read as if one logger had written them.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use smam::recording::{LoadedRun, RecordingError, RecordingSet, Start};
use tempfile::TempDir;

/// The plunger, mm: holds, and strokes of growing size.
fn plunger(t: f64) -> f64 {
    if t < 2.0 { 0.0 } else { 0.1 * (t - 2.0) * (1.0 - (0.9 * (t - 2.0)).cos()) }
}

fn elongation(t: f64) -> f64 {
    9.0 * plunger(t)
}

/// A logger at 100 Hz, 20 s.
fn logger(time: fn(usize) -> String) -> String {
    let mut text = "time_s,plunger_mm\n".to_owned();
    for i in 0..2000 {
        writeln!(text, "{},{:.5}", time(i), plunger(0.01 * i as f64)).expect("a text");
    }
    text
}

/// A camera at 25 Hz that was started 1.4 s later, as another program writes it.
fn camera(time: fn(usize) -> String) -> String {
    let mut text = "frame;Zeit [ms];Länge [cm]\n".to_owned();
    for i in 0..400 {
        let value = format!("{:.6}", 0.1 * elongation(1.4 + 0.04 * i as f64)).replace('.', ",");
        writeln!(text, "{i};{};{value}", time(i)).expect("a text");
    }
    text
}

fn stamp(milliseconds: usize) -> String {
    format!("2026-03-29 13:{:02}:{:02}.{:03}", milliseconds / 60_000, milliseconds / 1000 % 60, milliseconds % 1000)
}

const SET: &str = "format = 1\nscene = \"muscle_bench\"\n\
    [[channel]]\ncolumn = \"plunger_mm\"\nrole = \"input\"\n\
    [[channel]]\ncolumn = \"elongation_mm\"\nrole = \"output\"\nname = \"Länge [cm]\"\n\
    [[run]]\nfile = \"logger.csv\"\n\
    [[run.also]]\nfile = \"camera.csv\"\ndelimiter = \";\"\ndecimal = \",\"\ntime_column = \"Zeit [ms]\"\n";

fn folder(set: &str, logger: &str, camera: &str) -> TempDir {
    let here = tempfile::tempdir().expect("a folder");
    for (name, text) in [("recordings.toml", set), ("logger.csv", logger), ("camera.csv", camera)] {
        fs::write(here.path().join(name), text).expect("written");
    }
    here
}

fn with_numbers(set: &str) -> TempDir {
    folder(set, &logger(|i| format!("{:.2}", 0.01 * i as f64)), &camera(|i| format!("{}", 40 * i)))
}

fn load(folder: &Path) -> Result<LoadedRun, RecordingError> {
    let set = RecordingSet::load(folder)?;
    set.load_run(&set.runs[0])
}

/// Every sample of the camera is there once, at its own moment, and the run is the logger's.
fn check(loaded: &LoadedRun, late_s: f64) {
    let recording = &loaded.recording;
    let time_s = recording.time_s();
    assert_eq!(
        (recording.sample_count(), time_s[0], recording.columns()),
        (2000, 0.0, vec!["plunger_mm", "elongation_mm"])
    );
    let seen = &recording.channel("elongation_mm").expect("there").values;
    let there: Vec<(f64, f64)> =
        time_s.iter().copied().zip(seen.iter().copied()).filter(|(_, v)| !v.is_nan()).collect();
    assert_eq!(there.len(), 400);
    let worst = there.iter().map(|(t, v)| (v - elongation(t + late_s)).abs()).fold(0.0, f64::max);
    assert!(worst < 0.01, "{worst} mm");
    assert!(loaded.notes.iter().any(|n| n.contains("brought to it: camera.csv (400 samples)")), "{:?}", loaded.notes);
}

#[test]
fn a_stated_start_joins_the_files() {
    let here = with_numbers(&SET.replace("file = \"camera.csv\"\n", "file = \"camera.csv\"\nstarts_s = 1.4\n"));
    check(&load(here.path()).expect("joined"), 0.0);
}

#[test]
fn stamps_in_both_files_are_one_clock() {
    let here = folder(SET, &logger(|i| stamp(10 * i)), &camera(|i| stamp(1400 + 40 * i)));
    check(&load(here.path()).expect("joined"), 0.0);
    // What is stated outranks them: the two computers' clocks may differ.
    let set = SET.replace("file = \"camera.csv\"\n", "file = \"camera.csv\"\nstarts_s = 1.2\n");
    fs::write(here.path().join("recordings.toml"), set).expect("written");
    check(&load(here.path()).expect("joined"), 0.2);
    let other = folder(SET, &logger(|i| stamp(10 * i)), &camera(|i| stamp(600_000 + 40 * i)));
    let said = load(other.path()).expect_err("ten minutes later").to_string();
    assert!(said.contains("no moment in common") && said.contains("say what is right as starts_s"), "{said}");
}

/// The remedy of the message is what is to be written, and it is nearly the truth.
#[test]
fn an_unknown_start_is_looked_for_and_its_remedy_works() {
    let here = with_numbers(SET);
    let said = load(here.path()).expect_err("unknown").to_string();
    let remedy = said.split("add starts_s = ").nth(1).and_then(|text| text.split(' ').next()).expect(&said);
    assert!((remedy.parse::<f64>().expect(&said) - 1.4).abs() < 0.02, "{said}");
    let set = SET.replace("file = \"camera.csv\"\n", &format!("file = \"camera.csv\"\nstarts_s = {remedy}\n"));
    fs::write(here.path().join("recordings.toml"), set).expect("written");
    let set = RecordingSet::load(here.path()).expect("read");
    assert!(matches!(set.starts(&set.runs[0]).expect("read").as_slice(), [Start::Stated(_)]));
    assert_eq!(set.load_run(&set.runs[0]).expect("joined").recording.sample_count(), 2000);
}

#[test]
fn what_cannot_be_joined_is_said_with_a_remedy() {
    let changes = [
        ("file = \"camera.csv\"\n", "file = \"camera.csv\"\nstarts_s = 60\n", "no moment in common"),
        ("file = \"camera.csv\"\n", "file = \"logger.csv\"\nstarts_s = 0\n", "listed twice in this run"),
        (
            "file = \"camera.csv\"\n",
            "file = \"camera.csv\"\nstart_s = 0\n",
            "[[run.also]] 1 (\"camera.csv\"): unknown key \"start_s\", did you mean \"starts_s\"?",
        ),
        ("file = \"camera.csv\"\n", "file = \"gone.csv\"\nstarts_s = 0\n", "gone.csv: cannot be read"),
        ("name = \"Länge [cm]\"\n", "", "no column \"elongation_mm\""),
        ("delimiter = \";\"\n", "delimiter = \";\"\nsplit_at_restart = true\n", "brought to one clock"),
        (
            "file = \"logger.csv\"\n",
            "file = \"logger.csv\"\ntime = \"index\"\ninterval_s = 1\n",
            "brought to one clock",
        ),
        ("name = \"Länge [cm]\"", "name = \"plunger_mm\"", "has none of the declared channels"),
    ];
    for (from, to, expected) in changes {
        let set = SET.replacen(from, to, 1);
        assert_ne!(set, SET, "{from}");
        let here = with_numbers(&set);
        let said = load(here.path()).expect_err(to).to_string();
        assert!(said.contains(expected) && said.contains("remedy: "), "{to}: {said}");
    }
}

fn smam(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_smam")).args(arguments).current_dir(folder).output().expect("starts")
}

/// `import` describes both files; what it wrote is read by every command.
#[test]
fn import_describes_the_further_file_and_where_it_begins() {
    let here = with_numbers(SET);
    fs::remove_file(here.path().join("recordings.toml")).expect("removed");
    let camera = fs::read_to_string(here.path().join("camera.csv")).expect("there").replace("Länge", "elongation");
    fs::write(here.path().join("camera.csv"), camera).expect("written");
    let done = smam(&["import", "logger.csv", "--also", "camera.csv", "--scene", "muscle_bench"], here.path());
    let written = fs::read_to_string(here.path().join("recordings.toml")).unwrap_or_default();
    assert_eq!(done.status.code(), Some(0), "{}\n{written}", String::from_utf8_lossy(&done.stderr));
    assert!(
        written.contains("[[run.also]]\nfile = \"camera.csv\"\nstarts_s = 1.") && written.contains("# likely"),
        "{written}"
    );
    assert_eq!(load(here.path()).expect("joined").recording.sample_count(), 2000);

    let done = smam(
        &["import", "logger.csv", "--scene", "muscle_bench", "--force", "--also", "camera.csv", "logger.csv"],
        here.path(),
    );
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.code() == Some(2) && said.contains("--also names 2 files, and there are 1 runs"), "{said}");
    let done = smam(&["import", ".", "--scene", "muscle_bench", "--force", "--also", "camera.csv"], here.path());
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.code() == Some(2) && said.contains("--also: . is a folder"), "{said}");

    // A motion that repeats itself is begun nowhere by guess.
    let sine = |text: &str, of: fn(f64) -> f64, interval_s: f64, mark: &str| {
        let mut own = format!("{text}\n");
        (0..(20.0 / interval_s) as usize).for_each(|i| {
            let t = interval_s * i as f64;
            writeln!(own, "{t:.2}{mark}{:.5}", of(t)).expect("a text");
        });
        own
    };
    let logger = sine("time_s,plunger_mm", |t| 1.0 - (2.0 * t).cos(), 0.01, ",");
    let camera = sine("time_s;elongation_mm", |t| 9.0 - 9.0 * (2.0 * (t + 1.4)).cos(), 0.04, ";");
    fs::write(here.path().join("logger.csv"), logger).expect("written");
    fs::write(here.path().join("camera.csv"), camera).expect("written");
    let done =
        smam(&["import", "logger.csv", "--scene", "muscle_bench", "--force", "--also", "camera.csv"], here.path());
    let said = String::from_utf8_lossy(&done.stderr);
    let written = fs::read_to_string(here.path().join("recordings.toml")).expect("written");
    assert!(done.status.code() == Some(1) && said.contains("the motion repeats itself"), "{said}");
    assert!(!written.contains("starts_s"), "{written}");
}
