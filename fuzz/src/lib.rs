//! What the fuzz targets do with an input: hand it to a reader of the library, as if it had stood in a file, and hold what
//! comes back against what readers promise. `tests/fuzz_corpus.rs` includes this file, so that both go the same way in.

use std::fs::File;
use std::io::{Cursor, Seek, Write};
use std::path::Path;

use smam::columns::decode;
use smam::laws::{Law, LawTable, Program, Surroundings};
use smam::mechanism::{ContactSpec, Mechanism, MechanismSpec};
use smam::recording::{OpenScene, RecordingSet, Role, Wanted, guess, read_bag_from, read_csv_from, to_toml};
use smam::scene::Scene;
use smam::system::{Rom, Simulation, SystemError};

/// Hands an input to a reader.
pub type Target = fn(&[u8]);

/// The readers, by the name of the target and of its folder in `corpus/`.
pub const TARGETS: [(&str, Target); 9] = [
    ("csv", csv),
    ("workbook", workbook),
    ("recordings_toml", recordings_toml),
    ("law", law),
    ("scene_toml", scene_toml),
    ("scene_built", scene_built),
    ("urdf", urdf),
    ("bag", bag),
    ("parquet", parquet),
];

/// Folder that inputs stand in; relative paths in them lead to what the program carries.
const FOLDER: &str = "builtin:scenes";

/// A recording as CSV.
pub fn csv(bytes: &[u8]) {
    match read_csv_from(bytes, "fuzz.csv") {
        Ok(recording) => {
            let time_s = recording.time_s();
            assert!(time_s.iter().all(|t| t.is_finite()) && time_s.is_sorted_by(|a, b| a < b), "{time_s:?}");
        }
        Err(e) => check_words(&e.to_string(), "fuzz.csv"),
    }
    looked_at(bytes, "fuzz.csv");
}

/// A workbook whose first sheet, texts and styles are the input, one after the other with a zero byte between them. The archive around them
/// is whole: a changed byte of a real file would fail its checksum, and nothing behind that would be reached.
pub fn workbook(bytes: &[u8]) {
    looked_at(&archived(bytes), "fuzz.xlsx");
}

/// What every workbook has besides.
const BOOK: [(&str, &str); 4] = [
    (
        "[Content_Types].xml",
        "<Types xmlns='http://schemas.openxmlformats.org/package/2006/content-types'><Default Extension='rels' \
         ContentType='application/vnd.openxmlformats-package.relationships+xml'/><Default Extension='xml' \
         ContentType='application/xml'/></Types>",
    ),
    (
        "_rels/.rels",
        "<Relationships xmlns='http://schemas.openxmlformats.org/package/2006/relationships'><Relationship Id='r1' \
         Type='http://schemas.openxmlformats.org/officeDocument/2006/relationships/officeDocument' \
         Target='xl/workbook.xml'/></Relationships>",
    ),
    (
        "xl/workbook.xml",
        "<workbook xmlns='http://schemas.openxmlformats.org/spreadsheetml/2006/main' \
         xmlns:r='http://schemas.openxmlformats.org/officeDocument/2006/relationships'><sheets><sheet name='run' sheetId='1' \
         r:id='r1'/></sheets></workbook>",
    ),
    (
        "xl/_rels/workbook.xml.rels",
        "<Relationships xmlns='http://schemas.openxmlformats.org/package/2006/relationships'><Relationship Id='r1' \
         Type='http://schemas.openxmlformats.org/officeDocument/2006/relationships/worksheet' \
         Target='worksheets/sheet1.xml'/><Relationship Id='r2' \
         Type='http://schemas.openxmlformats.org/officeDocument/2006/relationships/sharedStrings' \
         Target='sharedStrings.xml'/><Relationship Id='r3' \
         Type='http://schemas.openxmlformats.org/officeDocument/2006/relationships/styles' \
         Target='styles.xml'/></Relationships>",
    ),
];

