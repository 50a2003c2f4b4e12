//! Contract: a ten-second run of a synthetic catheter, and a diagnosis of two, become `.rrd` files that end properly.
//!
//! To look at it, name the file: `SMAM_VIEW_RRD=f.rrd cargo test --release --test view`, then
//! `rerun f.rrd`, or `rerun f.rrd --headless --screenshot-to f.png --window-size 1600x900`.
#![cfg(feature = "viz")]

use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::PathBuf;

use smam::mechanism::geometry::{Contact, Pose, Shape, Visual};
use smam::system::observe::{
    CableFrame, Frame, JointGraph, LawFrame, LawGraph, MeasuredChannel, MuscleFrame, MuscleGraph, Observer, SceneGraph,
    SideBySide,
};
use smam::view::{ViewOptions, ViewSink, Viewer, show_diagnosis};

const LINKS: usize = 8;
const LINK_M: f64 = 0.018;
const RADIUS_M: f64 = 0.007;
const SIDES: [f64; 2] = [-1.0, 1.0];
const MUSCLE_FOOT_M: f64 = -0.17;
const MUSCLE_REST_M: f64 = 0.1;

#[test]
fn a_bending_catheter_becomes_a_complete_file() {
    let file = std::env::var_os("SMAM_VIEW_RRD")
        .map_or_else(|| PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("view.rrd"), PathBuf::from);
    let mut viewer = Viewer::open(&ViewSink::File(file.clone()), ViewOptions::default()).unwrap();
    assert!(viewer.announcement().contains("`rerun "));
    viewer.begin(&graph()).unwrap();
    for n in 0..=1000 {
        viewer.frame(&frame(f64::from(n) * 0.01)).unwrap();
    }
    assert_eq!(viewer.finish().unwrap().frames, 1001);

    let bytes = std::fs::read(&file).unwrap();
    assert!(bytes.starts_with(b"RRF2"), "an .rrd file's head");
    assert!(bytes.len() < 4_000_000, "{} bytes for 1001 frames", bytes.len());
}

/// Half a stream opens in the viewer like a whole one: it must not have the file's name, nor take the former file's place.
#[test]
fn a_run_that_is_cut_off_leaves_the_former_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("run.rrd");
    std::fs::write(&file, "former").unwrap();
    let mut viewer = Viewer::open(&ViewSink::File(file.clone()), ViewOptions::default()).unwrap();
    viewer.begin(&graph()).unwrap();
    (0..=2000).for_each(|n| viewer.frame(&frame(f64::from(n) * 0.01)).unwrap());
    assert_eq!(std::fs::read(&file).unwrap(), b"former");
    drop(viewer);
    assert_eq!(std::fs::read(&file).unwrap(), b"former");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "what was begun is gone");

    let mut viewer = Viewer::open(&ViewSink::File(file.clone()), ViewOptions::default()).unwrap();
    viewer.begin(&graph()).unwrap();
    viewer.frame(&frame(0.0)).unwrap();
    viewer.finish().unwrap();
    let bytes = std::fs::read(&file).unwrap();
    assert!(bytes.starts_with(b"RRF2") && bytes[..bytes.len() - 4].ends_with(b"RRF2FOOT"), "a whole stream");
}

/// Two runs of ten seconds: what was measured bends further than the calibrated scene, the corrected one almost so.
#[test]
fn a_diagnosis_becomes_a_complete_file() {
    let file = std::env::var_os("SMAM_DIAGNOSIS_RRD")
        .map_or_else(|| PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("diagnosis.rrd"), PathBuf::from);
    let runs = [compared("sine.csv"), compared("steps.csv (held out)")];
    let sink = ViewSink::File(file.clone());
    let said = show_diagnosis(&sink, "Diagnosis", "Something is missing.", &runs, &ViewOptions::default()).unwrap();
    assert!(said.contains("`rerun "));
    let bytes = std::fs::read(&file).unwrap();
    assert!(bytes.starts_with(b"RRF2"), "an .rrd file's head");
    assert!(bytes.len() < 4_000_000, "{} bytes for 2 runs of 1001 frames", bytes.len());
    let none = show_diagnosis(&sink, "Diagnosis", "", &[], &ViewOptions::default()).unwrap_err().to_string();
    assert!(none.contains("at least one"), "{none}");
    let mut wrong = compared("sine.csv");
    wrong.measured[0].values.pop();
    let error = show_diagnosis(&sink, "Diagnosis", "", &[wrong], &ViewOptions::default()).unwrap_err().to_string();
    assert!(error.contains("1000 measured samples") && error.contains("1001"), "{error}");
}

