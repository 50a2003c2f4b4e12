//! What the fast model's difference from the full scene does to the numbers.

use nalgebra::DVector;

use super::fit::{Fit, Problem};
use super::full::FullRun;
use super::model::Sides;
use super::normal::Normal;

/// By how much each number of a fit would move if the full scene were fitted in place of the fast model, to first order:
///
/// ```text
/// dx = -(J^T J + P)^-1 J^T d,   d = (full scene - fast model) / noise
/// ```
/// `J`: derivatives of what is simulated, in units of the noise; `P`: the priors' weights. `None` where the fast model cannot be
/// played there.
pub(super) fn shift(whole: &Problem, fit: &Fit, full: &[FullRun]) -> Option<Vec<f64>> {
    let numbers = whole.numbers(&fit.model);
    let mut rows = whole.rows(&fit.model, &fit.x, 0..fit.x.len(), Sides::Both)?;
    let played = whole.runs.iter().zip(full);
    let to_full = played.map(|(run, full)| whole.subtract(run, &full.values)).collect::<Vec<_>>();
    let against_full = whole.in_noise(&to_full);
    // Of the gradient only what the difference makes: that of the residuals vanishes where the fit has ended.
    rows.residual = against_full - rows.residual;
    let mut normal = Normal::of(&rows, &numbers, &fit.x);
    normal.gradient = rows.slopes.tr_mul(&rows.residual);
    let step: DVector<f64> = normal.bounded_step(&numbers, &fit.x, 0.0)?;
    Some(step.iter().zip(&numbers).map(|(step, n)| step * n.scale).collect())
}

/// Moves the numbers of a fit to where the full scene would have them, and widens their intervals by as much: the move is of first
/// order.
pub(super) fn apply(whole: &Problem, fit: &mut Fit, shift: &[f64]) {
    let numbers = whole.numbers(&fit.model);
    for (i, (n, shift)) in numbers.iter().zip(shift).enumerate() {
        fit.x[i] = (fit.x[i] + shift).clamp(n.min, n.max);
        fit.covariance[(i, i)] += (shift / 1.96).powi(2);
    }
}
