//! Which effects explain the recordings: screening by signature, joint refits, additions, swaps, deletions.

use rayon::prelude::*;

use super::candidates::Variant;
use super::fit::{Fit, Problem};
use super::model::{Model, Placed, Sides};
use super::screening::{Screened, Screening, screen, start_values};
use super::without::Step;

/// At most this many effects in one answer.
const MOST_EFFECTS: usize = 4;
/// Candidates that are refitted in full at every stage.
const REFITTED: usize = 10;
/// Of those, at most so many to the end, when they come within this share of the best's gain.
const FINISHED: usize = 4;
const NEAR: f64 = 0.1;
/// Candidates that promise less than this share of the best are not refitted.
const WORTH: f64 = 0.1;
/// Share of an effect in chi² per sample below which it is not called missing physics.
const LEAST_SHARE: f64 = 2e-3;
/// Least gain in chi² of an effect: about five sigma after looking at forty candidates.
const LEAST_GAIN: f64 = 35.0;

/// Share of all that is explained below which one more effect may be no more than the others' laws being idealised.
const LEAST_OF_ALL: f64 = 1e-3;

/// One more effect explains this share of all that is explained, or that share of what was left over: laws that are
/// idealised leave something that others imitate in part.
const FAIR_OF_ALL: f64 = 0.03;
const FAIR_OF_LEFT: f64 = 0.5;

/// Share of all that is explained by which a fit with another effect must beat one with a further branch of the same.
const BRANCH_TIE: f64 = 0.02;

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
    let mut found = climb(problem, &baseline, way, variants, say);
    if is_new && found.best.model.effects.len() > 1 && leaves_much(problem, &baseline, &found.best) {
        for (other, rivals) in other_beginnings(problem, &baseline, &found.first, variants) {
            say(format!("once more, beginning with {}", title(&other.model)));
            let way = climb(problem, &baseline, Way::from(problem, other, rivals, variants), variants, say);
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
const MUCH: f64 = 0.1;

/// Refits that may win, in the order in which they are asked: the simplest of the best, then what comes near it.
fn candidates<'a>(refits: &'a [Fit], before: &Fit, baseline_cost: f64) -> Vec<&'a Fit> {
    let Some(first) = simplest(refits, before, baseline_cost) else { return Vec::new() };
    let near = before.cost - NEARLY_AS_GOOD * (before.cost - first.cost);
    let others = refits.iter().filter(|f| f.cost < near && f.model != first.model);
    std::iter::once(first).chain(others.take(FINISHED)).collect()
}

/// Share of the best's gain from which another refit may stand in for it.
const NEARLY_AS_GOOD: f64 = 0.5;

fn first_that_foretells<'a>(
    problem: &Problem,
    before: &Fit,
    fits: impl Iterator<Item = &'a Fit>,
    say: &dyn Fn(String),
) -> Option<&'a Fit> {
    for fit in fits {
        if foretells(problem, before, fit) {
            return Some(fit);
        }
        say(format!("{}: does not foretell runs it was not fitted to", title(&fit.model)));
    }
    None
}

/// The next best fits with one effect, each effect once: as they are, and settled, with the rivals of that.
fn other_beginnings(
    problem: &Problem,
    baseline: &Fit,
    first: &[Fit],
    variants: &[Variant],
) -> Vec<(Fit, Vec<Vec<Fit>>)> {
    let worth = baseline.cost - BEGINNING_WORTH * (baseline.cost - first.first().map_or(0.0, |f| f.cost));
    let mut seen: Vec<String> = first.first().map(|f| title(&f.model)).into_iter().collect();
    let mut others = Vec::new();
    for fit in first.iter().filter(|f| f.cost < worth) {
        if others.len() < 2 * BEGINNINGS && !seen.contains(&title(&fit.model)) {
            seen.push(title(&fit.model));
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

/// Adds effect by effect, and settles after each.
fn climb(problem: &Problem, baseline: &Fit, mut way: Way, variants: &[Variant], say: &dyn Fn(String)) -> Way {
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
        let Some(winner) = first_that_foretells(problem, best, worthy, say) else { break };
        say(format!("{}: chi2 {:.0} -> {:.0}", title(&winner.model), best.cost, winner.cost));
        let winner = winner.clone();
        way.rivals = vec![refits.into_iter().filter(|f| f.model != winner.model).collect()];
        way.best = winner;
        if way.best.model.effects.len() > 1 {
            (way.best, way.rivals) = settle(problem, way.best, variants, least, say);
        }
        way.look_around(problem, variants);
    }
    way
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

/// Whether a fit only gives an effect that is there already one more branch.
fn adds_branch(before: &Fit, after: &Fit) -> bool {
    after.model.effects.last().is_some_and(|e| before.model.effects.contains(e))
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
        say(format!("{}: chi2 {:.0} -> {:.0}", title(&winner.model), best.cost, winner.cost));
        best = winner.clone();
    }
    (best.model != from.model).then_some(best)
}

/// The cheapest fit; but of nearly equal ones that which only gives an effect already named one more branch.
fn simplest<'a>(refits: &'a [Fit], before: &Fit, baseline_cost: f64) -> Option<&'a Fit> {
    let cheapest = refits.first()?;
    let tie = cheapest.cost + BRANCH_TIE * (baseline_cost - cheapest.cost).max(0.0);
    refits.iter().take_while(|f| f.cost <= tie).find(|f| adds_branch(before, f)).or(Some(cheapest))
}

