//! Least squares of a [`Model`] against runs.

use std::borrow::Cow;
use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::model::{Model, Probe, Sides, respond, simulate};
use super::normal::{FitParameter, Rows};
use crate::diagnose::case::{Case, CaseRun, Noise};
use crate::parallel;

/// A fitted model.
#[derive(Clone, Debug)]
pub struct Fit {
    pub model: Model,
    /// Calibration, then the fitted parameters of the effects.
    pub x: Vec<f64>,
    /// Sum of squared residuals in units of the noise, autocorrelation accounted for.
    pub cost: f64,
    /// Inverse of the normal matrix: covariance of `x`.
    pub covariance: DMatrix<f64>,
    /// Calibrated parameters that ended on a bound.
    pub on_bound: Vec<usize>,
}

impl Fit {
    /// The same with one effect moved to the end.
    pub(crate) fn with_last(&self, effect: usize) -> Self {
        let calibration = self.x.len() - self.model.effect_parameters();
        let places = self.model.places();
        let (own, others): (Vec<usize>, Vec<usize>) =
            (calibration..self.x.len()).partition(|i| places[i - calibration].0 == effect);
        let order: Vec<usize> = (0..calibration).chain(others).chain(own).collect();
        let covariance = &self.covariance;
        Self {
            model: self.model.with_last(effect),
            x: order.iter().map(|&i| self.x[i]).collect(),
            covariance: DMatrix::from_fn(order.len(), order.len(), |i, j| covariance[(order[i], order[j])]),
            ..self.clone()
        }
    }

    /// Half width of the 95 % interval of a number.
    pub fn half_width(&self, number: usize) -> f64 {
        1.96 * self.covariance[(number, number)].max(0.0).sqrt()
    }
}

/// Steps of difference quotients, as shares of the parameters' scales: large against the effect of kinks in the laws.
const CALIBRATION_STEP: f64 = 1e-3;
const EFFECT_STEP: f64 = 2e-2;
/// The same for calibrated parameters if cables go slack. Where a joint then comes to rest depends on how it bounced: a
/// step of a thousandth of a range makes derivatives a hundred times too large and intervals too narrow, a tenth
/// averages it out.
const STEP_ACROSS_SLACK: f64 = 1e-1;

/// Central steps are symmetric; steps lead away from a near bound.
pub(in crate::diagnose) fn probes(
    parameters: &[FitParameter],
    x: &[f64],
    which: Range<usize>,
    sides: Sides,
) -> Vec<Probe> {
    which.map(|number| probe(&parameters[number], x[number], number, sides)).collect()
}

/// Step of the difference quotient of a parameter at `x`.
pub(in crate::diagnose) fn probe(n: &FitParameter, x: f64, number: usize, sides: Sides) -> Probe {
    // A number grown far beyond its scale is probed in proportion.
    let size = (n.step * n.scale).max(1e-3 * x.abs());
    let has_room = x - size >= n.min && x + size <= n.max;
    let step = if x + size > n.max { -size } else { size };
    Probe { number, step, sides: if has_room { sides } else { Sides::One } }
}

/// The part of the data that is fitted, with its weights.
pub(in crate::diagnose) struct Problem<'a> {
    pub case: &'a Case,
    pub runs: Vec<Cow<'a, CaseRun>>,
    pub noise: &'a [Noise],
}

