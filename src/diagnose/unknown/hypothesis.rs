//! Step 6: what the catalogue does not explain, as laws that the grammar proposes. They are found on the open runs alone.

use rayon::prelude::*;

use super::forms::{Criterion, equally_good, leaves_something, with_elsewhere};
use super::stand_ins::other_places;
use super::unlisted::{Proposals, propose};
use crate::diagnose::case::{Case, Noise, RunSet, Step};
use crate::diagnose::fit::{Fit, Placed, Problem};
use crate::diagnose::grammar::Reach;
use crate::diagnose::search::{
    Found, MOST_EFFECTS, cross_validates, cross_validates_runs, least_gain, leaves_much, reweight,
};
use crate::diagnose::verdict::{self, Confirmed, Excess};

/// Laws in one answer, at most.
const MOST_LAWS: usize = 2;
/// Share of the misfit below which no further law is looked for.
const EXPLAINED: f64 = 0.02;
/// By so much the criterion of an answer with a law must be lower than that of an answer of the catalogue alone.
pub(super) const CLEARLY: f64 = 20.0;
/// A model with a law, and the others that are as good.
#[derive(Clone)]
pub(in crate::diagnose) struct Lawful {
    pub best: Fit,
    pub forms: Vec<Fit>,
}

/// What one law makes of the recordings before the catalogue has tried several effects.
pub(in crate::diagnose) enum OneLaw {
    /// It explains all that is more than noise, clearly better than any single effect. With the noise that it leaves.
    All(Box<Found>, Vec<Noise>),
    /// It does not, or was not asked for.
    Part(Box<Tried>),
}

/// Laws proposed beside the calibration.
#[derive(Default)]
pub(in crate::diagnose) struct Known {
    pub plain: Option<Proposals>,
    /// Single laws that remember, multiply or bend otherwise.
    pub wide: Option<Proposals>,
    /// Second laws, and the law that they are beside.
    pub second: Option<(Vec<Placed>, Proposals)>,
}

/// What has been tried with one law, for later.
#[derive(Default)]
pub(in crate::diagnose) struct Tried {
    pub known: Known,
    /// The best law that is clearly better than any single effect.
    pub law: Option<Fit>,
    /// The law in the place of the best single effect, or beside it, however much that leaves.
    pub instead: Option<Lawful>,
}

impl Known {
    /// What was proposed beside this law.
    fn beside(&mut self, law: &Fit) -> Option<Proposals> {
        self.second.take_if(|(own, _)| *own == law.model.effects).map(|(_, proposals)| proposals)
    }
}

/// Looks for one law in the place of the best single effect, where that leaves more than noise.
pub(in crate::diagnose) fn one_law(case: &mut Case, noise: &[Noise], found: &Found, say: &dyn Fn(String)) -> OneLaw {
    let nothing = OneLaw::Part(Box::default());
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    if case.is_without(Step::OpenSet) || !leaves_something(&open, &found.best) {
        return nothing;
    }
    let Some(proposals) = propose(&open, &found.baseline, Reach::Plain, say) else { return nothing };
    let is_all = |lawful: &Lawful| !leaves_something(&open, &lawful.best);
    // One that leaves much neither ends a search nor bounds it.
    let is_better = |lawful: &Lawful| {
        (is_all(lawful) || !leaves_much(&open, &found.baseline, &lawful.best))
            && is_clearly_better(&open, found, &lawful.best)
    };
    let alone = equally_good(&open, &proposals.fits, found.baseline.cost)
        .map(|(best, forms)| Lawful { best, forms })
        .filter(is_better);
    let instead = match alone.as_ref().is_some_and(is_all) {
        true => None,
        false => instead(&open, found, say),
    };
    // What needs an effect beside it may stand for a second effect: it waits until the catalogue has tried that.
    let better = instead.clone().filter(|lawful| lawful.best.model.effects.len() == 1).filter(is_better);
    let best = alone.into_iter().chain(better).min_by(|a, b| a.best.cost.total_cmp(&b.best.cost));
    let law = best.as_ref().map(|lawful| lawful.best.clone());
    let known = Known { plain: Some(proposals), ..Known::default() };
    let part = OneLaw::Part(Box::new(Tried { known, law, instead }));
    let Some(lawful) = best.filter(is_all) else { return part };
    match renewed(case, noise, lawful.beside(found), say) {
        Some((found, noise)) => OneLaw::All(Box::new(found), noise),
        None => part,
    }
}

/// What explains all, with the weights and steps that it asks for; none where it leaves more than noise then.
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

/// One law in the place of the best single effect, or beside it where that is not needless then. Where much is missing derivatives at the
/// calibration alone point anywhere; the effect, wrong as it may be, has brought the model nearer to what was measured.
fn instead(open: &Problem, found: &Found, say: &dyn Fn(String)) -> Option<Lawful> {
    if found.best.model.effects.is_empty() {
        return None;
    }
    let proposals = propose(open, &found.best, Reach::Plain, say)?;
    let (best, forms) = equally_good(open, &proposals.fits, found.best.cost)?;
    let (best, forms) = without_idle(open, best, forms);
    Some(Lawful { best, forms })
}

/// Whether a fit with a law is clearly better than what was found, and predicts better what it was not fitted to. Beside what the
/// catalogue explains a law must predict whole runs left out better than that does by itself.
pub(super) fn is_clearly_better(open: &Problem, found: &Found, lawful: &Fit) -> bool {
    let criterion = Criterion::of(open, [&found.best, lawful]);
    let predicts = || match found.best.model.effects.is_empty() {
        true => cross_validates(open, &found.baseline, lawful),
        false => cross_validates_runs(open, &found.best, lawful),
    };
    criterion.at(lawful) < criterion.at(&found.best) - CLEARLY && predicts()
}

