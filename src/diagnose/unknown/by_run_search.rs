//! Looks for what differs from run to run, one thing after another.

use std::collections::BTreeSet;
use std::sync::Arc;

use nalgebra::DMatrix;

use super::forms::{CLEARLY, Criterion, leaves_something};
use crate::diagnose::case::Case;
use crate::diagnose::fit::{Fit, Model, Normal, Problem, Rows, Sides, Variant};
use crate::diagnose::search::Found;
use crate::parallel;

/// Maximum number of things that differ, and of those refitted for each.
const MOST: usize = 3;
const REFITTED: usize = 6;

/// A fit that leaves nothing, and others with something else in the place of the last thing that differs.
pub(super) struct Complete {
    pub best: Fit,
    pub others: Vec<Fit>,
}

impl Complete {
    /// The answer: effects of the catalogue in its place are rivals, constants of the rig other forms.
    pub fn into_answer(self, found: &Found) -> Found {
        let Self { best, others } = self;
        let count = best.model.effects.len();
        let (mut rivals, mut forms) = (vec![Vec::new(); count], vec![Vec::new(); count]);
        let first = count.checked_sub(1).and_then(|last| best.model.of_each_run(last).first().copied());
        let is_law = |fit: &Fit| fit.model.effects.last().is_some_and(|own| own.entry.hypothetical);
        if let Some(first) = first {
            (forms[first], rivals[first]) = others.into_iter().partition(is_law);
        }
        Found { rivals_against: best.cost, best, rivals, forms, ..found.clone() }
    }
}

/// How to look for what differs.
pub(super) struct Search<'a> {
    pub open: &'a Problem<'a>,
    pub candidates: Vec<Variant>,
    /// By derivatives, a number in each run must leave less than this share of the misfit that one for all would leave.
    pub left_share: f64,
    pub say: &'a dyn Fn(String),
}

impl Search<'_> {
    /// Adds one thing after another that differs, until nothing is left. `None` if something is.
    pub fn complete(&self, from: &Fit) -> Option<Complete> {
        let open = self.open;
        let mut fit = from.clone();
        for _ in 0..MOST {
            let mut fits = self.one_more(&fit)?.into_iter();
            let next = fits.next()?;
            (self.say)(format!("different in each run, {}: chi2 {:.0} -> {:.0}", title(&next), fit.cost, next.cost));
            let criterion = Criterion::of(open, [&fit, &next]);
            if criterion.at(&next) > criterion.at(&fit) - CLEARLY {
                return None;
            }
            if !leaves_something(open, &next) {
                return Some(without_idle(open, Complete { best: next, others: fits.collect() }));
            }
            fit = next;
        }
        None
    }

    /// The best fits with one thing more that differs, cheapest first: of all by their derivatives, then of the first few as they are.
    pub fn one_more(&self, fit: &Fit) -> Option<Vec<Fit>> {
        let files = files(self.open.case);
        let starts = starts(self.open, fit, &self.candidates)?;
        let all: Vec<(&Start, &Variant)> =
            starts.iter().flat_map(|s| s.candidates.iter().map(move |v| (s, v))).collect();
        let rules = (self.open, self.left_share);
        let promised = parallel::map(&all, |(start, own)| promised(rules, (&start.fit, &start.known), own, &files));
        let mut promised: Vec<(f64, Fit)> = promised.into_iter().flatten().collect();
        promised.sort_by(|a, b| b.0.total_cmp(&a.0));
        promised.truncate(REFITTED);
        let open = self.open;
        let fits = parallel::map(&promised, |(_, start)| open.fit(&start.model, &start.x));
        let mut fits: Vec<Fit> = fits.into_iter().flatten().collect();
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        Some(fits)
    }
}

/// What derivatives promise of a number in each run, beside all that is fitted already, and where they lead. `None` if one number for all
/// runs promises nearly as much.
fn promised(
    (open, left_share): (&Problem, f64),
    (fit, known): (&Fit, &Rows),
    own: &Variant,
    files: &[Arc<str>],
) -> Option<(f64, Fit)> {
    let model = fit.model.plus_in_each(&own.placed, &own.values, files);
    let mut x = fit.x.clone();
    x.extend_from_slice(&open.start(&model, None)[fit.x.len()..]);
    let added = open.rows(&model, &x, fit.x.len()..x.len(), Sides::One)?;
    let parameters = open.parameters(&model);
    let step_with = |added: &DMatrix<f64>| {
        let count = known.jacobian.ncols();
        let mut jacobian = known.jacobian.clone().resize_horizontally(count + added.ncols(), 0.0);
        jacobian.columns_mut(count, added.ncols()).copy_from(added);
        let numbers = &parameters[..count + added.ncols()];
        let normal = Normal::of(&Rows { jacobian, residual: known.residual.clone() }, numbers, &x[..numbers.len()]);
        let step = normal.bounded_step(numbers, &x[..numbers.len()], 0.0)?;
        Some((normal.promised_gain(&step), step))
    };
    let (in_each, step) = step_with(&added.jacobian)?;
    let (for_all, _) = step_with(&for_all_runs(&model, fit, &added.jacobian))?;
    let excess = fit.cost - open.noise_cost();
    let is_one_for_all = in_each - for_all < CLEARLY;
    if is_one_for_all || (excess - in_each).max(0.0) > left_share * (excess - for_all).max(0.0) {
        return None;
    }
    for ((x, step), p) in x.iter_mut().zip(step.iter()).zip(&parameters) {
        *x = (*x + step * p.scale).clamp(p.min, p.max);
    }
    Some((in_each, Fit { model, x, ..fit.clone() }))
}

