//! Candidates for one more effect: selection, joint refits, and the order in which they may win.

use super::screening::{Screened, Screening, least_gain, screen, start_values};
use crate::diagnose::case::Step;
use crate::diagnose::fit::{Fit, Placed, Problem, Sides, Variant};
use crate::parallel;

/// Maximum number of candidates refitted at every stage.
const REFITTED: usize = 10;
/// Maximum number converged, if they come within this share of the best's gain.
const FINISHED: usize = 4;
const NEAR: f64 = 0.1;
/// Candidates with less than this share of the best promise are skipped.
const WORTH: f64 = 0.1;
/// Maximum number of candidates that the calibration may have absorbed.
const MOST_ABSORBED: usize = 2;
/// A different effect must beat a further branch of the same by this share of the explained misfit.
pub(super) const BRANCH_TIE: f64 = 0.02;

/// Which absorbed effects are tried. Their fits start at the scene's calibration and are the most expensive ones.
#[derive(Clone, Copy)]
pub(super) enum Absorbed<'a> {
    Any,
    /// Those among these.
    Among(&'a [Placed]),
}

/// Candidates worth a refit: the most promising variant of every effect, and some that the calibration may have
/// absorbed.
pub(super) fn pick(screened: &[Screened], least: f64, absorbed: Absorbed) -> Vec<Screened> {
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
    picked.extend(absorbed_ones(screened, absorbed));
    picked
}

/// Effects absorbed by the calibration, the most visible first. Their signatures are no guide: at another calibration
/// they may explain more than all others.
fn absorbed_ones(screened: &[Screened], which: Absorbed) -> Vec<Screened> {
    let is_tried = |s: &&Screened| match which {
        Absorbed::Any => s.is_absorbed,
        Absorbed::Among(known) => s.is_absorbed && known.contains(&s.variant.placed),
    };
    let mut absorbed: Vec<&Screened> = screened.iter().filter(is_tried).collect();
    absorbed.sort_by(|a, b| a.typical_over_least().total_cmp(&b.typical_over_least()).reverse());
    absorbed.into_iter().take(MOST_ABSORBED).cloned().collect()
}

/// Joint refits with each candidate added, best first; of several starts of one effect, the better. All are fitted
/// roughly; those near the best are converged.
pub(super) fn refit(problem: &Problem, screening: &Screening, candidates: &[Screened]) -> Vec<Fit> {
    finished(problem, screening, rough(problem, screening, candidates))
}

/// Rough refits with each candidate added, the better of several starts of one effect, cheapest first.
fn rough(problem: &Problem, screening: &Screening, candidates: &[Screened]) -> Vec<Fit> {
    best_of_each(parallel::map(candidates, |s| add(problem, screening, s)).into_iter().flatten().collect())
}

/// Converges those near the best.
fn finished(problem: &Problem, screening: &Screening, rough: Vec<Fit>) -> Vec<Fit> {
    let Some(best) = rough.first().map(|f| f.cost) else { return rough };
    let near = best + NEAR * (screening.from.cost - best).max(0.0) + 10.0;
    let close = rough.iter().take_while(|f| f.cost <= near).count().min(FINISHED);
    let finished: Vec<Option<Fit>> = parallel::map(&rough[..close], |f| problem.fit(&f.model, &f.x));
    let mut fits: Vec<Fit> = finished.into_iter().flatten().chain(rough[close..].iter().cloned()).collect();
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    fits
}

/// The best effects beside a fit, refitted jointly; cheapest first.
pub(in crate::diagnose) fn beside(problem: &Problem, fit: &Fit, variants: &[Variant]) -> Vec<Fit> {
    below(problem, fit, variants, f64::INFINITY)
}

/// Those whose rough fits leave no more than `most`.
pub(in crate::diagnose) fn below(problem: &Problem, fit: &Fit, variants: &[Variant], most: f64) -> Vec<Fit> {
    let Some(screening) = screen(problem, fit, variants) else { return Vec::new() };
    let picked = pick(&screening.screened, least_gain(problem.samples()), Absorbed::Any);
    let mut rough = rough(problem, &screening, &picked);
    rough.retain(|fit| fit.cost <= most);
    finished(problem, &screening, rough)
}

