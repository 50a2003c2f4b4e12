//! Contract of bags: what the MCAP and ROS 2 libraries of others write is read as they wrote it, and they read what a run
//! writes. The other side is `tests/mcap_peer.py`; its bags of two kinds lie in `tests/recordings/`, so that reading is tested
//! where no Python is.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use smam::recording::{LoadedRun, RecordingSet, read_csv, read_recording};

const SET: &str = r#"
format = 1
scene = "none_is_read"

[[channel]]
column = "position_mm"
role = "input"
topic = "/syringe/position"
unit = "mm"

[[channel]]
column = "tip_rad"
role = "output"
topic = "/joint_states"
field = "position"
joint = "tip"

[[channel]]
column = "drive_nm"
role = "output"
topic = "/joint_states"
field = "effort"
joint = "drive"

[[channel]]
column = "tip_nm"
role = "output"
topic = "/joint_states"
field = "effort"
joint = "tip"

[[channel]]
column = "line_kpa"
role = "output"
topic = "/line/pressure"
field = "fluid_pressure"
zero = 101325

[[channel]]
column = "force_mn"
role = "output"
topic = "/ft/wrench"
field = "wrench.force.z"

[[channel]]
column = "torque_nm"
role = "output"
topic = "/ft/wrench"
field = "wrench.torque.y"

[[channel]]
column = "valve_ratio"
role = "output"
topic = "/rig/state"
field = "valves[1].opening"
unit = "ratio"

[[run]]
file = "run.mcap"
"#;

fn fixture(kind: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/recordings/ros2_{kind}.mcap"))
}

fn loaded(bag: &Path, set: &str) -> Result<LoadedRun, String> {
    let folder = tempfile::tempdir().expect("a folder");
    fs::copy(bag, folder.path().join("run.mcap")).expect("copied");
    fs::write(folder.path().join("recordings.toml"), set).expect("written");
    let set = RecordingSet::load(folder.path()).map_err(|e| e.to_string())?;
    set.load_run(&set.runs[0]).map_err(|e| e.to_string())
}

/// Holds a loaded bag against the formulas of `mcap_peer.py`.
fn assert_is_the_peers(bag: &Path) {
    let run = loaded(bag, SET).expect("a run");
    let recording = &run.recording;
    // The first message is of /rig/state, recorded when the first joint state was stamped: time counts from there.
    let expected: Vec<f64> = (0..200).map(|i| f64::from(i) * 0.01).collect();
    assert_eq!(recording.time_s().len(), 200);
    assert!(
        recording.time_s().iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12),
        "{:?}",
        &recording.time_s()[..3]
    );
    let values = |column: &str| recording.channel(column).expect("there").values.clone();
    let all = |column: &str, formula: &dyn Fn(f64) -> f64| {
        for (i, value) in values(column).into_iter().enumerate() {
            let right = formula(i as f64);
            let is_right = (value - right).abs() <= 1e-14 * right.abs() || value.is_nan() && right.is_nan();
            assert!(is_right, "{column} {i}: {value} for {right}");
        }
    };
    all("tip_rad", &|i| -i / 128.0);
    all("drive_nm", &|i| i / 32.0);
    all("tip_nm", &|i| if i == 7.0 { f64::NAN } else { i / 16.0 });
    // Recorded 6 ms after the stamps: on the straight line between its samples; before the first one, missing.
    let position = values("position_mm");
    assert!(position[0].is_nan());
    for (i, value) in position.iter().enumerate().skip(1) {
        assert!((value - (i as f64 - 0.6) / 256.0).abs() < 1e-12, "{i}: {value}");
    }
    // Slower topics with the same stamps: their own samples, and none between.
    let slow = |every: f64, factor: f64| move |i: f64| if i % every == 0.0 { i * factor } else { f64::NAN };
    all("line_kpa", &slow(2.0, 1.0));
    all("force_mn", &slow(5.0, 125.0));
    all("torque_nm", &slow(5.0, 0.25));
    all("valve_ratio", &slow(5.0, 0.5));
    assert_eq!(
        run.notes,
        [
            "one time for all channels, that of /joint_states (200 samples); brought to it: /syringe/position (200 samples), \
          /line/pressure (100 samples), /ft/wrench (40 samples), /rig/state (40 samples)"
        ]
    );
}

#[test]
fn bags_of_others_are_read_as_they_wrote_them() {
    ["lz4", "zstd"].iter().for_each(|kind| assert_is_the_peers(&fixture(kind)));
}

