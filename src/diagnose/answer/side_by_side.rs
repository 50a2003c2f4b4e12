//! Every recorded run beside the full scene as calibrated and as corrected, for whoever looks at them.

use std::convert::Infallible;
use std::sync::atomic::AtomicBool;

use crate::parallel;
use crate::system::measured_poses;
use crate::system::observe::{Frame, MeasuredChannel, Observer, SceneGraph, SideBySide};
use crate::system::{RunError, Schedule, run as run_simulation};

use super::outcome::Outcome;
use crate::diagnose::case::{Case, CaseRun};
use crate::diagnose::error::DiagnoseError;
use crate::diagnose::fit::Fit;
use crate::diagnose::full::full_simulation;

/// Replays every run twice; empty when the recordings could not be diagnosed.
///
/// # Errors
/// A scene that the engine cannot play with the parameters found.
pub fn side_by_side(outcome: &Outcome) -> Result<Vec<SideBySide>, DiagnoseError> {
    let (Some(baseline), Some(complete)) = (&outcome.baseline, &outcome.complete) else { return Ok(Vec::new()) };
    parallel::map(&outcome.case.runs, |run| replay(outcome, run, [baseline, complete])).into_iter().collect()
}

fn replay(outcome: &Outcome, run: &CaseRun, [baseline, complete]: [&Fit; 2]) -> Result<SideBySide, DiagnoseError> {
    let case = &outcome.case;
    let (graph, calibrated) = frames(case, baseline, run)?;
    let (_, corrected) = frames(case, complete, run)?;
    let recorded: Vec<(&str, &[f64])> =
        case.channels.iter().zip(&run.measured).map(|(c, m)| (c.column.as_str(), m.as_slice())).collect();
    let windows = outcome.diagnosis.location.time_windows_s.iter().filter(|(file, _, _)| *file == run.file);
    let mut shown = SideBySide {
        run: if run.is_held_out { format!("{} (held out)", run.file) } else { run.file.clone() },
        measured_poses: measured_poses(&run.scene, &recorded)?,
        measured: Vec::new(),
        windows_s: windows.map(|(_, from, to)| (*from, *to)).collect(),
        graph,
        calibrated,
        corrected,
    };
    for (c, channel) in case.channels.iter().enumerate() {
        let Some(place) = shown.graph.channels.iter().position(|name| *name == channel.column) else { continue };
        let values = run.measured[c].clone();
        if channel.has_free_zero {
            shown.calibrated.zero_on(place, &values);
            shown.corrected.zero_on(place, &values);
        }
        shown.measured.push(MeasuredChannel { channel: place, values, noise_sd: outcome.noise[c].sd });
    }
    Ok(shown)
}

/// Moves a channel of simulated frames whose zero is arbitrary on to what was measured.
trait ZeroOn {
    fn zero_on(&mut self, channel: usize, measured: &[f64]);
}

impl ZeroOn for Vec<Frame> {
    fn zero_on(&mut self, channel: usize, measured: &[f64]) {
        let pairs = self.iter().zip(measured).filter(|(_, m)| m.is_finite());
        let (sum, count) = pairs.fold((0.0, 0usize), |(sum, n), (f, m)| (sum + m - f.channels[channel], n + 1));
        let shift = sum / count.max(1) as f64;
        self.iter_mut().for_each(|frame| frame.channels[channel] += shift);
    }
}

/// The full scene with the parameters of a fit over one run, from the first recorded sample on.
fn frames(case: &Case, fit: &Fit, run: &CaseRun) -> Result<(SceneGraph, Vec<Frame>), DiagnoseError> {
    let mut simulation = full_simulation(case, fit, run)?;
    let mut keeper = Keeper::default();
    let schedule = Schedule::at(run.drive.times_s.clone());
    match run_simulation(&mut simulation, &schedule, &AtomicBool::new(false), &mut keeper) {
        Ok(_) => {}
        Err(RunError::System(error)) => return Err(error.into()),
        Err(RunError::Observer(never)) => match never {},
    }
    Ok((keeper.graph, keeper.frames.split_off(run.lead_in)))
}

/// Keeps every frame.
#[derive(Default)]
struct Keeper {
    graph: SceneGraph,
    frames: Vec<Frame>,
}

impl Observer for Keeper {
    type Error = Infallible;

    fn begin(&mut self, graph: &SceneGraph) -> Result<(), Infallible> {
        self.graph = graph.clone();
        Ok(())
    }

    fn frame(&mut self, frame: &Frame) -> Result<(), Infallible> {
        self.frames.push(frame.clone());
        Ok(())
    }
}
