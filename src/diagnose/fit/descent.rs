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
        Some(self.descend(End::Told, model, start, None)?.finish())
    }

    /// The same from the scene's calibration, with the effects of a fit; `None` unless it ends lower. A calibration that compensated for a
    /// missing effect may be in another valley.
    pub fn fit_afresh(&self, fit: &Fit) -> Option<Fit> {
        let mut afresh = fit.x.clone();
        afresh.iter_mut().zip(&self.case.parameters).for_each(|(x, p)| *x = p.start);
        let descent = self.descend(End::Told, &fit.model, &afresh, Some(&fit.x))?;
        Some(descent.finish()).filter(|afresh| afresh.cost < fit.cost - LOWER)
    }

    /// As [`Problem::fit`], until next to nothing is to be gained, with the covariance from central differences.
    pub fn fit_to_the_end(&self, model: &Model, start: &[f64]) -> Option<Fit> {
        Some(self.descend(End::Converged, model, start, None)?.finish())
    }

    /// Descends with Jacobians evaluated anew until one of them gains no more, or it has come to where `known` is.
    fn descend<'a>(&'a self, end: End, model: &'a Model, start: &[f64], known: Option<&[f64]>) -> Option<Descent<'a>> {
        let parameters = self.parameters(model);
        let x = within(start, &parameters);
        // Across slack a quotient to one side may promise nothing, or what is not there.
        let sides = if self.case.goes_slack() { Sides::Both } else { Sides::One };
        let rows = self.rows(model, &x, 0..x.len(), sides)?;
        let mut descent = Descent { end, ..Descent::new(self, model, parameters, x, rows) };
        let has_ended = descent.run() < descent.least() && !descent.is_promising();
        if has_ended && end == End::Told {
            return Some(descent);
        }
        for _ in 0..REFRESHES {
            if known.is_some_and(|known| descent.is_at(known)) {
                break;
            }
            descent.rows = self.rows(model, &descent.x, 0..descent.x.len(), Sides::Both)?;
            descent.damping = LEAST_DAMPING;
            if descent.run() < descent.least() {
                break;
            }
        }
        Some(descent)
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
        let mut descent = Descent::new(self, &model, self.parameters(&model), x, rows);
        (descent.damping, descent.iterations) = (damping, iterations);
        descent.run();
        let Descent { x, rows, damping, .. } = descent;
        Underway { x, rows, damping, model }
    }

    /// The fit as it stands.
    pub fn end(&self, underway: Underway) -> Fit {
        let Underway { model, x, rows, .. } = underway;
        Descent::new(self, &model, self.parameters(&model), x, rows).finish()
    }
}

fn within(x: &[f64], parameters: &[FitParameter]) -> Vec<f64> {
    x.iter().zip(parameters).map(|(x, n)| x.clamp(n.min, n.max)).collect()
}

/// A rough fit that can be interrupted and continued.
pub(in crate::diagnose) struct Underway {
    pub model: Model,
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

/// What a fit is for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    /// To be told from other models.
    Told,
    /// To be the answer.
    Converged,
}

/// A fit in progress.
struct Descent<'a> {
    problem: &'a Problem<'a>,
    model: &'a Model,
    parameters: Vec<FitParameter>,
    x: Vec<f64>,
    rows: Rows,
    damping: f64,
    end: End,
    iterations: usize,
}

impl<'a> Descent<'a> {
    fn new(problem: &'a Problem<'a>, model: &'a Model, parameters: Vec<FitParameter>, x: Vec<f64>, rows: Rows) -> Self {
        Self { problem, model, parameters, x, rows, damping: LEAST_DAMPING, end: End::Told, iterations: ITERATIONS }
    }

    fn normal(&self) -> Normal {
        Normal::of(&self.rows, &self.parameters, &self.x)
    }

    /// Chi² that is worth another iteration.
    fn least(&self) -> f64 {
        let gain = match self.end {
            End::Told => GAIN,
            End::Converged => LAST_GAIN,
        };
        gain * self.unit()
    }

    /// Whether another step is promised: one that then gained nothing came of a Jacobian that is wrong.
    fn is_promising(&self) -> bool {
        let here = self.normal();
        let step = here.bounded_step(&self.parameters, &self.x, LEAST_DAMPING);
        step.is_some_and(|step| here.promised_gain(&step) >= self.least() / 3.0)
    }

    /// Whether other parameters are nearer than what would be another fit.
    fn is_at(&self, other: &[f64]) -> bool {
        let apart = self.x.iter().zip(other).zip(&self.parameters).map(|((x, other), n)| (x - other) / n.scale);
        (&self.rows.jacobian * DVector::from_iterator(other.len(), apart)).norm_squared() < LOWER
    }

    /// Chi² per sample, at least 1: a model that is far off need not be converged to the last digit.
    fn unit(&self) -> f64 {
        (self.rows.residual.norm_squared() / self.rows.residual.len().max(1) as f64).max(1.0)
    }

    /// Steps until the Jacobian promises no more; returns what they have gained.
    fn run(&mut self) -> f64 {
        let before = self.normal().cost;
        for _ in 0..self.iterations {
            let least = self.least();
            if self.improve(least).is_none_or(|gain| gain < least) {
                break;
            }
        }
        before - self.normal().cost
    }

    /// One step; returns its gain, `None` if less than a third of `least` can be gained.
    fn improve(&mut self, least: f64) -> Option<f64> {
        let here = self.normal();
        for _ in 0..TRIES {
            let step = here.bounded_step(&self.parameters, &self.x, self.damping)?;
            if here.promised_gain(&step) < least / 3.0 {
                return None;
            }
            let moved: Vec<f64> =
                self.x.iter().zip(&self.parameters).zip(step.iter()).map(|((x, n), s)| x + s * n.scale).collect();
            let next = within(&moved, &self.parameters);
            let made = self.x.iter().zip(&next).zip(&self.parameters).map(|((from, to), n)| (to - from) / n.scale);
            let made = DVector::from_iterator(next.len(), made);
            let residual = self.problem.weighted_residual(self.model, &next);
            let there = residual.map(|r| (r.norm_squared() + prior_cost(&self.parameters, &next), r));
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
        let cost = here.cost - prior_cost(&parameters, &x);
        let covariance = here.covariance().component_mul(&(&scales * scales.transpose()));
        Fit { model: self.model.clone(), cost, covariance, x, on_bound }
    }
}
