//! Least squares of a [`Model`] against runs.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use super::case::{Case, CaseRun};
use super::model::{Model, Probe, Sides, respond, simulate};
use super::noise::Noise;
use super::normal::{Normal, Number, Rows};

/// A fitted model.
#[derive(Clone, Debug)]
pub struct Fit {
    pub model: Model,
    /// Calibration, then the fitted numbers of the effects.
    pub x: Vec<f64>,
    /// Sum of squared residuals in units of the noise, colour allowed for.
    pub cost: f64,
    /// Inverse of the normal matrix: covariance of `x`.
    pub covariance: DMatrix<f64>,
    /// Calibrated parameters that ended on a bound.
    pub on_bound: Vec<usize>,
}

impl Fit {
    /// Half width of the 95 % interval of a number.
    pub fn half_width(&self, number: usize) -> f64 {
        1.96 * self.covariance[(number, number)].max(0.0).sqrt()
    }
}

/// Steps of the differences, as shares of the numbers' scales: above what kinks of the laws make of a smaller one.
const CALIBRATION_STEP: f64 = 1e-3;
const EFFECT_STEP: f64 = 2e-2;

/// Steps to both sides are alike; away from a bound that is near.
fn probes(numbers: &[Number], x: &[f64], which: Range<usize>, sides: Sides) -> Vec<Probe> {
    which
        .map(|number| {
            let n = &numbers[number];
            let share = if n.prior_weight > 0.0 { CALIBRATION_STEP } else { EFFECT_STEP };
            // A number grown far beyond its scale is probed in proportion.
            let size = (share * n.scale).max(1e-3 * x[number].abs());
            let has_room = x[number] - size >= n.min && x[number] + size <= n.max;
            let step = if x[number] + size > n.max { -size } else { size };
            Probe { number, step, sides: if has_room { sides } else { Sides::One } }
        })
        .collect()
}

/// The part of the data that is fitted, with its weights.
pub(super) struct Problem<'a> {
    pub case: &'a Case,
    pub runs: Vec<&'a CaseRun>,
    pub noise: &'a [Noise],
}

/// Stop when an iteration promises less than this many units of chi².
const GAIN: f64 = 0.5;
/// From here on derivatives are taken to both sides.
const CLOSE: f64 = 200.0;
const ITERATIONS: usize = 20;
/// The first steps are undamped: the laws are nearly linear in their numbers, and damping crawls along narrow valleys.
const LEAST_DAMPING: f64 = 1e-10;

