//! Compares the reduced-order model with the full scene, in every diagnosis, at the fitted parameters.

use std::collections::BTreeMap;

use crate::parallel;
use crate::recording::PiecewiseLinear;
use crate::system::{InputSource, Schedule, Simulation, record};

use super::scene::corrected_run_scene;
use crate::diagnose::case::{Case, CaseRun, Noise};
use crate::diagnose::diagnosis::FullScene;
use crate::diagnose::error::DiagnoseError;
use crate::diagnose::fit::{Fit, simulate};

/// The models agree up to this difference, in units of the noise.
const AGREES: f64 = 0.5;

/// The full scene's channels of one run, and the deviation of the reduced-order model.
#[derive(Clone, Debug)]
pub struct FullRun {
    pub is_held_out: bool,
    /// By channel, then time.
    pub values: Vec<Vec<f64>>,
    /// Root mean square difference by channel, a free zero allowed for, in units of the noise.
    pub difference_over_noise: Vec<f64>,
}

/// Simulates every run on the full scene with fitted parameters.
///
/// # Errors
/// A scene that the engine cannot play with these parameters.
pub fn play_full(case: &Case, fit: &Fit, noise: &[Noise]) -> Result<Vec<FullRun>, DiagnoseError> {
    parallel::map(&case.runs, |run| play(case, fit, noise, run)).into_iter().collect()
}

/// The greatest difference of each channel over all runs.
pub fn agreement(case: &Case, runs: &[FullRun]) -> FullScene {
    let greatest = |c: usize| runs.iter().map(|r| r.difference_over_noise[c]).fold(0.0, f64::max);
    let difference: BTreeMap<String, f64> =
        case.channels.iter().enumerate().map(|(c, channel)| (channel.column.clone(), greatest(c))).collect();
    FullScene { agrees: difference.values().all(|d| *d <= AGREES), rms_difference_over_noise: difference }
}

fn play(case: &Case, fit: &Fit, noise: &[Noise], run: &CaseRun) -> Result<FullRun, DiagnoseError> {
    let values = play_on_full(case, fit, run)?;
    let fast = simulate(case, run, &fit.model, &fit.x)
        .ok_or_else(|| DiagnoseError::Simulation("the reduced-order model diverges".to_owned()))?;
    let difference = |c: usize| {
        let pairs = values[c].iter().zip(&fast[c]).zip(&run.measured[c]);
        let compared: Vec<f64> = pairs.filter(|(_, m)| m.is_finite()).map(|((a, b), _)| a - b).collect();
        rms(&compared, case.channels[c].has_free_zero) / noise[c].sd
    };
    let difference_over_noise = (0..values.len()).map(difference).collect();
    Ok(FullRun { is_held_out: run.is_held_out, values, difference_over_noise })
}

/// Channels of the full scene in a run with fitted parameters: by channel, then time.
///
/// # Errors
/// A scene that the engine cannot play with these parameters.
pub fn play_on_full(case: &Case, fit: &Fit, run: &CaseRun) -> Result<Vec<Vec<f64>>, DiagnoseError> {
    let mut simulation = full_simulation(case, fit, run)?;
    let shown = record(&mut simulation, &Schedule::at(run.drive.times_s.clone()))?;
    case.channels.iter().map(|c| Ok(shown.channel(&c.column)?.values[run.lead_in..].to_vec())).collect()
}

/// The full scene of a run with the parameters of a fit, driven by what was recorded.
///
/// # Errors
/// Parameters that the scene's own checks refuse.
pub fn full_simulation(case: &Case, fit: &Fit, run: &CaseRun) -> Result<Simulation, DiagnoseError> {
    let scene = corrected_run_scene(case, fit, run)?;
    let columns: Vec<String> = scene.file.input.iter().map(|i| i.channel.clone()).collect();
    let mut simulation = Simulation::new(scene)?;
    for (column, values) in columns.iter().zip(&run.drive.inputs) {
        if let Some(line) = PiecewiseLinear::new(&run.drive.times_s, values) {
            simulation.set_input(column, InputSource::Recorded(line));
        }
    }
    Ok(simulation)
}

fn rms(difference: &[f64], has_free_zero: bool) -> f64 {
    let n = difference.len().max(1) as f64;
    let mean = if has_free_zero { difference.iter().sum::<f64>() / n } else { 0.0 };
    (difference.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / n).sqrt()
}