/// The same without what came before and is not needed beside the last.
fn without_idle(open: &Problem, mut own: Complete) -> Complete {
    while let Some(fewer) = fewer(open, &own.best) {
        own = Complete { best: fewer, others: Vec::new() };
    }
    own
}

/// A fit without one of the effects before the last that leaves no more than noise either, and is no worse for its fewer numbers.
fn fewer(open: &Problem, fit: &Fit) -> Option<Fit> {
    let last = fit.model.effects.len() - 1;
    let before =
        (0..last).filter(|i| fit.model.stands_for_itself(*i) && fit.model.effects[*i] != fit.model.effects[last]);
    let criterion = Criterion::of(open, [fit]);
    let without = |i: usize| {
        let mut fewer = fit.clone();
        let of_each = fit.model.of_each_run(i);
        let gone = if of_each.is_empty() { vec![i] } else { of_each };
        for effect in gone.into_iter().rev() {
            fewer.x = open.start_without(&fewer, effect);
            fewer.model = fewer.model.without(effect);
        }
        open.fit(&fewer.model, &fewer.x)
    };
    let fits = before.filter_map(without).filter(|fit| !leaves_something(open, fit));
    fits.min_by(|a, b| a.cost.total_cmp(&b.cost)).filter(|own| criterion.at(own) <= criterion.at(fit))
}

fn title(fit: &Fit) -> String {
    fit.model.effects.last().map_or_else(String::new, |last| last.title())
}

/// A fit that something is added to, its rows, and what that may be.
struct Start {
    fit: Fit,
    known: Rows,
    candidates: Vec<Variant>,
}

/// Everything that is not in a fit beside it, and each of its effects in its place, with the numbers that all runs share to begin with: from
/// there derivatives reach farther.
fn starts(open: &Problem, fit: &Fit, candidates: &[Variant]) -> Option<Vec<Start>> {
    let known = open.rows(&fit.model, &fit.x, 0..fit.x.len(), Sides::One)?;
    let n = open.case.parameters.len();
    let untied = |i: usize| {
        let values = fit.model.values_of(i, &fit.x[n..]);
        let own = fit.model.places().into_iter().enumerate().filter(|(_, (effect, _))| *effect == i);
        let columns: Vec<usize> = own.map(|(k, _)| n + k).collect();
        let x = open.start_without(fit, i);
        Start {
            fit: Fit { model: fit.model.without(i), x, ..fit.clone() },
            known: Rows { jacobian: known.jacobian.clone().remove_columns_at(&columns), ..known.clone() },
            candidates: vec![Variant { placed: fit.model.effects[i].clone(), values }],
        }
    };
    let of_all = (0..fit.model.effects.len()).filter(|i| fit.model.numbers[*i].only_in.is_none());
    let mut starts: Vec<Start> = of_all.map(untied).collect();
    let is_new = |v: &&Variant| !fit.model.effects.contains(&v.placed);
    let candidates = candidates.iter().filter(is_new).cloned().collect();
    starts.push(Start { fit: fit.clone(), known, candidates });
    Some(starts)
}

/// The columns of each number summed over the runs.
fn for_all_runs(model: &Model, fit: &Fit, added: &DMatrix<f64>) -> DMatrix<f64> {
    let places = &model.places()[fit.model.effect_parameters()..];
    let numbers: BTreeSet<usize> = places.iter().map(|(_, index)| *index).collect();
    let mut sums = DMatrix::zeros(added.nrows(), numbers.len());
    for (k, number) in numbers.iter().enumerate() {
        for (column, _) in places.iter().enumerate().filter(|(_, (_, index))| index == number) {
            let sum = sums.column(k) + added.column(column);
            sums.set_column(k, &sum);
        }
    }
    sums
}

/// The files of all runs; both parts of a run that was cut are one.
fn files(case: &Case) -> Vec<Arc<str>> {
    let mut files: Vec<Arc<str>> = Vec::new();
    for run in &case.runs {
        if files.iter().all(|known| **known != *run.file) {
            files.push(Arc::from(run.file.as_str()));
        }
    }
    files
}
