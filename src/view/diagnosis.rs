//! A diagnosis to look at: what was measured, the scene as calibrated and as corrected, run after run.
//!
//! Entities: `calibrated/..` and `corrected/..` (links, cables, muscles, and as `measured` the pose that was recorded),
//! `traces/<column>/..`, `residuals/<column>/..`, `states/run`, `states/calibrated_scene`, `summary`, `events`.

use rerun::{RecordingStream, TextDocument};

use super::blueprint::send_page;
use super::cables::Cables;
use super::comparison::{Comparison, log_comparison};
use super::diagnosis_page::page;
use super::error::ViewError;
use super::layer::Layer;
use super::links::Links;
use super::muscles::Muscles;
use super::options::ViewOptions;
use super::shape;
use super::sink::{Connection, ViewSink};
use super::viewer::{close, flush};
use crate::mechanism::geometry::Pose;
use crate::system::observe::{Frame, SceneGraph, SideBySide};

/// Roots of the two mechanisms.
pub(super) const CALIBRATED: &str = "calibrated";
pub(super) const CORRECTED: &str = "corrected";

/// Runs begin at multiples of this, s, with a pause between them: the time of a run is easily read off.
const ROUND_S: f64 = 10.0;
const PAUSE_S: f64 = 1.0;
/// What is played at first, on both sides of the worst sample, s.
const AROUND_S: f64 = 4.0;
/// Poses are drawn this often, s; lines have every sample.
const POSE_INTERVAL_S: f64 = 0.04;

/// Shows recorded runs beside two simulations of each, one run after the other on one timeline.
///
/// `name` is that of the recording, `summary` (Markdown) stands beside the mechanisms. Returns what to tell the user. A
/// served stream ends with the program; a file is complete when this returns.
///
/// # Errors
/// A sink that cannot be opened, frames that do not fit their scene.
pub fn show_diagnosis(
    sink: &ViewSink,
    name: &str,
    summary: &str,
    runs: &[SideBySide],
    options: &ViewOptions,
) -> Result<String, ViewError> {
    let Connection { stream, announcement, file, .. } = sink.open()?;
    if let Err(error) = log_diagnosis(&stream, name, summary, runs, options) {
        return Err(match &file {
            Some(file) => file.failed(&stream, error),
            None => error,
        });
    }
    close(&stream, file)?;
    Ok(announcement)
}

pub(super) fn log_diagnosis(
    out: &RecordingStream,
    name: &str,
    summary: &str,
    runs: &[SideBySide],
    options: &ViewOptions,
) -> Result<(), ViewError> {
    let Some(first) = runs.first() else { return Err(ViewError::NothingToCompare) };
    runs.iter().try_for_each(check)?;
    out.send_recording_name(name)?;
    let starts_s = starts_s(runs);
    send_page(out, page(first), worst_s(runs, &starts_s))?;
    let text = format!("{summary}\n\n{}", table_of_runs(runs, &starts_s));
    out.log_static("summary", &TextDocument::from_markdown(text))?;
    let mut comparison = Comparison::begin(out, first)?;
    let mut mechanisms = Mechanisms::begin(out, runs, options)?;
    // Names, colours and shapes first: a viewer that is still loading then shows what it has as it should.
    flush(out)?;
    for (run, start_s) in runs.iter().zip(starts_s) {
        let shift_s = start_s - run.calibrated.first().map_or(0.0, |frame| frame.time_s);
        log_comparison(out, &mut comparison, run, shift_s)?;
        mechanisms.log(out, run, shift_s)?;
    }
    Ok(())
}

/// Every frame fits the scene, and the recordings have as many samples.
fn check(run: &SideBySide) -> Result<(), ViewError> {
    shape::check_graph(&run.graph)?;
    for frame in run.calibrated.iter().chain(&run.corrected) {
        shape::check_frame(&run.graph, frame)?;
    }
    let samples = run.calibrated.len();
    let counts = run.measured.iter().map(|m| ("measured samples", m.values.len()));
    let poses = (!run.measured_poses.is_empty()).then_some(("measured poses", run.measured_poses.len()));
    let corrected = std::iter::once(("corrected frames", run.corrected.len()));
    match counts.chain(poses).chain(corrected).find(|(_, found)| *found != samples) {
        Some((what, found)) => Err(ViewError::FrameShape { time_s: 0.0, what, expected: samples, found }),
        None => Ok(()),
    }
}

fn length_s(run: &SideBySide) -> f64 {
    let ends = run.calibrated.first().zip(run.calibrated.last());
    ends.map_or(0.0, |(first, last)| last.time_s - first.time_s)
}

/// Where each run begins on the common timeline.
fn starts_s(runs: &[SideBySide]) -> Vec<f64> {
    let mut next_s = 0.0;
    let start = |run: &SideBySide| {
        let start_s = next_s;
        next_s = ((start_s + length_s(run) + PAUSE_S) / ROUND_S).ceil() * ROUND_S;
        start_s
    };
    runs.iter().map(start).collect()
}

