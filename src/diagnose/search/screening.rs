//! Screens candidates by their signatures.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::effects::Effect;
use crate::parallel;

use crate::diagnose::case::CaseRun;
use crate::diagnose::fit::{Fit, FitParameter, Probe, Problem, Rows, Sides, Variant, orthogonal, probe, simulate_many};

/// Effects below this chi² per sample are not called missing physics.
const LEAST_SHARE: f64 = 2e-3;
/// Least gain in chi²: about five sigma after looking at forty candidates.
const LEAST_GAIN: f64 = 35.0;

/// Least reduction of chi² for an effect, for this number of samples.
pub fn least_gain(samples: usize) -> f64 {
    LEAST_GAIN.max(LEAST_SHARE * samples as f64)
}

/// A candidate and its predicted gain.
#[derive(Clone, Debug)]
pub struct Screened {
    pub variant: Variant,
    /// Predicted reduction of chi², autocorrelated noise accounted for.
    pub gain: f64,
    /// Size with the predicted gain.
    pub size: f64,
    /// Detection limit: the size that would gain [`least_gain`].
    pub least_size: f64,
    /// Whether the calibration has absorbed the effect: it imitates nearly all of the signature, and the rest points
    /// out of the effect's range. The misfit may still be due to the effect, at a size that only a refit finds.
    pub is_absorbed: bool,
    /// The signature without what the calibration can imitate, of unit length.
    direction: Arc<DVector<f64>>,
}

impl Screened {
    /// The effect at its detection limit; `None` if there is none.
    pub fn just_visible(&self) -> Option<Effect<f64>> {
        let mut values = self.variant.values.clone();
        values[0] = self.signed_least();
        self.is_possible().then(|| self.variant.placed.with(&values))
    }

    /// Whether the detection limit lies in the law's range.
    pub(super) fn is_possible(&self) -> bool {
        let range = self.variant.placed.spec().parameters[0].range;
        self.least_size < range.max.abs().max(range.min.abs())
    }

    /// The detection limit with the sign that the law's range has.
    pub(super) fn signed_least(&self) -> f64 {
        let range = self.variant.placed.spec().parameters[0].range;
        if range.max > 0.0 { self.least_size } else { -self.least_size }
    }

    pub(super) fn typical(&self) -> f64 {
        self.variant.placed.spec().parameters[0].typical.abs()
    }

    /// Typical size over detection limit.
    pub fn typical_over_least(&self) -> f64 {
        self.typical() / self.least_size
    }

    /// Cosine of the angle between two signatures: 1 where no recording of this kind tells the effects apart.
    pub fn likeness(&self, other: &Self) -> f64 {
        if self.direction.len() == other.direction.len() { self.direction.dot(&other.direction).abs() } else { 0.0 }
    }
}

/// Start values of a refit: the predicted size, limited.
pub(super) fn start_values(s: &Screened) -> Vec<f64> {
    let mut values = s.variant.values.clone();
    let p = &s.variant.placed.spec().parameters[0];
    let largest = 30.0 * p.typical.abs();
    let size = s.size.clamp(-largest, largest).clamp(p.range.min, p.range.max);
    values[0] = if size == 0.0 { p.typical } else { size };
    values
}

/// A fit with its Jacobian and the predictions for all variants, best first.
#[derive(Clone)]
pub(super) struct Screening {
    pub from: Fit,
    pub jacobian: DMatrix<f64>,
    pub screened: Vec<Screened>,
}

/// Screens all variants at a fit. `None` when it cannot be simulated there.
pub(super) fn screen(problem: &Problem, from: &Fit, variants: &[Variant]) -> Option<Screening> {
    let known = problem.rows(&from.model, &from.x, 0..from.x.len(), Sides::Both)?;
    let screened = promises(problem, from, &known, variants);
    Some(Screening { from: from.clone(), jacobian: known.jacobian, screened })
}

/// Share below which only rounding is left.
const NOTHING_LEFT: f64 = 1e-9;
/// The calibration may have absorbed an effect if it leaves less than this share of the signature's length.
const ABSORBED: f64 = 0.5;

