//! The way a fit goes down.

use nalgebra::{DMatrix, DVector};

use super::model::{Model, Sides};
use super::normal::{Normal, Number, Rows, prior_cost};
use super::problem::{Fit, Problem};

/// Stop when an iteration promises less than this many units of chi²: enough to choose by, and for the numbers of the answer, which
/// otherwise lie up to a standard error from where the data would have them.
const GAIN: f64 = 0.5;
const LAST_GAIN: f64 = 0.01;
/// Chi² by which a fit from elsewhere is another: less is where descents stop.
const LOWER: f64 = 5.0;
/// Steps on mended slopes, and how often slopes are taken anew.
const ITERATIONS: usize = 25;
const REFRESHES: usize = 8;
const TRIES: usize = 8;
/// The same where playing is dear: a gain of 0.05 is two tenths of a standard error.
const PLAYED_GAIN: f64 = 0.05;
const PLAYED_ITERATIONS: usize = 4;
const PLAYED_TRIES: usize = 3;
const PLAYED_REFRESHES: usize = 4;
/// The first steps are undamped: the laws are nearly linear in their numbers, and damping crawls along narrow valleys.
const LEAST_DAMPING: f64 = 1e-10;

impl Problem<'_> {
    /// Fits a model from `start`. `None` when it cannot be simulated there.
    pub fn fit(&self, model: &Model, start: &[f64]) -> Option<Fit> {
        self.fit_until(GAIN, model, start)
    }

    /// The same from the scene's calibration, effects as `start` has them; none unless it ends lower than `cost`. A calibration that
    /// had to make up for what the model lacked may stand in a valley of its own.
    pub fn fit_afresh(&self, model: &Model, start: &[f64], cost: f64) -> Option<Fit> {
        let mut afresh = start.to_vec();
        afresh.iter_mut().zip(&self.case.parameters).for_each(|(x, p)| *x = p.start);
        self.fit(model, &afresh).filter(|fit| fit.cost < cost - LOWER)
    }

    /// The same as [`Problem::fit`], until next to nothing is to be gained.
    pub fn fit_to_the_end(&self, model: &Model, start: &[f64]) -> Option<Fit> {
        self.fit_until(LAST_GAIN, model, start)
    }

    fn fit_until(&self, gain: f64, model: &Model, start: &[f64]) -> Option<Fit> {
        let numbers = self.numbers(model);
        let x = within(start, &numbers);
        let rows = self.rows(model, &x, 0..x.len(), Sides::One)?;
        let residual = |x: &[f64]| self.weighted_residual(model, x);
        let mut descent = Descent::new(self, model, &numbers, x, rows, &residual);
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

    /// Fits a model from `start` with slopes known from nearby, which are mended on the way: quick, and good enough to
    /// tell which models are worth [`Problem::fit`].
    pub fn fit_roughly(&self, model: &Model, start: &[f64], slopes: DMatrix<f64>) -> Option<Fit> {
        let x = within(start, &self.numbers(model));
        let rows = Rows { residual: self.weighted_residual(model, &x)?, slopes };
        Some(self.end(self.go_on(self.begin(model, x, rows), ITERATIONS)))
    }

    /// Begins [`Problem::fit_roughly`] at numbers within their ranges, where residuals and slopes are known.
    pub fn begin(&self, model: &Model, x: Vec<f64>, rows: Rows) -> Underway {
        Underway { model: model.clone(), x, rows, damping: LEAST_DAMPING }
    }

    /// Goes on for so many steps at most.
    pub fn go_on(&self, underway: Underway, iterations: usize) -> Underway {
        let Underway { model, x, rows, damping } = underway;
        let numbers = self.numbers(&model);
        let residual = |x: &[f64]| self.weighted_residual(&model, x);
        let mut descent = Descent::new(self, &model, &numbers, x, rows, &residual);
        (descent.damping, descent.iterations) = (damping, iterations);
        descent.run();
        let Descent { x, rows, damping, .. } = descent;
        Underway { x, rows, damping, model }
    }

    /// The fit as it stands.
    pub fn end(&self, underway: Underway) -> Fit {
        let Underway { model, x, rows, .. } = underway;
        let numbers = self.numbers(&model);
        let residual = |x: &[f64]| self.weighted_residual(&model, x);
        Descent::new(self, &model, &numbers, x, rows, &residual).finish()
    }

    /// Goes on from `start` with something else than the fast model playing: `played` gives the residuals in units of the noise, the fast
    /// model the slopes. Every play may cost seconds, so there are few. With it the step that the slopes still ask for and that
    /// does not come nearer, in the numbers' units; `None` where nothing can be played.
    pub fn fit_played(&self, model: &Model, start: &[f64], played: &Play) -> Option<(Fit, Vec<f64>)> {
        let numbers = self.numbers(model);
        let rows = Rows { residual: played(start)?, ..self.rows(model, start, 0..start.len(), Sides::Both)? };
        let mut descent = Descent::new(self, model, &numbers, start.to_vec(), rows, played);
        descent.gain = PLAYED_GAIN;
        descent.iterations = PLAYED_ITERATIONS;
        descent.tries = PLAYED_TRIES;
        for _ in 0..PLAYED_REFRESHES {
            let cost = descent.normal().cost;
            descent.run();
            if cost - descent.normal().cost < PLAYED_GAIN * descent.unit() {
                break;
            }
            descent.rows.slopes = self.rows(model, &descent.x, 0..descent.x.len(), Sides::Both)?.slopes;
            descent.damping = LEAST_DAMPING;
        }
        let refused = descent.normal().bounded_step(&numbers, &descent.x, 0.0)?;
        let refused = refused.iter().zip(&numbers).map(|(step, n)| step * n.scale).collect();
        Some((descent.finish(), refused))
    }
}

