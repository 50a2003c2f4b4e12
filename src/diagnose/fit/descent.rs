//! Damped Gauss-Newton descent of a fit.

use nalgebra::{DMatrix, DVector};

use super::model::{Model, Sides};
use super::normal::{FitParameter, Normal, Rows, prior_cost};
use super::problem::{Fit, Problem};

/// Stop when an iteration promises less than this many units of chi²: enough to choose between models, and for the
/// parameters of the answer, which would otherwise be up to a standard error off.
const GAIN: f64 = 0.5;
const LAST_GAIN: f64 = 0.01;
/// A fit from another start is different if it is lower by this chi²; descents stop within less.
const LOWER: f64 = 5.0;
/// Steps on an updated Jacobian, and how often it is evaluated anew.
const ITERATIONS: usize = 25;
const REFRESHES: usize = 8;
/// Steps, each shorter than the last, that are tried in one direction.
const TRIES: usize = 8;
/// The first steps are undamped: the laws are nearly linear in their parameters, and damping crawls along narrow valleys.
const LEAST_DAMPING: f64 = 1e-10;

impl Problem<'_> {
    /// Fits a model from `start`. `None` if it cannot be simulated there.
    pub fn fit(&self, model: &Model, start: &[f64]) -> Option<Fit> {
        self.fit_until(GAIN, model, start)
    }

    /// The same from the scene's calibration, with effects as in `start`; `None` unless it ends lower than `cost`. A
    /// calibration that compensated for a missing effect may be in another valley.
    pub fn fit_afresh(&self, model: &Model, start: &[f64], cost: f64) -> Option<Fit> {
        let mut afresh = start.to_vec();
        afresh.iter_mut().zip(&self.case.parameters).for_each(|(x, p)| *x = p.start);
        self.fit(model, &afresh).filter(|fit| fit.cost < cost - LOWER)
    }

    /// As [`Problem::fit`], until next to nothing is to be gained.
    pub fn fit_to_the_end(&self, model: &Model, start: &[f64]) -> Option<Fit> {
        self.fit_until(LAST_GAIN, model, start)
    }

    fn fit_until(&self, gain: f64, model: &Model, start: &[f64]) -> Option<Fit> {
        let parameters = self.parameters(model);
        let x = within(start, &parameters);
        let rows = self.rows(model, &x, 0..x.len(), Sides::One)?;
        let mut descent = Descent::new(self, model, &parameters, x, rows);
        descent.gain = gain;
        descent.run();
        for _ in 0..REFRESHES {
            let cost = descent.normal().cost;
            descent.rows = self.rows(model, &descent.x, 0..descent.x.len(), Sides::Both)?;
            descent.damping = LEAST_DAMPING;
            descent.run();
            if cost - descent.normal().cost < gain * descent.unit() {
                break;
            }
        }
        Some(descent.finish())
    }

    /// Fits a model from `start` with a Jacobian known from nearby, updated on the way (Broyden): quick, and good enough to
    /// tell which models are worth [`Problem::fit`].
    pub fn fit_roughly(&self, model: &Model, start: &[f64], jacobian: DMatrix<f64>) -> Option<Fit> {
        let x = within(start, &self.parameters(model));
        let rows = Rows { residual: self.weighted_residual(model, &x)?, jacobian };
        Some(self.end(self.go_on(self.begin(model, x, rows), ITERATIONS)))
    }

    /// Begins [`Problem::fit_roughly`] at parameters within their ranges, where residuals and Jacobian are known.
    pub fn begin(&self, model: &Model, x: Vec<f64>, rows: Rows) -> Underway {
        Underway { model: model.clone(), x, rows, damping: LEAST_DAMPING }
    }

    /// Continues for at most this many steps.
    pub fn go_on(&self, underway: Underway, iterations: usize) -> Underway {
        let Underway { model, x, rows, damping } = underway;
        let parameters = self.parameters(&model);
        let mut descent = Descent::new(self, &model, &parameters, x, rows);
        (descent.damping, descent.iterations) = (damping, iterations);
        descent.run();
        let Descent { x, rows, damping, .. } = descent;
        Underway { x, rows, damping, model }
    }

    /// The fit as it stands.
    pub fn end(&self, underway: Underway) -> Fit {
        let Underway { model, x, rows, .. } = underway;
        let parameters = self.parameters(&model);
        Descent::new(self, &model, &parameters, x, rows).finish()
    }
}

