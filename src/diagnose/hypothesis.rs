//! Step 6: what the catalogue does not explain, as terms that regression chooses. A hypothesis, and labelled as one.

use super::answer::Proof;
use super::candidates::hypothetical_variants;
use super::case::{Case, Sealed};
use super::fit::{Fit, Problem};
use super::noise::Noise;
use super::prove::prove;
use super::search::{Found, grow};
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

/// By so much Schwarz's criterion, `chi² + numbers ln(samples)`, must be lower for a hypothesis to stand for what the catalogue names:
/// a thing that the catalogue has is imitated by a term as well as it is explained at best, or worse.
const CLEARLY: f64 = 20.0;

/// A hypothesis of no more numbers that explains the open runs clearly better, and the sealed ones no worse, than what the
/// catalogue offers: then the catalogue only imitates.
fn simpler(
    case: &Case,
    noise: &[Noise],
    found: &Found,
    proof: &Proof,
    seed: u64,
    say: &dyn Fn(String),
) -> Option<(Found, Proof)> {
    let open = Problem { case, runs: case.subset(Sealed::Open), noise };
    if found.best.model.effects.is_empty() {
        return None;
    }
    let (best, renewed) = with_terms(&open, found, &found.baseline, seed, say)?;
    let numbers = |fit: &Fit| fit.model.effect_numbers();
    let criterion = |fit: &Fit| fit.cost + numbers(fit) as f64 * (open.samples() as f64).ln();
    if numbers(&best) > numbers(&found.best) || criterion(&best) > criterion(&found.best) - CLEARLY {
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