impl Problem<'_> {
    fn numbers(&self, model: &Model) -> Vec<Number> {
        let mut numbers: Vec<Number> = self
            .case
            .parameters
            .iter()
            .map(|p| {
                let half = (p.max - p.min) / 2.0;
                Number { min: p.min, max: p.max, scale: half, prior: p.start, prior_weight: 1.0 / (2.0 * half) }
            })
            .collect();
        for (effect, index) in model.places() {
            let p = &model.effects[effect].spec().parameters[index];
            let scale = p.typical.abs().max(1e-3 * p.range.max.abs().min(1.0));
            numbers.push(Number { min: p.range.min, max: p.range.max, scale, prior: 0.0, prior_weight: 0.0 });
        }
        numbers
    }

    /// Where a fit of a model starts: calibration as in `near` (or the scene), effects at their numbers.
    pub fn start(&self, model: &Model, near: Option<&[f64]>) -> Vec<f64> {
        let n = self.case.parameters.len();
        let mut x: Vec<f64> = match near {
            Some(near) => near[..n].to_vec(),
            None => self.case.parameters.iter().map(|p| p.start).collect(),
        };
        x.extend(model.places().into_iter().map(|(effect, index)| model.values[effect][index]));
        x
    }

    /// Residuals measured minus simulated by run, channel and time, in the channels' units.
    pub fn residuals(&self, model: &Model, x: &[f64]) -> Option<Vec<Vec<Vec<f64>>>> {
        let one = |run: &&CaseRun| {
            let simulated = simulate(self.case, run, model, x)?;
            Some(subtract(self.case, run, &simulated))
        };
        self.runs.iter().map(one).collect()
    }

    /// Sum of squares of residuals in units of the noise.
    pub fn cost(&self, residuals: &[Vec<Vec<f64>>]) -> f64 {
        let mut cost = 0.0;
        for run in residuals {
            for (channel, noise) in run.iter().zip(self.noise) {
                let weight = noise.scale().powi(-2);
                cost += channel.iter().filter(|r| r.is_finite()).map(|r| r * r * weight).sum::<f64>();
            }
        }
        cost
    }

    fn prior_cost(&self, numbers: &[Number], x: &[f64]) -> f64 {
        numbers.iter().zip(x).map(|(n, x)| ((x - n.prior) * n.prior_weight).powi(2)).sum()
    }

    /// The normal equations at `x`, in scaled numbers.
    fn normal(&self, model: &Model, numbers: &[Number], x: &[f64], sides: Sides) -> Option<Normal> {
        let mut normal = Normal::empty(x.len());
        self.each_part(model, numbers, x, 0..x.len(), sides, |rows| normal.add(&rows))?;
        for (i, (n, x)) in numbers.iter().zip(x).enumerate() {
            let weight = n.prior_weight * n.scale;
            normal.matrix[(i, i)] += weight * weight;
            normal.gradient[i] -= weight * (x - n.prior) * n.prior_weight;
        }
        normal.cost += self.prior_cost(numbers, x);
        Some(normal)
    }

    /// Calls `take` with the rows of each run and channel: residuals, and their derivatives to the numbers `wanted`.
    fn each_part(
        &self,
        model: &Model,
        numbers: &[Number],
        x: &[f64],
        wanted: Range<usize>,
        sides: Sides,
        mut take: impl FnMut(Rows),
    ) -> Option<()> {
        let probes = probes(numbers, x, wanted.clone(), sides);
        for run in &self.runs {
            let response = respond(self.case, run, model, x, &probes)?;
            let residuals = subtract(self.case, run, &response.values);
            for c in 0..self.case.channels.len() {
                take(self.weighted_rows(run, c, &residuals[c], &response.slopes, &numbers[wanted.clone()]));
            }
        }
        Some(())
    }

    /// Residuals at `x` and their derivatives to the numbers `wanted`, one row per sample that is there.
    pub fn rows(&self, model: &Model, x: &[f64], wanted: Range<usize>, sides: Sides) -> Option<Rows> {
        let mut parts = Vec::new();
        self.each_part(model, &self.numbers(model), x, wanted, sides, |rows| parts.push(rows))?;
        Rows::stack(&parts)
    }

    fn weighted_rows(
        &self,
        run: &CaseRun,
        channel: usize,
        residual: &[f64],
        slopes: &[Vec<Vec<f64>>],
        numbers: &[Number],
    ) -> Rows {
        let weight = 1.0 / self.noise[channel].scale();
        let there: Vec<usize> = (0..residual.len()).filter(|&i| run.measured[channel][i].is_finite()).collect();
        let mut rows = Rows {
            slopes: DMatrix::zeros(there.len(), numbers.len()),
            residual: DVector::from_iterator(there.len(), there.iter().map(|&i| residual[i] * weight)),
        };
        for (k, (slope, number)) in slopes.iter().zip(numbers).enumerate() {
            let mut column: Vec<f64> = there.iter().map(|&i| slope[channel][i] * (weight * number.scale)).collect();
            if self.case.channels[channel].has_free_zero {
                take_mean_off(&mut column);
            }
            rows.slopes.column_mut(k).copy_from_slice(&column);
        }
        rows
    }

    /// Fits a model from `start`. `None` when it cannot be simulated there.
    pub fn fit(&self, model: &Model, start: &[f64]) -> Option<Fit> {
        let numbers = self.numbers(model);
        let mut x: Vec<f64> = start.iter().zip(&numbers).map(|(x, n)| x.clamp(n.min, n.max)).collect();
        let mut damping = LEAST_DAMPING;
        let mut sides = Sides::One;
        let mut here = self.normal(model, &numbers, &x, sides)?;
        for _ in 0..ITERATIONS {
            // A model that is far off need not be far off to the last digit.
            let unit = (here.cost / self.samples().max(1) as f64).max(1.0);
            let better = self.improve(model, &numbers, &x, &here, GAIN * unit, &mut damping);
            let gain = better.as_ref().map_or(0.0, |(_, cost)| here.cost - cost);
            if let Some((next, _)) = better {
                x = next;
            }
            if gain < CLOSE * unit {
                if sides == Sides::Both && gain < GAIN * unit {
                    break;
                }
                (sides, damping) = (Sides::Both, LEAST_DAMPING);
            }
            here = self.normal(model, &numbers, &x, sides)?;
        }
        let on_bound = (0..self.case.parameters.len())
            .filter(|&i| (x[i] - numbers[i].min).min(numbers[i].max - x[i]) < 1e-6 * numbers[i].scale)
            .collect();
        let scales = DVector::from_iterator(numbers.len(), numbers.iter().map(|n| n.scale));
        let cost = here.cost - self.prior_cost(&numbers, &x);
        let covariance = here.covariance().component_mul(&(&scales * scales.transpose()));
        Some(Fit { model: model.clone(), cost, covariance, x, on_bound })
    }

    /// A point of lower cost, with it; none when less than a third of `gain` can be had.
    fn improve(
        &self,
        model: &Model,
        numbers: &[Number],
        x: &[f64],
        here: &Normal,
        gain: f64,
        damping: &mut f64,
    ) -> Option<(Vec<f64>, f64)> {
        for _ in 0..8 {
            let step = here.bounded_step(numbers, x, *damping)?;
            if here.promised_gain(&step) < gain / 3.0 {
                return None;
            }
            let moved = x.iter().zip(numbers).zip(step.iter());
            let next: Vec<f64> = moved.map(|((x, n), s)| (x + s * n.scale).clamp(n.min, n.max)).collect();
            let there = self.residuals(model, &next).map(|r| self.cost(&r) + self.prior_cost(numbers, &next));
            if let Some(there) = there.filter(|t| *t < here.cost) {
                *damping = (*damping / 10.0).max(LEAST_DAMPING);
                return Some((next, there));
            }
            *damping *= 100.0;
        }
        None
    }

    /// Number of samples compared.
    pub fn samples(&self) -> usize {
        self.runs.iter().flat_map(|r| &r.measured).flatten().filter(|v| v.is_finite()).count()
    }

    /// The numbers of a fit without those of one effect.
    pub fn start_without(&self, fit: &Fit, effect: usize) -> Vec<f64> {
        let n = self.case.parameters.len();
        let mut x = fit.x[..n].to_vec();
        let numbers = fit.model.places().into_iter().zip(&fit.x[n..]);
        x.extend(numbers.filter(|((e, _), _)| *e != effect).map(|(_, v)| *v));
        x
    }
}

fn subtract(case: &Case, run: &CaseRun, simulated: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut all: Vec<Vec<f64>> = run
        .measured
        .iter()
        .zip(simulated)
        .map(|(measured, simulated)| measured.iter().zip(simulated).map(|(m, s)| m - s).collect())
        .collect();
    for (channel, residual) in case.channels.iter().zip(&mut all) {
        if channel.has_free_zero {
            take_mean_off(residual);
        }
    }
    all
}

fn take_mean_off(values: &mut [f64]) {
    let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
    let mean = finite.iter().sum::<f64>() / finite.len().max(1) as f64;
    values.iter_mut().for_each(|v| *v -= mean);
}
