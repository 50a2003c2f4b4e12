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

fn refused(output: &Output, words: &[&str]) {
    assert_eq!(output.status.code(), Some(2), "{}", said(output));
    for word in words.iter().chain(&["error: ", "remedy: "]) {
        assert!(said(output).contains(word), "no {word:?} in: {}", said(output));
    }
}

#[test]
fn a_table_of_something_else_stays() {
    let here = folder();
    std::fs::create_dir(here.path().join("mine")).expect("a folder");
    std::fs::write(here.path().join("mine/table.csv"), "mine\n").expect("written");
    let sweep = |out: &str| {
        let vary = ["--vary", "simulation.substeps=10,20", "--measure", "range=range(force_n)", "--duration", "0.1"];
        smam(&[&["sweep", "driven_axis", "--out", out], &vary[..]].concat(), here.path())
    };
    refused(&sweep("mine"), &["mine/table.csv: is a table of something else"]);
    assert_eq!(std::fs::read_to_string(here.path().join("mine/table.csv")).expect("there"), "mine\n");
    // Its remedy; whole numbers are varied as such.
    let done = sweep("own");
    assert_eq!(done.status.code(), Some(0), "{}", said(&done));
}

#[cfg(feature = "validation")]
#[test]
fn a_concealed_case_takes_no_others_place_and_an_answer_is_to_its_own() {
    let here = folder();
    let conceal = |seed: &str, rig: &str, more: &[&str]| {
        smam(&[&["conceal", "--seed", seed, "--rig", rig, "--out", "cases"], more].concat(), here.path())
    };
    assert_eq!(conceal("3", "muscle_bench", &[]).status.code(), Some(0));
    let recorded = std::fs::read(here.path().join("cases/case_3/recordings.toml")).expect("there");
    // The same again is the same.
    assert_eq!(conceal("3", "muscle_bench", &[]).status.code(), Some(0));
    refused(&conceal("3", "antagonistic_pulley", &[]), &["cases/case_3: another case of this name"]);
    assert_eq!(std::fs::read(here.path().join("cases/case_3/recordings.toml")).expect("there"), recorded);
    refused(
        &conceal("18446744073709551615", "muscle_bench", &["--count", "2"]),
        &["--seed 18446744073709551615: 2 seeds"],
    );

    let answer = here.path().join("answers/case_3");
    std::fs::create_dir_all(&answer).expect("a folder");
    std::fs::write(answer.join("diagnosis.json"), "{\"recordings\": [\"cases/case_4\"]}").expect("written");
    let output = smam(&["score", "cases", "--answers", "answers"], here.path());
    refused(&output, &["answers to the recordings cases/case_4, not to cases/case_3"]);
    // A copy of its runs under another name is the case: what is refused then is that this is no answer.
    let (case, copy) = (here.path().join("cases/case_3"), here.path().join("cases/case_4"));
    std::fs::create_dir_all(&copy).expect("a folder");
    for entry in std::fs::read_dir(case).expect("the case").flatten() {
        std::fs::copy(entry.path(), copy.join(entry.file_name())).expect("copied");
    }
    let output = smam(&["score", "cases", "--answers", "answers"], here.path());
    assert!(!said(&output).contains("answers to the recordings"), "{}", said(&output));
    refused(&output, &["diagnosis.json"]);
}