fn within(x: &[f64], numbers: &[Number]) -> Vec<f64> {
    x.iter().zip(numbers).map(|(x, n)| x.clamp(n.min, n.max)).collect()
}

/// A rough fit that can be left and taken up again.
pub(in crate::diagnose) struct Underway {
    model: Model,
    x: Vec<f64>,
    rows: Rows,
    damping: f64,
}

impl Underway {
    /// Sum of squares that it has come down to.
    pub fn cost(&self) -> f64 {
        self.rows.residual.norm_squared()
    }
}

/// Residuals at some numbers, in units of the noise; none where the model diverges.
pub(super) type Play<'a> = dyn Fn(&[f64]) -> Option<DVector<f64>> + 'a;

/// A fit on its way.
struct Descent<'a> {
    problem: &'a Problem<'a>,
    model: &'a Model,
    numbers: &'a [Number],
    x: Vec<f64>,
    rows: Rows,
    residual: &'a Play<'a>,
    damping: f64,
    /// Units of chi² that are worth another iteration.
    gain: f64,
    iterations: usize,
    /// Steps, each shorter than the last, that are tried in one direction.
    tries: usize,
}

impl<'a> Descent<'a> {
    fn new(
        problem: &'a Problem<'a>,
        model: &'a Model,
        numbers: &'a [Number],
        x: Vec<f64>,
        rows: Rows,
        residual: &'a Play<'a>,
    ) -> Self {
        let (damping, gain, iterations, tries) = (LEAST_DAMPING, GAIN, ITERATIONS, TRIES);
        Self { problem, model, numbers, x, rows, residual, damping, gain, iterations, tries }
    }

    fn normal(&self) -> Normal {
        Normal::of(&self.rows, self.numbers, &self.x)
    }

    /// Chi² per sample, at least 1: a model that is far off need not be far off to the last digit.
    fn unit(&self) -> f64 {
        (self.rows.residual.norm_squared() / self.rows.residual.len().max(1) as f64).max(1.0)
    }

    /// Steps until the slopes promise no more.
    fn run(&mut self) {
        for _ in 0..self.iterations {
            let least = self.gain * self.unit();
            if self.improve(least).is_none_or(|gain| gain < least) {
                break;
            }
        }
    }

    /// One step downwards; what it gained, none when less than a third of `least` can be had.
    fn improve(&mut self, least: f64) -> Option<f64> {
        let here = self.normal();
        for _ in 0..self.tries {
            let step = here.bounded_step(self.numbers, &self.x, self.damping)?;
            if here.promised_gain(&step) < least / 3.0 {
                return None;
            }
            let moved: Vec<f64> =
                self.x.iter().zip(self.numbers).zip(step.iter()).map(|((x, n), s)| x + s * n.scale).collect();
            let next = within(&moved, self.numbers);
            let made = self.x.iter().zip(&next).zip(self.numbers).map(|((from, to), n)| (to - from) / n.scale);
            let made = DVector::from_iterator(next.len(), made);
            let residual = (self.residual)(&next);
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
