//! Two things at once of which the catalogue holds one or none: a law with a listed effect beside it, or with a second law.

use super::forms::{equally_good, leaves_something};
use super::hypothesis::{Lawful, Tried, is_clearly_better, renewed, without_idle};
use super::unlisted::{Proposals, propose};
use crate::diagnose::case::{Case, Noise, RunSet, Step};
use crate::diagnose::fit::{Fit, Problem, Variant};
use crate::diagnose::grammar::Reach;
use crate::diagnose::search::{Found, beside, leaves_much};

/// Share of what a law leaves that its partner must explain: each of two is fitted as if it were alone at first, and still explains much.
const LEAST_SHARE: f64 = 1.0 / 3.0;

/// What two things make of the recordings.
pub(in crate::diagnose) enum Pair {
    /// A law with its partner explains all that is more than noise. With the noise that it leaves.
    All(Box<Found>, Vec<Noise>),
    /// The laws only stood for two effects of the catalogue that leave little: the search goes on from there.
    Listed(Fit, Box<Tried>),
    /// Neither.
    Part(Box<Tried>),
}

/// Looks for a law with something beside it, where the best listed effects leave much. What does best beside the best single law
/// is its partner; beside that the law is sought anew, since alone it had to stand for both.
pub(in crate::diagnose) fn pair(
    case: &mut Case,
    noise: &[Noise],
    (found, variants): (&Found, &[Variant]),
    mut tried: Tried,
    say: &dyn Fn(String),
) -> Pair {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let first = tried.known.plain.as_ref().and_then(|p| p.fits.first()).cloned();
    // Where two effects leave little, a third or their idealised laws are what is missing, and a law could imitate both.
    let is_asked = !case.is_without(Step::OpenSet) && leaves_much(&open, &found.baseline, &found.best);
    let Some(law) = first.filter(|_| is_asked && leaves_something(&open, &found.best)) else {
        return Pair::Part(Box::new(tried));
    };
    // One law that remembers or depends on two variables is simpler than two things.
    tried.known.wide = propose(&open, &found.baseline, Reach::Wide, say);
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
    let is_nearer = tried.instead.as_ref().is_none_or(|other| lawful.best.cost < other.best.cost);
    if is_all && let Some((found, noise)) = renewed(case, noise, lawful.clone().beside(found), say) {
        return Pair::All(Box::new(found), noise);
    }
    if is_nearer {
        // However many listed effects, they must leave less than this.
        let is_bound = is_better && tried.law.as_ref().is_none_or(|law| lawful.best.cost < law.cost);
        tried.law = if is_bound { Some(lawful.best.clone()) } else { tried.law };
        tried.instead = Some(lawful);
    }
    Pair::Part(Box::new(tried))
}

/// The best of proposals, where it leaves nothing and is clearly better than what was found.
fn explains_all(open: &Problem, found: &Found, proposals: &Proposals) -> Option<Lawful> {
    let (best, forms) = equally_good(open, &proposals.fits, found.baseline.cost)?;
    let is_all = !leaves_something(open, &best) && is_clearly_better(open, found, &best);
    is_all.then_some(Lawful { best, forms })
}

/// Of two things, the same with an effect of the catalogue in the place of a law, where that leaves little. It is sought where the law
/// has brought the model: fitted without it the other two, calibration and partner, would stand for it.
fn listed_instead(open: &Problem, baseline: &Fit, two: &Fit, variants: &[Variant]) -> Option<Fit> {
    if two.model.effects.len() != 2 {
        return None;
    }
    let other = |i: usize| {
        let (model, x) = (two.model.without(i), open.start_without(two, i));
        let cost = open.cost_at(&model, &x)?;
        let bare = Fit { model, x, cost, ..two.clone() };
        beside(open, &bare, variants).into_iter().next().filter(|listed| !leaves_much(open, baseline, listed))
    };
    let laws = (0..2).filter(|&i| two.model.effects[i].entry.hypothetical);
    laws.filter_map(other).min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// The same with the law behind the listed effect, where it stands before it: forms are of the last.
fn law_last(fit: &Fit) -> Option<Fit> {
    let [law, listed] = &fit.model.effects[..] else { return None };
    (law.entry.hypothetical && !listed.entry.hypothetical).then(|| fit.with_last(0))
}

/// A law that leaves much with what does best beside it; none where that does little.
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
