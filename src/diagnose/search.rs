//! Which effects explain the recordings: ways up from the calibration, effect by effect.

use super::candidates::Variant;
use super::fit::{Fit, Problem};
use super::model::Placed;
use super::refits::{Swallowed, adds_branch, afresh, candidates, first_that_foretells, foretells, pick, refit};
use super::screening::{Screened, Screening, screen};
use super::swaps::{Settled, Stage, Swaps, is_same};

/// At most this many effects in one answer.
pub(super) const MOST_EFFECTS: usize = 4;
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
    /// Chi² that the rivals' compares with: the best's beside which they were fitted, before it was given hypothetical terms.
    pub rivals_against: f64,
    /// What the baseline's residual promised of every effect.
    pub screened: Vec<Screened>,
    /// Other shapes and places of the last law that explain as much.
    pub forms: Vec<Fit>,
    /// Elements of the slots that were screened for laws, with the fall of chi² that each promised.
    pub located: Vec<(String, f64)>,
    /// A model that predicts held-out runs worse than the calibration: known, and not put into the scene.
    pub withheld: Option<Fit>,
}

impl Found {
    /// Effects that were worth fitting.
    pub(super) fn known(&self) -> Vec<Placed> {
        let rivals = self.rivals.iter().flatten().filter_map(|f| f.model.effects.last());
        self.best.model.effects.iter().chain(rivals).cloned().collect()
    }
}

/// Searches from `start`: the baseline, or what a former search has found. `known`: effects that one knew.
///
/// The way up is greedy. Where it ends with much left over it may have begun with the wrong effect: then the next best
/// beginnings are tried as well.
pub(super) fn search(
    problem: &Problem,
    baseline: Fit,
    start: Fit,
    variants: &[Variant],
    known: Vec<Placed>,
    say: &dyn Fn(String),
) -> Found {
    let mut swaps = Swaps::new(problem, variants, known);
    let screening = screen(problem, &baseline, variants);
    let screened = screening.as_ref().map_or_else(Vec::new, |s| s.screened.clone());
    let is_new = start.model.effects.is_empty();
    let way = match is_new {
        true => Way { best: start, rivals: Vec::new(), first: Vec::new(), screening },
        false => {
            let settled = swaps.settle(start, least_gain(problem.samples()), None, say);
            Way::from(&swaps, settled)
        }
    };
    let mut seen = Seen::default();
    let mut found = climb(&mut swaps, &baseline, way, &mut seen, say);
    if is_new && found.best.model.effects.len() > 1 && leaves_much(problem, &baseline, &found.best) {
        for other in other_beginnings(&baseline, &found.first, &seen) {
            if !leaves_much(problem, &baseline, &found.best) {
                break;
            }
            if !seen.is_new(&other) {
                continue;
            }
            say(format!("once more, beginning with {}", other.model.title()));
            let way = Way::from(&swaps, Settled { best: other, rivals: Vec::new() });
            let way = climb(&mut swaps, &baseline, way, &mut seen, say);
            if way.best.cost < found.best.cost - least_gain(problem.samples()) {
                (found.best, found.rivals) = (way.best, way.rivals);
            }
        }
    }
    Found {
        baseline,
        rivals_against: found.best.cost,
        best: found.best,
        rivals: found.rivals,
        screened,
        forms: Vec::new(),
        located: Vec::new(),
        withheld: None,
    }
}

/// Beginnings other than the best that are tried, and the share of its gain that makes one worth it.
const BEGINNINGS: usize = 2;
const BEGINNING_WORTH: f64 = 0.3;
/// Share of the misfit that is much.
const MUCH: f64 = 0.05;

/// The best fits with one effect that no way has come by, each effect once.
fn other_beginnings(baseline: &Fit, first: &[Fit], seen: &Seen) -> Vec<Fit> {
    let worth = baseline.cost - BEGINNING_WORTH * (baseline.cost - first.first().map_or(0.0, |f| f.cost));
    let mut others: Vec<Fit> = Vec::new();
    for fit in first.iter().filter(|f| f.cost < worth && !seen.contains(f)) {
        if others.iter().all(|other| other.model.title() != fit.model.title()) {
            others.push(fit.clone());
        }
    }
    others.truncate(BEGINNINGS);
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
    fn from(swaps: &Swaps, start: Settled) -> Self {
        let mut way = Self { best: start.best, rivals: start.rivals, first: Vec::new(), screening: None };
        way.look_around(swaps);
        way
    }

    /// Screens where the way stands, if it may go on.
    fn look_around(&mut self, swaps: &Swaps) {
        if self.best.model.effects.len() < MOST_EFFECTS {
            self.screening = screen(swaps.problem, &self.best, swaps.variants);
        }
    }
}

