//! Least squares of a [`Model`] against runs.

use nalgebra::{DMatrix, DVector};

use super::case::{Case, CaseRun};
use super::model::{Model, Probe, Sides, respond, simulate};
use super::noise::Noise;

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

/// Range and scale of one number.
#[derive(Clone, Copy, Debug)]
struct Number {
    min: f64,
    max: f64,
    scale: f64,
    /// Where the prior sits and its weight, one over standard deviations.
    prior: f64,
    prior_weight: f64,
}

/// Steps of the differences, as shares of the numbers' scales: above what kinks of the laws make of a smaller one.
const CALIBRATION_STEP: f64 = 1e-3;
const EFFECT_STEP: f64 = 2e-2;

/// Steps to both sides are alike; away from a bound that is near.
fn probes(numbers: &[Number], x: &[f64], which: std::ops::Range<usize>, sides: Sides) -> Vec<Probe> {
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

/// Normal matrix, gradient and cost.
type Normal = (DMatrix<f64>, DVector<f64>, f64);

impl<'a> Problem<'a> {
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

    /// Normal matrix, gradient and cost at `x`, in scaled numbers.
    fn normal(&self, model: &Model, numbers: &[Number], x: &[f64], sides: Sides) -> Option<Normal> {
        let count = x.len();
        let probes = probes(numbers, x, 0..count, sides);
        let mut matrix = DMatrix::zeros(count, count);
        let mut gradient = DVector::zeros(count);
        let mut cost = 0.0;
        for run in &self.runs {
            let response = respond(self.case, run, model, x, &probes)?;
            let residuals = subtract(self.case, run, &response.values);
            for (c, noise) in self.noise.iter().enumerate() {
                let weight = 1.0 / noise.scale();
                let rows = weighted_rows(self.case, run, c, &residuals[c], &response.slopes, numbers, weight);
                cost += rows.residual.norm_squared();
                gradient += rows.slopes.tr_mul(&rows.residual);
                matrix += rows.slopes.tr_mul(&rows.slopes);
            }
        }
        for (i, (n, x)) in numbers.iter().zip(x).enumerate() {
            let weight = n.prior_weight * n.scale;
            matrix[(i, i)] += weight * weight;
            gradient[i] -= weight * (x - n.prior) * n.prior_weight;
        }
        Some((matrix, gradient, cost + self.prior_cost(numbers, x)))
    }

    /// Fits a model from `start`. `None` when it cannot be simulated there.
    pub fn fit(&self, model: &Model, start: &[f64]) -> Option<Fit> {
        let numbers = self.numbers(model);
        let mut x: Vec<f64> = start.iter().zip(&numbers).map(|(x, n)| x.clamp(n.min, n.max)).collect();
        // Undamped at first: the laws are nearly linear in their numbers, and damping crawls along narrow valleys.
        let mut damping = 1e-10;
        // A model that is far off need not be far off to the last digit.
        let samples = self.samples().max(1) as f64;
        let unit = |cost: f64| (cost / samples).max(1.0);
        let mut sides = Sides::One;
        let (mut matrix, mut gradient, mut cost) = self.normal(model, &numbers, &x, sides)?;
        for _ in 0..ITERATIONS {
            let better = self.improve(model, &numbers, &x, &matrix, &gradient, cost, &mut damping);
            let gain = better.as_ref().map_or(0.0, |(_, next)| cost - next);
            if let Some((next, _)) = better {
                x = next;
            }
            if gain < CLOSE * unit(cost) {
                if sides == Sides::Both && gain < GAIN * unit(cost) {
                    break;
                }
                (sides, damping) = (Sides::Both, 1e-10);
            }
            (matrix, gradient, cost) = self.normal(model, &numbers, &x, sides)?;
        }
        let on_bound = (0..self.case.parameters.len())
            .filter(|&i| (x[i] - numbers[i].min).min(numbers[i].max - x[i]) < 1e-6 * numbers[i].scale)
            .collect();
        let scales = DVector::from_iterator(numbers.len(), numbers.iter().map(|n| n.scale));
        let covariance = inverse(matrix).component_mul(&(&scales * scales.transpose()));
        Some(Fit { model: model.clone(), cost: cost - self.prior_cost(&numbers, &x), covariance, x, on_bound })
    }

    #[allow(clippy::too_many_arguments)]
    fn improve(
        &self,
        model: &Model,
        numbers: &[Number],
        x: &[f64],
        matrix: &DMatrix<f64>,
        gradient: &DVector<f64>,
        cost: f64,
        damping: &mut f64,
    ) -> Option<(Vec<f64>, f64)> {
        for _ in 0..8 {
            let step = bounded_step(matrix, gradient, numbers, x, *damping)?;
            if predicted_gain(matrix, gradient, &step) < GAIN / 3.0 * (cost / self.samples().max(1) as f64).max(1.0) {
                return None;
            }
            let next: Vec<f64> = x
                .iter()
                .zip(numbers)
                .zip(step.iter())
                .map(|((x, n), s)| (x + s * n.scale).clamp(n.min, n.max))
                .collect();
            let there = self.residuals(model, &next).map(|r| self.cost(&r) + self.prior_cost(numbers, &next));
            if let Some(there) = there.filter(|t| *t < cost) {
                *damping = (*damping / 10.0).max(1e-10);
                return Some((next, there));
            }
            *damping *= 100.0;
        }
        None
    }

    /// Fitted derivatives of the residuals to the calibration and the effects, and the residuals, all in units of the
    /// noise, one row per sample (missing ones left out).
    pub fn tangent(&self, model: &Model, x: &[f64]) -> Option<Rows> {
        let numbers = self.numbers(model);
        let probes = probes(&numbers, x, 0..x.len(), Sides::Both);
        let mut parts = Vec::new();
        for run in &self.runs {
            let response = respond(self.case, run, model, x, &probes)?;
            let residuals = subtract(self.case, run, &response.values);
            for (c, noise) in self.noise.iter().enumerate() {
                let weight = 1.0 / noise.scale();
                parts.push(weighted_rows(self.case, run, c, &residuals[c], &response.slopes, &numbers, weight));
            }
        }
        let rows: usize = parts.iter().map(|p| p.residual.len()).sum();
        let mut all = Rows { slopes: DMatrix::zeros(rows, x.len()), residual: DVector::zeros(rows) };
        let mut at = 0;
        for part in parts {
            let n = part.residual.len();
            all.slopes.rows_mut(at, n).copy_from(&part.slopes);
            all.residual.rows_mut(at, n).copy_from(&part.residual);
            at += n;
        }
        Some(all)
    }
}

/// Residuals and derivatives in units of the noise and of each number's scale.
pub(super) struct Rows {
    pub slopes: DMatrix<f64>,
    pub residual: DVector<f64>,
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

fn weighted_rows(
    case: &Case,
    run: &CaseRun,
    channel: usize,
    residual: &[f64],
    slopes: &[Vec<Vec<f64>>],
    numbers: &[Number],
    weight: f64,
) -> Rows {
    let there: Vec<usize> = (0..residual.len()).filter(|&i| run.measured[channel][i].is_finite()).collect();
    let mut rows = Rows {
        slopes: DMatrix::zeros(there.len(), numbers.len()),
        residual: DVector::from_iterator(there.len(), there.iter().map(|&i| residual[i] * weight)),
    };
    for (k, (slope, number)) in slopes.iter().zip(numbers).enumerate() {
        let mut column: Vec<f64> = there.iter().map(|&i| slope[channel][i] * (weight * number.scale)).collect();
        if case.channels[channel].has_free_zero {
            take_mean_off(&mut column);
        }
        rows.slopes.column_mut(k).copy_from_slice(&column);
    }
    rows
}

/// A damped step in scaled numbers; numbers that a bound holds back stay.
fn bounded_step(
    matrix: &DMatrix<f64>,
    gradient: &DVector<f64>,
    numbers: &[Number],
    x: &[f64],
    damping: f64,
) -> Option<DVector<f64>> {
    let mut held = vec![false; x.len()];
    for _ in 0..x.len() + 1 {
        let mut damped = matrix.clone();
        let mut right = gradient.clone();
        let largest = matrix.diagonal().max().max(f64::MIN_POSITIVE);
        for i in 0..x.len() {
            damped[(i, i)] += damping * matrix[(i, i)] + 1e-14 * largest;
            if held[i] {
                damped.row_mut(i).fill(0.0);
                damped.column_mut(i).fill(0.0);
                damped[(i, i)] = 1.0;
                right[i] = 0.0;
            }
        }
        let step = damped.cholesky()?.solve(&right);
        let blocked = (0..x.len()).find(|&i| {
            let n = &numbers[i];
            !held[i] && ((x[i] <= n.min && step[i] < 0.0) || (x[i] >= n.max && step[i] > 0.0))
        });
        match blocked {
            Some(i) => held[i] = true,
            None => return Some(step),
        }
    }
    None
}

fn predicted_gain(matrix: &DMatrix<f64>, gradient: &DVector<f64>, step: &DVector<f64>) -> f64 {
    2.0 * gradient.dot(step) - step.dot(&(matrix * step))
}

/// Inverse of a normal matrix; directions the data do not see get a very large variance.
fn inverse(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let largest = matrix.diagonal().max().max(f64::MIN_POSITIVE);
    let n = matrix.nrows();
    let damped = matrix + DMatrix::identity(n, n) * (1e-13 * largest);
    damped.try_inverse().unwrap_or_else(|| DMatrix::from_element(n, n, f64::INFINITY))
}

impl Problem<'_> {
    /// Number of samples compared.
    pub fn samples(&self) -> usize {
        self.runs.iter().flat_map(|r| &r.measured).flatten().filter(|v| v.is_finite()).count()
    }

    /// Derivatives of the simulated channels to some of the numbers, in units of the noise and of each scale.
    pub fn columns(&self, model: &Model, x: &[f64], wanted: std::ops::Range<usize>) -> Option<DMatrix<f64>> {
        let all = self.numbers(model);
        let probes = probes(&all, x, wanted.clone(), Sides::One);
        let numbers = &all[wanted];
        let mut parts = Vec::new();
        for run in &self.runs {
            let response = respond(self.case, run, model, x, &probes)?;
            let residuals = subtract(self.case, run, &response.values);
            for (c, noise) in self.noise.iter().enumerate() {
                let weight = 1.0 / noise.scale();
                parts.push(weighted_rows(self.case, run, c, &residuals[c], &response.slopes, numbers, weight).slopes);
            }
        }
        let rows = parts.iter().map(DMatrix::nrows).sum();
        let mut all = DMatrix::zeros(rows, numbers.len());
        let mut at = 0;
        for part in parts {
            all.rows_mut(at, part.nrows()).copy_from(&part);
            at += part.nrows();
        }
        Some(all)
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
