//! An effect of the catalogue in the place of a law.

use super::forms::{is_clearly_better, leaves_something};
use crate::diagnose::fit::{Fit, Problem, Variant};
use crate::diagnose::search::{Found, below, least_gain};

/// Share of the misfit that an effect of the catalogue in the place of a law may leave roughly, to be fitted to the end: two times what it
/// may leave then.
const MAY_LEAVE: f64 = 0.1;

/// The best effect of the catalogue in the place of one of a fit's, if it comes near it. It is fitted where that one has brought the model;
/// otherwise calibration and partner would absorb it.
pub(super) fn in_place_of(
    open: &Problem,
    baseline: &Fit,
    (fit, effect): (&Fit, usize),
    variants: &[Variant],
) -> Option<Fit> {
    let (model, x) = (fit.model.without(effect), open.start_without(fit, effect));
    let cost = open.cost_at(&model, &x)?;
    let bare = Fit { model, x, cost, ..fit.clone() };
    let noise = open.noise_cost();
    let most = noise + f64::max(MAY_LEAVE * (baseline.cost - noise), 2.0 * least_gain(open.samples()));
    below(open, &bare, variants, most).into_iter().next()
}

/// The effect of the catalogue that does as well as a single law that explains everything. The search from the scene's own
/// calibration may have missed it.
pub(super) fn does_as_well(open: &Problem, found: &Found, law: &Fit, variants: &[Variant]) -> Option<Fit> {
    let listed = in_place_of(open, &found.baseline, (law, 0), variants)?;
    let is_all = listed.cost < found.best.cost && !leaves_something(open, &listed);
    let instead = Found { best: listed, ..found.clone() };
    (is_all && !is_clearly_better(open, &instead, law)).then_some(instead.best)
}