#[test]
fn a_channel_that_the_bag_does_not_have_is_named_with_the_remedy() {
    let refusal = |from: &str, to: &str| {
        assert!(SET.contains(from));
        loaded(&fixture("zstd"), &SET.replacen(from, to, 1)).expect_err("refused")
    };
    let said = refusal("\"/ft/wrench\"", "\"/ft/wrenches\"");
    assert!(
        said.contains("run.mcap: no topic /ft/wrenches (topics: /chatter (std_msgs/msg/String), /ft/wrench"),
        "{said}"
    );
    assert!(said.ends_with("fix the topic of the [[channel]] \"force_mn\" in recordings.toml"), "{said}");
    assert!(refusal("joint = \"tip\"", "joint = \"top\"").contains("no message has the field and the joint"));
    assert!(refusal("field = \"wrench.force.z\"", "").contains("topic /ft/wrench, message 1: it has no field `data`"));
    assert!(refusal("topic = \"/syringe/position\"\nunit = \"mm\"", "").contains("ends in /position_mm (topics"));
    assert!(refusal("unit = \"mm\"", "unit = \"kpa\"").contains("unit = \"kpa\" cannot become the column's, mm"));
    assert!(refusal("topic = \"/syringe/position\"", "").contains("are for tables\n  remedy: add topic"));
    assert!(refusal("\"/syringe/position\"", "\"syringe\"").contains("remedy: write topic = \"/syringe\""));
    let notes = loaded(&fixture("zstd"), &SET.replace("zero = 101325", "")).expect("a run").notes;
    assert!(
        notes[0].contains("FluidPressure is an absolute pressure") && notes[0].contains("zero = 101325"),
        "{notes:?}"
    );
}

#[test]
fn a_channel_that_the_bag_has_all_the_same_was_recorded() {
    let file = "file = \"run.mcap\"";
    let set = SET.replace(file, &format!("{file}\nnot_recorded = [\"force_mn\"]"));
    let refused = loaded(&fixture("zstd"), &set).expect_err("it is there");
    assert!(refused.contains("\"force_mn\" is there, and recordings.toml says that it is not_recorded"), "{refused}");
    let elsewhere = set.replacen("\"/ft/wrench\"", "\"/ft/wrenches\"", 1);
    let run = loaded(&fixture("zstd"), &elsewhere).expect("a run without it");
    assert!(run.recording.channel("force_mn").expect("filled in").values.iter().all(|v| v.is_nan()));
}

fn smam(arguments: &[&str]) {
    let done = Command::new(env!("CARGO_BIN_EXE_smam")).args(arguments).output().expect("starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// The same run in three formats, and each of them drives the same run again.
#[test]
fn a_run_is_the_same_in_every_format() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let files = ["run.csv", "run.parquet", "run.mcap"].map(at);
    for file in &files {
        smam(&["run", "tendon_sheath", "--duration", "2", "--output", file]);
    }
    let recordings = files.each_ref().map(|file| read_recording(Path::new(file)).expect("a recording"));
    let with_channels = |i: usize| recordings[i].channels().iter().map(|c| (c.column.clone(), c.values.clone()));
    assert_eq!(recordings[0], recordings[1]);
    assert!(with_channels(0).eq(with_channels(2)));
    // A bag keeps whole nanoseconds.
    let times = recordings[0].time_s().iter().zip(recordings[2].time_s());
    assert!(times.clone().count() > 10 && times.into_iter().all(|(a, b)| (a - b).abs() <= 0.5e-9));
    let again = files.each_ref().map(|file| {
        smam(&["run", "tendon_sheath", "--input", file, "--output", &at("again.csv")]);
        read_csv(Path::new(&at("again.csv"))).expect("a recording")
    });
    assert_eq!(again[0], again[1]);
    let difference = |column: &str| {
        let pairs = again[0]
            .channel(column)
            .expect("there")
            .values
            .iter()
            .zip(&again[2].channel(column).expect("there").values);
        pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    assert!(difference("tip_deg") < 1e-6, "{}", difference("tip_deg"));
}

/// `SMAM_PEER_PYTHON`: a Python that has `mcap` 1.6.0 and `mcap-ros2-support` 0.6.0; `check.sh` makes one.
#[test]
fn the_peers_library_agrees_both_ways() {
    let Some(python) = std::env::var_os("SMAM_PEER_PYTHON") else {
        eprintln!("skipped: SMAM_PEER_PYTHON names no Python with mcap and mcap-ros2-support");
        return;
    };
    let peer = |arguments: &[&str]| {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/mcap_peer.py");
        let done = Command::new(&python).arg(script).args(arguments).output().expect("python starts");
        assert!(done.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&done.stderr));
        String::from_utf8_lossy(&done.stdout).into_owned()
    };
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    for kind in ["none", "lz4", "zstd", "unchunked"] {
        peer(&["write", &at("peer.mcap"), kind]);
        assert_is_the_peers(Path::new(&at("peer.mcap")));
    }
    for scene in ["tendon_sheath", "muscle_bench"] {
        smam(&["run", scene, "--duration", "2", "--output", &at("run.csv")]);
        smam(&["run", scene, "--duration", "2", "--output", &at("run.mcap")]);
        let said = peer(&["read", &at("run.mcap"), &at("run.csv")]);
        assert!(said.starts_with("equal: "), "{said}");
        print!("{scene}: {said}");
    }
}
