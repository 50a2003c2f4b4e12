//! Step 6: what the catalogue does not explain, as laws that the grammar proposes. They are found on the open runs alone.

use super::answer::Proof;
use super::case::{Case, Sealed};
use super::fit::{Fit, Problem};
use super::noise::Noise;
use super::prove::prove;
use super::refits::foretells;
use super::search::{Found, least_gain};
use super::unlisted::{Located, propose};
use super::verdict::Excess;
use super::without::Step;
use super::{Confirmed, verdict};

/// Laws in one answer, at most.
const MOST_LAWS: usize = 2;
/// Share of the misfit below which no further law is looked for.
const EXPLAINED: f64 = 0.02;
/// By so much the criterion of an answer with a law must be lower than that of an answer of the catalogue alone.
const CLEARLY: f64 = 20.0;
/// Laws are called equally good within so much chi², in units of the dispersion, and within this share of what they explain.
const SAME_CHI2: f64 = 10.0;
const SAME_SHARE: f64 = 5e-4;
/// Forms that an answer names beside its own, at most.
const MOST_FORMS: usize = 4;

/// A model with a law, the others that are as good, and where the misfit sits.
struct Lawful {
    best: Fit,
    forms: Vec<Fit>,
    located: Vec<Located>,
}

/// What laws make of what was found: one alone or two, or one beside the catalogue's effects, or nothing.
pub(super) fn weigh_laws(
    case: &Case,
    noise: &[Noise],
    (found, confirmed): (&Found, Confirmed),
    excess: Excess,
    seed: u64,
    say: &dyn Fn(String),
) -> Option<(Found, Proof)> {
    if case.is_without(Step::OpenSet) {
        return None;
    }
    let open = Problem { case, runs: case.subset(Sealed::Open), noise };
    let is_open = confirmed == Confirmed::InPart || verdict::is_unknown(found, excess);
    let is_doubtful = found.best.model.effects.len() > 1 || leaves_something(&open, found);
    let is_null = found.best.model.effects.is_empty();
    if !is_open && (is_null || !is_doubtful) {
        return None;
    }
    let alone = search(&open, &found.baseline, &found.baseline, say);
    let beside = (is_open && !is_null).then(|| search(&open, &found.baseline, &found.best, say)).flatten();
    let criterion =
        Criterion::of(&open, [Some(&found.best), alone.as_ref().map(|l| &l.best), beside.as_ref().map(|l| &l.best)]);
    let best =
        [alone, beside].into_iter().flatten().min_by(|a, b| criterion.at(&a.best).total_cmp(&criterion.at(&b.best)))?;
    let against = if is_open { &found.baseline } else { &found.best };
    if criterion.at(&best.best) > criterion.at(&found.best) - CLEARLY || !foretells(&open, &found.baseline, &best.best)
    {
        say(format!("{} is no better than {}", best.best.model.title(), against.model.title()));
        return None;
    }
    say(format!("{}: chi2 {:.0} -> {:.0}", best.best.model.title(), found.best.cost, best.best.cost));
    let sealed = Problem { case, runs: case.subset(Sealed::Sealed), noise };
    let proof = prove(&sealed, &found.baseline, &best.best, seed)?;
    let rivals = vec![Vec::new(); best.best.model.effects.len()];
    let located = best.located.iter().map(|l| (l.slot.element(), l.gain)).collect();
    let renewed =
        Found { rivals_against: best.best.cost, best: best.best, rivals, forms: best.forms, located, ..found.clone() };
    Some((renewed, proof))
}

/// Whether the best leaves more than its search would still take up.
fn leaves_something(open: &Problem, found: &Found) -> bool {
    found.best.cost - open.noise_cost() > least_gain(open.samples())
}

/// Adds laws to a fit, one by one, as long as much is left; `baseline` is the calibration alone.
fn search(open: &Problem, baseline: &Fit, from: &Fit, say: &dyn Fn(String)) -> Option<Lawful> {
    let noise = open.noise_cost();
    let mut lawful: Option<Lawful> = None;
    let mut here = from.clone();
    for _ in 0..MOST_LAWS {
        if here.cost - noise < EXPLAINED * (baseline.cost - noise) {
            break;
        }
        let Some(proposals) = propose(open, &here, say) else { break };
        let Some(first) = proposals.fits.first() else { break };
        if here.cost - first.cost < least_gain(open.samples()) {
            break;
        }
        let criterion = Criterion::of(open, [Some(first), None, None]);
        let tie = SAME_CHI2 * criterion.dispersion + SAME_SHARE * (here.cost - first.cost);
        let same: Vec<Fit> = proposals.fits.iter().filter(|f| f.cost <= first.cost + tie).cloned().collect();
        let best = same.iter().min_by(|a, b| criterion.at(a).total_cmp(&criterion.at(b)))?.clone();
        let forms = same.into_iter().filter(|f| f.model.effects != best.model.effects).take(MOST_FORMS).collect();
        here = best.clone();
        let located = lawful.map_or(proposals.located, |l| l.located);
        lawful = Some(Lawful { best, forms, located });
    }
    lawful
}

/// Schwarz's criterion in units of what the best of several models leaves: `chi² / dispersion + numbers ln(samples)`.
pub(super) struct Criterion {
    pub dispersion: f64,
    per_number: f64,
}

impl Criterion {
    fn of(problem: &Problem, fits: [Option<&Fit>; 3]) -> Self {
        let least = fits.into_iter().flatten().map(|f| f.cost).fold(f64::INFINITY, f64::min);
        let dispersion = (least / problem.noise_cost().max(1.0)).max(1.0);
        Self { dispersion, per_number: (problem.samples() as f64).ln() }
    }

    fn at(&self, fit: &Fit) -> f64 {
        fit.cost / self.dispersion + fit.model.effect_numbers() as f64 * self.per_number
    }
}
