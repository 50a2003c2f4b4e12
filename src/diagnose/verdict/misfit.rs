//! The part of a model's residual that is more than noise.

use crate::diagnose::case::noise::structured_excess;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::search::Found;

/// Residuals by run, channel and time.
pub type Residuals = Vec<Vec<Vec<f64>>>;

/// Misfit per sample of baseline and best, with their standard error.
#[derive(Clone, Copy, Debug)]
pub struct Excess {
    pub baseline: f64,
    pub best: f64,
    pub error: f64,
}

/// Residuals of the answer, and the misfit above noise of baseline and best.
pub(in crate::diagnose) fn misfit(whole: &Problem, found: &Found) -> Option<(Residuals, Excess)> {
    let before = whole.residuals(&found.baseline.model, &found.baseline.x)?;
    let after = whole.residuals(&found.best.model, &found.best.x)?;
    let (baseline, error) = structured_excess(&before, whole.noise);
    let (best, _) = structured_excess(&after, whole.noise);
    Some((after, Excess { baseline, best, error }))
}

/// Misfit per sample of a fit, and its standard error; `None` if it cannot be simulated.
pub(in crate::diagnose) fn left(problem: &Problem, fit: &Fit) -> Option<(f64, f64)> {
    Some(structured_excess(&problem.residuals(&fit.model, &fit.x)?, problem.noise))
}

/// Chi² that a fit leaves beyond noise; nothing if it cannot be simulated.
pub(in crate::diagnose) fn left_beyond_noise(problem: &Problem, fit: &Fit) -> f64 {
    left(problem, fit).map_or(0.0, |excess| beyond_noise(fit, excess, problem.samples()))
}

/// The same of an excess per sample and its standard error. Beside a law, whose shape is never quite the true one, it is what
/// may be left unseen, one standard error more: such a misfit may favour the wrong one of two laws.
fn beyond_noise(fit: &Fit, (excess, error): (f64, f64), samples: usize) -> f64 {
    let has_law = fit.model.effects.iter().any(|effect| effect.entry.hypothetical);
    let unseen = if has_law { error } else { 0.0 };
    (excess.max(0.0) + unseen) * samples as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::{Model, Placed};
    use crate::effects::{Element, ElementKind, find};
    use nalgebra::DMatrix;

    #[test]
    fn beside_a_law_what_may_be_left_unseen_counts() {
        let with = |name: &str, kind: ElementKind| {
            let entry = find(name).expect("of the catalogue");
            let placed = Placed { entry, element: Element::of(kind, 0, 1), channel: None };
            let model = Model::baseline().plus(&placed, &entry.typical());
            Fit { model, x: Vec::new(), cost: 0.0, covariance: DMatrix::zeros(0, 0), on_bound: Vec::new() }
        };
        let (leak, law) = (with("leak", ElementKind::Line), with("hypothetical_force", ElementKind::Muscle));
        let left = |excess: f64| [&leak, &law].map(|fit| beyond_noise(fit, (excess, 0.01), 1000));
        // Less than noise is nothing.
        assert_eq!([left(0.02), left(-0.02)], [[20.0, 30.0], [0.0, 10.0]]);
    }
}
