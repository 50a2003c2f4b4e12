//! How far a run would set models apart, in standard errors, and what one more sensor would add.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::case::{CaseChannel, CaseRun};
use super::fit::{Fit, Problem};
use super::model::{Sides, simulate};
use super::noise::Noise;
use super::normal::Rows;
use super::verdict::Open;

/// Noise that sensors have who knows nothing better, by unit of their column.
const TYPICAL_NOISE: [(&str, f64); 4] = [("_mm", 0.02), ("_kpa", 5.0), ("_deg", 0.15), ("_n", 0.02)];

/// Distance between two models on a run in standard errors, what the best could imitate by other numbers taken off.
pub(super) fn separation(problem: &Problem, best: &Fit, rival: &Fit, run: &CaseRun) -> Option<f64> {
    Some(beyond(played(problem, best, rival, run)?))
}

/// What a run would show if a rival were true: residuals of the best, and the derivatives to its numbers.
fn played(problem: &Problem, best: &Fit, rival: &Fit, run: &CaseRun) -> Option<Rows> {
    let (case, noise) = (problem.case, problem.noise);
    let mut run = run.clone();
    run.measured = simulate(case, &run, &rival.model, &rival.x)?;
    let problem = Problem { case, runs: vec![Cow::Owned(run)], noise };
    problem.rows(&best.model, &best.x, 0..best.x.len(), Sides::One)
}

/// Length of the residual less what the slopes can make of it.
fn beyond(rows: Rows) -> f64 {
    let basis = rows.slopes.qr().q();
    (&rows.residual - &basis * basis.tr_mul(&rows.residual)).norm()
}

/// What the recordings that there are say about the difference between the best and its rivals.
pub(super) struct Known {
    /// Derivatives to the best's numbers, sample by sample.
    slopes: DMatrix<f64>,
    /// Rival minus best, of each rival.
    apart: Vec<DVector<f64>>,
}

impl Known {
    pub fn of(whole: &Problem, best: &Fit, open: &Open) -> Option<Self> {
        let rows = whole.rows(&best.model, &best.x, 0..best.x.len(), Sides::One)?;
        let of = |rival: &&Fit| Some(&rows.residual - whole.weighted_residual(&rival.model, &rival.x)?);
        let apart = open.rivals.iter().map(of).collect::<Option<Vec<_>>>()?;
        Some(Self { slopes: rows.slopes, apart })
    }

    /// Distance in standard errors from the rival that a run sets apart least, after the best's numbers have been fitted to
    /// that rival on all there would then be.
    pub fn least_separation<'a>(
        &self,
        problem: &Problem,
        best: &Fit,
        open: &Open<'a>,
        run: &CaseRun,
    ) -> Option<(f64, &'a Fit)> {
        let mut least: Option<(f64, &'a Fit)> = None;
        for (rival, known) in open.rivals.iter().zip(&self.apart) {
            let rows = played(problem, best, rival, run)?;
            let all = Rows::stack(&[Rows { slopes: self.slopes.clone(), residual: known.clone() }, rows])?;
            let separation = beyond(all) / open.unit.sqrt();
            if least.is_none_or(|(s, _)| separation < s) {
                least = Some((separation, *rival));
            }
        }
        least
    }
}

/// Calls `ask` with every output of the scene that was not recorded, and the problem that has it recorded on one more
/// run: its column, that problem, that run.
pub(super) fn with_each_sensor(problem: &Problem, run: &CaseRun, mut ask: impl FnMut(&str, &Problem, &CaseRun)) {
    let case = problem.case;
    for (output, spec) in case.scene.file.output.iter().enumerate() {
        let sd = TYPICAL_NOISE.iter().find(|(unit, _)| spec.channel.ends_with(unit)).map(|(_, sd)| *sd);
        let Some(sd) = sd.filter(|_| case.channels.iter().all(|c| c.output != output)) else { continue };
        let mut wider = case.clone();
        let (column, has_free_zero) = (spec.channel.clone(), spec.counts_from_start);
        wider.channels.push(CaseChannel { column, output, stated_sd: Some(sd), has_free_zero });
        let mut run = run.clone();
        run.measured.push(vec![f64::NAN; run.drive.times_s.len()]);
        let noise: Vec<Noise> = problem.noise.iter().copied().chain([Noise::white(sd)]).collect();
        ask(&spec.channel, &Problem { case: &wider, runs: Vec::new(), noise: &noise }, &run);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_best_can_imitate_separates_nothing() {
        let slopes = DMatrix::from_column_slice(4, 1, &[1.0, 1.0, 0.0, 0.0]);
        let rows = |residual: [f64; 4]| Rows { slopes: slopes.clone(), residual: DVector::from_row_slice(&residual) };
        assert!(beyond(rows([2.0, 2.0, 0.0, 0.0])) < 1e-12);
        assert!((beyond(rows([2.0, 2.0, 3.0, 4.0])) - 5.0).abs() < 1e-12);
    }
}
