//! Fitting the parameters that belong to the recorded rig.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::recording::{RecordingSet, Role, noise_sd};
use crate::scene::{CalibrateSpec, Override, Scene, set_the_same};

use super::levenberg_marquardt::{Bounds, LmOptions, LmResult, minimise};
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
    // Of a few thousand samples 1e-8 of the cost is a hundredth of a standard error: where the search began is not to be seen.
    options: LmOptions { max_iterations: 40, relative_decrease: 1e-8, difference: 1e-5 },
};

/// One fitted parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct FittedParameter {
    pub key: String,
    pub value: f64,
    /// 95 % interval from the Jacobian at the end, as far as residuals are independent; none where the runs do not show the number.
    pub ci95: Option<[f64; 2]>,
    /// The fit ended on a bound of its range.
    pub on_bound: bool,
}

/// What was fitted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FitReport {
    pub parameters: Vec<FittedParameter>,
    pub evaluations: usize,
    /// The search from the scene's own values stopped higher than one from elsewhere in the ranges, which is the answer.
    pub from_elsewhere: bool,
}

impl FitReport {
    /// The fitted values as changes of the scene.
    pub fn overrides(&self) -> Vec<Override> {
        self.parameters.iter().map(|p| Override::number(&p.key, p.value)).collect()
    }
}

/// Fits the scene's parameters marked `belongs_to_rig` to the runs; those in `overrides` stay as given.
///
/// Residuals are weighted by the noise, stated or estimated from the recordings.
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
    let search = |start: &[f64]| {
        let coarse = minimise(&|x| residuals(x, COARSE), start, &bounds, COARSE.options);
        // Steps that long may be too long for a scene: then the search starts where it would have without them.
        let near = coarse.as_ref().map_or(start, |found| &found.parameters);
        let mut fine = minimise(&|x| residuals(x, FINE), near, &bounds, FINE.options)?;
        fine.evaluations += coarse.map_or(0, |found| found.evaluations);
        Some(fine)
    };
    let first = search(&start).ok_or_else(|| IdentifyError::Mismatch {
        file: base.path.display().to_string(),
        message: "the scene cannot be simulated with its starting values".to_owned(),
        remedy: "run it alone with `smam run` to see why".to_owned(),
    })?;
    let samples = residuals(&first.parameters, FINE).map_or(1, |r| r.len());
    let (result, from_elsewhere) = lowest(first, samples, &bounds, &search);
    let intervals = intervals(&|x| residuals(x, FINE), &result.parameters, &bounds);
    let parameters = free.iter().zip(&result.parameters).zip(intervals).map(|((c, &value), ci95)| FittedParameter {
        key: c.key.clone(),
        value,
        ci95,
        on_bound: (value - c.min).min(c.max - value) < 1e-6 * (c.max - c.min),
    });
    Ok(FitReport { parameters: parameters.collect(), evaluations: result.evaluations, from_elsewhere })
}

/// Mean square, in units of the noise, from which a fit is tried from elsewhere as well: where sticking and slipping change places with a
/// number, its cost has valleys.
const MISFIT: f64 = 1.5;
/// Where in the ranges those begin, and the share by which their cost must be lower.
const ELSEWHERE: [f64; 2] = [0.25, 0.75];
const LOWER: f64 = 0.99;

/// The lowest of a search and, where it leaves more than noise, of those from elsewhere; whether it is one of these.
fn lowest(
    mut first: LmResult,
    samples: usize,
    bounds: &[Bounds],
    search: &dyn Fn(&[f64]) -> Option<LmResult>,
) -> (LmResult, bool) {
    let own = first.cost;
    if own < MISFIT * samples as f64 {
        return (first, false);
    }
    for share in ELSEWHERE {
        let start: Vec<f64> = bounds.iter().map(|b| b.min + share * (b.max - b.min)).collect();
        let Some(other) = search(&start) else { continue };
        let evaluations = first.evaluations + other.evaluations;
        if other.cost < LOWER * first.cost {
            first = other;
        }
        first.evaluations = evaluations;
    }
    let is_other = first.cost < own;
    (first, is_other)
}

/// Step of the differences behind intervals, as a share of the range: wide enough to see past where sticking begins.
const WIDE: f64 = 1e-3;

/// Added to each diagonal element of the normal matrix, per range squared: a number that no run shows must not hide the others. Its own
/// interval is then a thousand ranges wide.
const UNSHOWN: f64 = 1e-6;