/// Refits the ones near the best from the scene's calibration as well, if the best gains by that; mostly it does not.
pub(super) fn afresh(problem: &Problem, refits: Vec<Fit>) -> Vec<Fit> {
    let again = |f: &Fit| problem.fit_afresh(f);
    let Some(best) = refits.first().and_then(again) else { return refits };
    let others: Vec<Option<Fit>> = parallel::map(&refits[1..refits.len().min(FINISHED)], again);
    let mut fits = refits;
    fits[0] = best;
    for (fit, other) in fits[1..].iter_mut().zip(others) {
        *fit = other.unwrap_or_else(|| fit.clone());
    }
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

/// A rough fit with one effect more; the Jacobian is that of the fit it starts from, extended by the effect's
/// parameters.
fn add(problem: &Problem, screening: &Screening, candidate: &Screened) -> Option<Fit> {
    let (from, values) = (&screening.from, start_values(candidate));
    let model = from.model.plus(&candidate.variant.placed, &values);
    let mut start = from.x.clone();
    start.extend(model.numbers.last()?.fitted.iter().map(|&i| values[i]));
    if candidate.is_absorbed {
        // Where the calibration stands the effect is not wanted: it begins where the scene has it.
        let calibrated = problem.case.parameters.iter().map(|p| p.start);
        start.iter_mut().zip(calibrated).for_each(|(x, scene)| *x = scene);
        let jacobian = problem.rows(&model, &start, 0..start.len(), Sides::One)?.jacobian;
        return problem.fit_roughly(&model, &start, jacobian);
    }
    let own = problem.rows(&model, &start, from.x.len()..start.len(), Sides::One)?.jacobian;
    let mut jacobian = screening.jacobian.clone().resize_horizontally(start.len(), 0.0);
    jacobian.columns_mut(from.x.len(), own.ncols()).copy_from(&own);
    problem.fit_roughly(&model, &start, jacobian)
}

/// Refits that may win, in order: the simplest of the best, then those near it.
pub(super) fn candidates<'a>(refits: &'a [Fit], before: &Fit, baseline_cost: f64) -> Vec<&'a Fit> {
    let Some(first) = simplest(refits, before, baseline_cost) else { return Vec::new() };
    let near = before.cost - NEARLY_AS_GOOD * (before.cost - first.cost);
    let others = refits.iter().filter(|f| f.cost < near && f.model != first.model);
    std::iter::once(first).chain(others.take(FINISHED)).collect()
}

/// Another refit may win if it has this share of the best's gain.
const NEARLY_AS_GOOD: f64 = 0.5;

pub(super) fn first_that_cross_validates<'a>(
    problem: &Problem,
    before: &Fit,
    fits: impl Iterator<Item = &'a Fit>,
    say: &dyn Fn(String),
) -> Option<&'a Fit> {
    for fit in fits {
        if cross_validates(problem, before, fit) {
            return Some(fit);
        }
        say(format!("{}: does not predict runs it was not fitted to", fit.model.title()));
    }
    None
}

/// Whether a fit only adds a further branch to an effect.
pub(super) fn adds_branch(before: &Fit, after: &Fit) -> bool {
    after.model.effects.last().is_some_and(|e| before.model.effects.contains(e))
}

/// The cheapest fit; among nearly equal ones, that which only adds a branch to an effect already named.
fn simplest<'a>(refits: &'a [Fit], before: &Fit, baseline_cost: f64) -> Option<&'a Fit> {
    let cheapest = refits.first()?;
    let tie = cheapest.cost + BRANCH_TIE * (baseline_cost - cheapest.cost).max(0.0);
    refits.iter().take_while(|f| f.cost <= tie).find(|f| adds_branch(before, f)).or(Some(cheapest))
}

/// Share of its gain that an effect must predict on left-out halves of runs if it does not predict whole runs.
const PREDICTED: f64 = 0.5;

/// Whether a model predicts each run, fitted to the others, better than the simpler one. A single run is cut in two.
///
/// If the other runs determine an effect poorly, it extrapolates too far. Then it must predict halves of runs, with all
/// others known, and much better.
pub(in crate::diagnose) fn cross_validates(problem: &Problem, before: &Fit, after: &Fit) -> bool {
    cross_validates_runs(problem, before, after) || cross_validates_halves(problem, before, after)
}

/// Whether a model predicts left-out halves of runs much better than the simpler one.
pub(in crate::diagnose) fn cross_validates_halves(problem: &Problem, before: &Fit, after: &Fit) -> bool {
    gain_left_out(problem.halves_left_out(), before, after) > PREDICTED * (before.cost - after.cost)
}

/// Whether a model predicts whole left-out runs better than another. A single run is cut in two.
pub(in crate::diagnose) fn cross_validates_runs(problem: &Problem, before: &Fit, after: &Fit) -> bool {
    problem.case.is_without(Step::CrossValidation) || gain_left_out(problem.runs_left_out(), before, after) > 0.0
}

/// Reduction of chi² on left-out data.
fn gain_left_out(folds: Vec<(Problem, Problem)>, before: &Fit, after: &Fit) -> f64 {
    // A fold on which the model before cannot be played says nothing; one on which that with more in it cannot is not predicted.
    let gain = |(rest, left_out): (Problem, Problem)| -> f64 {
        let cost = |fit: &Fit| {
            let jacobian = rest.rows(&fit.model, &fit.x, 0..fit.x.len(), Sides::One)?.jacobian;
            let fitted = rest.fit_roughly(&fit.model, &fit.x, jacobian)?;
            left_out.cost_at(&fit.model, &fitted.x)
        };
        cost(before).map_or(0.0, |was| was - cost(after).unwrap_or(f64::INFINITY))
    };
    folds.into_iter().map(gain).sum()
}