fn within(x: &[f64], parameters: &[FitParameter]) -> Vec<f64> {
    x.iter().zip(parameters).map(|(x, n)| x.clamp(n.min, n.max)).collect()
}

/// A rough fit that can be interrupted and continued.
pub(in crate::diagnose) struct Underway {
    model: Model,
    x: Vec<f64>,
    rows: Rows,
    damping: f64,
}

impl Underway {
    /// Sum of squares reached so far.
    pub fn cost(&self) -> f64 {
        self.rows.residual.norm_squared()
    }
}

/// A fit in progress.
struct Descent<'a> {
    problem: &'a Problem<'a>,
    model: &'a Model,
    parameters: &'a [FitParameter],
    x: Vec<f64>,
    rows: Rows,
    damping: f64,
    /// Units of chi² that are worth another iteration.
    gain: f64,
    iterations: usize,
}

impl<'a> Descent<'a> {
    fn new(
        problem: &'a Problem<'a>,
        model: &'a Model,
        parameters: &'a [FitParameter],
        x: Vec<f64>,
        rows: Rows,
    ) -> Self {
        Self { problem, model, parameters, x, rows, damping: LEAST_DAMPING, gain: GAIN, iterations: ITERATIONS }
    }

    fn normal(&self) -> Normal {
        Normal::of(&self.rows, self.parameters, &self.x)
    }

    /// Chi² per sample, at least 1: a model that is far off need not be converged to the last digit.
    fn unit(&self) -> f64 {
        (self.rows.residual.norm_squared() / self.rows.residual.len().max(1) as f64).max(1.0)
    }

    /// Steps until the Jacobian promises no more.
    fn run(&mut self) {
        for _ in 0..self.iterations {
            let least = self.gain * self.unit();
            if self.improve(least).is_none_or(|gain| gain < least) {
                break;
            }
        }
    }

    /// One step; returns its gain, `None` if less than a third of `least` can be gained.
    fn improve(&mut self, least: f64) -> Option<f64> {
        let here = self.normal();
        for _ in 0..TRIES {
            let step = here.bounded_step(self.parameters, &self.x, self.damping)?;
            if here.promised_gain(&step) < least / 3.0 {
                return None;
            }
            let moved: Vec<f64> =
                self.x.iter().zip(self.parameters).zip(step.iter()).map(|((x, n), s)| x + s * n.scale).collect();
            let next = within(&moved, self.parameters);
            let made = self.x.iter().zip(&next).zip(self.parameters).map(|((from, to), n)| (to - from) / n.scale);
            let made = DVector::from_iterator(next.len(), made);
            let residual = self.problem.weighted_residual(self.model, &next);
            let there = residual.map(|r| (r.norm_squared() + prior_cost(self.parameters, &next), r));
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
        let (parameters, x) = (self.parameters, self.x);
        let on_bound = (0..self.problem.case.parameters.len())
            .filter(|&i| (x[i] - parameters[i].min).min(parameters[i].max - x[i]) < 1e-6 * parameters[i].scale)
            .collect();
        let scales = DVector::from_iterator(parameters.len(), parameters.iter().map(|n| n.scale));
        let cost = here.cost - prior_cost(parameters, &x);
        let covariance = here.covariance().component_mul(&(&scales * scales.transpose()));
        Fit { model: self.model.clone(), cost, covariance, x, on_bound }
    }
}
