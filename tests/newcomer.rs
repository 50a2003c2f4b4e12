//! What newcomers have tripped over, by the built program.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn smam(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_smam")).args(arguments).current_dir(folder).output().expect("starts")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A recording with its description, in a folder of its own.
fn recorded(folder: &Path) {
    fs::create_dir_all(folder).expect("folder");
    let recordings = "format = 1\nscene = \"muscle_bench\"\n\n[[channel]]\ncolumn = \"plunger_mm\"\nrole = \"input\"\n\n\
                      [[channel]]\ncolumn = \"elongation_mm\"\nrole = \"output\"\n\n[[run]]\nfile = \"sine.csv\"\n";
    fs::write(folder.join("recordings.toml"), recordings).expect("written");
    let made = smam(&["run", "muscle_bench", "--duration", "2", "--output", "sine.csv"], folder);
    assert!(made.status.success(), "{}", said(&made));
}

/// Monday's rig and Tuesday's have one name: the second comparison does not take the place of the first.
#[test]
fn results_of_folders_of_one_name_are_kept_apart() {
    let here = tempfile::tempdir().expect("temporary folder");
    ["monday/rig", "tuesday/rig"].into_iter().for_each(|folder| recorded(&here.path().join(folder)));
    let compare = |arguments: &[&str]| smam(&[&["compare"], arguments].concat(), here.path());
    assert!(compare(&["monday/rig"]).status.success());
    let page = here.path().join("out/compare_rig/compare.html");
    let first = fs::read(&page).expect("written");
    let refused = compare(&["tuesday/rig"]);
    assert_eq!(refused.status.code(), Some(2));
    let words = said(&refused);
    let remedy = "--out out/compare_tuesday_rig";
    assert!(
        words.contains("holds the results of") && words.contains("monday/rig") && words.contains(remedy),
        "{words}"
    );
    assert_eq!(fs::read(&page).expect("still there"), first);
    assert!(compare(&["tuesday/rig", "--out", "out/compare_tuesday_rig"]).status.success());
    // Where the folder is named after all it belongs to the other from then on.
    assert!(compare(&["tuesday/rig", "--out", "out/compare_rig"]).status.success());
    assert!(compare(&["tuesday/rig"]).status.success());
    assert_eq!(compare(&["monday/rig"]).status.code(), Some(2));
    fs::remove_dir_all(here.path().join("out")).expect("removed");
    assert!(compare(&["monday/rig"]).status.success());
    // The same folder again, by another way to it, and a folder that is gone.
    assert!(compare(&["./monday/../monday/rig"]).status.success());
    fs::remove_dir_all(here.path().join("monday")).expect("removed");
    assert!(compare(&["tuesday/rig"]).status.success());
}

/// `line 1`, `line[1]` and `line1` are the line that answers call `line_1`.
#[test]
fn elements_are_found_however_their_number_is_written() {
    let here = tempfile::tempdir().expect("temporary folder");
    let table = |law: &str, file: &str| {
        let law = format!("{law}.resistance scales 1.5");
        let run = ["run", "antagonistic_pulley", "--duration", "0.2", "--law", &law, "--output", file];
        let output = smam(&run, here.path());
        assert!(output.status.success(), "{law}: {}", said(&output));
        fs::read(here.path().join(file)).expect("written")
    };
    let right = table("line_2", "right.csv");
    for written in ["line 2", "line[2]", "line2"] {
        assert_eq!(table(written, "other.csv"), right, "{written}");
    }
}

/// A limit of the URDF is not enforced: a run that passes it says so, and a stop of the scene takes its place.
#[test]
fn a_joint_beyond_its_urdf_limit_is_warned_of() {
    let here = tempfile::tempdir().expect("temporary folder");
    assert!(smam(&["scenes", "muscle_bench", "--copy-to", "."], here.path()).status.success());
    let urdf = here.path().join("models/muscle_bench.urdf");
    let text = fs::read_to_string(&urdf).expect("copied");
    fs::write(&urdf, text.replace("upper=\"0.2\"", "upper=\"0.01\"")).expect("written");
    let scene = here.path().join("scenes/muscle_bench.toml");
    let warned = || {
        let run = smam(&["run", "scenes/muscle_bench.toml"], here.path());
        assert!(run.status.success(), "{}", said(&run));
        said(&run).contains("warning: joint slide: beyond its limit in the URDF, where the scene has no stop")
    };
    assert!(warned());
    let stop = "\n[[mechanism.joint]]\njoints = [\"slide\"]\nupper_stop = { position_m = 0.04, stiffness_n_m = 1e4 }\n";
    let text = fs::read_to_string(&scene).expect("copied");
    fs::write(&scene, text + stop).expect("written");
    assert!(!warned());
}
