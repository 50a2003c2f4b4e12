//! Intervals that are valid in presence of model discrepancy.

use nalgebra::{DMatrix, DVector};

use super::model::Sides;
use super::normal::Normal;
use super::problem::{Fit, Problem};

/// Residuals of one run within this time count as one, s: what a law leaves in one reversal is not independent.
const BLOCK_S: f64 = 2.0;

/// Widens the intervals of a fit to those that its residuals give by themselves, taken in blocks of two seconds (a sandwich
/// covariance of clustered residuals; Huber 1967, Liang and Zeger 1986):
///
/// ```text
/// cov = H^-1 (sum_b g_b g_b^T) H^-1,   H = J^T J + P,   g_b = J_b^T r_b
/// ```
/// `J_b`, `r_b`: derivatives and residuals in units of the noise in block `b`; `P`: the priors' weights. No interval becomes
/// narrower: of few blocks the sum says little.
pub(in crate::diagnose) fn widen(whole: &Problem, fit: &mut Fit) {
    let parameters = whole.parameters(&fit.model);
    let Some(rows) = whole.rows(&fit.model, &fit.x, 0..fit.x.len(), Sides::Both) else { return };
    let mut scores: Vec<DVector<f64>> = Vec::new();
    for (row, block) in blocks(whole).into_iter().enumerate() {
        scores.resize_with(scores.len().max(block + 1), || DVector::zeros(parameters.len()));
        scores[block].axpy(rows.residual[row], &rows.jacobian.row(row).transpose(), 1.0);
    }
    let meat = scores.iter().fold(DMatrix::zeros(parameters.len(), parameters.len()), |sum, g| sum + g * g.transpose());
    let bread = Normal::of(&rows, &parameters, &fit.x).covariance();
    let sandwich = &bread * meat * &bread;
    for (i, n) in parameters.iter().enumerate() {
        let variance = sandwich[(i, i)] * n.scale * n.scale;
        if variance.is_finite() {
            fit.covariance[(i, i)] = fit.covariance[(i, i)].max(variance);
        }
    }
}

/// The block that each row belongs to, all channels of one time in one, in the order of [`Problem::rows`].
fn blocks(whole: &Problem) -> Vec<usize> {
    let mut all = Vec::with_capacity(whole.samples());
    let mut first = 0;
    for run in &whole.runs {
        let times_s = run.times_s();
        let start_s = times_s.first().copied().unwrap_or(0.0);
        let block = |t: &f64| first + ((t - start_s) / BLOCK_S) as usize;
        for measured in &run.measured {
            all.extend(times_s.iter().zip(measured).filter(|(_, m)| m.is_finite()).map(|(t, _)| block(t)));
        }
        first = times_s.last().map_or(first, block) + 1;
    }
    all
}
