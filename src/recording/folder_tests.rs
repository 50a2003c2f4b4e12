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
         format, scene, file, channel, run"
    );
    assert_eq!(
        refusal("[[run]]", "[[channel]]"),
        "rig/recordings.toml: [[channel]] 3: unknown key \"file\"\n  remedy: the keys here are column, role, noise_sd, constant, \
         name, unit, scale, zero, topic, field, joint, time"
    );
    assert_eq!(
        refusal("format = 1", "format = 1\ntime = \"index\""),
        "rig/recordings.toml: top level: key \"time\" is one of [file]\n  remedy: write time = \"index\" below a line \
         [file]"
    );
    let moved = GOOD.replace("[[run]]", "[file]\ntime = \"index\"\ninterval_s = 0.1\n[[run]]");
    assert!(parse(&moved).is_ok());
    assert!(refusal("scene = ", "scene ").contains("is not valid TOML: TOML parse error at line 3"));
}

#[test]
fn channel_mistakes() {
    assert_eq!(
        refusal("role = \"input\"", "rol = \"input\""),
        "rig/recordings.toml: [[channel]] 1 (\"plunger_mm\"): unknown key \"rol\", did you mean \"role\"?\n  remedy: \
         the keys here are column, role, noise_sd, constant, name, unit, scale, zero, topic, field, joint, time"
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
             rename the column, say name = \"...\" in the [[channel]], or list it under not_recorded in the [[run]] of this file"
        ),
        "{error}"
    );
}

#[test]
fn an_input_that_stood_still_need_not_be_in_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let text =
        GOOD.replace("[[run]]", "[[channel]]\ncolumn = \"pressure_kpa\"\nrole = \"input\"\nconstant = 20\n\n[[run]]");
    std::fs::write(folder.path().join(SET_FILE_NAME), text).unwrap();
    let set = RecordingSet::load(folder.path()).unwrap();
    let csv = folder.path().join("sine.csv");
    std::fs::write(&csv, "time_s,plunger_mm,force_n\n0,1,2\n0.1,2,2\n").unwrap();
    let loaded = set.load_run(&set.runs[0]).unwrap();
    assert_eq!(loaded.recording.channel("pressure_kpa").unwrap().values, [20.0, 20.0]);
    assert!(loaded.notes.is_empty());
    std::fs::write(&csv, "time_s,plunger_mm,force_n,pressure_kpa\n0,1,2,20\n").unwrap();
    let error = set.load_run(&set.runs[0]).unwrap_err().to_string();
    assert!(
        error.ends_with(
            "column \"pressure_kpa\" is there, and recordings.toml says that it stood still (constant)\n  \
             remedy: remove constant from its [[channel]], or rename the column"
        ),
        "{error}"
    );
    assert!(
        refusal("noise_sd = 1", "constant = 1")
            .ends_with("constant is for inputs\n  remedy: leave an output out that was not recorded")
    );
    assert!(refusal("role = \"input\"", "role = \"input\"\nconstant = 1\nunit = \"m\"").ends_with(
        "unit says where the files have the channel, constant that they lack it\n  remedy: remove one of the two"
    ));
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

const LAYOUT: &str = "[file]\ndelimiter = \";\"\ndecimal = \",\"\n\n[[run]]\n";

/// What `[file]` says holds for every run that does not say otherwise.
#[test]
fn a_run_may_be_laid_out_otherwise() {
    let text = GOOD.replace("[[run]]\n", LAYOUT) + "delimiter = \"tab\"\n\n[[run]]\nfile = \"step.csv\"\n";
    let set = parse(&text).unwrap();
    let delimiters: Vec<_> =
        set.runs.iter().map(|run| run.layout.delimiter.map(crate::recording::Delimiter::word)).collect();
    assert_eq!(delimiters, [Some("tab".to_owned()), Some(";".to_owned())]);
    assert!(set.runs.iter().all(|run| run.layout.decimal == Some(',')));
    assert_eq!(set.runs[0].conditions.len(), 2);
}