/// 95 % intervals at a fit; residuals in units of the noise, in those of what is left where that is more.
fn intervals(
    residuals: &dyn Fn(&[f64]) -> Option<DVector<f64>>,
    x: &[f64],
    bounds: &[Bounds],
) -> Vec<Option<[f64; 2]>> {
    let covariance = || {
        let here = residuals(x)?;
        let mut jacobian = DMatrix::zeros(here.len(), x.len());
        for (i, b) in bounds.iter().enumerate() {
            let [mut low, mut high] = [x.to_vec(), x.to_vec()];
            low[i] = (x[i] - WIDE * (b.max - b.min)).max(b.min);
            high[i] = (x[i] + WIDE * (b.max - b.min)).min(b.max);
            jacobian.set_column(i, &((residuals(&high)? - residuals(&low)?) * ((b.max - b.min) / (high[i] - low[i]))));
        }
        let unit = (here.norm_squared() / here.len().max(1) as f64).max(1.0);
        let normal = jacobian.tr_mul(&jacobian) + DMatrix::identity(x.len(), x.len()) * UNSHOWN;
        Some(normal.try_inverse()? * unit)
    };
    let Some(covariance) = covariance() else { return vec![None; x.len()] };
    let half = |i: usize| 1.96 * covariance[(i, i)].max(0.0).sqrt() * (bounds[i].max - bounds[i].min);
    let interval = |i: usize| {
        let (half, b) = (half(i), bounds[i]);
        (half < b.max - b.min).then(|| [(x[i] - half).max(b.min), (x[i] + half).min(b.max)])
    };
    (0..x.len()).map(interval).collect()
}

/// The value in the scene, else the middle of the range.
fn start_value(scene: &Scene, spec: &CalibrateSpec) -> f64 {
    scene.number(&spec.key).unwrap_or((spec.min + spec.max) / 2.0)
}

/// One over the scale of each output's residual.
fn weights(set: &RecordingSet, runs: &[RecordedRun]) -> Vec<f64> {
    let scale = set.of_role(Role::Output).map(|spec| spec.noise_sd.unwrap_or_else(|| scale(&spec.column, runs)));
    scale.map(|s| 1.0 / s).collect()
}

/// Share of a channel's range below which no residual counts as small: no scene is that exact, whatever the sensor.
const LEAST_SHARE: f64 = 1e-3;

