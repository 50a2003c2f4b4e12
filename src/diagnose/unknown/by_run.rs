//! Numbers that differ from run to run: a logger started by hand, air after a refill, a wall that softens from day to day.
//!
//! Nothing that is the same in all runs follows them, and much that is not there imitates them. Effects of the catalogue and constants of
//! the rig are therefore tried with a number of their own in each run, if neither one effect nor one law explains everything. The answer
//! is taken only if it leaves nothing but noise.

use std::collections::BTreeSet;
use std::sync::Arc;

use nalgebra::DMatrix;

use super::forms::{CLEARLY, Criterion, leaves_something};
use crate::diagnose::case::{Case, Noise, RunSet, Step};
use crate::diagnose::fit::{Fit, Model, Normal, Problem, Rows, Sides, Variant};
use crate::diagnose::grammar::{constants, variant};
use crate::diagnose::search::{Found, cross_validates, leaves_much, reweight};
use crate::parallel;

/// Maximum number of things that differ, and of those refitted for each.
const MOST: usize = 3;
const REFITTED: usize = 6;
/// What is looked for beside the calibration or one effect must differ that much: by derivatives, a number in each run leaves less than this
/// share of the misfit that one for all would leave. Else every rig on which something else is missing would pay for it.
const LEFT_SHARE: f64 = 0.5;
/// Steps to the number of a run, the rest of the model known.
const STEPS: usize = 8;

/// What differs from run to run and explains everything, with renewed noise and steps: something that is not in the best single effect, or
/// that effect. `None` if nothing does.
pub(in crate::diagnose) fn by_run(
    case: &mut Case,
    noise: &[Noise],
    (found, variants): (&Found, &[Variant]),
    say: &dyn Fn(String),
) -> Option<(Found, Vec<Noise>)> {
    let open = asked(case, noise, found)?;
    // What one effect leaves of itself is for other effects and laws.
    if !leaves_much(&open, &found.baseline, &found.best) {
        return None;
    }
    let search = Search { open: &open, candidates: candidates(case, variants), left_share: LEFT_SHARE, say };
    let from_effect = Some(&found.best).filter(|best| !best.model.effects.is_empty());
    let all = [Some(&found.baseline), from_effect].into_iter().flatten().filter_map(|from| search.complete(from));
    let count = |own: &Complete| own.best.model.effects.len();
    let own = all.min_by(|a, b| count(a).cmp(&count(b)).then(a.best.cost.total_cmp(&b.best.cost)))?;
    taken(case, noise, (found, own), say)
}

/// The effects of an answer that explains a part only with numbers of their own in each run, if that explains everything; with renewed noise
/// and steps.
pub(in crate::diagnose) fn untied(
    case: &mut Case,
    noise: &[Noise],
    found: &Found,
    say: &dyn Fn(String),
) -> Option<(Found, Vec<Noise>)> {
    let open = asked(case, noise, found)?;
    let own = Search { open: &open, candidates: Vec::new(), left_share: 1.0, say }.complete(&found.best)?;
    taken(case, noise, (found, own), say)
}

/// The open runs, if there are several and the answer leaves something of them.
fn asked<'a>(case: &'a Case, noise: &'a [Noise], found: &Found) -> Option<Problem<'a>> {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    // Of several folders, runs may have one name.
    let names: BTreeSet<&str> = open.runs.iter().map(|run| run.file.as_str()).collect();
    // Of runs that nothing drives each has elements of its own already.
    let is_driven = !case.scene.file.input.is_empty();
    let are_several = is_driven && names.len() > 1 && names.len() == open.runs.len();
    let is_asked = are_several && !case.is_without(Step::OpenSet) && leaves_something(&open, &found.best);
    is_asked.then_some(open)
}

/// What explains everything as an answer, if it is clearly better and predicts what is left out.
fn taken(
    case: &mut Case,
    noise: &[Noise],
    (found, own): (&Found, Complete),
    say: &dyn Fn(String),
) -> Option<(Found, Vec<Noise>)> {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let criterion = Criterion::of(&open, [&found.best, &own.best]);
    let is_better = criterion.at(&own.best) < criterion.at(&found.best) - CLEARLY;
    if !is_better || !cross_validates(&open, &found.baseline, &own.best) {
        return None;
    }
    let found = own.into_answer(found);
    let former = case.runs.clone();
    let renewed = renewed(case, noise, &found);
    if renewed.is_none() {
        case.runs = former;
    }
    let (found, noise) = renewed?;
    say(format!("{} explains it all", found.best.model.title()));
    Some((found, noise))
}