fn archived(bytes: &[u8]) -> Vec<u8> {
    let mut parts = bytes.splitn(3, |byte| *byte == 0);
    let own = ["xl/worksheets/sheet1.xml", "xl/sharedStrings.xml", "xl/styles.xml"].map(|name| (name, parts.next()));
    let own = own.into_iter().filter_map(|(name, part)| Some((name, part?)));
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let stored = zip::write::SimpleFileOptions::default().compression_method(zip::CompressionMethod::Stored);
    for (name, part) in BOOK.map(|(name, text)| (name, text.as_bytes())).into_iter().chain(own) {
        archive.start_file(name, stored).expect("a new name");
        archive.write_all(part).expect("written to memory");
    }
    archive.finish().expect("written to memory").into_inner()
}

/// The same file, described by what it looks like and read so: what is written of it is always a description.
fn looked_at(bytes: &[u8], name: &str) {
    let wanted = [("plunger_mm", Role::Input), ("force_n", Role::Output)]
        .map(|(column, role)| Wanted { column: column.to_owned(), role });
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    let found = match guess(&path, &wanted) {
        Ok(found) => found,
        Err(e) => return check_words(&e.to_string(), name),
    };
    let text = to_toml(&[found], &[], OpenScene { name: "muscle_bench", channels: &wanted }, &|_| name.to_owned());
    match RecordingSet::parse(&text, &folder.path().join("recordings.toml")) {
        Err(e) => check_words(&e.to_string(), "recordings.toml"),
        Ok(set) => {
            if let Err(e) = set.load_parts(&set.runs[0]) {
                check_words(&e.to_string(), name);
            }
        }
    }
}

/// A law: in its short form if the input is one line, else as a table. What is accepted is written and read again, and evaluated where its
/// variables are zero, usual, huge and no numbers.
pub fn law(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let Some(table) = law_table(&text) else { return };
    let around = Surroundings { conditions: vec![("sheath_angle_rad".to_owned(), 1.5)], ..Surroundings::default() };
    match table.law(&around) {
        Err(e) => assert!(!e.message.is_empty() && !e.remedy.is_empty(), "{e:?}"),
        Ok(law) => {
            let written: toml::Table = table.to_toml().parse().expect("what is written of a law is TOML");
            let again = written["law"].as_array().and_then(|laws| laws.first()).cloned().expect("a table");
            let again: LawTable = again.try_into().expect("what is written of a law is one");
            assert_eq!(again.law(&around).as_ref().map(Law::text), Ok(law.text()));
            let programs = &law.programs;
            let of_states =
                [&programs.rates, &programs.rate_slopes, &programs.starts, &programs.follows, &programs.widths];
            for value in [0.0, 1e-3, -41.0, 1e300, f64::NAN] {
                of_states.into_iter().chain([&programs.value]).for_each(|program| evaluate(program, value));
            }
        }
    }
}

fn law_table(text: &str) -> Option<LawTable> {
    if text.contains('\n') {
        return toml::from_str(text).ok();
    }
    let read = LawTable::parse(text, "fuzz");
    read.inspect_err(|(message, remedy)| assert!(!message.is_empty() && !remedy.is_empty(), "{message}")).ok()
}

/// All that a program computes.
fn evaluate(program: &Program, value: f64) {
    let mut registers = vec![0.0; program.registers()];
    program.run(program.symbols().iter().map(|_| value), &mut registers);
}

/// The description of a folder of recordings.
pub fn recordings_toml(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    if let Err(e) = RecordingSet::parse(&text, Path::new("fuzz.toml")) {
        check_words(&e.to_string(), "fuzz.toml");
    }
}

/// A scene, with the tables of its effects: parsed, checked, listed.
pub fn scene_toml(bytes: &[u8]) {
    if let Some(scene) = scene(bytes) {
        assert!(!scene.keys().is_empty());
    }
}

