//! Explains what the catalogue cannot, by laws that the grammar proposes. Uses the open runs only.

use super::forms::{CLEARLY, Criterion, equally_good, is_clearly_better, leaves_something, with_elsewhere};
use super::grown::completed;
use super::listed::does_as_well;
use super::stand_ins::other_places;
use super::tried::{Known, Lawful, Tried};
use super::unlisted::{Proposals, propose, propose_against};
use crate::diagnose::case::{Case, Noise, Optional, RunSet, Step};
use crate::diagnose::fit::{Fit, Problem, Variant};
use crate::diagnose::grammar::{Reach, is_sum};
use crate::diagnose::search::{Found, MOST_EFFECTS, least_gain, leaves_much, reweight};
use crate::diagnose::verdict::{self, Confirmed, Excess};
use crate::parallel;

/// Maximum number of laws in one answer.
const MOST_LAWS: usize = 2;
/// Shares of the misfit and of the noise below which no further law is looked for.
const EXPLAINED: f64 = 0.02;
const EXPLAINED_OF_NOISE: f64 = 0.3;

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

/// Whether a law leaves something, but too little to look for another one beside it.
fn may_grow(open: &Problem, baseline: &Fit, simple: &Fit) -> bool {
    leaves_something(open, simple) && is_explained(open, baseline, simple)
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
    if !tried.is_open || is_listed || tried.is_enough(&open, &one.baseline) {
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

impl Lawful {
    /// The answer with the law in its place.
    pub fn beside(self, found: &Found) -> Found {
        let rivals = vec![Vec::new(); self.best.model.effects.len()];
        let found = Found { rivals_against: self.best.cost, best: self.best, rivals, ..found.clone() };
        found.with_last_forms(self.forms)
    }
}

/// Improves the answer by laws: one alone, two, or one beside effects of the catalogue. `tried`: earlier results for
/// one law.
pub(in crate::diagnose) fn weigh_laws(
    case: &Case,
    noise: &[Noise],
    (found, confirmed): (&mut Found, Confirmed),
    excess: Excess,
    tried: Tried,
    say: &dyn Fn(String),
) -> Option<Found> {
    if case.is_without(Step::OpenSet) {
        return None;
    }
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let is_open = confirmed == Confirmed::InPart || verdict::is_unknown(found, excess);
    let is_null = found.best.model.effects.is_empty();
    let is_elsewhere = !is_open && other_places(&open, found);
    let found = &*found;
    let is_doubtful = || found.best.model.effects.len() > 1 || leaves_something(&open, &found.best);
    if !is_open && (is_null || !(is_elsewhere || is_doubtful())) {
        return None;
    }
    let is_all = |lawful: &Option<Lawful>| lawful.as_ref().is_some_and(|l| !leaves_something(&open, &l.best));
    // In the place of one listed effect a law that bends fits better wherever that effect is idealised; of several it is the simpler answer.
    let is_simpler = |l: &Lawful| is_open || l.best.model.effects.len() < found.best.model.effects.len();
    let search = Search { open: &open, found, is_open, say };
    let instead = tried.instead.filter(is_simpler).and_then(|l| search.go_on(l));
    let is_enough = |lawful: &Option<Lawful>| {
        let is_explained = |l: &&Lawful| is_explained(&open, &found.baseline, &l.best);
        lawful.as_ref().filter(is_explained).is_some_and(|l| is_clearly_better(&open, found, &l.best))
    };
    let alone = if is_enough(&instead) { None } else { search.from(&found.baseline, tried.known) };
    let is_beside = is_open && !is_null && !is_all(&alone) && !is_enough(&instead) && !is_enough(&alone);
    let is_beside = is_beside && case.effort.allows(Optional::LawsBeside);
    let beside = if is_beside { search.from(&found.best, Known::default()) } else { None };
    let lawful: Vec<Lawful> = [instead, alone, beside].into_iter().flatten().collect();
    let criterion = Criterion::of(&open, lawful.iter().map(|l| &l.best).chain([&found.best]));
    let best = lawful.into_iter().min_by(|a, b| criterion.at(&a.best).total_cmp(&criterion.at(&b.best)))?;
    let against = if is_open { &found.baseline } else { &found.best };
    if !is_clearly_better(&open, found, &best.best) {
        say(format!("{} is no better than {}", best.best.model.title(), against.model.title()));
        return None;
    }
    say(format!("{}: chi2 {:.0} -> {:.0}", best.best.model.title(), found.best.cost, best.best.cost));
    Some(best.beside(found))
}

/// Renews weights and steps for the law, then refits and chooses among it and its alternatives.
pub(in crate::diagnose) fn renew(case: &mut Case, noise: &[Noise], mut found: Found) -> (Found, Vec<Noise>) {
    let former = case.runs.clone();
    let Some(renewed) = reweight::renew(case, noise, &found) else {
        case.runs = former;
        return (found, noise.to_vec());
    };
    let open = reweight::open_runs(case, &renewed.noise);
    let former = found.forms.last().map_or(&[][..], Vec::as_slice);
    let mut fits: Vec<Fit> = parallel::map(former, |f| open.fit(&f.model, &f.x)).into_iter().flatten().collect();
    fits.extend(with_elsewhere(&open, renewed.start, renewed.baseline.cost));
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    if let Some((best, forms)) = equally_good(&open, &fits, renewed.baseline.cost) {
        let (best, forms) = without_idle(&open, best, forms);
        found.rivals.truncate(best.model.effects.len());
        (found.rivals_against, found.best) = (best.cost, best);
        found = found.with_last_forms(forms);
    }
    found.baseline = renewed.baseline;
    (found, renewed.noise)
}

/// Whether a fit leaves too little of the misfit to search for another law.
pub(super) fn is_explained(open: &Problem, baseline: &Fit, fit: &Fit) -> bool {
    let noise = open.noise_cost();
    let little = f64::min(EXPLAINED * (baseline.cost - noise), EXPLAINED_OF_NOISE * noise);
    fit.cost - noise < little
}

/// Searches for laws that replace the answer, or accompany it if it leaves more than noise (`is_open`).
struct Search<'a> {
    open: &'a Problem<'a>,
    found: &'a Found,
    is_open: bool,
    say: &'a dyn Fn(String),
}

impl Search<'_> {
    /// Adds laws to a fit. `known` were proposed with other weights.
    fn from(&self, from: &Fit, known: Known) -> Option<Lawful> {
        self.add_laws(from.clone(), None, known)
    }

    /// Continues from a law found with other weights: refits it, compares it with alternatives elsewhere, and tries one
    /// more beside it.
    fn go_on(&self, own: Lawful) -> Option<Lawful> {
        let open = self.open;
        let fit = open.fit(&own.best.model, &own.best.x)?;
        let last = fit.model.effects.len() - 1;
        let before = match last {
            0 => self.found.baseline.cost,
            _ => open.fit(&fit.model.without(last), &open.start_without(&fit, last))?.cost,
        };
        let mut fits = with_elsewhere(open, fit, before);
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let (best, forms) = equally_good(open, &fits, before)?;
        let (best, forms) = without_idle(open, best, forms);
        self.add_laws(best.clone(), Some(Lawful { best, forms }), Known::default())
    }

    /// Adds laws one by one while much of the misfit remains.
    fn add_laws(&self, mut here: Fit, mut lawful: Option<Lawful>, mut known: Known) -> Option<Lawful> {
        let open = self.open;
        for _ in usize::from(lawful.is_some())..self.most() {
            let is_all = lawful.is_some() && !leaves_something(open, &here);
            if is_explained(open, &self.found.baseline, &here) || is_all || here.model.effects.len() >= MOST_EFFECTS {
                break;
            }
            if lawful.is_some() && !open.case.effort.allows(Optional::SecondLaw) {
                break;
            }
            let begun = if lawful.is_none() { known.plain.take() } else { known.beside(&here) };
            let begun = begun.map(|begun| begun.again(open));
            let Some(mut proposals) = begun.or_else(|| self.propose(&here, Reach::Plain)) else { break };
            let Some(first) = proposals.fits.first() else { break };
            if lawful.is_none() && leaves_something(open, first) && !self.is_wide(first) && self.may_be_wider(first) {
                proposals.fits = self.wider(&here, proposals.fits, known.wide.take());
            }
            let Some(first) = proposals.fits.first() else { break };
            if here.cost - first.cost < least_gain(open.samples()) {
                break;
            }
            let (best, forms) = equally_good(open, &proposals.fits, here.cost)?;
            let (best, forms) = without_idle(open, best, forms);
            here = best.clone();
            lawful = Some(Lawful { best, forms });
        }
        lawful
    }

    /// Laws beside a fit; against an answer that leaves nothing, only such as may come near it.
    fn propose(&self, from: &Fit, reach: Reach) -> Option<Proposals> {
        let answer = (!self.is_open).then_some(self.found.best.cost);
        propose_against(self.open, (from, answer), reach, self.say)
    }

    /// Replaces plain laws by ones with memory, products or wider shapes where these are clearly better. Cheapest first.
    fn wider(&self, from: &Fit, plain: Vec<Fit>, known: Option<Proposals>) -> Vec<Fit> {
        if known.is_none() && !self.open.case.effort.allows(Optional::WiderLaws) {
            return plain;
        }
        let simple = plain.first().filter(|simple| may_grow(self.open, &self.found.baseline, simple));
        let mut wide = simple.map_or_else(Vec::new, |simple| completed(self.open, simple, from.cost));
        let is_all = wide.first().is_some_and(|fit| !leaves_something(self.open, fit));
        if !is_all {
            let anew = known.map(|wide| wide.again(self.open)).or_else(|| self.propose(from, Reach::Wide));
            wide.extend(anew.into_iter().flat_map(|anew| anew.fits));
            wide.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        }
        let criterion = Criterion::of(self.open, plain.first().into_iter().chain(wide.first()));
        let best = |fits: &[Fit]| fits.iter().map(|f| criterion.at(f)).fold(f64::INFINITY, f64::min);
        if best(&wide) < best(&plain) - CLEARLY { wide } else { plain }
    }

    /// Whether a fit has a law of two shapes that leaves next to nothing: none needs to be wider.
    fn is_wide(&self, fit: &Fit) -> bool {
        let is_sum = fit.model.effects.last().is_some_and(|law| is_sum(law.spec()));
        is_sum && is_explained(self.open, &self.found.baseline, fit)
    }

    /// Maximum number of laws: fewer than the effects they replace, if those leave nothing.
    fn most(&self) -> usize {
        let fewer = self.found.best.model.effects.len().saturating_sub(1).max(1);
        if self.is_open { MOST_LAWS } else { fewer.min(MOST_LAWS) }
    }

    /// Whether to try laws with memory or of wider shapes. If the effects leave nothing, only where the same law
    /// without memory explains nearly everything.
    fn may_be_wider(&self, plain: &Fit) -> bool {
        self.is_open || !leaves_much(self.open, &self.found.baseline, plain)
    }
}

/// Removes the effects that the last law has made redundant, from a fit and its alternatives.
pub(super) fn without_idle(open: &Problem, mut best: Fit, mut forms: Vec<Fit>) -> (Fit, Vec<Fit>) {
    let without = |fit: &Fit, i: usize| open.fit(&fit.model.without(i), &open.start_without(fit, i));
    let least = least_gain(open.samples());
    loop {
        let others = best.model.effects.len() - 1;
        let fewer: Vec<Option<Fit>> = parallel::map_indices(others, |i| without(&best, i));
        let idle = fewer.into_iter().enumerate().filter_map(|(i, fit)| Some((i, fit?)));
        let idle = idle.filter(|(_, fit)| fit.cost - best.cost < least).min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        let Some((i, fit)) = idle else { return (best, forms) };
        forms = parallel::map(&forms, |form| without(form, i)).into_iter().flatten().collect();
        best = fit;
    }
}