/// What may differ: effects of the catalogue, and constants of the rig. The size starts at nothing.
fn candidates(case: &Case, variants: &[Variant]) -> Vec<Variant> {
    let of_rig = constants(case).into_iter().filter_map(|slot| variant(case, &slot, &slot.shapes()[0], 1.0));
    let mut all: Vec<Variant> = variants.iter().cloned().chain(of_rig).collect();
    all.iter_mut().for_each(|v| v.values[0] = 0.0);
    all
}

/// A fit that leaves nothing, and others with something else in the place of the last thing that differs.
struct Complete {
    best: Fit,
    others: Vec<Fit>,
}

impl Complete {
    /// The answer: effects of the catalogue in its place are rivals, constants of the rig other forms.
    fn into_answer(self, found: &Found) -> Found {
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
struct Search<'a> {
    open: &'a Problem<'a>,
    candidates: Vec<Variant>,
    /// By derivatives, a number in each run must leave less than this share of the misfit that one for all would leave.
    left_share: f64,
    say: &'a dyn Fn(String),
}

impl Search<'_> {
    /// Adds one thing after another that differs, until nothing is left. `None` if something is.
    fn complete(&self, from: &Fit) -> Option<Complete> {
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
    fn one_more(&self, fit: &Fit) -> Option<Vec<Fit>> {
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
    let is_first = |i: &usize| fit.model.of_each_run(*i).first().is_none_or(|first| first == i);
    let before = (0..last).filter(|i| is_first(i) && fit.model.effects[*i] != fit.model.effects[last]);
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
    let of_all = (0..fit.model.effects.len()).filter(|i| fit.model.only_in[*i].is_none());
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

/// The answer with renewed weights and steps. `None` if it then leaves more than noise.
fn renewed(case: &mut Case, noise: &[Noise], found: &Found) -> Option<(Found, Vec<Noise>)> {
    let renewed = reweight::renew(case, noise, found)?;
    let open = reweight::open_runs(case, &renewed.noise);
    if leaves_something(&open, &renewed.start) {
        return None;
    }
    let others: Vec<&Fit> = found.rivals.iter().chain(&found.forms).flatten().collect();
    let mut fits: Vec<Fit> = parallel::map(&others, |fit| open.fit(&fit.model, &fit.x)).into_iter().flatten().collect();
    fits.push(renewed.start);
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut fits = fits.into_iter();
    let own = Complete { best: fits.next()?, others: fits.collect() };
    let mut found = Found { baseline: renewed.baseline, ..own.into_answer(found) };
    decide_held_out(case, &renewed.noise, &mut found.best);
    Some((found, renewed.noise))
}

/// What belongs to a held-out run is decided by that run, as the zeros of its channels are; the rest of the model is known.
fn decide_held_out(case: &Case, noise: &[Noise], fit: &mut Fit) {
    let n = case.parameters.len();
    let is_open = |file: &str| case.runs.iter().any(|run| !run.is_held_out && run.file == file);
    // The end of a run that was cut has the number of its beginning.
    for run in case.subset(RunSet::HeldOut).into_iter().filter(|run| !is_open(&run.file)) {
        let problem = Problem { case, runs: vec![run], noise };
        let file = problem.runs[0].file.as_str();
        let is_own = |(_, (effect, _)): &(usize, (usize, usize))| fit.model.only_in[*effect].as_deref() == Some(file);
        let own: Vec<usize> = fit.model.places().into_iter().enumerate().filter(is_own).map(|(k, _)| n + k).collect();
        for &k in own.iter().cycle().take(STEPS * own.len()) {
            let parameters = &problem.parameters(&fit.model)[k..=k];
            let Some(rows) = problem.rows(&fit.model, &fit.x, k..k + 1, Sides::Both) else { return };
            let normal = Normal::of(&rows, parameters, &fit.x[k..=k]);
            let Some(step) = normal.bounded_step(parameters, &fit.x[k..=k], 0.0) else { return };
            fit.x[k] = (fit.x[k] + step[0] * parameters[0].scale).clamp(parameters[0].min, parameters[0].max);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{CaseRun, made};
    use crate::diagnose::fit::simulate;
    use crate::diagnose::search::candidates::variants as listed;

    const SD_MM: f64 = 0.01;

    /// Four runs of a bench, the last of them held out, on which something has another number in each.
    fn rig(own: &Variant, numbers: [f64; 4]) -> Case {
        let mut case = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        let run = case.runs.iter().find(|run| run.is_held_out).cloned().expect("one is held out");
        let stroke: Vec<f64> = run.drive.inputs[0].clone();
        let runs = numbers.iter().enumerate().map(|(i, number)| {
            let mut run = CaseRun { file: format!("{i}.csv"), is_held_out: i == 3, open_part: None, ..run.clone() };
            run.drive.inputs[0] = stroke.iter().map(|x| x * (1.0 - 0.15 * i as f64)).collect();
            let model = Model::baseline().plus(&own.placed, &[*number]);
            let mut x: Vec<f64> = case.parameters.iter().map(|p| p.start).collect();
            x.push(*number);
            run.measured = simulate(&case, &run, &model, &x).expect("it can be simulated");
            run
        });
        case.runs = runs.collect();
        case
    }

    fn found(case: &Case, noise: &[Noise], effect: Option<&Variant>) -> Found {
        let open = Problem { case, runs: case.subset(RunSet::Open), noise };
        let baseline = open.fit(&Model::baseline(), &open.start(&Model::baseline(), None)).expect("a fit");
        let best = effect.map_or_else(
            || baseline.clone(),
            |own| {
                let model = Model::baseline().plus(&own.placed, &own.values);
                open.fit(&model, &open.start(&model, None)).expect("a fit")
            },
        );
        let (rivals, forms) = (vec![Vec::new(); best.model.effects.len()], vec![Vec::new(); best.model.effects.len()]);
        let rivals_against = best.cost;
        Found { baseline, best, rivals, rivals_against, screened: Vec::new(), forms, withheld: None, described: None }
    }

    fn sizes(case: &Case, found: &Found) -> Vec<f64> {
        let in_run = |run: &CaseRun| {
            found.best.model.effects_in(Some(&run.file), &found.best.x[case.parameters.len()..])[0].values[0]
        };
        case.runs.iter().map(in_run).collect()
    }

    fn wall(case: &Case) -> Variant {
        let of_wall =
            |own: &Variant| own.placed.spec().unlisted().is_some_and(|w| w.law.address.to_string() == "muscle.wall");
        candidates(case, &[]).into_iter().find(of_wall).expect("a constant of the wall")
    }

    #[test]
    fn a_wall_that_softens_has_a_number_in_each_run_and_the_mean_elsewhere() {
        let plain = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        let own = wall(&plain);
        let mut case = rig(&own, [0.0, -0.06, -0.03, -0.1]);
        let noise = [Noise::white(SD_MM)];
        let first = found(&case, &noise, None);
        let (answer, _) = by_run(&mut case, &noise, (&first, &[]), &|_| {}).expect("it explains everything");
        let numbers = sizes(&case, &answer);
        // What all runs share is the calibration's: ratios are those of the rig.
        let ratio = |i: usize| (1.0 + numbers[i]) / (1.0 + numbers[0]);
        assert_eq!(answer.best.model.effects.len(), 4);
        for (i, hidden) in [1.0, 0.94, 0.97, 0.9].into_iter().enumerate() {
            assert!((ratio(i) - hidden).abs() < 3e-3, "{i}: {numbers:?}");
        }
        let elsewhere = answer.best.model.effects_in(None, &answer.best.x[case.parameters.len()..]);
        assert!(elsewhere.len() == 1 && (elsewhere[0].values[0] - numbers.iter().sum::<f64>() / 4.0).abs() < 1e-12);
        assert_eq!(answer.best.model.title(), format!("{}, different in each run", own.placed.title()));
    }

    #[test]
    fn a_logger_started_by_hand_is_late_by_another_time_in_each_run() {
        let plain = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        let late = listed(&plain);
        let is_delay = |v: &&Variant| v.placed.spec().parameters[0].key == "delay_s";
        let own = late.iter().find(is_delay).cloned().expect("of the catalogue");
        let mut case = rig(&own, [0.02, 0.1, 0.05, 0.08]);
        let noise = [Noise::white(SD_MM)];
        let first = found(&case, &noise, Some(&own));
        let (answer, _) = untied(&mut case, &noise, &first, &|_| {}).expect("it explains everything");
        let numbers = sizes(&case, &answer);
        for (number, hidden) in numbers.iter().zip([0.02, 0.1, 0.05, 0.08]) {
            assert!((number - hidden).abs() < 2e-3, "{numbers:?}");
        }
    }

    /// What is the same in all runs is no number of each.
    #[test]
    fn what_all_runs_share_is_not_tried_in_each() {
        let plain = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        let own = wall(&plain);
        let case = rig(&own, [-0.05; 4]);
        let noise = [Noise::white(SD_MM)];
        let first = found(&case, &noise, None);
        let open = Problem { case: &case, runs: case.subset(RunSet::Open), noise: &noise };
        let search = Search { open: &open, candidates: vec![own], left_share: LEFT_SHARE, say: &|_| {} };
        assert!(search.one_more(&first.baseline).is_some_and(|fits| fits.is_empty()));
    }
}
