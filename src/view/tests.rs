//! Contract: what goes in comes out of the stream, value by value, whatever the stretches were.

use rerun::components::{Position2D, Scalar, Translation3D};
use rerun::log::{Chunk, LogMsg};
use rerun::sink::MemorySinkStorage;
use rerun::{ComponentIdentifier, RecordingStreamBuilder};

use super::diagnosis::log_diagnosis;
use super::error::ViewError;
use super::options::{Pace, ViewOptions};
use super::sink::Connection;
use super::viewer::Viewer;
use crate::mechanism::geometry::{Contact, Pose, Shape, Visual};
use crate::system::observe::{
    CableFrame, Frame, JointGraph, LawFrame, LawGraph, MeasuredChannel, MuscleFrame, MuscleGraph, Observer, SceneGraph,
    SideBySide,
};

const FRAMES: usize = 250;

#[test]
fn every_channel_value_comes_back_in_order() {
    let chunks = run(7);
    let values = component::<Scalar>(&chunks, "/plots/pressure_kpa/pressure_1_kpa", "Scalars:scalars");
    let wanted: Vec<f64> = (0..FRAMES).map(|n| frame(n).channels[0]).collect();
    assert_eq!(values.iter().map(|value| value.0.0).collect::<Vec<_>>(), wanted);
}

#[test]
fn each_frame_has_its_time() {
    let chunks = run(1000);
    let at = of(&chunks, "/joints/01").flat_map(|chunk| {
        let times = chunk.timelines().values().flat_map(|column| column.times_raw().to_vec());
        times.collect::<Vec<_>>()
    });
    let wanted: Vec<i64> = (0..FRAMES as i64).map(|n| n * 10_000_000).collect();
    assert_eq!(at.collect::<Vec<_>>(), wanted);
}

#[test]
fn poses_keep_their_order_and_count() {
    let chunks = run(64);
    let name = "Transform3D:translation";
    let moved = component::<Translation3D>(&chunks, "/world/links/tip link", name);
    assert_eq!(moved.len(), FRAMES);
    assert_eq!(moved[100].0.x(), frame(100).link_poses[0].translation_m[0] as f32);
}

#[test]
fn events_and_contacts_appear_only_when_they_happen() {
    let chunks = run(64);
    assert_eq!(rows(&chunks, "/events"), 1);
    // Ten frames in touch and one empty row that ends them.
    assert_eq!(rows(&chunks, "/world/contacts/points"), 11);
}

#[test]
fn the_loop_is_drawn_with_axes_that_name_their_units() {
    let chunks = run(64);
    let texts = component::<rerun::Text>(&chunks, "/loops/1/labels", "Points2D:labels");
    let texts: Vec<&str> = texts.iter().map(|text| text.as_str()).collect();
    assert!(texts.contains(&"pressure 1 (kPa)") && texts.contains(&"bending angle (°)"), "{texts:?}");
}

#[test]
fn a_law_is_drawn_over_time_and_over_its_variable() {
    let chunks = run(64);
    let values = component::<Scalar>(&chunks, "/laws/stiffer", "Scalars:scalars");
    assert_eq!(
        values.iter().map(|v| v.0.0).collect::<Vec<_>>(),
        (0..FRAMES).map(|n| frame(n).laws[0].value).collect::<Vec<_>>()
    );
    let texts = component::<rerun::Text>(&chunks, "/law_curves/stiffer/labels", "Points2D:labels");
    let texts: Vec<&str> = texts.iter().map(|text| text.as_str()).collect();
    assert!(texts.contains(&"elongation (m)") && texts.contains(&"stiffer"), "{texts:?}");
    let dots = component::<Position2D>(&chunks, "/law_curves/stiffer/data/curve", "Points2D:positions");
    assert_eq!(dots.len(), FRAMES);
}

