//! The parameters of the answer as the full scene would have them.

use std::borrow::Cow;

use nalgebra::DVector;
use rayon::prelude::*;

use super::play::play_on_full;
use crate::diagnose::case::CaseRun;
use crate::diagnose::fit::{Fit, Problem};

/// Goes on from a fit of the reduced-order model with the full scene in its place: the residuals are the full scene's, the derivatives the fast
/// model's. A step is taken only where the full scene itself comes nearer to the recordings. Intervals grow by what their parameters
/// moved, and by what the derivatives ask for at the end and the scene refuses: they are another model's.
///
/// `None` where the full scene cannot be played with the fit.
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

    /// From a reduced-order model's fit that is wrong by two per cent to the number with which the full scene was played; and no further.
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