impl Problem<'_> {
    pub fn parameters(&self, model: &Model) -> Vec<FitParameter> {
        let step = if self.case.goes_slack() { STEP_ACROSS_SLACK } else { CALIBRATION_STEP };
        let mut parameters: Vec<FitParameter> = self
            .case
            .parameters
            .iter()
            .map(|p| {
                let half = (p.max - p.min) / 2.0;
                FitParameter {
                    min: p.min,
                    max: p.max,
                    scale: half,
                    step,
                    prior: p.start,
                    prior_weight: 1.0 / (2.0 * half),
                }
            })
            .collect();
        for (effect, index) in model.places() {
            let p = &model.effects[effect].spec().parameters[index];
            let scale = p.typical.abs().max(1e-3 * p.range.max.abs().min(1.0));
            let (min, max) = (p.range.min, p.range.max);
            parameters.push(FitParameter { min, max, scale, step: EFFECT_STEP, prior: 0.0, prior_weight: 0.0 });
        }
        parameters
    }

    /// Start of a fit: calibration as in `near` (or the scene), effects at their start values.
    pub fn start(&self, model: &Model, near: Option<&[f64]>) -> Vec<f64> {
        let n = self.case.parameters.len();
        let mut x: Vec<f64> = match near {
            Some(near) => near[..n].to_vec(),
            None => self.case.parameters.iter().map(|p| p.start).collect(),
        };
        x.extend(model.places().into_iter().map(|(effect, index)| model.numbers[effect].values[index]));
        x
    }

    /// Residuals measured minus simulated by run, channel and time, in the channels' units.
    pub fn residuals(&self, model: &Model, x: &[f64]) -> Option<Vec<Vec<Vec<f64>>>> {
        let one = |run: &Cow<'_, CaseRun>| {
            let simulated = simulate(self.case, run, model, x)?;
            Some(self.subtract(run, &simulated))
        };
        // All runs are simulated even where one diverges: what a diagnosis has cost must not depend on which comes first.
        parallel::map(&self.runs, one).into_iter().collect()
    }

    /// Residuals at `x` and the Jacobian for the parameters `wanted`, one row per existing sample.
    pub fn rows(&self, model: &Model, x: &[f64], wanted: Range<usize>, sides: Sides) -> Option<Rows> {
        let parameters = self.parameters(model);
        let probes = probes(&parameters, x, wanted.clone(), sides);
        let one = |run: &Cow<'_, CaseRun>| -> Option<Vec<Rows>> {
            let response = respond(self.case, run, model, x, &probes)?;
            let residuals = self.subtract(run, &response.values);
            let channels = residuals.iter().enumerate();
            let rows = channels
                .map(|(c, r)| self.weighted_rows(run, c, r, &response.sensitivities, &parameters[wanted.clone()]));
            Some(rows.collect())
        };
        let parts = parallel::map(&self.runs, one).into_iter().collect::<Option<Vec<_>>>()?;
        Rows::stack(&parts.concat())
    }

    /// The same at a fit, with the Jacobian for all parameters from central differences.
    pub fn rows_of(&self, fit: &Fit) -> Option<Rows> {
        self.rows(&fit.model, &fit.x, 0..fit.x.len(), Sides::Both)
    }

    /// Residuals at `x` in units of the noise, in the order of [`Problem::rows`].
    pub fn weighted_residual(&self, model: &Model, x: &[f64]) -> Option<DVector<f64>> {
        Some(self.in_noise(&self.residuals(model, x)?))
    }

    /// Residuals by run, channel and time in units of the noise, where something was measured, in the order of [`Problem::rows`].
    pub fn in_noise(&self, residuals: &[Vec<Vec<f64>>]) -> DVector<f64> {
        let mut all = Vec::with_capacity(self.samples());
        for (run, residuals) in self.runs.iter().zip(residuals) {
            for ((measured, residual), noise) in run.measured.iter().zip(residuals).zip(self.noise) {
                let there = measured.iter().zip(residual).filter(|(m, _)| m.is_finite());
                all.extend(there.map(|(_, r)| r / noise.scale()));
            }
        }
        DVector::from_vec(all)
    }

    fn weighted_rows(
        &self,
        run: &CaseRun,
        channel: usize,
        residual: &[f64],
        sensitivities: &[Vec<Vec<f64>>],
        parameters: &[FitParameter],
    ) -> Rows {
        let weight = 1.0 / self.noise[channel].scale();
        let there = |(measured, residual): (&f64, &f64)| measured.is_finite().then_some(residual * weight);
        let residual: Vec<f64> = run.measured[channel].iter().zip(residual).filter_map(there).collect();
        let mut rows =
            Rows { jacobian: DMatrix::zeros(residual.len(), parameters.len()), residual: DVector::from_vec(residual) };
        for (k, (sensitivity, number)) in sensitivities.iter().zip(parameters).enumerate() {
            let column = self.weighted_sensitivity(run, channel, &sensitivity[channel], number);
            rows.jacobian.column_mut(k).iter_mut().zip(column).for_each(|(to, from)| *to = from);
        }
        rows
    }

    /// Derivative of a channel at its measured samples, in units of the noise and of the parameter's scale.
    pub fn weighted_sensitivity(
        &self,
        run: &CaseRun,
        channel: usize,
        sensitivity: &[f64],
        number: &FitParameter,
    ) -> impl Iterator<Item = f64> {
        let zero = self.zero(run, channel, |i, _| sensitivity[i]);
        self.sensitivity_in_noise(run, channel, sensitivity, number.scale)
            .map(move |(sensitivity, weight)| (sensitivity - zero) * weight)
    }

    /// Change of a channel at its measured samples for a small change of this size, in units of the noise, free zero
    /// ignored.
    pub fn seen(&self, run: &CaseRun, channel: usize, sensitivity: &[f64], size: f64) -> impl Iterator<Item = f64> {
        self.sensitivity_in_noise(run, channel, sensitivity, size).map(|(sensitivity, weight)| sensitivity * weight)
    }

    fn sensitivity_in_noise(
        &self,
        run: &CaseRun,
        channel: usize,
        sensitivity: &[f64],
        size: f64,
    ) -> impl Iterator<Item = (f64, f64)> {
        let weight = 1.0 / self.noise[channel].scale() * size;
        let there = run.measured[channel].iter().zip(sensitivity).filter(|(measured, _)| measured.is_finite());
        there.map(move |(_, sensitivity)| (*sensitivity, weight))
    }

    /// A column for every run and channel whose zero is free there, one in each row of it.
    pub fn free_zeros(&self) -> Vec<DVector<f64>> {
        let mut columns = Vec::new();
        let (samples, mut row) = (self.samples(), 0);
        for run in &self.runs {
            for (measured, channel) in run.measured.iter().zip(&self.case.channels) {
                let count = measured.iter().filter(|m| m.is_finite()).count();
                if channel.has_free_zero && count > 0 {
                    let mut column = DVector::zeros(samples);
                    column.rows_mut(row, count).fill(1.0);
                    columns.push(column);
                }
                row += count;
            }
        }
        columns
    }

    /// Sum of squares of the residuals at `x`, in units of the noise.
    pub fn cost_at(&self, model: &Model, x: &[f64]) -> Option<f64> {
        Some(self.weighted_residual(model, x)?.norm_squared())
    }

    /// Measured minus simulated, each channel with a free zero about its own.
    pub fn subtract(&self, run: &CaseRun, simulated: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let channel = |(c, measured): (usize, &Vec<f64>)| -> Vec<f64> {
            let zero = self.zero(run, c, |i, m| m - simulated[c][i]);
            measured.iter().zip(&simulated[c]).map(|(m, s)| m - s - zero).collect()
        };
        run.measured.iter().enumerate().map(channel).collect()
    }

    /// The zero of a channel: the mean of `value(sample, measured)` if it is free, else 0.
    fn zero(&self, run: &CaseRun, channel: usize, value: impl Fn(usize, f64) -> f64) -> f64 {
        if !self.case.channels[channel].has_free_zero {
            return 0.0;
        }
        let decides = run.open_part.as_ref().unwrap_or(&run.measured)[channel].iter().enumerate();
        let values = decides.filter(|(_, m)| m.is_finite()).map(|(i, m)| value(i, *m));
        let (sum, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
        if count > 0.0 { sum / count } else { 0.0 }
    }

    /// Number of samples compared.
    pub fn samples(&self) -> usize {
        self.runs.iter().flat_map(|r| &r.measured).flatten().filter(|v| v.is_finite()).count()
    }

    /// Sum of squares, in the units of [`Fit::cost`], that noise alone would leave.
    pub fn noise_cost(&self) -> f64 {
        let count = |c: usize| -> usize {
            self.runs.iter().map(|r| r.measured[c].iter().filter(|v| v.is_finite()).count()).sum()
        };
        self.noise.iter().enumerate().map(|(c, noise)| count(c) as f64 / noise.inflation()).sum()
    }

    /// The parameters of a fit without those of one effect.
    pub fn start_without(&self, fit: &Fit, effect: usize) -> Vec<f64> {
        let n = self.case.parameters.len();
        let mut x = fit.x[..n].to_vec();
        let parameters = fit.model.places().into_iter().zip(&fit.x[n..]);
        x.extend(parameters.filter(|((e, _), _)| *e != effect).map(|(_, v)| *v));
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::Placed;
    use crate::effects::{Element, ElementKind, find};

    /// Calibration, two parameters of one effect, one of another.
    #[test]
    fn an_effect_goes_behind_the_others_with_its_numbers() {
        let placed = |id: &str| {
            let entry = find(id).expect("of the catalogue");
            (Placed { entry, element: Element::of(ElementKind::Muscle, 0, 1), channel: None }, entry.typical())
        };
        let [(first, two), (second, one)] = ["viscoelasticity", "coil_preload"].map(placed);
        let model = Model::baseline().plus(&first, &two).plus(&second, &one);
        let n = 1 + model.effect_parameters();
        let own = model.numbers[0].fitted.len();
        let x: Vec<f64> = (0..n).map(|i| i as f64).collect();
        let covariance = DMatrix::from_fn(n, n, |i, j| (10 * i.min(j) + i.max(j)) as f64);
        let fit = Fit { model, x, cost: 1.0, covariance, on_bound: Vec::new() };
        let moved = fit.with_last(0);
        assert_eq!(moved.model.effects, [second, first]);
        assert_eq!(moved.x[..2], [0.0, (1 + own) as f64]);
        assert_eq!(moved.x[2..], fit.x[1..=own]);
        for (i, &from) in moved.x.iter().enumerate() {
            assert_eq!(moved.half_width(i), fit.half_width(from as usize));
        }
        let back = moved.with_last(0);
        assert_eq!((back.model, back.x, back.covariance), (fit.model, fit.x, fit.covariance));
    }
}