/// Noise of a channel whose noise is not stated: that of its noisiest run.
fn scale(column: &str, runs: &[RecordedRun]) -> f64 {
    let own = || runs.iter().filter_map(|run| Some((run.recording.time_s(), run.recording.find(column)?)));
    let noise = own().filter_map(|(time_s, channel)| noise_sd(time_s, &channel.values)).fold(0.0, f64::max);
    let values = own().flat_map(|(_, channel)| channel.values.iter().copied()).filter(|v| v.is_finite());
    let (low, high) = values.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    // A channel that never moves is weighed by its level.
    let span = if high > low { high - low } else { high.abs() };
    let least = if span.is_finite() { LEAST_SHARE * span } else { 0.0 };
    Some(noise.max(least)).filter(|scale| *scale > 0.0).unwrap_or(1.0)
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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::recording::{Channel, Recording, Run};
    use crate::system::{Schedule, Simulation, record};

    const LAW: &str =
        "law.drag={port=\"muscle.damping\", adds=\"force_n*tanh(speed_m_s/2e-3)\", parameter={force_n={value=0.3}}}";
    const FREE: &str = "calibrate=[{key=\"law.drag.force_n\", min=0.0, max=1.0, belongs_to_rig=true}]";

    fn changes(more: &str) -> Vec<Override> {
        [LAW, FREE, more].map(|text| Override::parse(text).expect("written rightly")).to_vec()
    }

    /// Ten seconds of the bench with a drag of 0.12 N, with noise of its own in two channels.
    fn recorded() -> RecordedRun {
        let scene = Scene::load("muscle_bench", &changes("law.drag.force_n=0.12")).expect("loads");
        let schedule = Schedule::even(10.0, 0.02);
        let clean = record(&mut Simulation::new(scene).expect("builds"), &schedule).expect("runs");
        let mut state = 7_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let noisy = clean.channels().iter().filter(|c| c.column != "force_n").map(|c| {
            let size = match c.column.as_str() {
                "plunger_mm" => 0.0,
                "pressure_kpa" => 20.0,
                _ => 0.2,
            };
            Channel::new(c.column.clone(), c.values.iter().map(|v| v + size * uniform()).collect())
        });
        let recording = Recording::new(clean.time_s().to_vec(), noisy.collect()).expect("even times");
        RecordedRun { run: Run { file: "sine.csv".to_owned(), ..Run::default() }, recording }
    }

    #[test]
    fn every_start_leads_to_one_minimum_where_no_noise_is_stated() {
        let text = "format = 1\nscene = \"muscle_bench\"\nrun = [{ file = \"sine.csv\" }]\nchannel = [{ column = \"plunger_mm\", \
                    role = \"input\" }, { column = \"elongation_mm\", role = \"output\" }, { column = \"pressure_kpa\", role = \"output\" }]";
        let set = RecordingSet::parse(text, Path::new("recordings.toml")).expect("a set");
        let run = recorded();
        // A start is what stands in the scene, so it is not given by a change that would hold the number.
        let from = |start: f64| {
            let law = Override::parse(&LAW.replace("value=0.3", &format!("value={start}"))).expect("written rightly");
            let free = Override::parse(FREE).expect("written rightly");
            let found =
                fit_rig_parameters(&set, "muscle_bench", &[law, free], std::slice::from_ref(&run)).expect("fits");
            let [low, high] = found.parameters[0].ci95.expect("the runs show it");
            assert!(low < 0.12 && 0.12 < high && high - low < 0.02, "{low} {high}");
            assert!(!found.from_elsewhere);
            found.parameters[0].value
        };
        let found: Vec<f64> = [0.0, 0.06, 0.3, 1.0].map(from).to_vec();
        let spread = found.iter().fold(0.0_f64, |m, v| m.max((v - found[0]).abs()));
        assert!(spread < 1e-6, "{found:?}");
        assert!((found[0] - 0.12).abs() < 0.005, "{found:?}");
    }

    /// `F = 3 N + (40 N s/m) v + (2.5 kg) a` of an axis shaken at 1.1 Hz from rest to rest, without a pressure, its position rounded to 1 µm.
    #[test]
    fn an_axis_without_a_pressure_shows_its_mass() {
        let text = "format = 1\nscene = \"driven_axis\"\nrun = [{ file = \"sine.csv\" }]\nchannel = [{ column = \"position_mm\", \
                    role = \"input\" }, { column = \"pressure_kpa\", role = \"input\", constant = 0 }, { column = \"force_n\", \
                    role = \"output\", noise_sd = 0.05 }]";
        let set = RecordingSet::parse(text, Path::new("recordings.toml")).expect("a set");
        let omega = std::f64::consts::TAU * 1.1;
        let times_s: Vec<f64> = (0..2000).map(|i| 0.01 * f64::from(i)).collect();
        let position_mm: Vec<f64> = times_s.iter().map(|t| (1e4 * (1.0 - (omega * t).cos())).round() / 1e3).collect();
        let force = |t: &f64| {
            let (sin, cos) = (omega * t).sin_cos();
            3.0 + 40.0 * 0.01 * omega * sin + 2.5 * 0.01 * omega * omega * cos
        };
        let force_n: Vec<f64> = times_s.iter().map(force).collect();
        let still = vec![0.0; times_s.len()];
        let channels = [("position_mm", position_mm), ("pressure_kpa", still), ("force_n", force_n)];
        let channels = channels.map(|(column, values)| Channel::new(column, values)).to_vec();
        let recording = Recording::new(times_s, channels).expect("even times");
        let run = RecordedRun { run: Run { file: "sine.csv".to_owned(), ..Run::default() }, recording };
        let free = [
            "piston_area_m2\", min=0.0, max=0.01",
            "mass_kg\", min=0.0, max=10.0",
            "damping_n_s_m\", min=0.0, max=200.0",
            "offset_n\", min=-10.0, max=10.0",
        ];
        let free = free.map(|own| format!("{{key=\"axis.{own}, belongs_to_rig=true}}")).join(",");
        let free = Override::parse(&format!("calibrate=[{free}]")).expect("written rightly");
        let found = fit_rig_parameters(&set, "driven_axis", &[free], &[run]).expect("fits");
        for (key, truth) in [("axis.mass_kg", 2.5), ("axis.damping_n_s_m", 40.0), ("axis.offset_n", 3.0)] {
            let own = found.parameters.iter().find(|p| p.key == key).expect("calibrated");
            assert!((own.value / truth - 1.0).abs() < 0.01, "{key}: {} of {truth}", own.value);
            assert!(own.ci95.is_some(), "{key}: {own:?}");
        }
        // Without a pressure nothing shows the area, which hides none of the others.
        assert!(found.parameters.iter().any(|p| p.key == "axis.piston_area_m2" && p.ci95.is_none()));
    }

    /// A cost with a valley beside the true one: a search that ends in it begins again elsewhere.
    #[test]
    fn a_fit_leaves_a_valley() {
        let bounds = [Bounds { min: 0.0, max: 1.0 }];
        let residuals =
            |x: &[f64]| Some(DVector::from_element(100, 10.0 * (x[0] - 0.8).abs().min(0.3 + (x[0] - 0.1).abs())));
        let search = |start: &[f64]| minimise(&residuals, start, &bounds, LmOptions::default());
        let first = search(&[0.15]).expect("it can be evaluated");
        assert!((first.parameters[0] - 0.1).abs() < 0.05, "{first:?}");
        let (found, is_other) = lowest(first, 100, &bounds, &search);
        assert!(is_other && (found.parameters[0] - 0.8).abs() < 1e-3, "{found:?}");
        let (again, is_other) = lowest(found.clone(), 100, &bounds, &search);
        assert!(!is_other && again == found);
    }
}
