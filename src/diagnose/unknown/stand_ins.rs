//! Alternatives to an effect of the answer: laws at other places that explain as much.

use super::forms::{CLEARLY, Criterion, leaves_something, other_forms, tie, with_elsewhere};
use super::grown::in_its_place;
use super::simpler::simpler;
use super::tried::Lawful;
use crate::diagnose::case::{Case, Noise, RunSet, Step};
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::search::Found;
use crate::diagnose::verdict;

/// Adds the laws elsewhere that explain as much as a single effect of the catalogue to its alternatives. Returns
/// whether one is clearly better, so that the effect is a surrogate. Sensor effects are never surrogates of laws in the
/// rig.
pub(super) fn other_places(open: &Problem, found: &mut Found) -> bool {
    let [effect] = &found.best.model.effects[..] else { return false };
    if effect.entry.hypothetical {
        return false;
    }
    let is_in_rig = effect.channel.is_none();
    let (best, forms) = stand_ins(open, &found.best, found.baseline.cost);
    found.forms = vec![forms];
    let criterion = Criterion::of(open, [&found.best]);
    best.is_some_and(|best| is_in_rig && criterion.at(&best) < criterion.at(&found.best) - CLEARLY)
}

/// The same for each of several effects whose alternatives are not known yet. Returns the answer with another law in place
/// of one of several, if that is clearly better: elsewhere, or located again along the runs of all of them.
pub(in crate::diagnose) fn of_several(case: &Case, noise: &[Noise], found: &mut Found) -> Option<Found> {
    let count = found.best.model.effects.len();
    if count < 2 || case.is_without(Step::OpenSet) {
        return None;
    }
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let (mut all, mut exchanged) = (Vec::with_capacity(count), None);
    for index in 0..count {
        let is_law = found.best.model.effects[index].entry.hypothetical;
        if is_law && index + 1 == count || !found.forms_of(index).is_empty() {
            all.push(found.forms_of(index).to_vec());
            continue;
        }
        let last = found.best.with_last(index);
        let without = open.fit(&last.model.without(count - 1), &open.start_without(&last, count - 1));
        let before = without.map(|without| without.cost);
        let (elsewhere, forms) = before.map_or((None, Vec::new()), |before| stand_ins(&open, &last, before));
        all.push(forms);
        // A law that bends fits better wherever an effect of the catalogue is idealised.
        let Some(before) = before.filter(|_| is_law) else { continue };
        let again = leaves_something(&open, &last).then(|| in_its_place(&open, &last, before));
        let criterion = Criterion::of(&open, [&last]);
        let better = again.into_iter().flatten().chain(elsewhere).min_by(|a, b| a.cost.total_cmp(&b.cost));
        let better = better.filter(|better| criterion.at(better) < criterion.at(&last) - CLEARLY);
        // What came later may have made a part of it idle.
        let simple = || {
            let simple = simpler(&open, &last).into_iter().min_by(|a, b| criterion.at(a).total_cmp(&criterion.at(b)));
            simple.filter(|simple| criterion.at(simple) < criterion.at(&last))
        };
        exchanged = exchanged.or(better).or_else(simple);
    }
    found.forms = all;
    // Should it not stand, what was found keeps its forms.
    exchanged.map(|best| Lawful { best, forms: Vec::new() }.beside(found))
}

/// The best fit with a law elsewhere in place of the last effect, and the alternatives that an answer names. `before`:
/// chi² without the last effect.
fn stand_ins(open: &Problem, fit: &Fit, before: f64) -> (Option<Fit>, Vec<Fit>) {
    let port = fit.model.effects.last().map(verdict::port);
    let is_elsewhere = |other: &Fit| other.model.effects.last().map(verdict::port) != port;
    let mut fits = with_elsewhere(open, fit.clone(), before);
    fits.retain(is_elsewhere);
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let most = least_of(fit, &fits) + tie(open, fit, before);
    let forms = other_forms(fit, fits.iter().take_while(|f| f.cost <= most));
    (fits.into_iter().next(), forms)
}

/// The cost that alternatives are held against. A law that fits better than an effect that stands alone rules out those that fit as well as that
/// effect. Beside others it may have taken up what those, idealised, leave.
fn least_of(fit: &Fit, others: &[Fit]) -> f64 {
    let is_alone = fit.model.effects.len() == 1;
    others.first().filter(|_| is_alone).map_or(fit.cost, |other| other.cost.min(fit.cost))
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::diagnose::fit::{Model, Placed};
    use crate::effects::{Element, ElementKind, find};

    fn fit(ids: &[&str], cost: f64) -> Fit {
        let placed = |id: &str| {
            let entry = find(id).expect("of the catalogue");
            (Placed { entry, element: Element::of(ElementKind::Muscle, 0, 1), channel: None }, entry.typical())
        };
        let model = ids.iter().map(|id| placed(id)).fold(Model::baseline(), |m, (placed, own)| m.plus(&placed, &own));
        Fit { model, x: Vec::new(), cost, covariance: DMatrix::zeros(0, 0), on_bound: Vec::new() }
    }

    #[test]
    fn alternatives_to_an_effect_alone_are_held_against_the_best_of_them() {
        let (alone, beside) = (fit(&["coil_preload"], 100.0), fit(&["leak", "coil_preload"], 100.0));
        let laws = [fit(&["hypothetical_force"], 60.0), fit(&["hypothetical_flow"], 103.0)];
        assert_eq!((least_of(&alone, &laws), least_of(&beside, &laws)), (60.0, 100.0));
        assert_eq!((least_of(&alone, &laws[1..]), least_of(&alone, &[])), (100.0, 100.0));
    }
}
