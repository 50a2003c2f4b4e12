//! Two causes at once, of which the catalogue lists at most one: a law beside a listed effect, or two laws.

use super::forms::{equally_good, is_clearly_better, leaves_something};
use super::grown::{grown, is_near};
use super::hypothesis::{is_explained, without_idle};
use super::listed::in_place_of;
use super::one_law::renewed;
use super::tried::{Lawful, Tried};
use super::unlisted::{Proposals, propose};
use crate::diagnose::case::{Case, Noise, Optional, RunSet, Step};
use crate::diagnose::fit::{Fit, Problem, Variant};
use crate::diagnose::grammar::Reach;
use crate::diagnose::search::{Found, beside, leaves_much};

/// A partner must explain this share of what the law leaves: each of the two is first fitted as if alone and still
/// explains much.
const LEAST_SHARE: f64 = 1.0 / 3.0;

/// Result of trying two causes.
pub(in crate::diagnose) enum Pair {
    /// A law with its partner explains everything above noise. With the noise estimated from its residual.
    All(Box<Found>, Vec<Noise>),
    /// The laws were surrogates for two effects of the catalogue that leave little: the search continues from there.
    Listed(Fit, Box<Tried>),
    /// Neither.
    Part(Box<Tried>),
}

/// Searches for a law with a partner if the best listed effects leave much. The partner is what does best beside the
/// best single law; the law is then searched anew beside the partner, because alone it had to represent both.
pub(in crate::diagnose) fn pair(
    case: &mut Case,
    noise: &[Noise],
    (found, variants): (&Found, &[Variant]),
    mut tried: Tried,
    say: &dyn Fn(String),
) -> Pair {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let first = tried.known.first().cloned();
    // Where effects leave little, a further one or their idealised laws are what is missing, and a law could imitate them.
    let is_asked = !case.is_without(Step::OpenSet) && leaves_much(&open, &found.baseline, &found.best);
    let is_asked = is_asked && !tried.is_enough(&open, &found.baseline);
    let Some(law) = first.filter(|_| is_asked && leaves_something(&open, &found.best)) else {
        return Pair::Part(Box::new(tried));
    };
    if !case.effort.allows(Optional::WiderLaws) {
        return Pair::Part(Box::new(tried));
    }
    // One law that remembers or depends on two variables is simpler than two things.
    tried.known.wide = wide(&open, &found.baseline, &law, say);
    // A bend of what a channel shows imitates anything that is still: a law in the rig comes before it.
    let bent =
        || propose(&open, &found.baseline, Reach::Channels, say).and_then(|bent| explains_all(&open, found, &bent));
    let single = tried.known.wide.as_ref().and_then(|wide| explains_all(&open, found, wide)).or_else(bent);
    if let Some(lawful) = single
        && let Some((found, noise)) = renewed(case, noise, lawful.beside(found), say)
    {
        return Pair::All(Box::new(found), noise);
    }
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    // What one law leaves may be too little for a second one, which would take the first one's place.
    if let Some(one) = tried.known.wide.as_ref().and_then(|wide| nearly_all(&open, found, wide)) {
        let is_enough = is_explained(&open, &found.baseline, &one.best);
        tried.takes(one, is_enough);
        if is_enough {
            return Pair::Part(Box::new(tried));
        }
    }
    if !case.effort.allows(Optional::SecondLaw) {
        return Pair::Part(Box::new(tried));
    }
    let second = propose(&open, &law, Reach::Plain, say);
    let lawful = with_partner(&open, (&found.baseline, &law), (second.as_ref(), variants), say);
    tried.known.second = second.map(|second| (law.model.effects.clone(), second));
    let Some(lawful) = lawful else { return Pair::Part(Box::new(tried)) };
    if !lawful.best.model.effects.iter().any(|e| e.entry.hypothetical) {
        let is_lower = lawful.best.cost < found.best.cost;
        return if is_lower { Pair::Listed(lawful.best, Box::new(tried)) } else { Pair::Part(Box::new(tried)) };
    }
    let is_better = is_clearly_better(&open, found, &lawful.best);
    let is_all = is_better && !leaves_something(&open, &lawful.best);
    if is_all && let Some((found, noise)) = renewed(case, noise, lawful.clone().beside(found), say) {
        return Pair::All(Box::new(found), noise);
    }
    tried.takes(lawful, is_better);
    Pair::Part(Box::new(tried))
}

