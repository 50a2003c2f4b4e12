//! Full-model refinement: fits the answer's parameters to the full scene.

use std::borrow::Cow;

use super::play::play_on_full;
use crate::diagnose::case::CaseRun;
use crate::diagnose::fit::{Fit, Problem, difference, shifted, simulate};
use crate::parallel;

/// How often the full scene is asked at most, and the units of chi² for which it is asked again: 0.05 is two tenths of a standard
/// error.
const ROUNDS: usize = 4;
const GAIN: f64 = 0.05;

/// Refines a fit so that the full scene comes closest to the recordings. The reduced-order model is fitted to the
/// recordings less what it lacks of the full scene at the fit (defect correction: Stetter, Numer. Math. 29, 1978). Where
/// that is more than a tenth of the noise, the result counts only if the full scene comes closer with it, and is refined again. Intervals
/// grow by the shift of the parameters, and by the last one that the full scene rejects.
///
/// `None` if the full scene cannot be simulated with the fit.
pub(in crate::diagnose) fn refine(whole: &Problem, fit: Fit) -> Option<Fit> {
    let mut here = Played::with(whole, fit.clone())?;
    let mut rejected = here.fit.x.clone();
    for _ in 1..ROUNDS {
        let next = here.corrected.fit_to_the_end(&fit.model, &here.fit.x)?;
        let gain = here.cost - next.cost;
        if here.is_close {
            (here.fit, rejected) = (next.clone(), next.x);
            break;
        }
        rejected.clone_from(&next.x);
        let unit = (here.cost / whole.samples().max(1) as f64).max(1.0);
        let there = if gain < GAIN * unit { None } else { Played::with(whole, next) };
        match there.filter(|there| there.cost < here.cost) {
            Some(there) => here = there,
            None => break,
        }
    }
    let mut covariance = fit.covariance;
    for (i, refined) in here.fit.x.iter().enumerate() {
        covariance[(i, i)] += ((refined - fit.x[i]) / 1.96).powi(2) + ((rejected[i] - refined) / 1.96).powi(2);
    }
    Some(Fit { x: here.fit.x, on_bound: here.fit.on_bound, covariance, ..fit })
}

/// A fit simulated on the full scene.
struct Played<'a> {
    fit: Fit,
    /// Recordings less what the reduced-order model lacks there.
    corrected: Problem<'a>,
    /// Chi² of the full scene.
    cost: f64,
    /// Whether the two models agree to a tenth of the noise.
    is_close: bool,
}

impl<'a> Played<'a> {
    fn with(whole: &Problem<'a>, fit: Fit) -> Option<Self> {
        let one = |run: &Cow<'a, CaseRun>| -> Option<(CaseRun, bool)> {
            let full = play_on_full(whole.case, &fit, run).ok()?;
            let lacking = difference(&simulate(whole.case, run, &fit.model, &fit.x)?, &full);
            let is_close = whole.is_little(&lacking);
            Some((shifted(run.as_ref().clone(), &lacking), is_close))
        };
        let runs = parallel::map(&whole.runs, one).into_iter().collect::<Option<Vec<_>>>()?;
        let is_close = runs.iter().all(|(_, is_close)| *is_close);
        let runs = runs.into_iter().map(|(run, _)| Cow::Owned(run)).collect();
        let corrected = Problem { case: whole.case, runs, noise: whole.noise };
        let cost = corrected.cost_at(&fit.model, &fit.x)?;
        Some(Self { fit, corrected, cost, is_close })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::Model;
    use crate::scene::Override;

    /// Starts 2 % off the parameter that the full scene was simulated with, and ends at it.
    #[test]
    fn numbers_are_those_that_the_full_scene_was_played_with() {
        let set = [Override::number("friction_m0_n", 0.11)];
        let case = made::recorded("antagonistic_pulley", &set, &["plunger_1_mm", "plunger_2_mm"], &["angle_deg"]);
        let noise = [Noise::white(0.01)];
        let whole = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let baseline = Model::baseline();
        let friction = case.parameters.iter().position(|p| p.key == "friction_m0_n").expect("calibrated");
        let mut wrong = whole.fit_to_the_end(&baseline, &whole.start(&baseline, None)).expect("played");
        wrong.x = whole.start(&baseline, None);
        wrong.x[friction] = 0.1122;
        let refined = refine(&whole, wrong.clone()).expect("played");
        let off = (refined.x[friction] - 0.11).abs();
        assert!(off < 2e-4, "{} of 0.11", refined.x[friction]);
        let moved = refined.x[friction] - wrong.x[friction];
        let grown = refined.covariance[(friction, friction)] - wrong.covariance[(friction, friction)];
        assert!(grown >= 0.999 * (moved / 1.96).powi(2), "{grown} for {moved}");
        let once_more = refine(&whole, refined.clone()).expect("played");
        assert!((once_more.x[friction] - refined.x[friction]).abs() < 2e-5, "{}", once_more.x[friction]);
    }
}
