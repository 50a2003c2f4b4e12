//! Contract: a result goes where it was asked to go, and takes the place of nothing else that is there.

use std::path::Path;
use std::process::{Command, Output};

fn smam(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_smam")).args(arguments).current_dir(folder).output().expect("starts")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("temporary folder")
}

#[test]
fn a_dash_is_the_standard_output() {
    let here = folder();
    let output = smam(&["run", "driven_axis", "--duration", "0.1", "--output", "-"], here.path());
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.starts_with("time_s,") && text.lines().count() > 2 && !said(&output).contains("recording:"), "{text}");
    assert_eq!(std::fs::read_dir(here.path()).expect("folder").count(), 0);
    let file = smam(&["run", "driven_axis", "--duration", "0.1", "--output", "x.csv"], here.path());
    assert_eq!(file.status.code(), Some(0), "{}", said(&file));
    assert_eq!(std::fs::read_to_string(here.path().join("x.csv")).expect("written"), text);
}

#[cfg(unix)]
#[test]
fn devices_and_links_stay_what_they_are() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let here = folder();
    let run = |output: &str| smam(&["run", "driven_axis", "--duration", "0.1", "--output", output], here.path());
    assert_eq!(run("/dev/null").status.code(), Some(0));
    assert!(std::fs::metadata("/dev/null").expect("there").file_type().is_char_device());
    symlink("data.csv", here.path().join("link.csv")).expect("a link");
    assert_eq!(run("link.csv").status.code(), Some(0));
    assert!(here.path().join("link.csv").is_symlink() && here.path().join("data.csv").is_file());
    let full = run("/dev/full");
    assert_eq!(full.status.code(), Some(1), "{}", said(&full));
    assert!(said(&full).contains("/dev/full: cannot be written"), "{}", said(&full));
}

#[test]
fn no_answer_takes_the_place_of_a_recording() {
    let here = folder();
    let rig = here.path().join("rig");
    let made = smam(&["run", "muscle_bench", "--duration", "2", "--output", "rig/next_experiment.csv"], here.path());
    assert_eq!(made.status.code(), Some(0), "{}", said(&made));
    assert_eq!(smam(&["import", "rig", "--scene", "muscle_bench"], here.path()).status.code(), Some(0));
    let before = std::fs::read(rig.join("next_experiment.csv")).expect("there");
    for given in ["rig", "rig/next_experiment.csv"] {
        let output = smam(&["diagnose", given, "--scene", "muscle_bench", "--out", "rig"], here.path());
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains("--out rig: next_experiment.csv there is read"), "{}", said(&output));
        assert_eq!(std::fs::read(rig.join("next_experiment.csv")).expect("there"), before);
    }
}