fn compared(run: &str) -> SideBySide {
    let frames = |share: f64| -> Vec<Frame> {
        let scaled = |time_s: f64| {
            let mut frame = frame(time_s);
            frame.channels[6] *= share;
            frame.link_poses = poses(share * frame.channels[6].to_radians());
            frame
        };
        (0..=1000).map(|n| scaled(f64::from(n) * 0.01)).collect()
    };
    let (measured, calibrated, corrected) = (frames(1.0), frames(0.8), frames(0.98));
    SideBySide {
        run: run.to_owned(),
        graph: graph(),
        measured: vec![MeasuredChannel {
            channel: 6,
            values: measured.iter().map(|frame| frame.channels[6]).collect(),
            noise_sd: 0.5,
        }],
        measured_poses: measured.into_iter().map(|frame| frame.link_poses).collect(),
        calibrated,
        corrected,
        windows_s: vec![(2.0, 4.5), (6.0, 8.0)],
    }
}

fn graph() -> SceneGraph {
    let channels = [
        "plunger_1_mm",
        "plunger_2_mm",
        "pressure_1_kpa",
        "pressure_2_kpa",
        "elongation_1_mm",
        "elongation_2_mm",
        "bending_angle_deg",
        "tension_left_n",
        "tension_right_n",
    ];
    SceneGraph {
        name: "Synthetic catheter".into(),
        channels: channels.map(str::to_owned).to_vec(),
        input_count: 2,
        links: (0..=LINKS).map(link_name).collect(),
        visuals: visuals(),
        joints: (1..=LINKS)
            .map(|n| JointGraph { name: format!("hinge {n}"), is_angle: true, link: n, axis: [0.0, 1.0, 0.0] })
            .collect(),
        cables: vec!["left".into(), "right".into()],
        muscles: SIDES.map(muscle).to_vec(),
        laws: vec![LawGraph {
            name: "drag".into(),
            text: "joint.torque adds -c * angular_speed_rad_s".into(),
            variable: Some("angular_speed_rad_s".into()),
        }],
        loops: vec![(0, 6)],
        camera_target_m: [0.01, 0.0, -0.025],
        camera_position_m: [0.06, -0.33, 0.05],
        tip_link: Some(LINKS),
    }
}

fn link_name(number: usize) -> String {
    if number == 0 { "base".into() } else { format!("segment {number}") }
}

fn visuals() -> Vec<Visual> {
    let plate = Visual {
        link: 0,
        pose: Pose { translation_m: [0.0, 0.0, -0.004], ..Pose::IDENTITY },
        shape: Shape::Box { size_m: [0.07, 0.03, 0.006] },
        colour_rgba: [0.45, 0.47, 0.5, 1.0],
    };
    let segment = |link: usize| Visual {
        link,
        pose: Pose { translation_m: [0.0, 0.0, 0.5 * LINK_M], ..Pose::IDENTITY },
        shape: Shape::Cylinder { radius_m: RADIUS_M, length_m: 0.8 * LINK_M },
        colour_rgba: [0.85, 0.87, 0.9, 1.0],
    };
    let tip = Visual {
        link: LINKS,
        pose: Pose { translation_m: [0.0, 0.0, LINK_M], ..Pose::IDENTITY },
        shape: Shape::Sphere { radius_m: 0.6 * RADIUS_M },
        colour_rgba: [0.3, 0.8, 0.5, 1.0],
    };
    [plate].into_iter().chain((1..=LINKS).map(segment)).chain([tip]).collect()
}

fn muscle(side: f64) -> MuscleGraph {
    MuscleGraph {
        name: if side < 0.0 { "muscle 1".into() } else { "muscle 2".into() },
        outer_diameter_m: 0.004,
        coil_turns: 120.0,
        rest_length_m: MUSCLE_REST_M,
        anchor_m: [side * 0.022, 0.0, MUSCLE_FOOT_M],
        direction: [0.0, 0.0, 1.0],
    }
}

