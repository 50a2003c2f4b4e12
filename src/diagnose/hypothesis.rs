//! Step 6: what the catalogue does not explain, as terms that regression chooses. A hypothesis, and labelled as one.

use super::answer::Proof;
use super::candidates::hypothetical_variants;
use super::case::{Case, Sealed};
use super::fit::{Fit, Problem};
use super::noise::Noise;
use super::prove::prove;
use super::search::{Found, grow, least_gain};
use super::verdict::Excess;
use super::without::Step;
use super::{Confirmed, verdict};

/// Share of the gap on sealed runs that the terms must close beyond what was closed without them.
const WORTH: f64 = 0.02;

/// What the hypotheses make of what was found: better with terms added, or replaced by them, or left as it is.
pub(super) fn weigh_hypotheses(
    case: &Case,
    noise: &[Noise],
    (found, proof, confirmed): (&Found, &Proof, Confirmed),
    excess: Excess,
    seed: u64,
    say: &dyn Fn(String),
) -> Option<(Found, Proof)> {
    if case.is_without(Step::OpenSet) {
        return None;
    }
    if confirmed == Confirmed::InPart || verdict::is_unknown(found, excess) {
        hypothesise(case, noise, found, proof, seed, say)
    } else {
        simpler(case, noise, found, proof, seed, say)
    }
}

/// A hypothesis of no more numbers that explains the open runs better, and the sealed ones no worse, than what the
/// catalogue offers: then the catalogue only imitates. Not tried where nothing worth naming is left.
fn simpler(
    case: &Case,
    noise: &[Noise],
    found: &Found,
    proof: &Proof,
    seed: u64,
    say: &dyn Fn(String),
) -> Option<(Found, Proof)> {
    let open = Problem { case, runs: case.subset(Sealed::Open), noise };
    let least = least_gain(open.samples());
    let numbers = found.best.model.effect_numbers();
    if numbers == 0 || found.best.cost < open.noise_cost() + least {
        return None;
    }
    let (best, renewed) = with_terms(&open, found, &found.baseline, seed, say)?;
    if best.model.effect_numbers() > numbers || best.cost > found.best.cost - least {
        return None;
    }
    say(format!("{} imitates, {} explains more with less", found.best.model.title(), best.model.title()));
    let rivals = vec![vec![found.best.clone()]];
    (renewed.gap_closed >= proof.gap_closed).then(|| (Found { best, rivals, ..found.clone() }, renewed))
}

/// Adds terms one by one to what was found, as long as they foretell open runs; kept only if sealed runs gain by them.
fn hypothesise(
    case: &Case,
    noise: &[Noise],
    found: &Found,
    proof: &Proof,
    seed: u64,
    say: &dyn Fn(String),
) -> Option<(Found, Proof)> {
    let open = Problem { case, runs: case.subset(Sealed::Open), noise };
    let (best, renewed) = with_terms(&open, found, &found.best, seed, say)?;
    if renewed.gap_closed < proof.gap_closed + WORTH {
        say("hypothetical terms: gain nothing on the sealed runs, dropped".to_owned());
        return None;
    }
    Some((Found { best, ..found.clone() }, renewed))
}

/// A fit with terms added to it, and what it is worth on sealed runs. `None` when no term is worth it.
fn with_terms(open: &Problem, found: &Found, from: &Fit, seed: u64, say: &dyn Fn(String)) -> Option<(Fit, Proof)> {
    let best = grow(open, &found.baseline, from, &hypothetical_variants(open.case), say)?;
    let sealed = Problem { case: open.case, runs: open.case.subset(Sealed::Sealed), noise: open.noise };
    let proof = prove(&sealed, &found.baseline, &best, seed)?;
    Some((best, proof))
}