/// Laws that remember or depend on two variables: what the best simple law grows into, if that is all there is to it, or any.
fn wide(open: &Problem, baseline: &Fit, simple: &Fit, say: &dyn Fn(String)) -> Option<Proposals> {
    let near = Some(simple).filter(|simple| is_near(open, simple, baseline.cost));
    let mut fits = near.map_or_else(Vec::new, |simple| grown(open, simple, baseline.cost));
    if let Some(best) = fits.first() {
        say(format!(
            "{} grows into {}: chi2 {:.0} -> {:.0}",
            simple.model.title(),
            best.model.title(),
            simple.cost,
            best.cost
        ));
        if !leaves_something(open, best) {
            return Some(Proposals { fits, curve: None });
        }
    }
    fits.extend(propose(open, baseline, Reach::Wide, say).into_iter().flat_map(|own| own.fits));
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    (!fits.is_empty()).then_some(Proposals { fits, curve: None })
}

/// The best proposal, if it leaves nothing above noise and is clearly better than the answer.
fn explains_all(open: &Problem, found: &Found, proposals: &Proposals) -> Option<Lawful> {
    let (best, forms) = equally_good(open, &proposals.fits, found.baseline.cost)?;
    let is_all = !leaves_something(open, &best) && is_clearly_better(open, found, &best);
    is_all.then_some(Lawful { best, forms })
}

/// The best proposal, if it leaves little and is clearly better than the answer.
fn nearly_all(open: &Problem, found: &Found, proposals: &Proposals) -> Option<Lawful> {
    let (best, forms) = equally_good(open, &proposals.fits, found.baseline.cost)?;
    let is_nearly = !leaves_much(open, &found.baseline, &best) && is_clearly_better(open, found, &best);
    is_nearly.then_some(Lawful { best, forms })
}

/// Replaces one of two laws by an effect of the catalogue if that leaves little.
fn listed_instead(open: &Problem, baseline: &Fit, two: &Fit, variants: &[Variant]) -> Option<Fit> {
    if two.model.effects.len() != 2 {
        return None;
    }
    let listed = |i: usize| in_place_of(open, baseline, (two, i), variants);
    let other = |i: usize| listed(i).filter(|listed| !leaves_much(open, baseline, listed));
    let laws = (0..2).filter(|&i| two.model.effects[i].entry.hypothetical);
    laws.filter_map(other).min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// Moves the law behind the listed effect: alternatives belong to the last effect.
fn law_last(fit: &Fit) -> Option<Fit> {
    let [law, listed] = &fit.model.effects[..] else { return None };
    (law.entry.hypothetical && !listed.entry.hypothetical).then(|| fit.with_last(0))
}

/// A law that leaves much, with its best partner. `None` if the partner does little.
fn with_partner(
    open: &Problem,
    (baseline, law): (&Fit, &Fit),
    (second, variants): (Option<&Proposals>, &[Variant]),
    say: &dyn Fn(String),
) -> Option<Lawful> {
    let listed = beside(open, law, variants).into_iter().next();
    let second = second.and_then(|second| second.fits.first()).cloned();
    let both = listed.into_iter().chain(second).min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    say(format!("{}: chi2 {:.0} -> {:.0}", both.model.title(), law.cost, both.cost));
    if law.cost - both.cost < LEAST_SHARE * (law.cost - open.noise_cost()) {
        return None;
    }
    let partner = open.fit(&both.model.without(0), &open.start_without(&both, 0))?;
    let proposals = propose(open, &partner, Reach::Plain, say)?;
    let (best, forms) = equally_good(open, &proposals.fits, partner.cost)?;
    let (best, forms) = if best.cost < both.cost { (best, forms) } else { (both, Vec::new()) };
    let (best, forms) = without_idle(open, best, forms);
    let mut listed = listed_instead(open, baseline, &best, variants);
    // One law may have stood before the other: the other may stand for an effect as well.
    if let Some(again) = listed.as_ref().and_then(|listed| listed_instead(open, baseline, listed, variants)) {
        listed = Some(again);
    }
    let (best, forms) = listed.map_or((best, forms), |listed| (listed, Vec::new()));
    let (best, forms) = law_last(&best).map_or((best, forms), |fit| (fit, Vec::new()));
    say(format!("{}: chi2 {:.0}", best.model.title(), best.cost));
    Some(Lawful { best, forms })
}