/// Each mistake names its key and its remedy; the remedies are in the second column, and are read.
#[test]
fn layout_mistakes_and_their_remedies() {
    for (wrong, right) in [
        ("delimiter = \"colon\"", "delimiter = \";\""),
        ("decimal = \";\"", "decimal = \",\"\ndelimiter = \";\""),
        ("decimal = \",\"", "decimal = \",\"\ndelimiter = \"tab\""),
        ("encoding = \"ansi code\"", "encoding = \"windows-1252\""),
        ("skip_rows = -1", "skip_rows = 3"),
        ("header = 0", "header = 4"),
        ("header = false", "header = false\nnames = [\"time_s\", \"plunger_mm\"]"),
        ("names = [\"time_s\"]", "header = false\nnames = [\"time_s\"]"),
        ("units_row = 1", "units_row = true"),
        ("time_unit = \"mm\"", "time_unit = \"ms\""),
        ("time = \"index\"", "time = \"index\"\ninterval_s = 0.1"),
        ("interval_s = 0", "interval_s = 0.01"),
        ("time = \"rows\"", "time = \"column\""),
        ("split_at_restart = \"yes\"", "split_at_restart = true"),
        ("colums = 1", "skip_rows = 1"),
    ] {
        let said = refusal("[[run]]", &format!("[file]\n{wrong}\n[[run]]"));
        let key = wrong.split(' ').next().unwrap();
        assert!(said.starts_with("rig/recordings.toml: [file]: ") && said.contains(key), "{said}");
        assert_eq!(said.matches("remedy: ").count(), 1, "{said}");
        let fixed = parse(&GOOD.replace("[[run]]", &format!("[file]\n{right}\n[[run]]")));
        assert!(fixed.is_ok(), "{right}: {fixed:?}");
    }
    let said = refusal("scene = \"muscle_bench\"", "scene = \"muscle_bench\"\nfile = 3");
    assert!(said.contains("file = 3 must be a table"), "{said}");
}

#[test]
fn channel_sources_are_checked_against_their_units() {
    for (wrong, right) in [
        ("unit = \"furlong\"", "unit = \"kgf\""),
        ("unit = \"V\"", "unit = \"V\"\nscale = 2.5"),
        ("unit = \"bar\"", "unit = \"lbf\""),
        ("scale = 0", "scale = 2"),
        ("field = \"data\"", "topic = \"/force\"\nfield = \"data\""),
        ("topic = \"/force\"\nscale = 2", "topic = \"/force\""),
    ] {
        let said = refusal("noise_sd = 1", wrong);
        assert!(said.contains("[[channel]] 2 (\"force_n\"): ") && said.contains("remedy: "), "{said}");
        let fixed = parse(&GOOD.replace("noise_sd = 1", right));
        assert!(fixed.is_ok(), "{right}: {fixed:?}");
    }
}

/// `value = unit(scale * (number - zero))`, by hand: (3 V - 0.5 V) * 4 N/V; (50 - 10) cm is 400 mm.
#[test]
fn numbers_become_the_channels() {
    let folder = tempfile::tempdir().unwrap();
    let text = GOOD
        .replace("noise_sd = 1", "name = \"Load [V]\"\nzero = 0.5\nscale = 4")
        .replace("role = \"input\"", "role = \"input\"\nname = \"x\"\nunit = \"cm\"\nzero = 10");
    std::fs::write(folder.path().join(SET_FILE_NAME), text).unwrap();
    std::fs::write(folder.path().join("sine.csv"), "time_s,x,Load [V]\n0,50,3\n0.1,10,0.5\n").unwrap();
    let set = RecordingSet::load(folder.path()).unwrap();
    let read = set.load_run(&set.runs[0]).unwrap().recording;
    assert_eq!(read.channel("plunger_mm").unwrap().values, [400.0, 0.0]);
    assert_eq!(read.channel("force_n").unwrap().values, [10.0, 0.0]);
}

/// Where one run is asked for, the remedy is the one that was tried: a file for each.
#[test]
fn several_runs_in_a_file_are_not_one() {
    let folder = tempfile::tempdir().unwrap();
    let whole = "time_s,plunger_mm,force_n\n0,50,3\n0.1,10,0.5\n0,1,2\n0.1,2,3\n";
    let write = |layout: &str, data: &str| {
        let text = GOOD.replace("[[run]]", &format!("{layout}[[run]]"));
        std::fs::write(folder.path().join(SET_FILE_NAME), text).unwrap();
        std::fs::write(folder.path().join("sine.csv"), data).unwrap();
        RecordingSet::load(folder.path()).unwrap()
    };
    let set = write("[file]\nsplit_at_restart = true\n", whole);
    assert_eq!(set.load_parts(&set.runs[0]).unwrap().len(), 2);
    let said = set.load_run(&set.runs[0]).unwrap_err().to_string();
    assert!(said.contains("remedy: give each a file of its own, and leave split_at_restart out"), "{said}");
    let first = whole.split("0,1,2").next().unwrap();
    let set = write("", first);
    assert_eq!(set.load_run(&set.runs[0]).unwrap().recording.time_s(), [0.0, 0.1]);
}
