//! Contract of the JSON Schemas: what is committed is what the program prints, scenes name it, and an independent validator
//! takes what the program takes and refuses what it refuses. The other side is `tests/schema_peer.py`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use smam::recording::{RecordingSet, recordings_schema};
use smam::scene::{Scene, scene_schema};
use smam::stock;

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

#[test]
fn committed_schemas_are_what_the_program_prints() {
    for (kind, text) in [("scene", scene_schema()), ("recordings", recordings_schema())] {
        let file = scenes().join(format!("{kind}.schema.json"));
        let remedy = format!("write it anew: smam schema {kind} > scenes/{kind}.schema.json");
        assert!(fs::read_to_string(file).unwrap_or_default() == text, "{remedy}");
        let done = Command::new(env!("CARGO_BIN_EXE_smam")).args(["schema", kind]).output().expect("starts");
        assert!(done.stdout == text.as_bytes(), "smam schema {kind}");
    }
}

#[test]
fn stock_scenes_name_their_schema() {
    for name in stock::scenes() {
        let text = fs::read_to_string(scenes().join(format!("{name}.toml"))).expect("a scene");
        assert_eq!(text.lines().next(), Some("#:schema scene.schema.json"), "{name}");
    }
}

/// What the peer says of each file; `None` where there is none.
fn peer(kind: &str, files: &[PathBuf]) -> Option<Vec<String>> {
    let Some(python) = std::env::var_os("SMAM_PEER_PYTHON") else {
        eprintln!("skipped: SMAM_PEER_PYTHON names no Python with jsonschema");
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/schema_peer.py");
    let schema = scenes().join(format!("{kind}.schema.json"));
    let done = Command::new(python).arg(script).arg(schema).args(files).output().expect("python starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    Some(String::from_utf8_lossy(&done.stdout).lines().map(str::to_owned).collect())
}

/// Writes the text with each change made in it; the changes must be there to make.
fn changed(folder: &Path, text: &str, changes: &[(&str, &str)]) -> Vec<PathBuf> {
    let files = changes.iter().enumerate().map(|(i, (from, to))| {
        assert!(text.contains(from), "`{from}` is not in the text");
        let file = folder.join(format!("changed_{i}.toml"));
        fs::write(&file, text.replacen(from, to, 1)).expect("written");
        file
    });
    files.collect()
}

#[test]
fn stock_scenes_are_right_and_wrong_ones_wrong_to_both() {
    let stock: Vec<PathBuf> = stock::scenes().map(|name| scenes().join(format!("{name}.toml"))).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let text = fs::read_to_string(scenes().join("muscle_bench.toml")).expect("a scene");
    let changes = [
        ("duration_s", "duration"),
        ("substeps = ", "substeps = -"),
        ("format = 1", "format = \"1\""),
        ("kind = \"", "kind = \"no_"),
        ("stroke_m", "stroke_mm"),
        ("law = \"", "law = \"no_"),
        ("quantity = \"", "quantity = \"no_"),
        ("[simulation]", "[simulations]"),
        ("length_m = ", "length_m = \"long\" # "),
    ];
    let wrong = changed(folder.path(), &text, &changes);
    for (file, change) in wrong.iter().zip(&changes) {
        assert!(Scene::load(&file.display().to_string(), &[]).is_err(), "{change:?} is taken by the program");
    }
    let Some(said) = peer("scene", &stock) else { return };
    assert!(said.len() == stock.len() && said.iter().all(|line| line == "right"), "{said:#?}");
    let said = peer("scene", &wrong).unwrap_or_default();
    for (line, change) in said.iter().zip(&changes) {
        assert!(line.starts_with("wrong "), "{change:?} is taken by the schema");
    }
    assert_eq!(said.len(), changes.len());
}

const RECORDINGS: &str = "format = 1\nscene = \"tendon_sheath\"\n\
    [[channel]]\ncolumn = \"drive_deg\"\nrole = \"input\"\ntopic = \"/joint_states\"\nfield = \"position\"\njoint = \"drive\"\n\
    [[channel]]\ncolumn = \"tip_deg\"\nrole = \"output\"\nnoise_sd = 0.1\n\
    [[run]]\nfile = \"run.mcap\"\nuse = \"holdout\"\nhanging_mass_kg = 0.2\n";

#[test]
fn recordings_are_right_and_wrong_to_both() {
    let folder = tempfile::tempdir().expect("a folder");
    let changes = [
        ("format = 1", "format = 2"),
        ("role", "rol"),
        ("\"output\"", "\"outputs\""),
        ("drive_deg", "drive_grad"),
        ("noise_sd = 0.1", "noise_sd = 0"),
        ("\"/joint_states\"", "\"joint_states\""),
        ("topic = \"/joint_states\"\n", ""),
        ("use = \"holdout\"", "use = \"no\""),
        ("hanging_mass_kg = 0.2", "hanging_mass_kg = \"light\""),
        ("file = \"run.mcap\"", "files = 1"),
    ];
    let right = folder.path().join("recordings.toml");
    fs::write(&right, RECORDINGS).expect("written");
    assert!(RecordingSet::load(&right).is_ok());
    let wrong = changed(folder.path(), RECORDINGS, &changes);
    for (file, change) in wrong.iter().zip(&changes) {
        assert!(RecordingSet::load(file).is_err(), "{change:?} is taken by the program");
    }
    let Some(said) = peer("recordings", &[right]) else { return };
    assert_eq!(said, ["right"]);
    let said = peer("recordings", &wrong).unwrap_or_default();
    assert!(said.len() == changes.len() && said.iter().all(|line| line.starts_with("wrong ")), "{said:#?}");
}
