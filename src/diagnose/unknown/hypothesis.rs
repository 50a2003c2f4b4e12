//! Weighs laws that the grammar proposes against the answer of the catalogue. Uses the open runs only.

use super::forms::{CLEARLY, Criterion, equally_good, is_clearly_better, leaves_something, with_elsewhere};
use super::grown::completed;
use super::stand_ins::other_places;
use super::tried::{Known, Lawful, Tried};
use super::unlisted::{Proposals, propose_against};
use crate::diagnose::case::{Case, Noise, Optional, RunSet, Step};
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::grammar::{Reach, is_sum};
use crate::diagnose::search::{Found, MOST_EFFECTS, least_gain, leaves_much, reweight};
use crate::diagnose::verdict::{self, Confirmed, Excess};
use crate::parallel;

/// Maximum number of laws in one answer.
const MOST_LAWS: usize = 2;
/// Share of the misfit below which no further law is looked for.
const EXPLAINED: f64 = 0.02;

/// Whether a law leaves something, but too little to look for another one beside it.
pub(super) fn may_grow(open: &Problem, baseline: &Fit, simple: &Fit) -> bool {
    leaves_something(open, simple) && is_explained(open, baseline, simple)
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
    let curve = tried.known.plain.as_ref().and_then(|plain| plain.curve.clone()).filter(|_| is_open);
    let instead = tried.instead.filter(is_simpler).and_then(|l| search.go_on(l));
    let is_enough = |lawful: &Option<Lawful>| {
        let is_explained = |l: &&Lawful| is_explained(&open, &found.baseline, &l.best);
        lawful.as_ref().filter(is_explained).is_some_and(|l| is_clearly_better(&open, found, &l.best))
    };
    let alone = if is_enough(&instead) { None } else { search.from(&found.baseline, tried.known) };
    let is_beside = is_open && !is_null && !is_all(&alone) && !is_enough(&instead) && !is_enough(&alone);
    let is_beside = is_beside && case.effort.allows(Optional::LawsBeside);
    let beside = if is_beside { search.from(&found.best, Known::default()) } else { None };
    // A curve describes what nothing simpler explains.
    let is_bare = ![&instead, &alone, &beside].into_iter().any(|l| is_all(l) || is_enough(l));
    let curve = curve.filter(|_| is_bare).and_then(|curve| search.described(&curve));
    let lawful: Vec<Lawful> = [instead, alone, beside, curve].into_iter().flatten().collect();
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
    // What diverges under the inputs of any run is no law; their outputs have no say in it.
    let whole = Problem { case, runs: case.subset(RunSet::All), noise: &renewed.noise };
    fits.retain(|fit| whole.residuals(&fit.model, &fit.x).is_some());
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
    let little = f64::min(EXPLAINED * (baseline.cost - noise), verdict::LITTLE_OF_NOISE * noise);
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

    /// A curve of pieces in place of the answer, with its alternatives.
    fn described(&self, curve: &Fit) -> Option<Lawful> {
        let before = self.found.baseline.cost;
        let fit = self.open.fit(&curve.model, &curve.x)?;
        let mut fits = with_elsewhere(self.open, fit, before);
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        let (best, forms) = equally_good(self.open, &fits, before)?;
        Some(Lawful { best, forms })
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
