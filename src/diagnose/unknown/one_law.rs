//! One law in place of the best single effect, before several effects of the catalogue are tried. Uses the open runs only.

use super::forms::{equally_good, is_clearly_better, leaves_something};
use super::freed::freed_in_place;
use super::grown::completed;
use super::hypothesis::{may_grow, renew, without_idle};
use super::listed::does_as_well;
use super::tried::{Known, Lawful, Tried};
use super::unlisted::propose;
use crate::diagnose::case::{Case, Noise, Optional, RunSet, Step};
use crate::diagnose::fit::{Fit, Problem, Variant};
use crate::diagnose::grammar::Reach;
use crate::diagnose::search::{Found, leaves_much};

/// Result of trying one law before several effects of the catalogue.
pub(in crate::diagnose) enum OneLaw {
    /// One law explains everything above noise, and clearly better than any single effect. With the noise estimated
    /// from its residual.
    All(Box<Found>, Vec<Noise>),
    /// It does, and so does an effect of the catalogue where the law has brought the calibration.
    Listed(Fit, Box<Tried>),
    /// It does not, or the step was left out.
    Part(Box<Tried>),
}

/// Searches for one law to replace the best single effect, if that effect leaves more than noise.
pub(in crate::diagnose) fn one_law(
    case: &mut Case,
    noise: &[Noise],
    (found, variants): (&Found, &[Variant]),
    say: &dyn Fn(String),
) -> OneLaw {
    let nothing = OneLaw::Part(Box::default());
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    if case.is_without(Step::OpenSet) || !leaves_something(&open, &found.best) {
        return nothing;
    }
    let Some(proposals) = propose(&open, &found.baseline, Reach::Plain, say) else { return nothing };
    let alone = equally_good(&open, &proposals.fits, found.baseline.cost)
        .map(|(best, forms)| Lawful { best, forms })
        .filter(|lawful| may_end_search(&open, found, &lawful.best))
        .map(|lawful| with_free_exponent(&open, lawful, &proposals.fits, say))
        .map(|lawful| with_more_to_it(&open, lawful, &found.baseline, say));
    let known = Known { plain: Some(proposals), ..Known::default() };
    let is_all = alone.as_ref().is_some_and(|lawful| !leaves_something(&open, &lawful.best));
    let law = alone.as_ref().map(|lawful| lawful.best.clone());
    let tried = Tried { known, law, instead: None, is_open: !is_all };
    match alone.filter(|_| is_all) {
        Some(lawful) => all(case, noise, (found, variants), (lawful, tried), say),
        None => OneLaw::Part(Box::new(tried)),
    }
}

/// A law that leaves something, or one with a free exponent in its place: that shapes of whole numbers lead there has been seen already.
fn with_free_exponent(open: &Problem, lawful: Lawful, fits: &[Fit], say: &dyn Fn(String)) -> Lawful {
    if !leaves_something(open, &lawful.best) {
        return lawful;
    }
    let Some(best) = freed_in_place(open, fits, &lawful.best) else { return lawful };
    say(format!("with a free exponent, {}: chi2 {:.0} -> {:.0}", best.model.title(), lawful.best.cost, best.cost));
    // The alternatives are weighed again where weights are renewed.
    Lawful { best, ..lawful }
}

/// A simple law, or the same elsewhere or one with memory or a product in its place if that explains all that it leaves.
fn with_more_to_it(open: &Problem, simple: Lawful, baseline: &Fit, say: &dyn Fn(String)) -> Lawful {
    if !may_grow(open, baseline, &simple.best) || !open.case.effort.allows(Optional::WiderLaws) {
        return simple;
    }
    let fits = completed(open, &simple.best, baseline.cost);
    let more = equally_good(open, &fits, baseline.cost).filter(|(best, _)| !leaves_something(open, best));
    let Some((best, forms)) = more else { return simple };
    say(format!("instead of {}: chi2 {:.0} -> {:.0}", simple.best.model.title(), simple.best.cost, best.cost));
    Lawful { best, forms }
}