#[test]
fn frames_that_do_not_fit_the_scene_are_refused_with_their_time() {
    let (mut viewer, _storage) = viewer(8);
    viewer.begin(&graph()).unwrap();
    let mut wrong = frame(3);
    wrong.channels.pop();
    let error = viewer.frame(&wrong).unwrap_err().to_string();
    assert!(error.starts_with("frame at 0.03 s has 1 channels, the scene has 2"), "{error}");
}

#[test]
fn a_frame_before_the_scene_is_refused() {
    let (mut viewer, _storage) = viewer(8);
    assert!(matches!(viewer.frame(&frame(0)), Err(ViewError::NotBegun)));
}

#[test]
fn a_graph_that_points_nowhere_is_refused() {
    let (mut viewer, _storage) = viewer(8);
    let graph = SceneGraph { loops: vec![(0, 9)], ..graph() };
    assert!(matches!(viewer.begin(&graph), Err(ViewError::BadIndex { index: 9, .. })));
}

#[test]
fn dropping_an_unfinished_run_still_sends_it() {
    let (mut viewer, storage) = viewer(1000);
    viewer.begin(&graph()).unwrap();
    viewer.frame(&frame(0)).unwrap();
    drop(viewer);
    assert_eq!(rows(&chunks(&storage), "/joints/01"), 1);
}

#[test]
fn an_empty_scene_can_be_shown() {
    let (mut viewer, _storage) = viewer(8);
    viewer.begin(&SceneGraph::default()).unwrap();
    viewer.frame(&Frame::default()).unwrap();
    assert_eq!(viewer.finish().unwrap().frames, 1);
}

#[test]
fn runs_of_a_diagnosis_follow_each_other_from_full_tens_of_seconds() {
    let (stream, storage) = RecordingStreamBuilder::new("smam").enabled(true).memory().unwrap();
    let frames: Vec<Frame> = (0..FRAMES).map(frame).collect();
    let run = SideBySide {
        run: "sine.csv".into(),
        graph: graph(),
        measured: vec![MeasuredChannel { channel: 1, values: vec![5.0; FRAMES], noise_sd: 0.1 }],
        measured_poses: frames.iter().map(|frame| frame.link_poses.clone()).collect(),
        calibrated: frames.clone(),
        corrected: frames,
        windows_s: vec![(0.5, 1.0)],
    };
    log_diagnosis(&stream, "diagnosis", "verdict", &[run.clone(), run], &ViewOptions::default()).unwrap();
    stream.flush_blocking().unwrap();
    let chunks = chunks(&storage);
    // A missing value after each run keeps its line apart from the next.
    let measured = component::<Scalar>(&chunks, "/traces/bending_angle_deg/as_measured", "Scalars:scalars");
    assert_eq!(measured.len(), 2 * (FRAMES + 1));
    assert!(measured[FRAMES].0.0.is_nan());
    let at =
        of(&chunks, "/residuals/bending_angle_deg/corrected").filter(|chunk| !chunk.is_static()).flat_map(|chunk| {
            chunk.timelines().values().flat_map(|column| column.times_raw().to_vec()).collect::<Vec<_>>()
        });
    assert_eq!(at.collect::<Vec<_>>()[FRAMES + 1], 10_000_000_000);
    // Poses come every 0.04 s, in both mechanisms and as measured.
    for entity in ["/calibrated/links/tip link", "/corrected/links/tip link", "/calibrated/measured/tip link"] {
        assert_eq!(rows(&chunks, entity), 2 * FRAMES.div_ceil(4), "{entity}");
    }
    assert_eq!(rows(&chunks, "/states/run"), 4);
    assert_eq!(rows(&chunks, "/events"), 4);
}

/// All chunks of a synthetic run sent in stretches of a length.
fn run(stretch: usize) -> Vec<Chunk> {
    let (mut viewer, storage) = viewer(stretch);
    viewer.begin(&graph()).unwrap();
    (0..FRAMES).for_each(|n| viewer.frame(&frame(n)).unwrap());
    assert_eq!(viewer.finish().unwrap().frames, FRAMES);
    chunks(&storage)
}

