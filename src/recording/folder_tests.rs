//! `recordings.toml` is read as the format says, and every mistake is refused with place and remedy.

use super::*;

const GOOD: &str = r#"
format = 1
scene = "muscle_bench"

[[channel]]
column = "plunger_mm"
role = "input"

[[channel]]
column = "force_n"
role = "output"
noise_sd = 1

[[run]]
file = "sine.csv"
use = "holdout"
hanging_mass_kg = 0.2
sheath_angle_deg = 60
"#;

fn parse(text: &str) -> Result<RecordingSet, RecordingError> {
    RecordingSet::parse(text, Path::new("rig/recordings.toml"))
}

fn refusal(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from));
    parse(&GOOD.replace(from, to)).unwrap_err().to_string()
}

#[test]
fn good_file_is_read_whole() {
    let set = parse(GOOD).unwrap();
    assert_eq!((set.dir.as_path(), set.scene.as_str()), (Path::new("rig"), "muscle_bench"));
    let outputs: Vec<_> = set.of_role(Role::Output).collect();
    assert_eq!(outputs[0].column, "force_n");
    assert_eq!(outputs[0].noise_sd, Some(1.0));
    assert_eq!(set.runs[0].run_use, Some(RunUse::Holdout));
    assert_eq!(set.runs[0].conditions["hanging_mass_kg"], 0.2);
    assert_eq!(set.runs[0].conditions["sheath_angle_deg"], 60.0);
}

#[test]
fn top_level_mistakes() {
    assert_eq!(
        refusal("format = 1", "format = 2"),
        "rig/recordings.toml: top level: format = 2 is not known\n  remedy: this version reads format = 1"
    );
    assert_eq!(
        refusal("format = 1", ""),
        "rig/recordings.toml: top level: key \"format\" is missing\n  remedy: add format = 1"
    );
    assert_eq!(
        refusal("scene =", "scen ="),
        "rig/recordings.toml: top level: unknown key \"scen\", did you mean \"scene\"?\n  remedy: the keys here are \
         format, scene, channel, run"
    );
    assert_eq!(
        refusal("[[run]]", "[[channel]]"),
        "rig/recordings.toml: [[channel]] 3: unknown key \"file\"\n  remedy: the keys here are column, role, noise_sd, \
         topic, field, joint, unit, zero, time"
    );
    assert!(refusal("scene = ", "scene ").contains("is not valid TOML: TOML parse error at line 3"));
}

#[test]
fn channel_mistakes() {
    assert_eq!(
        refusal("role = \"input\"", "rol = \"input\""),
        "rig/recordings.toml: [[channel]] 1 (\"plunger_mm\"): unknown key \"rol\", did you mean \"role\"?\n  remedy: \
         the keys here are column, role, noise_sd, topic, field, joint, unit, zero, time"
    );
    assert_eq!(
        refusal("\"output\"", "\"ouput\""),
        "rig/recordings.toml: [[channel]] 2 (\"force_n\"): role = \"ouput\" is not known, did you mean \
         \"output\"?\n  remedy: write one of \"input\", \"output\""
    );
    assert_eq!(
        refusal("\"output\"", "\"input\""),
        "rig/recordings.toml: top level: no channel has role = \"output\"\n  remedy: declare one that was measured"
    );
    assert_eq!(
        refusal("noise_sd = 1", "noise_sd = 0"),
        "rig/recordings.toml: [[channel]] 2 (\"force_n\"): noise_sd = 0 must be > 0\n  remedy: leave it out to have \
         it estimated"
    );
    assert!(refusal("force_n", "force").contains("column \"force\": its name ends in no known unit"));
    assert!(refusal("force_n", "plunger_mm").contains("declared twice"));
    assert!(refusal("force_n", "time_s").contains("the time is no channel"));
}

