//! The same problem on longer steps: for rough fits, which only tell the models that are worth an exact one.

use std::borrow::Cow;

use super::model::simulate;
use super::problem::{Fit, Problem};
use crate::diagnose::case::{CaseRun, Noise};
use crate::parallel;
use crate::recording::figures;

/// Steps are longer by the first of these factors that does: one in a sampling interval where friction asks for four, or two.
const LONGER: [u16; 2] = [4, 2];
/// A factor does where longer steps change no channel of the fit by more than this share of its noise, root mean square.
const CHANGES: f64 = 0.1;

impl<'a> Problem<'a> {
    /// The problem on longer steps, for models near a fit, each run on the longest that do. What these change of the fit is added to the
    /// measurement, so that the fit leaves the same residual, and another model is off only by what it changes of the error (defect
    /// correction: Stetter, Numer. Math. 29, 1978).
    pub fn coarse(&self, near: &Fit) -> Self {
        let longer = |run: &Cow<'a, CaseRun>| self.on_longer_steps(run, near).map_or_else(|| run.clone(), Cow::Owned);
        Problem { case: self.case, runs: parallel::map(&self.runs, longer), noise: self.noise }
    }

    fn on_longer_steps(&self, run: &CaseRun, near: &Fit) -> Option<CaseRun> {
        let shown = |run: &CaseRun| simulate(self.case, run, &near.model, &near.x);
        let plan = run.drive.plan.as_ref().filter(|plan| plan.iter().any(|steps| *steps > 1))?;
        let exact = shown(run)?;
        LONGER.into_iter().find_map(|factor| {
            let mut coarse = run.clone();
            coarse.drive.plan = Some(plan.iter().map(|steps| steps.div_ceil(factor)).collect());
            let changes = difference(&shown(&coarse)?, &exact);
            self.is_little(&changes).then(|| shifted(coarse, &changes))
        })
    }

    /// Whether changes of a run, by channel and time, are small enough that a model nearby changes them by next to nothing.
    pub fn is_little(&self, changes: &[Vec<f64>]) -> bool {
        let is_little = |(change, noise): (&Vec<f64>, &Noise)| figures::rms(change) <= CHANGES * noise.sd;
        changes.iter().zip(self.noise).all(is_little)
    }
}

/// The run with changes, by channel and time, added to what was measured.
pub(in crate::diagnose) fn shifted(mut run: CaseRun, changes: &[Vec<f64>]) -> CaseRun {
    for values in std::iter::once(&mut run.measured).chain(&mut run.open_part) {
        let each = values.iter_mut().flatten().zip(changes.iter().flatten());
        each.for_each(|(measured, change)| *measured += change);
    }
    run
}

/// One set of channels less another.
pub(in crate::diagnose) fn difference(a: &[Vec<f64>], b: &[Vec<f64>]) -> Vec<Vec<f64>> {
    a.iter().zip(b).map(|(a, b)| a.iter().zip(b).map(|(a, b)| a - b).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{RunSet, made};
    use crate::diagnose::fit::{Model, Placed};
    use crate::effects::{Element, ElementKind, find};
    use crate::scene::Override;

    /// A softer syringe, seen from the stock one: at the fit the residual is the exact one, with a great leak chi² is off by less than a hundredth
    /// of what it changes by, and there are a quarter of the steps. Where the noise is a thousandth of that, they stay as they are.
    #[test]
    fn longer_steps_leave_the_same_misfit_nearby() {
        let softer = Override::parse("hydraulics.upstream_compliance_m3_pa=9e-15").expect("a key");
        let channels = ["elongation_mm", "pressure_kpa"];
        let mut case = made::recorded("muscle_bench", &[softer], &["plunger_mm"], &channels);
        let noise = [0.01, 1.0].map(Noise::white);
        let model = Model::baseline();
        let start: Vec<f64> = case.parameters.iter().map(|p| p.start).collect();
        case.plan_steps(&model.settings(&case, &start), &noise).expect("it does not diverge");
        let problem = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let fit = problem.fit(&model, &start).expect("it does not diverge");
        let fit = Fit { cost: problem.cost_at(&model, &start).expect("played"), x: start, ..fit };
        let coarse = problem.coarse(&fit);
        let steps = |p: &Problem| -> u32 {
            p.runs[0].drive.plan.iter().flat_map(|plan| plan.iter()).map(|s| u32::from(*s)).sum()
        };
        assert!(10 * steps(&coarse) < 3 * steps(&problem), "{} of {} steps", steps(&coarse), steps(&problem));
        let [exact, same] = [&problem, &coarse].map(|p| p.weighted_residual(&model, &fit.x).expect("played"));
        assert!((exact - same).amax() < 1e-9);
        let (entry, element) = (find("leak").expect("of the catalogue"), Element::of(ElementKind::Line, 0, 1));
        let leaks = model.plus(&Placed { entry, element, channel: None }, &[3e-15]);
        let x = problem.start(&leaks, Some(&fit.x));
        let [exact, near] = [&problem, &coarse].map(|p| p.cost_at(&leaks, &x).expect("played"));
        assert!((exact - near).abs() < 1e-2 * (exact - fit.cost).abs(), "{} {exact} {near}", fit.cost);
        let quiet = noise.each_ref().map(|own| Noise::white(1e-3 * own.sd));
        let kept = Problem { case: &case, runs: case.subset(RunSet::All), noise: &quiet };
        assert_eq!(steps(&kept.coarse(&fit)), steps(&kept));
    }
}
