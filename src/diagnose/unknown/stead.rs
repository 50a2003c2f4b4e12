//! Another law in the place of the last effect, begun with its numbers: where a search from the calibration may not have come.

use crate::diagnose::fit::{Fit, Problem, Variant};

/// Names and values of the last effect's parameters.
pub(super) fn numbers(problem: &Problem, fit: &Fit) -> Vec<(String, f64)> {
    let effects = fit.model.effects_at(&fit.x[problem.case.parameters.len()..]);
    let Some(last) = effects.last() else { return Vec::new() };
    let parameters = last.entry.entry().parameters.iter();
    parameters.map(|p| p.key.to_string()).zip(last.values.iter().copied()).collect()
}

/// A converged fit with a law in place of the last effect. Its parameters start at their values here, those of these names from known ones.
pub(super) fn in_stead(problem: &Problem, fit: &Fit, own: &Variant, known: &[(String, f64)]) -> Option<Fit> {
    let last = fit.model.effects.len().checked_sub(1)?;
    let mut values = own.values.clone();
    for (parameter, value) in own.placed.spec().parameters.iter().zip(&mut values) {
        if let Some((_, known)) = known.iter().find(|(name, _)| parameter.key == *name) {
            *value = known.clamp(parameter.range.min, parameter.range.max);
        }
    }
    let model = fit.model.without(last).plus(&own.placed, &values);
    let before = problem.start_without(fit, last);
    let mut x = problem.start(&model, None);
    x[..before.len()].copy_from_slice(&before);
    problem.fit(&model, &x)
}
