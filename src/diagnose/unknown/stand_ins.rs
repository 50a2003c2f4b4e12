//! What an effect of an answer could be instead: laws at other places that do the same.

use super::forms::{Criterion, other_forms, tie, with_elsewhere};
use super::hypothesis::CLEARLY;
use crate::diagnose::case::{Case, Noise, RunSet, Step};
use crate::diagnose::fit::{Fit, Placed, Problem};
use crate::diagnose::search::Found;
use crate::diagnose::verdict;

/// Of a single effect of the catalogue: laws at other places that explain the recordings as well become its forms. Whether one explains
/// them clearly better, so that the effect only stands in for a law.
pub(super) fn other_places(open: &Problem, found: &mut Found) -> bool {
    let [effect] = &found.best.model.effects[..] else { return false };
    if effect.entry.hypothetical || !has_a_place(effect) {
        return false;
    }
    let (best, forms) = stand_ins(open, &found.best, found.baseline.cost);
    found.forms = vec![forms];
    let criterion = Criterion::of(open, [&found.best]);
    best.is_some_and(|best| criterion.at(&best) < criterion.at(&found.best) - CLEARLY)
}

/// The same for every effect of several of which none is known yet. The law that came last has its forms.
pub(in crate::diagnose) fn of_several(case: &Case, noise: &[Noise], found: &mut Found) {
    let count = found.best.model.effects.len();
    if count < 2 || case.is_without(Step::OpenSet) {
        return;
    }
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let forms = |index: usize| -> Vec<Fit> {
        let own = &found.best.model.effects[index];
        let is_known = !found.forms_of(index).is_empty() || (own.entry.hypothetical && index + 1 == count);
        if is_known || !has_a_place(own) {
            return found.forms_of(index).to_vec();
        }
        let last = found.best.with_last(index);
        let without = open.fit(&last.model.without(count - 1), &open.start_without(&last, count - 1));
        without.map_or_else(Vec::new, |without| stand_ins(&open, &last, without.cost).1)
    };
    found.forms = (0..count).map(forms).collect();
}

/// Whether an effect is something in the rig that depends on something: of sensors and mere numbers nothing is tried elsewhere.
fn has_a_place(effect: &Placed) -> bool {
    let is_over_nothing = match effect.spec().unlisted() {
        Some(written) => written.law.variables().is_empty(),
        None => effect.spec().variables.is_empty(),
    };
    effect.channel.is_none() && !is_over_nothing
}

/// The best fit with a law elsewhere in the place of the last effect, and those that an answer names beside it. `before` is the chi² without
/// it.
fn stand_ins(open: &Problem, fit: &Fit, before: f64) -> (Option<Fit>, Vec<Fit>) {
    let port = fit.model.effects.last().map(verdict::port);
    let is_elsewhere = |other: &Fit| other.model.effects.last().map(verdict::port) != port;
    let mut fits = with_elsewhere(open, fit.clone(), before);
    fits.retain(is_elsewhere);
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let tie = tie(open, fit, before);
    let forms = other_forms(fit, fits.iter().filter(|f| f.cost <= fit.cost + tie));
    (fits.into_iter().next(), forms)
}
