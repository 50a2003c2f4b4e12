//! How far a run would set models apart, in standard errors, and what one more sensor would add.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::case::{Case, CaseChannel, CaseRun};
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

    /// Distance in standard errors from each rival, after the best's numbers have been fitted to that rival on all there would
    /// then be. What the best's law leaves grows with the run, and with it what counts as a difference: more of the same
    /// settles nothing.
    pub fn separations(&self, problem: &Problem, best: &Fit, open: &Open, run: &CaseRun) -> Option<Vec<f64>> {
        let of = |(rival, known): (&&Fit, &DVector<f64>)| {
            let rows = played(problem, best, rival, run)?;
            let more = (known.len() + rows.residual.len()) as f64 / known.len() as f64;
            let unit = if open.unit > 1.0 { open.unit * more } else { 1.0 };
            let all = Rows::stack(&[Rows { slopes: self.slopes.clone(), residual: known.clone() }, rows])?;
            Some(beyond(all) / unit.sqrt())
        };
        open.rivals.iter().zip(&self.apart).map(of).collect()
    }

    /// The least of them, and the rival.
    pub fn least_separation<'a>(
        &self,
        problem: &Problem,
        best: &Fit,
        open: &Open<'a>,
        run: &CaseRun,
    ) -> Option<(f64, &'a Fit)> {
        let separations = self.separations(problem, best, open, run)?;
        separations.into_iter().zip(open.rivals.iter().copied()).min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// An output of the scene that was not recorded, and the noise that its sensor would have.
type Lacking = (usize, f64);

fn lacking(case: &Case) -> Vec<Lacking> {
    let sd = |column: &str| TYPICAL_NOISE.iter().find(|(unit, _)| column.ends_with(unit)).map(|(_, sd)| *sd);
    let outputs = case.scene.file.output.iter().enumerate();
    let lacking = outputs.filter(|(output, _)| case.channels.iter().all(|c| c.output != *output));
    lacking.filter_map(|(output, spec)| Some((output, sd(&spec.channel)?))).collect()
}

/// What `ask` makes of the problem that has more outputs recorded on one more run: that problem, that run.
fn with_sensors<T>(problem: &Problem, run: &CaseRun, more: &[Lacking], ask: impl FnOnce(&Problem, &CaseRun) -> T) -> T {
    let (mut case, mut run, mut noise) = (problem.case.clone(), run.clone(), problem.noise.to_vec());
    for &(output, sd) in more {
        let spec = &problem.case.scene.file.output[output];
        let (column, has_free_zero) = (spec.channel.clone(), spec.counts_from_start);
        case.channels.push(CaseChannel { column, output, stated_sd: Some(sd), has_free_zero });
        run.measured.push(vec![f64::NAN; run.drive.times_s.len()]);
        noise.push(Noise::white(sd));
    }
    ask(&Problem { case: &case, runs: Vec::new(), noise: &noise }, &run)
}

/// Calls `ask` with every output of the scene that was not recorded, and the problem that has it recorded on one more
/// run: its column, that problem, that run.
pub(super) fn with_each_sensor(problem: &Problem, run: &CaseRun, mut ask: impl FnMut(&str, &Problem, &CaseRun)) {
    for sensor in lacking(problem.case) {
        let column = &problem.case.scene.file.output[sensor.0].channel;
        with_sensors(problem, run, &[sensor], |problem, run| ask(column, problem, run));
    }
}

/// The same with all of them at once.
pub(super) fn with_every_sensor<T>(problem: &Problem, run: &CaseRun, ask: impl FnOnce(&Problem, &CaseRun) -> T) -> T {
    with_sensors(problem, run, &lacking(problem.case), ask)
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
