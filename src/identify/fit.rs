//! Fitting the parameters that belong to the recorded rig.

use nalgebra::DVector;
use rayon::prelude::*;

use crate::recording::{RecordingSet, Role};
use crate::scene::{CalibrateSpec, Override, Scene, set_the_same};

use super::levenberg_marquardt::{Bounds, LmOptions, minimise};
use super::replay::{IdentifyError, RecordedRun, check_channels, replay};

/// How finely the runs are replayed while parameters are searched.
#[derive(Clone, Copy)]
struct Grain {
    /// At most this many samples of a run enter.
    samples_per_run: usize,
    /// Engine steps are this much longer than the scene's.
    step_factor: f64,
    options: LmOptions,
}

/// Nearly all of the search: cheap replays, so that a long valley can be followed to its end.
const COARSE: Grain = Grain {
    samples_per_run: 300,
    step_factor: 10.0,
    options: LmOptions { max_iterations: 60, relative_decrease: 1e-5, difference: 1e-5 },
};
/// Finishes at the scene's own steps, so that the answer does not depend on the coarse ones.
const FINE: Grain = Grain {
    samples_per_run: 1500,
    step_factor: 1.0,
    options: LmOptions { max_iterations: 10, relative_decrease: 1e-3, difference: 1e-5 },
};

/// One fitted parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedParameter {
    pub key: String,
    pub value: f64,
    /// The fit ended on a bound of its range.
    pub on_bound: bool,
}

/// What was fitted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitReport {
    pub parameters: Vec<FittedParameter>,
    pub evaluations: usize,
}

impl FitReport {
    /// The fitted values as changes of the scene.
    pub fn overrides(&self) -> Vec<Override> {
        self.parameters.iter().map(|p| Override::number(&p.key, p.value)).collect()
    }
}

/// Fits the scene's parameters marked `belongs_to_rig` to the runs; those in `overrides` stay as given.
///
/// Residuals are weighted by the stated noise, else by a hundredth of the channel's range over all runs.
pub fn fit_rig_parameters(
    set: &RecordingSet,
    scene: &str,
    overrides: &[Override],
    runs: &[RecordedRun],
) -> Result<FitReport, IdentifyError> {
    let base = Scene::load(scene, overrides)?;
    check_channels(set, &base)?;
    let given = |spec: &CalibrateSpec| overrides.iter().any(|o| set_the_same(&base.file.muscle, &o.key, &spec.key));
    let free: Vec<&CalibrateSpec> = base.file.calibrate.iter().filter(|c| c.belongs_to_rig && !given(c)).collect();
    if free.is_empty() || runs.is_empty() {
        return Ok(FitReport::default());
    }
    let weights = weights(set, runs);
    let bounds: Vec<Bounds> = free.iter().map(|c| Bounds { min: c.min, max: c.max }).collect();
    let start: Vec<f64> = free.iter().map(|c| start_value(&base, c)).collect();
    // A first replay, so that what is wrong with a run is said as such and not as a failed fit.
    runs.iter().try_for_each(|run| replay(scene, overrides, run, run.recording.sample_count()).map(|_| ()))?;
    let residuals = |x: &[f64], grain: Grain| {
        let changed = free.iter().zip(x).map(|(c, x)| Override::number(&c.key, *x));
        let step = Override::number("simulation.step_s", base.file.simulation.step_s * grain.step_factor);
        let all: Vec<Override> = overrides.iter().cloned().chain(changed).chain([step]).collect();
        residuals(set, scene, &all, runs, &weights, grain.samples_per_run)
    };
    let search = |start: &[f64], grain: Grain| minimise(&|x| residuals(x, grain), start, &bounds, grain.options);
    let coarse = search(&start, COARSE);
    // Steps that long may be too long for a scene: then the search starts where it would have without them.
    let near = coarse.as_ref().map_or(&start, |found| &found.parameters);
    let result = search(near, FINE).ok_or_else(|| IdentifyError::Mismatch {
        file: base.path.display().to_string(),
        message: "the scene cannot be simulated with its starting values".to_owned(),
        remedy: "run it alone with `smam run` to see why".to_owned(),
    })?;
    let parameters = free.iter().zip(&result.parameters).map(|(c, &value)| FittedParameter {
        key: c.key.clone(),
        value,
        on_bound: (value - c.min).min(c.max - value) < 1e-6 * (c.max - c.min),
    });
    let evaluations = result.evaluations + coarse.map_or(0, |found| found.evaluations);
    Ok(FitReport { parameters: parameters.collect(), evaluations })
}

/// The value in the scene, else the middle of the range.
fn start_value(scene: &Scene, spec: &CalibrateSpec) -> f64 {
    scene.number(&spec.key).unwrap_or((spec.min + spec.max) / 2.0)
}

/// One over the scale of each output's residual.
fn weights(set: &RecordingSet, runs: &[RecordedRun]) -> Vec<f64> {
    let outputs = set.of_role(Role::Output);
    let scale = outputs.map(|spec| {
        let values = runs.iter().filter_map(|r| r.recording.find(&spec.column)).flat_map(|c| c.values.iter().copied());
        let (low, high) = values.filter(|v| v.is_finite()).fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
        // A channel that never moves is weighed by its level.
        let span = if high > low { high - low } else { high.abs() };
        spec.noise_sd.unwrap_or(if span > 0.0 && span.is_finite() { span / 100.0 } else { 1.0 })
    });
    scale.map(|s| 1.0 / s).collect()
}

fn residuals(
    set: &RecordingSet,
    scene: &str,
    overrides: &[Override],
    runs: &[RecordedRun],
    weights: &[f64],
    samples_per_run: usize,
) -> Option<DVector<f64>> {
    let per_run: Option<Vec<Vec<f64>>> = runs
        .par_iter()
        .map(|run| {
            let every = run.recording.sample_count().div_ceil(samples_per_run);
            let simulated = replay(scene, overrides, run, every).ok()?;
            let mut all = Vec::new();
            for (spec, weight) in set.of_role(Role::Output).zip(weights) {
                let measured = run.recording.find(&spec.column)?.values.iter().step_by(every);
                let is = &simulated.find(&spec.column)?.values;
                all.extend(measured.zip(is).filter(|(m, _)| m.is_finite()).map(|(m, s)| (s - m) * weight));
            }
            Some(all)
        })
        .collect();
    per_run.map(|runs| DVector::from_vec(runs.concat()))
}