/// A law that explains everything, unless a listed effect does as well.
fn all(
    case: &mut Case,
    noise: &[Noise],
    (found, variants): (&Found, &[Variant]),
    (lawful, tried): (Lawful, Tried),
    say: &dyn Fn(String),
) -> OneLaw {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    if let Some(listed) = does_as_well(&open, found, &lawful.best, variants) {
        say(format!("{} does as well as {}", listed.model.title(), lawful.best.model.title()));
        return OneLaw::Listed(listed, Box::new(Tried { law: None, ..tried }));
    }
    match renewed(case, noise, lawful.beside(found), say) {
        Some((found, noise)) => OneLaw::All(Box::new(found), noise),
        None => OneLaw::Part(Box::new(tried)),
    }
}

/// Searches again for one law, from the best single effect (`one`), unless two effects of the catalogue leave nothing above
/// noise (`two`). A law that is out of reach from the calibration leaves a large misfit, and no two listed effects explain
/// all of that.
pub(in crate::diagnose) fn one_law_from_effect(
    case: &mut Case,
    noise: &[Noise],
    (one, two, variants): (&Found, &Found, &[Variant]),
    mut tried: Tried,
    say: &dyn Fn(String),
) -> OneLaw {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let is_listed = two.best.model.effects.len() > 1 && !leaves_something(&open, &two.best);
    if !tried.is_open || is_listed || tried.is_nearer(&one.best) {
        return OneLaw::Part(Box::new(tried));
    }
    tried.instead = instead(&open, one, say);
    // What needs an effect beside it may stand for a second effect: it waits until the catalogue has tried that.
    let alone = tried.instead.clone().filter(|lawful| lawful.best.model.effects.len() == 1);
    let alone = alone.filter(|lawful| may_end_search(&open, one, &lawful.best));
    let alone = alone.filter(|lawful| tried.law.as_ref().is_none_or(|law| lawful.best.cost < law.cost));
    let Some(lawful) = alone else { return OneLaw::Part(Box::new(tried)) };
    tried.law = Some(lawful.best.clone());
    match leaves_something(&open, &lawful.best) {
        false => all(case, noise, (one, variants), (lawful, tried), say),
        true => OneLaw::Part(Box::new(tried)),
    }
}

/// Whether a law may end the search for several effects, or bound it: it leaves little, and is clearly better than the best
/// single effect.
fn may_end_search(open: &Problem, found: &Found, lawful: &Fit) -> bool {
    let leaves_little = !leaves_something(open, lawful) || !leaves_much(open, &found.baseline, lawful);
    leaves_little && is_clearly_better(open, found, lawful)
}

/// Refits a complete explanation with renewed weights and steps. `None` if it then leaves more than noise.
pub(super) fn renewed(
    case: &mut Case,
    noise: &[Noise],
    found: Found,
    say: &dyn Fn(String),
) -> Option<(Found, Vec<Noise>)> {
    let former = case.runs.clone();
    let (found, noise) = renew(case, noise, found);
    let open = Problem { case, runs: case.subset(RunSet::Open), noise: &noise };
    if leaves_something(&open, &found.best) {
        case.runs = former;
        return None;
    }
    say(format!("{} explains it all", found.best.model.title()));
    Some((found, noise))
}

/// One law that replaces the best single effect, or accompanies it if both are needed. With a large misfit, derivatives
/// at the calibration point nowhere; even a wrong effect brings the model nearer to the measurement.
fn instead(open: &Problem, found: &Found, say: &dyn Fn(String)) -> Option<Lawful> {
    if found.best.model.effects.is_empty() {
        return None;
    }
    let proposals = propose(open, &found.best, Reach::Plain, say)?;
    let (best, forms) = equally_good(open, &proposals.fits, found.best.cost)?;
    let (best, forms) = without_idle(open, best, forms);
    Some(Lawful { best, forms })
}
