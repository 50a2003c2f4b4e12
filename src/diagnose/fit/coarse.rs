//! The same problem on longer steps, for fits that only tell which models are worth an exact one.

use std::borrow::Cow;

use rayon::prelude::*;

use super::model::simulate;
use super::problem::{Fit, Problem};
use crate::diagnose::case::CaseRun;
use crate::system::StepPlan;

/// Steps are longer by this factor: one in a sampling interval where friction asks for four.
const LONGER: u16 = 4;
/// A problem whose longer steps save less than this factor stays as it is.
const WORTH: f64 = 1.5;

impl<'a> Problem<'a> {
    /// The problem on longer steps, for models near a fit. What these change of the fit is added to the measurement, so that the fit
    /// leaves the same residual, and another model is off only by what it changes of the error (defect correction: Stetter, Numer.
    /// Math. 29, 1978). The same problem if that saves little, or cannot be simulated.
    ///
    /// Not for fits to the end: where friction and slack decide, slopes over long steps need two to three times as many of them.
    pub fn coarse(&self, near: &Fit) -> Self {
        let runs = self.runs_on_longer_steps(near).unwrap_or_else(|| self.runs.clone());
        Problem { case: self.case, runs, noise: self.noise }
    }

    fn runs_on_longer_steps(&self, near: &Fit) -> Option<Vec<Cow<'a, CaseRun>>> {
        let longer = |plan: &StepPlan| plan.iter().map(|steps| steps.div_ceil(LONGER)).collect();
        let longer: Vec<StepPlan> = self.plans().map(longer).collect();
        if longer.len() < self.runs.len() || steps(self.plans()) < WORTH * steps(longer.iter()) {
            return None;
        }
        let corrected = |(run, plan): (&Cow<'a, CaseRun>, StepPlan)| self.corrected(run, plan, near).map(Cow::Owned);
        let runs: Vec<Option<Cow<'a, CaseRun>>> = self.runs.par_iter().zip(longer).map(corrected).collect();
        runs.into_iter().collect()
    }

    fn plans(&self) -> impl Iterator<Item = &StepPlan> {
        self.runs.iter().filter_map(|run| run.drive.plan.as_ref())
    }

    fn corrected(&self, run: &CaseRun, plan: StepPlan, near: &Fit) -> Option<CaseRun> {
        let mut coarse = run.clone();
        coarse.drive.plan = Some(plan);
        let shown = |run: &CaseRun| simulate(self.case, run, &near.model, &near.x);
        let (exact, changed) = (shown(run)?, shown(&coarse)?);
        for values in std::iter::once(&mut coarse.measured).chain(&mut coarse.open_part) {
            for (values, (exact, changed)) in values.iter_mut().zip(exact.iter().zip(&changed)) {
                values
                    .iter_mut()
                    .zip(exact.iter().zip(changed))
                    .for_each(|(m, (exact, changed))| *m += changed - exact);
            }
        }
        Some(coarse)
    }
}

/// Steps of one simulation with each plan.
fn steps<'p>(plans: impl Iterator<Item = &'p StepPlan>) -> f64 {
    plans.flat_map(|plan| plan.iter()).map(|steps| f64::from(*steps)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::{Model, Placed};
    use crate::effects::{Element, ElementKind, find};
    use crate::scene::Override;

    /// A stiffer tube, seen from the stock one: at the fit the residual is the exact one, nearby chi² is off by less than a thousandth
    /// of what it changes by, and there are a quarter of the steps.
    #[test]
    fn longer_steps_leave_the_same_misfit_nearby() {
        let stiffer = Override::parse("muscles.tube.c1_pa=0.27e6").expect("a key");
        let channels = ["elongation_mm", "pressure_kpa"];
        let mut case = made::recorded("muscle_bench", &[stiffer], &["plunger_mm"], &channels);
        let noise = [0.01, 1.0].map(Noise::white);
        let model = Model::baseline();
        let start: Vec<f64> = case.parameters.iter().map(|p| p.start).collect();
        case.plan_steps(&model.settings(&case, &start), &noise).expect("it does not diverge");
        let problem = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let fit = problem.fit(&model, &start).expect("it does not diverge");
        let fit = Fit { cost: problem.cost_at(&model, &start).expect("played"), x: start, ..fit };
        let coarse = problem.coarse(&fit);
        assert!(steps(coarse.plans()) < 0.3 * steps(problem.plans()), "{} steps", steps(coarse.plans()));
        let [exact, same] = [&problem, &coarse].map(|p| p.weighted_residual(&model, &fit.x).expect("played"));
        assert!((exact - same).amax() < 1e-9);
        let (entry, element) = (find("leak").expect("of the catalogue"), Element::of(ElementKind::Line, 0, 1));
        let leaks = model.plus(&Placed { entry, element, channel: None }, &[3e-15]);
        let x = problem.start(&leaks, Some(&fit.x));
        let [exact, near] = [&problem, &coarse].map(|p| p.cost_at(&leaks, &x).expect("played"));
        assert!((exact - near).abs() < 1e-3 * (exact - fit.cost).abs(), "{} {exact} {near}", fit.cost);
    }
}