/// Some seconds around the sample where the calibrated scene is furthest off in units of the noise.
fn worst_s(runs: &[SideBySide], starts_s: &[f64]) -> Option<[f64; 2]> {
    let mut worst = (0.0, None);
    for (run, start_s) in runs.iter().zip(starts_s) {
        let first_s = run.calibrated.first().map_or(0.0, |frame| frame.time_s);
        for measured in &run.measured {
            for (frame, value) in run.calibrated.iter().zip(&measured.values) {
                let off = (value - frame.channels[measured.channel]).abs() / measured.noise_sd;
                if off > worst.0 {
                    worst = (off, Some((frame.time_s - first_s + start_s, *start_s, start_s + length_s(run))));
                }
            }
        }
    }
    let (at_s, start_s, end_s) = worst.1?;
    Some([(at_s - AROUND_S).max(start_s), (at_s + AROUND_S).min(end_s)])
}

fn table_of_runs(runs: &[SideBySide], starts_s: &[f64]) -> String {
    let row = |(run, start_s): (&SideBySide, &f64)| {
        let marked = run.windows_s.iter().fold(0.0, |all, (from, to)| all + (to - from));
        format!("| {} | {start_s:.0} s | {:.0} s | {marked:.0} s |", run.run, length_s(run))
    };
    let rows: Vec<String> = runs.iter().zip(starts_s).map(row).collect();
    format!("| run | begins at | lasts | off by more than noise |\n|---|---|---|---|\n{}", rows.join("\n"))
}

/// The two mechanisms with the measured pose in each.
struct Mechanisms {
    sides: [Vec<Box<dyn Layer>>; 2],
    ghosts: [Links; 2],
}

impl Mechanisms {
    fn begin(out: &RecordingStream, runs: &[SideBySide], options: &ViewOptions) -> Result<Self, ViewError> {
        let graph = &runs[0].graph;
        let moves = moving(graph, runs);
        let mut mechanisms = Mechanisms {
            sides: [CALIBRATED, CORRECTED].map(|root| layers(root, graph, options)),
            ghosts: [CALIBRATED, CORRECTED].map(|root| Links::ghost(root, graph, &moves)),
        };
        mechanisms.sides.iter_mut().flatten().try_for_each(|layer| layer.begin(out))?;
        mechanisms.ghosts.iter_mut().try_for_each(|ghost| ghost.begin(out))?;
        Ok(mechanisms)
    }

    fn log(&mut self, out: &RecordingStream, run: &SideBySide, shift_s: f64) -> Result<(), ViewError> {
        let kept = kept(&run.calibrated);
        for (layers, frames) in self.sides.iter_mut().zip([&run.calibrated, &run.corrected]) {
            let frames: Vec<Frame> = kept.iter().map(|&i| later(&frames[i], shift_s)).collect();
            layers.iter_mut().try_for_each(|layer| layer.stretch(out, &frames))?;
        }
        if run.measured_poses.is_empty() {
            return Ok(());
        }
        let posed = |&i: &usize| Frame {
            time_s: run.calibrated[i].time_s + shift_s,
            link_poses: run.measured_poses[i].clone(),
            ..Frame::default()
        };
        let frames: Vec<Frame> = kept.iter().map(posed).collect();
        self.ghosts.iter_mut().try_for_each(|ghost| ghost.stretch(out, &frames))
    }
}

fn layers(root: &'static str, graph: &SceneGraph, options: &ViewOptions) -> Vec<Box<dyn Layer>> {
    vec![
        Box::new(Links::new(root, graph)),
        Box::new(Cables::new(root, graph, options)),
        Box::new(Muscles::new(root, graph, options)),
    ]
}

/// Which links the recordings move.
fn moving(graph: &SceneGraph, runs: &[SideBySide]) -> Vec<bool> {
    let differs = |a: &Pose, b: &Pose| a != b;
    let moves = |link: usize| {
        let mut poses = runs.iter().flat_map(|run| &run.measured_poses).map(|poses| &poses[link]);
        let first = poses.next();
        first.is_some_and(|first| poses.any(|pose| differs(first, pose)))
    };
    (0..graph.links.len()).map(moves).collect()
}

/// Indices of frames far enough apart to be worth a pose.
fn kept(frames: &[Frame]) -> Vec<usize> {
    let mut last_s = f64::NEG_INFINITY;
    let mut keep = |(i, frame): (usize, &Frame)| {
        let is_due = frame.time_s - last_s >= POSE_INTERVAL_S - 1e-9;
        if is_due {
            last_s = frame.time_s;
        }
        is_due.then_some(i)
    };
    frames.iter().enumerate().filter_map(&mut keep).collect()
}

fn later(frame: &Frame, shift_s: f64) -> Frame {
    Frame { time_s: frame.time_s + shift_s, ..frame.clone() }
}
