//! Least squares of a [`Model`] against runs.

use std::borrow::Cow;
use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::case::{Case, CaseRun};
use super::model::{Model, Probe, Sides, respond, simulate};
use super::noise::Noise;
use super::normal::{Normal, Number, Rows, prior_cost};

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
    pub runs: Vec<Cow<'a, CaseRun>>,
    pub noise: &'a [Noise],
}

/// Stop when an iteration promises less than this many units of chi².
const GAIN: f64 = 0.5;
/// Steps on mended slopes, and how often slopes are taken anew.
const ITERATIONS: usize = 25;
const REFRESHES: usize = 8;
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
        let one = |run: &Cow<'_, CaseRun>| {
            let simulated = simulate(self.case, run, model, x)?;
            Some(subtract(self.case, run, &simulated))
        };
        self.runs.par_iter().map(one).collect()
    }

    /// Residuals at `x` and the derivatives to the numbers `wanted`, one row per sample that is there.
    pub fn rows(&self, model: &Model, x: &[f64], wanted: Range<usize>, sides: Sides) -> Option<Rows> {
        let numbers = self.numbers(model);
        let probes = probes(&numbers, x, wanted.clone(), sides);
        let one = |run: &Cow<'_, CaseRun>| -> Option<Vec<Rows>> {
            let response = respond(self.case, run, model, x, &probes)?;
            let residuals = subtract(self.case, run, &response.values);
            let channels = residuals.iter().enumerate();
            let rows = channels.map(|(c, r)| self.weighted_rows(run, c, r, &response.slopes, &numbers[wanted.clone()]));
            Some(rows.collect())
        };
        let parts = self.runs.par_iter().map(one).collect::<Option<Vec<_>>>()?;
        Rows::stack(&parts.concat())
    }

    /// Residuals at `x` in units of the noise, in the order of [`Problem::rows`].
    fn weighted_residual(&self, model: &Model, x: &[f64]) -> Option<DVector<f64>> {
        let residuals = self.residuals(model, x)?;
        let mut all = Vec::with_capacity(self.samples());
        for (run, residuals) in self.runs.iter().zip(&residuals) {
            for ((measured, residual), noise) in run.measured.iter().zip(residuals).zip(self.noise) {
                let there = measured.iter().zip(residual).filter(|(m, _)| m.is_finite());
                all.extend(there.map(|(_, r)| r / noise.scale()));
            }
        }
        Some(DVector::from_vec(all))
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
        let x = within(start, &numbers);
        let rows = self.rows(model, &x, 0..x.len(), Sides::One)?;
        let mut descent = Descent { problem: self, model, numbers: &numbers, x, rows, damping: LEAST_DAMPING };
        descent.run();
        for _ in 0..REFRESHES {
            let cost = descent.normal().cost;
            descent.rows = self.rows(model, &descent.x, 0..descent.x.len(), Sides::Both)?;
            descent.damping = LEAST_DAMPING;
            descent.run();
            if cost - descent.normal().cost < GAIN * descent.unit() {
                break;
            }
        }
        Some(descent.finish())
    }

    /// Fits a model from `start` with slopes known from nearby, which are mended on the way: quick, and good enough to
    /// tell which models are worth [`Problem::fit`].
    pub fn fit_roughly(&self, model: &Model, start: &[f64], slopes: DMatrix<f64>) -> Option<Fit> {
        let numbers = self.numbers(model);
        let x = within(start, &numbers);
        let rows = Rows { residual: self.weighted_residual(model, &x)?, slopes };
        let mut descent = Descent { problem: self, model, numbers: &numbers, x, rows, damping: LEAST_DAMPING };
        descent.run();
        Some(descent.finish())
    }

    /// Sum of squares of the residuals at `x`, in units of the noise.
    pub fn cost_at(&self, model: &Model, x: &[f64]) -> Option<f64> {
        Some(self.weighted_residual(model, x)?.norm_squared())
    }

    /// Every run left out once: the others, and it. A single run is cut into its halves.
    pub fn folds<'s>(&'s self) -> Vec<(Problem<'s>, Problem<'s>)> {
        let part = |runs: Vec<Cow<'s, CaseRun>>| Problem { case: self.case, runs, noise: self.noise };
        if let [run] = &self.runs[..] {
            let half = run.times_s().len() / 2;
            let blank = |range: Range<usize>| -> Cow<'_, CaseRun> {
                let mut part = run.clone().into_owned();
                part.measured.iter_mut().for_each(|m| m[range.clone()].fill(f64::NAN));
                Cow::Owned(part)
            };
            let halves = [blank(half..run.times_s().len()), blank(0..half)];
            return vec![
                (part(vec![halves[0].clone()]), part(vec![halves[1].clone()])),
                (part(vec![halves[1].clone()]), part(vec![halves[0].clone()])),
            ];
        }
        let without = |i: usize| {
            let mut rest: Vec<_> = self.runs.iter().map(|r| Cow::Borrowed(r.as_ref())).collect();
            let left_out = rest.remove(i);
            (part(rest), part(vec![left_out]))
        };
        (0..self.runs.len()).map(without).collect()
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