/// Whether a model predicts each run, fitted to the others, better than the one before it. A single run is cut in two.
fn foretells(problem: &Problem, before: &Fit, after: &Fit) -> bool {
    if problem.case.is_without(Step::CrossValidation) {
        return true;
    }
    let gain = |(rest, left_out): (Problem, Problem)| -> Option<f64> {
        let cost = |fit: &Fit| {
            let slopes = rest.rows(&fit.model, &fit.x, 0..fit.x.len(), Sides::One)?.slopes;
            let fitted = rest.fit_roughly(&fit.model, &fit.x, slopes)?;
            left_out.cost_at(&fit.model, &fitted.x)
        };
        Some(cost(before)? - cost(after)?)
    };
    let folds = problem.folds();
    folds.into_iter().filter_map(gain).sum::<f64>() > 0.0
}

/// The candidates worth a full refit: the most promising of every effect.
fn pick(screened: &[Screened], least: f64) -> Vec<Screened> {
    let mut picked: Vec<Screened> = Vec::new();
    let top = screened.first().map_or(0.0, |s| s.gain);
    for s in screened {
        // A signature at zero size says little of laws with a threshold: they get the benefit of the doubt.
        let promising = s.gain > 0.2 * least && s.gain > WORTH * top;
        if promising && picked.iter().filter(|p| p.variant.placed == s.variant.placed).count() < 2 {
            picked.push(s.clone());
        }
        if picked.len() >= REFITTED {
            break;
        }
    }
    picked
}

/// Joint refits of a model with each candidate added, best first; of several starts of one effect the better. All are
/// fitted roughly; those that come near the best are fitted to the end.
fn refit(problem: &Problem, screening: &Screening, candidates: &[Screened]) -> Vec<Fit> {
    let rough: Vec<Option<Fit>> = candidates.par_iter().map(|s| add(problem, screening, s)).collect();
    let rough = best_of_each(rough.into_iter().flatten().collect());
    let Some(best) = rough.first().map(|f| f.cost) else { return rough };
    let near = best + NEAR * (screening.from.cost - best).max(0.0) + 10.0;
    let close = rough.iter().take_while(|f| f.cost <= near).count().min(FINISHED);
    let finished: Vec<Option<Fit>> = rough[..close].par_iter().map(|f| problem.fit(&f.model, &f.x)).collect();
    let mut fits: Vec<Fit> = finished.into_iter().flatten().chain(rough[close..].iter().cloned()).collect();
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    fits
}

/// The cheapest fit of each effect, cheapest first.
fn best_of_each(mut fits: Vec<Fit>) -> Vec<Fit> {
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut seen: Vec<Placed> = Vec::new();
    fits.retain(|f| {
        let last = f.model.effects.last().cloned();
        let is_new = last.as_ref().is_some_and(|l| !seen.contains(l));
        seen.extend(last);
        is_new
    });
    fits
}

/// A rough fit with one effect more, on the slopes of the fit it starts from and those of the effect's numbers.
fn add(problem: &Problem, screening: &Screening, candidate: &Screened) -> Option<Fit> {
    let (from, values) = (&screening.from, start_values(candidate));
    let model = from.model.plus(&candidate.variant.placed, &values);
    let mut start = from.x.clone();
    start.extend(model.fitted.last()?.iter().map(|&i| values[i]));
    let own = problem.rows(&model, &start, from.x.len()..start.len(), Sides::One)?.slopes;
    let mut slopes = screening.slopes.clone().resize_horizontally(start.len(), 0.0);
    slopes.columns_mut(from.x.len(), own.ncols()).copy_from(&own);
    problem.fit_roughly(&model, &start, slopes)
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
        say(format!("rather {}: chi2 {:.0} -> {:.0}", title(&better.model), best.cost, better.cost));
        best = better;
        rivals.clear();
    }
    (best, rivals)
}

/// Whether an effect stands there with more than one branch.
fn has_branches(model: &Model) -> bool {
    model.effects.iter().enumerate().any(|(i, e)| model.effects[..i].contains(e))
}

/// Effects of a model in words.
pub fn title(model: &Model) -> String {
    if model.effects.is_empty() {
        return "calibration alone".to_owned();
    }
    model.effects.iter().map(Placed::title).collect::<Vec<_>>().join(" + ")
}
