//! What a scene leaves of the recordings once its own calibration is fitted to them.

use super::baseline::{baseline, diverges};
use super::problem::Problem;
use crate::diagnose::case::{Case, Noise, RunSet};
use crate::diagnose::error::DiagnoseError;

/// Residuals of a calibrated scene in the open runs.
pub struct Calibrated {
    /// By run, channel and time, in the channels' units; not a number where nothing counts.
    pub residuals: Vec<Vec<Vec<f64>>>,
    /// Of each channel, as its residual shows it.
    pub noise: Vec<Noise>,
}

impl Calibrated {
    /// Calibrates the scene of a case.
    ///
    /// # Errors
    /// A scene that diverges.
    pub fn of(mut case: Case) -> Result<Self, DiagnoseError> {
        let base = baseline(&mut case)?;
        let problem = Problem { case: &case, runs: case.subset(RunSet::Open), noise: &base.noise };
        let mut residuals = problem.residuals(&base.fit.model, &base.fit.x).ok_or_else(diverges)?;
        for (run, of_run) in problem.runs.iter().zip(&mut residuals) {
            for (residual, measured) in of_run.iter_mut().flatten().zip(run.measured.iter().flatten()) {
                *residual = if measured.is_finite() { *residual } else { f64::NAN };
            }
        }
        Ok(Self { residuals, noise: base.noise })
    }
}

/// Chi² that one scene leaves beyond another, of the same recordings, where samples count for both; the noise is that of the second.
pub fn chi2_beyond(one: &Calibrated, other: &Calibrated) -> f64 {
    let runs = one.residuals.iter().zip(&other.residuals);
    let channels = runs.flat_map(|(a, b)| a.iter().zip(b).zip(&other.noise));
    let beyond = |((a, b), noise): ((&Vec<f64>, &Vec<f64>), &Noise)| {
        let squares = a.iter().zip(b).map(|(a, b)| a * a - b * b).filter(|d| d.is_finite());
        squares.sum::<f64>() / noise.scale().powi(2)
    };
    channels.map(beyond).sum()
}