/// Both sides are driven half a period apart; the angle lags behind the plungers.
fn frame(time_s: f64) -> Frame {
    let phase = TAU * time_s / 4.0;
    let grow = (time_s / 4.0).min(1.0);
    let drive = SIDES.map(|side| -side * grow * phase.sin());
    let pressures_kpa = SIDES.map(|side| 850.0 * (side * grow * (phase - 0.15).sin()).max(0.0));
    let elongations_m = pressures_kpa.map(|pressure| 0.03 * pressure / 850.0);
    let angle_rad = 1.3 * FRAC_PI_2 * grow * (phase - 0.5).sin();
    let tensions_n = SIDES.map(|side| (8.5 * side * grow * (phase - 0.35).sin()).max(0.0));
    let link_poses = poses(angle_rad);
    let contacts = if angle_rad > 0.9 { vec![contact(&link_poses)] } else { Vec::new() };
    let events = if (time_s - 6.5).abs() < 1e-9 { vec!["muscle 1: cavitation begins".into()] } else { Vec::new() };
    Frame {
        time_s,
        channels: vec![
            20.0 * drive[0],
            20.0 * drive[1],
            pressures_kpa[0],
            pressures_kpa[1],
            1e3 * elongations_m[0],
            1e3 * elongations_m[1],
            angle_rad.to_degrees(),
            tensions_n[0],
            tensions_n[1],
        ],
        cables: (0..2).map(|n| cable(&link_poses, SIDES[n], elongations_m[n], tensions_n[n])).collect(),
        muscles: (0..2)
            .map(|n| MuscleFrame {
                elongation_m: elongations_m[n],
                pressure_pa: 1e3 * pressures_kpa[n],
                pull_n: tensions_n[n],
            })
            .collect(),
        contacts,
        laws: vec![LawFrame { value: -0.01 * phase.cos(), variable: phase.cos() }],
        joint_positions: vec![angle_rad / LINKS as f64; LINKS],
        events,
        energy_j: vec![("stored".into(), 0.1 * angle_rad * angle_rad), ("dissipated".into(), 0.02 * time_s)],
        link_poses,
    }
}

/// Base, then segments that share the angle evenly, bending in the x-z plane.
fn poses(angle_rad: f64) -> Vec<Pose> {
    let mut translation_m = [0.0; 3];
    let mut poses = vec![Pose::IDENTITY];
    for link in 1..=LINKS {
        let turn = angle_rad * link as f64 / LINKS as f64;
        let (sin, cos) = (0.5 * turn).sin_cos();
        poses.push(Pose { translation_m, rotation_xyzw: [0.0, sin, 0.0, cos] });
        translation_m[0] += LINK_M * turn.sin();
        translation_m[2] += LINK_M * turn.cos();
    }
    poses
}

/// From the muscle's moving end through every segment to the tip.
fn cable(poses: &[Pose], side: f64, elongation_m: f64, tension_n: f64) -> CableFrame {
    let end = [side * 0.022, 0.0, MUSCLE_FOOT_M + MUSCLE_REST_M + elongation_m];
    let guide = [side * 1.2 * RADIUS_M, 0.0, 0.0];
    let along = poses[1..]
        .iter()
        .flat_map(|pose| [0.1, 0.9].map(|share| outward(pose, side * 1.15 * RADIUS_M, share * LINK_M)));
    CableFrame { points_m: [end, guide].into_iter().chain(along).collect(), tension_n }
}

fn outward(pose: &Pose, x: f64, z: f64) -> [f64; 3] {
    let turn = 2.0 * pose.rotation_xyzw[1].atan2(pose.rotation_xyzw[3]);
    let (sin, cos) = turn.sin_cos();
    let [px, py, pz] = pose.translation_m;
    [px + x * cos + z * sin, py, pz - x * sin + z * cos]
}

fn contact(poses: &[Pose]) -> Contact {
    Contact {
        link_a: LINKS,
        link_b: 0,
        point_m: outward(&poses[LINKS], 0.0, 1.25 * LINK_M),
        normal: [1.0, 0.0, 0.0],
        penetration_m: 1e-4,
        force_n: 4.0,
    }
}