/// Predictions for all variants, best first.
fn promises(problem: &Problem, fit: &Fit, known: &Rows, variants: &[Variant]) -> Vec<Screened> {
    let fresh: Vec<&Variant> = variants.iter().filter(|v| fit.model.takes(&v.placed)).collect();
    let basis = known.jacobian.clone().qr().q();
    let left = orthogonal(&basis, &known.residual);
    let samples = known.residual.len();
    let signatures = signatures(problem, fit, &fresh.iter().map(|v| (*v, None)).collect::<Vec<_>>());
    let found = fresh.into_par_iter().zip(signatures).filter_map(|(variant, raw)| Some((variant, raw?)));
    let mut screened: Vec<Screened> = found
        .map(|(variant, raw)| {
            let signature = orthogonal(&basis, &raw);
            let length = signature.norm();
            let scale = variant.placed.spec().parameters[0].typical.abs();
            let amplitude = if length > NOTHING_LEFT * raw.norm() { signature.dot(&left) / length } else { 0.0 };
            let range = variant.placed.spec().parameters[0].range;
            let feasible = (amplitude > 0.0 && range.max > 0.0) || (amplitude < 0.0 && range.min < 0.0);
            Screened {
                gain: if feasible { amplitude * amplitude } else { 0.0 },
                size: amplitude / length.max(f64::MIN_POSITIVE) * scale,
                is_absorbed: !feasible && length > NOTHING_LEFT * raw.norm() && length < ABSORBED * raw.norm(),
                least_size: least_gain(samples).sqrt() / length.max(f64::MIN_POSITIVE) * scale,
                direction: Arc::new(signature / length.max(f64::MIN_POSITIVE)),
                variant: variant.clone(),
            }
        })
        .collect();
    screened.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    screened
}

/// A variant, its size as a fit parameter, and the size of the difference.
struct Trial<'a> {
    variant: &'a Variant,
    number: FitParameter,
    probe: Probe,
}

/// Derivatives of the simulated channels with respect to each variant's size at zero, in units of the typical size: one
/// simulation each and one shared by all, because an effect of zero size is absent. Taken over a small size, or over
/// the size given with the variant.
pub(super) fn signatures(
    problem: &Problem,
    fit: &Fit,
    variants: &[(&Variant, Option<f64>)],
) -> Vec<Option<DVector<f64>>> {
    let trials: Vec<Trial> = variants.iter().map(|(variant, size)| Trial::of(problem, fit, variant, *size)).collect();
    let parts: Vec<Vec<Option<DVector<f64>>>> = parallel::map(&problem.runs, |run| in_run(problem, fit, run, &trials));
    let whole = |i: usize| {
        let parts = parts.iter().map(|run| run[i].as_ref()).collect::<Option<Vec<_>>>()?;
        let entries = parts.iter().flat_map(|part| part.iter().copied());
        Some(DVector::from_vec(entries.collect()))
    };
    (0..trials.len()).map(whole).collect()
}

/// The rows of each signature in one run.
fn in_run(problem: &Problem, fit: &Fit, run: &CaseRun, trials: &[Trial]) -> Vec<Option<DVector<f64>>> {
    let case = problem.case;
    let base = fit.model.setting(case, run, &fit.x);
    let tried = trials.iter().map(|trial| {
        let mut setting = base.clone();
        let mut values = trial.variant.values.clone();
        values[0] = trial.probe.step;
        setting.effects.push(trial.variant.placed.with(&values));
        setting
    });
    let settings: Vec<_> = std::iter::once(base.clone()).chain(tried).collect();
    let mut series = simulate_many(case, run, &settings).into_iter();
    let Some(Some(base)) = series.next() else { return vec![None; trials.len()] };
    let column = |(trial, series): (&Trial, Option<Vec<Vec<f64>>>)| {
        let jacobian: Vec<Vec<f64>> = trial.probe.sensitivity(&series?, &base);
        let channels = 0..jacobian.len();
        let weighted = channels.flat_map(|c| problem.weighted_sensitivity(run, c, &jacobian[c], &trial.number));
        Some(DVector::from_vec(weighted.collect()))
    };
    trials.iter().zip(series).map(column).collect()
}

impl<'a> Trial<'a> {
    fn of(problem: &Problem, fit: &Fit, variant: &'a Variant, size: Option<f64>) -> Self {
        let mut values = variant.values.clone();
        values[0] = 0.0;
        let model = fit.model.plus_size(&variant.placed, &values);
        let parameters = problem.parameters(&model);
        let number = parameters[fit.x.len()];
        let small = probe(&number, 0.0, fit.x.len(), Sides::One);
        Self { variant, number, probe: Probe { step: size.unwrap_or(small.step), ..small } }
    }
}