/// Where the ways of one search have been: another that comes there goes on as they did.
#[derive(Default)]
struct Seen(Vec<Fit>);

impl Seen {
    fn contains(&self, fit: &Fit) -> bool {
        self.0.iter().any(|other| is_same(other, fit))
    }

    /// Whether no way has been here before; from now on one has.
    fn is_new(&mut self, fit: &Fit) -> bool {
        let is_new = !self.contains(fit);
        if is_new {
            self.0.push(fit.clone());
        }
        is_new
    }
}

/// Adds effect by effect, and settles after each, until nothing helps or another way has been there.
fn climb(swaps: &mut Swaps, baseline: &Fit, mut way: Way, seen: &mut Seen, say: &dyn Fn(String)) -> Way {
    let problem = swaps.problem;
    while way.best.model.effects.len() < MOST_EFFECTS {
        let best = &way.best;
        let least = least_gain(problem.samples()).max(LEAST_OF_ALL * (baseline.cost - best.cost).max(0.0));
        let Some(screening) = way.screening.take() else { break };
        let refits = refit(problem, &screening, &pick(&screening.screened, least, Swallowed::Any));
        let refits = afresh(problem, refits);
        if best.model.effects.is_empty() {
            way.first.clone_from(&refits);
        }
        let worthy = candidates(&refits, best, baseline.cost)
            .into_iter()
            .filter(|f| best.cost - f.cost > least && explains_its_share(problem, baseline.cost, best, f));
        swaps.keep_in_mind(best, &refits, least);
        let next = match first_that_foretells(problem, best, worthy, say).cloned() {
            Some(winner) => {
                say(format!("{}: chi2 {:.0} -> {:.0}", winner.model.title(), best.cost, winner.cost));
                if winner.model.effects.len() > 1 {
                    let stage = Stage { before: best, refits: &refits };
                    swaps.settle(winner, least, Some(stage), say)
                } else {
                    let rivals = refits.into_iter().filter(|f| f.model != winner.model).collect();
                    Settled { best: winner, rivals: vec![rivals] }
                }
            }
            None => {
                let Some(next) = several_at_once(swaps, best, &refits, least) else { break };
                say(format!("together {}: chi2 {:.0} -> {:.0}", next.best.model.title(), best.cost, next.best.cost));
                next
            }
        };
        (way.best, way.rivals) = (next.best, next.rivals);
        if !seen.is_new(&way.best) {
            break;
        }
        way.look_around(swaps);
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
fn several_at_once(swaps: &mut Swaps, before: &Fit, refits: &[Fit], least: f64) -> Option<Settled> {
    let problem = swaps.problem;
    let left = before.cost - problem.noise_cost();
    if left < MUCH_PER_SAMPLE * problem.samples() as f64 {
        return None;
    }
    let mut best = refits.first().filter(|f| before.cost - f.cost > least)?.clone();
    loop {
        let settled = swaps.settle(best, least, None, &|_| {});
        if before.cost - settled.best.cost > TOGETHER * left {
            return foretells(problem, before, &settled.best).then_some(settled);
        }
        if settled.best.model.effects.len() >= MOST_EFFECTS {
            return None;
        }
        let screening = screen(problem, &settled.best, swaps.variants)?;
        let refits = refit(problem, &screening, &pick(&screening.screened, least, Swallowed::Any));
        best = refits.into_iter().next().filter(|f| settled.best.cost - f.cost > least)?;
    }
}

/// What was found with another best model, and the rivals of that.
pub(super) fn settled(problem: &Problem, found: Found, best: Fit, variants: &[Variant], say: &dyn Fn(String)) -> Found {
    let settled = Swaps::new(problem, variants, found.known()).settle(best, least_gain(problem.samples()), None, say);
    Found { rivals_against: settled.best.cost, best: settled.best, rivals: settled.rivals, ..found }
}

/// Whether what one more effect explains is more than what another's idealised law may leave over.
fn explains_its_share(problem: &Problem, baseline_cost: f64, before: &Fit, after: &Fit) -> bool {
    let (gain, all) = (before.cost - after.cost, baseline_cost - after.cost);
    let left = before.cost - problem.noise_cost();
    adds_branch(before, after) || gain > FAIR_OF_ALL * all || gain > FAIR_OF_LEFT * left
}