/// A scene that is right in itself, with its mechanism and its equations: three steps of both simulations.
pub fn scene_built(bytes: &[u8]) {
    /// More fine steps and nodes than this in one step of the engine only take their time.
    const DEAREST: usize = 20_000;
    let Some(scene) = scene(bytes) else { return };
    let segments = scene.file.hydraulics.as_ref().map_or(1, |h| h.line.segments);
    if scene.file.simulation.substeps.saturating_mul(segments) > DEAREST {
        return;
    }
    if let Err(e) = Rom::new(&scene) {
        check_words(&e.to_string(), "fuzz.toml");
    }
    let until_s = 3.0 * scene.file.simulation.step_s.min(scene.file.simulation.output_interval_s);
    let run = Simulation::new(scene).and_then(|mut simulation| simulation.advance_to(until_s));
    if let Err(e) = run {
        // A law that shakes the equations apart is met on the way, where no file is asked any more.
        let place = if matches!(e, SystemError::Diverged { .. }) { "the run diverged at" } else { "fuzz.toml" };
        check_words(&e.to_string(), place);
    }
}

fn scene(bytes: &[u8]) -> Option<Scene> {
    let text = String::from_utf8_lossy(bytes);
    let path = Path::new(FOLDER).join("fuzz.toml");
    Scene::parse(&text, &path, &[]).inspect_err(|e| check_words(&e.to_string(), "fuzz.toml")).ok()
}

/// A mechanism: the URDF and what the engine makes of it.
pub fn urdf(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    let spec = MechanismSpec {
        urdf: "fuzz.urdf".into(),
        gravity_m_s2: [0.0, 0.0, -9.81],
        links_have_weight: true,
        contact: Some(ContactSpec { links: vec!["tip".to_owned()], ..ContactSpec::default() }),
        ..MechanismSpec::default()
    };
    let plain = MechanismSpec { contact: None, ..spec.clone() };
    for spec in [spec, plain] {
        match Mechanism::parse(&text, &Path::new(FOLDER).join("fuzz.urdf"), &spec) {
            Ok(mut mechanism) => {
                let count = mechanism.coordinates().len();
                mechanism.advance(1e-3, &vec![0.1; count], &mut vec![0.0; count]);
                assert_eq!(mechanism.link_poses().len(), mechanism.link_names().len());
            }
            Err(e) => check_words(&e.to_string(), "remedy: "),
        }
    }
}

/// A ROS 2 bag, with channels declared and without.
pub fn bag(bytes: &[u8]) {
    let set = RecordingSet::parse(BAG_SET, Path::new("recordings.toml")).expect("it is right");
    for declared in [&set.channels[..], &[]] {
        match read_bag_from(Cursor::new(bytes), Path::new("fuzz.mcap"), declared) {
            Ok(run) => assert!(run.recording.time_s().is_sorted_by(|a, b| a < b)),
            Err(e) => assert!(e.to_string().contains("fuzz.mcap"), "{e}"),
        }
    }
}

/// What the corpus' bags hold: a stamped joint state, an absolute pressure, a list within a list.
const BAG_SET: &str = r#"
format = 1
scene = "none"
channel = [
    { column = "tip_deg", role = "output", topic = "/joint_states", field = "position", joint = "tip", unit = "rad" },
    { column = "line_kpa", role = "input", topic = "/p", field = "fluid_pressure", zero = 101325 },
    { column = "valve_ratio", role = "output", topic = "/rig", field = "valves[1].opening", unit = "ratio", time = "log" },
]
run = [{ file = "fuzz.mcap" }]
"#;

/// A recording as Parquet.
pub fn parquet(bytes: &[u8]) {
    let columns = temporary(bytes).map_err(|e| e.to_string()).and_then(decode);
    if let Ok(columns) = columns {
        for (_, column) in columns {
            assert_eq!(column.numbers().map_or(column.len(), |n| n.len()), column.len());
        }
    }
}

/// The input as a file without a name.
fn temporary(bytes: &[u8]) -> std::io::Result<File> {
    let mut file = tempfile::tempfile()?;
    file.write_all(bytes)?;
    file.rewind()?;
    Ok(file)
}

/// A message says where, and what to do.
fn check_words(message: &str, place: &str) {
    assert!(message.contains(place) && message.contains("remedy: "), "{message}");
}
