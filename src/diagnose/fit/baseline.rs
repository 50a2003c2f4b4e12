//! Refits the scene's own calibration and estimates the noise from its residual.

use super::model::Model;
use super::problem::{Fit, Problem};
use crate::diagnose::case::noise::estimate;
use crate::diagnose::case::{Case, Noise, RunSet};
use crate::diagnose::error::DiagnoseError;

/// Baseline on the open runs, with the noise estimated from its residual.
pub(in crate::diagnose) struct Baseline {
    pub fit: Fit,
    pub noise: Vec<Noise>,
    pub warnings: Vec<String>,
}

/// Fits the calibration from the scene's values and from the middle of the ranges; widens a bound that is met, once.
pub(in crate::diagnose) fn baseline(case: &mut Case) -> Result<Baseline, DiagnoseError> {
    let mut noise = first_noise(case);
    plan_steps(case, &noise, None).ok_or_else(diverges)?;
    let mut warnings = Vec::new();
    let mut fit = fit(case, &noise, None)?;
    if !fit.on_bound.is_empty() {
        for &i in &fit.on_bound {
            let p = &mut case.parameters[i];
            (p.min, p.max) = widened(p.min, p.max);
            warnings.push(format!(
                "{} met the end of its range, which was widened to {:.3e} .. {:.3e}",
                p.title(),
                p.min,
                p.max
            ));
        }
        fit = self::fit(case, &noise, Some(&fit.x))?;
    }
    let residuals = problem(case, &noise).residuals(&fit.model, &fit.x).ok_or_else(diverges)?;
    noise = estimate(case, &residuals);
    plan_steps(case, &noise, Some(&fit.x)).ok_or_else(diverges)?;
    case.leave_out_slack(&fit.model.settings(case, &fit.x)).ok_or_else(diverges)?;
    let fit = self::fit(case, &noise, Some(&fit.x))?;
    Ok(Baseline { fit, noise, warnings })
}

/// A range with half of it added on both sides; what cannot be negative stays so.
fn widened(min: f64, max: f64) -> (f64, f64) {
    let half = (max - min) / 2.0;
    let low = if min < 0.0 { min - half } else { (min - half).max(0.1 * min) };
    (low, max + half)
}

/// Steps planned at a calibration, the scene's own if none is given.
fn plan_steps(case: &mut Case, noise: &[Noise], near: Option<&[f64]>) -> Option<()> {
    let model = Model::baseline();
    let start = problem(case, noise).start(&model, near);
    let settings = model.settings(case, &start);
    case.plan_steps(&settings, noise)
}

pub(super) fn diverges() -> DiagnoseError {
    DiagnoseError::Simulation("it diverges".to_owned())
}

fn problem<'a>(case: &'a Case, noise: &'a [Noise]) -> Problem<'a> {
    Problem { case, runs: case.subset(RunSet::Open), noise }
}

fn fit(case: &Case, noise: &[Noise], near: Option<&[f64]>) -> Result<Fit, DiagnoseError> {
    let problem = problem(case, noise);
    let model = Model::baseline();
    let from_here = problem.fit(&model, &problem.start(&model, near));
    if near.is_some() {
        return from_here.ok_or_else(diverges);
    }
    let middle: Vec<f64> = case.parameters.iter().map(|p| (p.min + p.max) / 2.0).collect();
    // Stock values stand in the middle of their ranges: one start then says all.
    let is_another = case.parameters.iter().zip(&middle).any(|(p, m)| (p.start - m).abs() > 1e-3 * (p.max - p.min));
    let from_middle = if is_another { problem.fit(&model, &middle) } else { None };
    let best = [from_here, from_middle].into_iter().flatten().min_by(|a, b| a.cost.total_cmp(&b.cost));
    best.ok_or_else(diverges)
}

/// Stated noise, else that of the recording's fastest changes.
fn first_noise(case: &Case) -> Vec<Noise> {
    let of = |c: usize| {
        let found = case.runs.iter().filter_map(|r| crate::recording::noise_sd(r.times_s(), &r.measured[c]));
        let smallest = found.fold(f64::INFINITY, f64::min);
        let sd = case.channels[c].stated_sd.unwrap_or(if smallest.is_finite() { smallest } else { 1.0 });
        Noise::white(sd)
    };
    (0..case.channels.len()).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_grows_on_both_sides_and_keeps_its_sign() {
        assert_eq!(widened(-100.0, 100.0), (-200.0, 200.0));
        assert_eq!(widened(1.0, 4.0), (0.1, 5.5));
        assert_eq!(widened(0.0, 2.0), (0.0, 3.0));
    }
}