#[test]
fn run_mistakes() {
    assert_eq!(
        refusal("hanging_mass_kg = 0.2", "hanging_mass_kg = \"light\""),
        "rig/recordings.toml: [[run]] 1 (\"sine.csv\"): hanging_mass_kg = \"light\" must be a finite number\n  remedy: write hanging_mass_kg = 0.5, or whatever it is"
    );
    assert_eq!(
        refusal("file = \"sine.csv\"", ""),
        "rig/recordings.toml: [[run]] 1: key \"file\" is missing\n  remedy: add file = \"sine.csv\""
    );
    assert!(refusal("\"holdout\"", "\"hold\"").contains("write one of \"fit\", \"holdout\""));
}

#[test]
fn runs_are_checked_against_the_declaration() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(SET_FILE_NAME), GOOD).unwrap();
    let set = RecordingSet::load(folder.path()).unwrap();
    let csv = folder.path().join("sine.csv");
    std::fs::write(&csv, "time_s,plunger_mm,force_n,remark\n0,1,2,3\n").unwrap();
    let loaded = set.load_run(&set.runs[0]).unwrap();
    assert_eq!(loaded.recording.columns(), ["plunger_mm", "force_n", "remark"]);
    assert_eq!(loaded.notes, ["columns that recordings.toml does not declare are not used: remark"]);
    std::fs::write(&csv, "time_s,plunger_mm,force\n0,1,2\n").unwrap();
    let error = set.load_run(&set.runs[0]).unwrap_err().to_string();
    assert!(
        error.ends_with(
            "sine.csv: no column \"force_n\", which recordings.toml declares (found: plunger_mm, force)\n  remedy: \
             rename the column or the [[channel]], or list it under not_recorded in the [[run]] of this file"
        ),
        "{error}"
    );
}

#[test]
fn a_run_may_lack_a_sensor_that_others_have() {
    let folder = tempfile::tempdir().unwrap();
    let text = GOOD.replace("use = \"holdout\"", "not_recorded = [\"force_n\"]");
    std::fs::write(folder.path().join(SET_FILE_NAME), text).unwrap();
    let set = RecordingSet::load(folder.path()).unwrap();
    let csv = folder.path().join("sine.csv");
    std::fs::write(&csv, "time_s,plunger_mm\n0,1\n0.1,2\n").unwrap();
    let loaded = set.load_run(&set.runs[0]).unwrap();
    assert_eq!(loaded.recording.columns(), ["plunger_mm", "force_n"]);
    assert!(loaded.recording.channel("force_n").unwrap().values.iter().all(|v| v.is_nan()));
    assert!(loaded.notes.is_empty());
    std::fs::write(&csv, "time_s,plunger_mm,force_n\n0,1,\n").unwrap();
    assert!(set.load_run(&set.runs[0]).is_ok(), "an empty column is one that was not recorded");
    std::fs::write(&csv, "time_s,plunger_mm,force_n\n0,1,2\n").unwrap();
    let error = set.load_run(&set.runs[0]).unwrap_err().to_string();
    assert!(error.contains("\"force_n\" is there") && error.contains("remedy: remove it from that list"), "{error}");
}

#[test]
fn what_was_not_recorded_is_an_output_that_is_declared() {
    let said = |list: &str| refusal("use = \"holdout\"", &format!("not_recorded = {list}"));
    assert_eq!(
        said("[\"force_m\"]"),
        "rig/recordings.toml: [[run]] 1 (\"sine.csv\"): not_recorded names \"force_m\", which is no declared output, did \
         you mean \"force_n\"?\n  remedy: the outputs are force_n"
    );
    assert!(
        said("[\"force_n\", \"force_n\"]").ends_with("not_recorded names \"force_n\" twice\n  remedy: name it once")
    );
    assert!(said("[\"plunger_mm\"]").contains("no declared output"));
    assert!(said("\"force_n\"").ends_with("must be a list of texts\n  remedy: write not_recorded = [\"force_n\"]"));
}