impl Lawful {
    /// What was found with the law in its place.
    pub fn beside(self, found: &Found) -> Found {
        let rivals = vec![Vec::new(); self.best.model.effects.len()];
        let found = Found { rivals_against: self.best.cost, best: self.best, rivals, ..found.clone() };
        found.with_last_forms(self.forms)
    }
}

/// What laws make of what was found: one alone or two, or one beside the catalogue's effects, or nothing. `tried`: what one law came to
/// before several effects were tried.
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
    let is_enough = instead
        .as_ref()
        .is_some_and(|l| is_explained(&open, &found.baseline, &l.best) && is_clearly_better(&open, found, &l.best));
    let alone = if is_enough { None } else { search.from(&found.baseline, tried.known) };
    let is_beside = is_open && !is_null && !is_enough && !is_all(&alone);
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

/// The same with weights and steps that the law asks for: the law and the forms beside it are fitted and chosen anew.
pub(in crate::diagnose) fn renew(case: &mut Case, noise: &[Noise], mut found: Found) -> (Found, Vec<Noise>) {
    let former = case.runs.clone();
    let Some(renewed) = reweight::renew(case, noise, &found) else {
        case.runs = former;
        return (found, noise.to_vec());
    };
    let open = reweight::open_runs(case, &renewed.noise);
    let again = found.forms.last().map_or(&[][..], Vec::as_slice).par_iter().filter_map(|f| open.fit(&f.model, &f.x));
    let mut fits: Vec<Fit> = again.collect();
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

/// Whether a fit leaves so little of the misfit that no further law is looked for.
fn is_explained(open: &Problem, baseline: &Fit, fit: &Fit) -> bool {
    let noise = open.noise_cost();
    fit.cost - noise < EXPLAINED * (baseline.cost - noise)
}

/// The search for laws in the place of what was found, or beside it where that leaves more than noise (`is_open`).
struct Search<'a> {
    open: &'a Problem<'a>,
    found: &'a Found,
    is_open: bool,
    say: &'a dyn Fn(String),
}

impl Search<'_> {
    /// Adds laws to a fit; `known` were proposed with other weights.
    fn from(&self, from: &Fit, known: Known) -> Option<Lawful> {
        self.add_laws(from.clone(), None, known)
    }

    /// Goes on from a law that was found with other weights: fitted anew, held against others that do the same, and one more beside it.
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

    /// Adds laws one by one, as long as much is left.
    fn add_laws(&self, mut here: Fit, mut lawful: Option<Lawful>, mut known: Known) -> Option<Lawful> {
        let open = self.open;
        for _ in usize::from(lawful.is_some())..self.most() {
            let is_all = lawful.is_some() && !leaves_something(open, &here);
            if is_explained(open, &self.found.baseline, &here) || is_all || here.model.effects.len() >= MOST_EFFECTS {
                break;
            }
            let begun = if lawful.is_none() { known.plain.take() } else { known.beside(&here) };
            let begun = begun.map(|begun| begun.again(open));
            let Some(mut proposals) = begun.or_else(|| propose(open, &here, Reach::Plain, self.say)) else { break };
            let Some(first) = proposals.fits.first() else { break };
            if lawful.is_none() && leaves_something(open, first) && self.may_be_wider(first) {
                proposals.fits = wider(open, &here, proposals.fits, known.wide.take(), self.say);
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

    /// Laws, at most: in the place of effects that leave nothing fewer than these are, or there is nothing in it.
    fn most(&self) -> usize {
        let fewer = self.found.best.model.effects.len().saturating_sub(1).max(1);
        if self.is_open { MOST_LAWS } else { fewer.min(MOST_LAWS) }
    }

    /// Whether laws that remember or bend otherwise are worth trying. Beside effects that leave nothing they are where the same law
    /// without memory explains nearly all.
    fn may_be_wider(&self, plain: &Fit) -> bool {
        self.is_open || !leaves_much(self.open, &self.found.baseline, plain)
    }
}

/// A fit and its forms without the effects that the law which came last, as it now stands, has made needless.
pub(super) fn without_idle(open: &Problem, mut best: Fit, mut forms: Vec<Fit>) -> (Fit, Vec<Fit>) {
    let without = |fit: &Fit, i: usize| open.fit(&fit.model.without(i), &open.start_without(fit, i));
    let least = least_gain(open.samples());
    loop {
        let others = best.model.effects.len() - 1;
        let fewer: Vec<Option<Fit>> = (0..others).into_par_iter().map(|i| without(&best, i)).collect();
        let idle = fewer.into_iter().enumerate().filter_map(|(i, fit)| Some((i, fit?)));
        let idle = idle.filter(|(_, fit)| fit.cost - best.cost < least).min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        let Some((i, fit)) = idle else { return (best, forms) };
        forms = forms.par_iter().filter_map(|form| without(form, i)).collect();
        best = fit;
    }
}

/// Fits with laws that remember, multiply or bend otherwise in the place of plain ones, where they are clearly better; cheapest first.
fn wider(open: &Problem, from: &Fit, plain: Vec<Fit>, known: Option<Proposals>, say: &dyn Fn(String)) -> Vec<Fit> {
    let wide = known.map(|wide| wide.again(open)).or_else(|| propose(open, from, Reach::Wide, say));
    let Some(wide) = wide else { return plain };
    let criterion = Criterion::of(open, plain.first().into_iter().chain(wide.fits.first()));
    let best = |fits: &[Fit]| fits.iter().map(|f| criterion.at(f)).fold(f64::INFINITY, f64::min);
    if best(&wide.fits) < best(&plain) - CLEARLY { wide.fits } else { plain }
}