fn viewer(stretch: usize) -> (Viewer, MemorySinkStorage) {
    let (stream, storage) = RecordingStreamBuilder::new("smam").enabled(true).memory().unwrap();
    let connection = Connection { stream, announcement: String::new(), pace: Pace::Frames(stretch), file: None };
    (Viewer::new(connection, ViewOptions::default()), storage)
}

fn chunks(storage: &MemorySinkStorage) -> Vec<Chunk> {
    let messages = storage.take().into_iter();
    let chunk = |message| match message {
        LogMsg::ArrowMsg(store, arrow) if store.is_recording() => Some(Chunk::from_arrow_msg(&arrow).unwrap()),
        _ => None,
    };
    messages.filter_map(chunk).collect()
}

fn of<'a>(chunks: &'a [Chunk], entity: &'a str) -> impl Iterator<Item = &'a Chunk> {
    let same = move |chunk: &&Chunk| *chunk.entity_path() == rerun::EntityPath::from(entity);
    chunks.iter().filter(same)
}

fn rows(chunks: &[Chunk], entity: &str) -> usize {
    of(chunks, entity).filter(|chunk| !chunk.is_static()).map(Chunk::num_rows).sum()
}

fn component<C: rerun::Component>(chunks: &[Chunk], entity: &str, name: &'static str) -> Vec<C> {
    let name = ComponentIdentifier::from(name);
    let lists = of(chunks, entity).flat_map(|chunk| chunk.iter_component::<C>(name));
    lists.flat_map(|list| list.as_slice().to_vec()).collect()
}

fn graph() -> SceneGraph {
    SceneGraph {
        name: "synthetic".into(),
        channels: vec!["pressure_1_kpa".into(), "bending_angle_deg".into()],
        input_count: 1,
        links: vec!["tip link".into()],
        visuals: vec![Visual {
            link: 0,
            pose: Pose::IDENTITY,
            shape: Shape::Sphere { radius_m: 0.01 },
            colour_rgba: [1.0; 4],
        }],
        joints: vec![JointGraph { name: "hinge 1".into(), is_angle: true, link: 0, axis: [0.0, 1.0, 0.0] }],
        cables: vec!["c".into()],
        muscles: vec![MuscleGraph {
            name: "m".into(),
            outer_diameter_m: 0.001,
            coil_turns: 100.0,
            rest_length_m: 0.1,
            anchor_m: [0.0; 3],
            direction: [1.0, 0.0, 0.0],
        }],
        laws: vec![LawGraph {
            name: "stiffer".into(),
            text: "muscle_1.pull adds k_n_m * elongation_m".into(),
            variable: Some("elongation_m".into()),
        }],
        loops: vec![(0, 1)],
        camera_position_m: [0.3, 0.0, 0.0],
        ..SceneGraph::default()
    }
}

fn frame(n: usize) -> Frame {
    let phase = n as f64 * 0.1;
    let contact =
        Contact { link_a: 0, link_b: 0, point_m: [0.0; 3], normal: [0.0, 0.0, 1.0], penetration_m: 0.0, force_n: 1.0 };
    Frame {
        time_s: n as f64 * 0.01,
        channels: vec![100.0 * phase.sin(), 10.0 * (phase - 0.3).sin()],
        link_poses: vec![Pose { translation_m: [phase, 0.0, 0.0], ..Pose::IDENTITY }],
        cables: vec![CableFrame { points_m: vec![[0.0; 3], [phase, 0.0, 0.0]], tension_n: phase }],
        muscles: vec![MuscleFrame::default()],
        laws: vec![LawFrame { value: phase, variable: phase.sin() }],
        contacts: if (100..110).contains(&n) { vec![contact] } else { Vec::new() },
        joint_positions: vec![phase],
        events: if n == 42 { vec!["m: cavitation begins".into()] } else { Vec::new() },
        energy_j: vec![("stored".into(), phase)],
    }
}
