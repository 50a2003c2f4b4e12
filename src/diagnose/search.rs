//! Which effects explain the recordings: screening by signature, joint refits, additions, swaps, deletions.

use super::candidates::Variant;
use super::fit::{Fit, Problem};
use super::model::{Model, Placed};
use super::refits::{BRANCH_TIE, adds_branch, candidates, first_that_foretells, foretells, pick, refit};
use super::screening::{Screened, Screening, screen};

/// At most this many effects in one answer.
const MOST_EFFECTS: usize = 4;
/// Share of an effect in chi² per sample below which it is not called missing physics.
const LEAST_SHARE: f64 = 2e-3;
/// Least gain in chi² of an effect: about five sigma after looking at forty candidates.
const LEAST_GAIN: f64 = 35.0;

/// Share of all that is explained below which one more effect may be no more than the others' laws being idealised.
const LEAST_OF_ALL: f64 = 1e-3;

/// One more effect explains this share of all that is explained, or that share of what was left over: laws that are
/// idealised leave something that others imitate in part.
const FAIR_OF_ALL: f64 = 0.03;
const FAIR_OF_LEFT: f64 = 0.75;

/// Fall of chi² that makes an effect worth naming, for so many samples.
pub fn least_gain(samples: usize) -> f64 {
    LEAST_GAIN.max(LEAST_SHARE * samples as f64)
}

/// A model with the rivals that were refitted beside it.
#[derive(Clone, Debug)]
pub struct Found {
    pub baseline: Fit,
    pub best: Fit,
    /// For each effect of the best: the other effects tried in its place, refitted jointly; cheapest first.
    pub rivals: Vec<Vec<Fit>>,
    /// What the baseline's residual promised of every effect.
    pub screened: Vec<Screened>,
}

