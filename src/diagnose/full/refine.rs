//! Full-model refinement: fits the answer's parameters to the full scene.

use std::borrow::Cow;

use nalgebra::DVector;
use rayon::prelude::*;

use super::play::play_on_full;
use crate::diagnose::case::CaseRun;
use crate::diagnose::fit::{Fit, Problem};

/// Refines a fit with residuals of the full scene and the Jacobian of the reduced-order model. A step is accepted only
/// if the full scene comes closer to the recordings. Intervals grow by the shift of the parameters, and by the last
/// step that the Jacobian proposes and the full scene rejects.
///
/// `None` if the full scene cannot be simulated with the fit.
pub(in crate::diagnose) fn refine(whole: &Problem, fit: Fit) -> Option<Fit> {
    let residual = |x: &[f64]| -> Option<DVector<f64>> {
        let there = Fit { x: x.to_vec(), ..fit.clone() };
        let left = |run: &Cow<'_, CaseRun>| Some(whole.subtract(run, &play_on_full(whole.case, &there, run).ok()?));
        Some(whole.in_noise(&whole.runs.par_iter().map(left).collect::<Option<Vec<_>>>()?))
    };
    let (refined, refused) = whole.fit_played(&fit.model, &fit.x, &residual)?;
    let mut covariance = fit.covariance;
    for (i, refused) in refused.into_iter().enumerate() {
        let moved = refined.x[i] - fit.x[i];
        covariance[(i, i)] += (moved / 1.96).powi(2) + (refused / 1.96).powi(2);
    }
    Some(Fit { x: refined.x, on_bound: refined.on_bound, covariance, ..fit })
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