fn within(x: &[f64], numbers: &[Number]) -> Vec<f64> {
    x.iter().zip(numbers).map(|(x, n)| x.clamp(n.min, n.max)).collect()
}

/// A fit on its way.
struct Descent<'a> {
    problem: &'a Problem<'a>,
    model: &'a Model,
    numbers: &'a [Number],
    x: Vec<f64>,
    rows: Rows,
    damping: f64,
}

impl Descent<'_> {
    fn normal(&self) -> Normal {
        Normal::of(&self.rows, self.numbers, &self.x)
    }

    /// Chi² per sample, at least 1: a model that is far off need not be far off to the last digit.
    fn unit(&self) -> f64 {
        (self.rows.residual.norm_squared() / self.rows.residual.len().max(1) as f64).max(1.0)
    }

    /// Steps until the slopes promise no more.
    fn run(&mut self) {
        for _ in 0..ITERATIONS {
            let least = GAIN * self.unit();
            if self.improve(least).is_none_or(|gain| gain < least) {
                break;
            }
        }
    }

    /// One step downwards; what it gained, none when less than a third of `least` can be had.
    fn improve(&mut self, least: f64) -> Option<f64> {
        let here = self.normal();
        for _ in 0..8 {
            let step = here.bounded_step(self.numbers, &self.x, self.damping)?;
            if here.promised_gain(&step) < least / 3.0 {
                return None;
            }
            let moved: Vec<f64> =
                self.x.iter().zip(self.numbers).zip(step.iter()).map(|((x, n), s)| x + s * n.scale).collect();
            let next = within(&moved, self.numbers);
            let made = self.x.iter().zip(&next).zip(self.numbers).map(|((from, to), n)| (to - from) / n.scale);
            let made = DVector::from_iterator(next.len(), made);
            let residual = self.problem.weighted_residual(self.model, &next);
            let there = residual.map(|r| (r.norm_squared() + prior_cost(self.numbers, &next), r));
            if let Some((cost, residual)) = there.filter(|(cost, _)| *cost < here.cost) {
                self.rows.move_on(&made, residual);
                self.x = next;
                self.damping = (self.damping / 10.0).max(LEAST_DAMPING);
                return Some(here.cost - cost);
            }
            self.damping = (self.damping * 100.0).max(1e-4);
        }
        None
    }

    fn finish(self) -> Fit {
        let here = self.normal();
        let (numbers, x) = (self.numbers, self.x);
        let on_bound = (0..self.problem.case.parameters.len())
            .filter(|&i| (x[i] - numbers[i].min).min(numbers[i].max - x[i]) < 1e-6 * numbers[i].scale)
            .collect();
        let scales = DVector::from_iterator(numbers.len(), numbers.iter().map(|n| n.scale));
        let cost = here.cost - prior_cost(numbers, &x);
        let covariance = here.covariance().component_mul(&(&scales * scales.transpose()));
        Fit { model: self.model.clone(), cost, covariance, x, on_bound }
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