/// Searches from `start`: the baseline, or what a former search has found.
///
/// The way up is greedy. Where it ends with much left over it may have begun with the wrong effect: then the next best
/// beginnings are tried as well.
pub(super) fn search(
    problem: &Problem,
    baseline: Fit,
    start: Fit,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> Found {
    let screening = screen(problem, &baseline, variants);
    let screened = screening.as_ref().map_or_else(Vec::new, |s| s.screened.clone());
    let is_new = start.model.effects.is_empty();
    let (start, rivals) = match is_new {
        true => (start, Vec::new()),
        false => settle(problem, start, variants, least_gain(problem.samples()), say),
    };
    let way = match is_new {
        true => Way { best: start, rivals, first: Vec::new(), screening },
        false => Way::from(problem, start, rivals, variants),
    };
    let mut seen = Seen::default();
    let mut found = climb(problem, &baseline, way, variants, &mut seen, say);
    if is_new && found.best.model.effects.len() > 1 && leaves_much(problem, &baseline, &found.best) {
        for (other, rivals) in other_beginnings(problem, &baseline, &found.first, variants) {
            if !leaves_much(problem, &baseline, &found.best) {
                break;
            }
            if !seen.is_new(&other) {
                continue;
            }
            say(format!("once more, beginning with {}", other.model.title()));
            let way = Way::from(problem, other, rivals, variants);
            let way = climb(problem, &baseline, way, variants, &mut seen, say);
            if way.best.cost < found.best.cost - least_gain(problem.samples()) {
                (found.best, found.rivals) = (way.best, way.rivals);
            }
        }
    }
    Found { baseline, best: found.best, rivals: found.rivals, screened }
}

/// Beginnings other than the best that are tried, and the share of its gain that makes one worth it.
const BEGINNINGS: usize = 2;
const BEGINNING_WORTH: f64 = 0.3;
/// Share of the misfit that is much.
const MUCH: f64 = 0.05;

/// The next best fits with one effect, each effect once: as they are, and settled, with the rivals of that.
fn other_beginnings(
    problem: &Problem,
    baseline: &Fit,
    first: &[Fit],
    variants: &[Variant],
) -> Vec<(Fit, Vec<Vec<Fit>>)> {
    let worth = baseline.cost - BEGINNING_WORTH * (baseline.cost - first.first().map_or(0.0, |f| f.cost));
    let mut seen: Vec<String> = first.first().map(|f| f.model.title()).into_iter().collect();
    let mut others = Vec::new();
    for fit in first.iter().filter(|f| f.cost < worth) {
        if others.len() < 2 * BEGINNINGS && !seen.contains(&fit.model.title()) {
            seen.push(fit.model.title());
            others.push((fit.clone(), Vec::new()));
            others.push(settle(problem, fit.clone(), variants, least_gain(problem.samples()), &|_| {}));
        }
    }
    others
}

fn leaves_much(problem: &Problem, baseline: &Fit, best: &Fit) -> bool {
    let noise = problem.noise_cost();
    best.cost - noise > MUCH * (baseline.cost - noise) && best.cost - noise > least_gain(problem.samples())
}

/// One greedy way up.
struct Way {
    best: Fit,
    rivals: Vec<Vec<Fit>>,
    /// The refits with one effect, cheapest first, if it began with none.
    first: Vec<Fit>,
    /// What the effects promise at `best`.
    screening: Option<Screening>,
}

impl Way {
    fn from(problem: &Problem, start: Fit, rivals: Vec<Vec<Fit>>, variants: &[Variant]) -> Self {
        let mut way = Self { best: start, rivals, first: Vec::new(), screening: None };
        way.look_around(problem, variants);
        way
    }

    /// Screens where the way stands, if it may go on.
    fn look_around(&mut self, problem: &Problem, variants: &[Variant]) {
        if self.best.model.effects.len() < MOST_EFFECTS {
            self.screening = screen(problem, &self.best, variants);
        }
    }
}

/// Where the ways of one search have been: another that comes there goes on as they did.
#[derive(Default)]
struct Seen(Vec<(Vec<String>, f64)>);

/// Costs of one model that differ by a smaller share are those of one fit: ways come to it from different sides.
const SAME_COST: f64 = 2e-4;

impl Seen {
    /// Whether no way has been here before, effects in whatever order; from now on one has.
    fn is_new(&mut self, fit: &Fit) -> bool {
        let mut effects: Vec<String> = fit.model.effects.iter().map(Placed::title).collect();
        effects.sort();
        let is_here =
            |(other, cost): &(Vec<String>, f64)| *other == effects && (cost - fit.cost).abs() < SAME_COST * fit.cost;
        let is_new = !self.0.iter().any(is_here);
        if is_new {
            self.0.push((effects, fit.cost));
        }
        is_new
    }
}

/// Adds effect by effect, and settles after each, until nothing helps or another way has been there.
fn climb(
    problem: &Problem,
    baseline: &Fit,
    mut way: Way,
    variants: &[Variant],
    seen: &mut Seen,
    say: &dyn Fn(String),
) -> Way {
    while way.best.model.effects.len() < MOST_EFFECTS {
        let best = &way.best;
        let least = least_gain(problem.samples()).max(LEAST_OF_ALL * (baseline.cost - best.cost).max(0.0));
        let Some(screening) = way.screening.take() else { break };
        let refits = refit(problem, &screening, &pick(&screening.screened, least));
        if best.model.effects.is_empty() {
            way.first.clone_from(&refits);
        }
        let worthy = candidates(&refits, best, baseline.cost)
            .into_iter()
            .filter(|f| best.cost - f.cost > least && explains_its_share(problem, baseline.cost, best, f));
        let (next, rivals) = match first_that_foretells(problem, best, worthy, say).cloned() {
            Some(winner) => {
                say(format!("{}: chi2 {:.0} -> {:.0}", winner.model.title(), best.cost, winner.cost));
                if winner.model.effects.len() > 1 {
                    settle(problem, winner, variants, least, say)
                } else {
                    let rivals = refits.into_iter().filter(|f| f.model != winner.model).collect();
                    (winner, vec![rivals])
                }
            }
            None => {
                let Some((next, rivals)) = several_at_once(problem, best, &refits, variants, least) else { break };
                say(format!("together {}: chi2 {:.0} -> {:.0}", next.model.title(), best.cost, next.cost));
                (next, rivals)
            }
        };
        (way.best, way.rivals) = (next, rivals);
        if !seen.is_new(&way.best) {
            break;
        }
        way.look_around(problem, variants);
    }
    way
}

/// Share of what is left over that several effects together must explain where none does its share by itself: nearly all of it, which
/// effects that only imitate another's idealised law do not.
const TOGETHER: f64 = 0.9;
/// Misfit per sample, in units of the noise's variance, from which it is worth looking for several at once.
const MUCH_PER_SAMPLE: f64 = 0.3;

/// Two effects or more that explain together what is left over, where none of them does its share by itself: the first that was found
/// may stand for another, and then each of the others alone changes little. `None` if they do not, or not on runs left out.
fn several_at_once(
    problem: &Problem,
    before: &Fit,
    refits: &[Fit],
    variants: &[Variant],
    least: f64,
) -> Option<(Fit, Vec<Vec<Fit>>)> {
    let left = before.cost - problem.noise_cost();
    if left < MUCH_PER_SAMPLE * problem.samples() as f64 {
        return None;
    }
    let mut best = refits.first().filter(|f| before.cost - f.cost > least)?.clone();
    loop {
        let (settled, rivals) = settle(problem, best, variants, least, &|_| {});
        best = settled;
        if before.cost - best.cost > TOGETHER * left {
            return foretells(problem, before, &best).then_some((best, rivals));
        }
        if best.model.effects.len() >= MOST_EFFECTS {
            return None;
        }
        let screening = screen(problem, &best, variants)?;
        let refits = refit(problem, &screening, &pick(&screening.screened, least));
        best = refits.into_iter().next().filter(|f| best.cost - f.cost > least)?;
    }
}

/// What was found with another best model, and the rivals of that.
pub(super) fn settled(problem: &Problem, found: Found, best: Fit, variants: &[Variant], say: &dyn Fn(String)) -> Found {
    let (best, rivals) = settle(problem, best, variants, least_gain(problem.samples()), say);
    Found { best, rivals, ..found }
}

/// Whether what one more effect explains is more than what another's idealised law may leave over.
fn explains_its_share(problem: &Problem, baseline_cost: f64, before: &Fit, after: &Fit) -> bool {
    let (gain, all) = (before.cost - after.cost, baseline_cost - after.cost);
    let left = before.cost - problem.noise_cost();
    adds_branch(before, after) || gain > FAIR_OF_ALL * all || gain > FAIR_OF_LEFT * left
}

/// Most terms of a hypothesis.
const MOST_TERMS: usize = 3;

/// Adds the best variants one by one, nothing else changed. `None` when none is worth it.
pub(super) fn grow(
    problem: &Problem,
    baseline: &Fit,
    from: &Fit,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> Option<Fit> {
    let mut best = from.clone();
    for _ in 0..MOST_TERMS {
        let least = least_gain(problem.samples()).max(LEAST_OF_ALL * (baseline.cost - best.cost).max(0.0));
        let screening = screen(problem, &best, variants)?;
        let refits = refit(problem, &screening, &pick(&screening.screened, least));
        let winner = refits.first().filter(|f| best.cost - f.cost > least && foretells(problem, &best, f));
        let Some(winner) = winner else { break };
        say(format!("{}: chi2 {:.0} -> {:.0}", winner.model.title(), best.cost, winner.cost));
        best = winner.clone();
    }
    (best.model != from.model).then_some(best)
}

/// Leaves out effects that others have made needless and puts better ones in their place, until neither helps.
/// Returns with it, for each effect, the others tried in its place.
fn settle(
    problem: &Problem,
    mut best: Fit,
    variants: &[Variant],
    least: f64,
    say: &dyn Fn(String),
) -> (Fit, Vec<Vec<Fit>>) {
    let mut rivals: Vec<Vec<Fit>> = Vec::new();
    while rivals.len() < best.model.effects.len() {
        let index = rivals.len();
        let start = problem.start_without(&best, index);
        let Some(fewer) = problem.fit(&best.model.without(index), &start) else {
            rivals.push(Vec::new());
            continue;
        };
        let refits = screen(problem, &fewer, variants).map_or_else(Vec::new, |screening| {
            let mut others = pick(&screening.screened, least);
            // What stands there already would only be found again.
            others.retain(|s| s.variant.placed != best.model.effects[index]);
            refit(problem, &screening, &others)
        });
        let margin = 1.0 + if has_branches(&best.model) { BRANCH_TIE * (fewer.cost - best.cost).max(0.0) } else { 0.0 };
        let better = match refits.first().filter(|f| f.cost < best.cost - margin) {
            _ if fewer.cost - best.cost < least => fewer,
            Some(other) => other.clone(),
            None => {
                rivals.push(refits);
                continue;
            }
        };
        say(format!("rather {}: chi2 {:.0} -> {:.0}", better.model.title(), best.cost, better.cost));
        best = better;
        rivals.clear();
    }
    (best, rivals)
}

/// Whether an effect stands there with more than one branch.
fn has_branches(model: &Model) -> bool {
    model.effects.iter().enumerate().any(|(i, e)| model.effects[..i].contains(e))
}
