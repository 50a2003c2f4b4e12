//! The part of a model's residual that is more than noise.

use crate::diagnose::case::noise::structured_excess;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::search::Found;

/// Residuals by run, channel and time.
pub type Residuals = Vec<Vec<Vec<f64>>>;

/// Misfit per sample of baseline and best, with their standard error.
#[derive(Clone, Copy, Debug)]
pub struct Excess {
    pub baseline: f64,
    pub best: f64,
    pub error: f64,
}

/// Residuals of the answer, and the misfit above noise of baseline and best.
pub(in crate::diagnose) fn misfit(whole: &Problem, found: &Found) -> Option<(Residuals, Excess)> {
    let before = whole.residuals(&found.baseline.model, &found.baseline.x)?;
    let after = whole.residuals(&found.best.model, &found.best.x)?;
    let (baseline, error) = structured_excess(&before, whole.noise);
    let (best, _) = structured_excess(&after, whole.noise);
    Some((after, Excess { baseline, best, error }))
}

/// Misfit per sample of a fit, and its standard error; `None` if it cannot be simulated.
pub(in crate::diagnose) fn left(problem: &Problem, fit: &Fit) -> Option<(f64, f64)> {
    Some(structured_excess(&problem.residuals(&fit.model, &fit.x)?, problem.noise))
}
