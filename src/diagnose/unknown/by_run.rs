//! Numbers that differ from run to run: a logger started by hand, air after a refill, a wall that softens from day to day.
//!
//! Nothing that is the same in all runs follows them, and much that is not there imitates them. Effects of the catalogue and constants of
//! the rig are therefore tried with a number of their own in each run, if neither one effect nor one law explains everything. The answer
//! is taken only if it leaves nothing but noise.

use std::collections::BTreeSet;

use super::by_run_search::{Complete, Search};
use super::forms::{CLEARLY, Criterion, leaves_something};
use crate::diagnose::case::{Case, Noise, RunSet, Step};
use crate::diagnose::fit::{Fit, Normal, Problem, Sides, Variant};
use crate::diagnose::grammar::{constants, variant};
use crate::diagnose::search::{Found, cross_validates_halves, leaves_much, reweight};
use crate::parallel;

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
    // A run that is left out whole has no number: halves of runs must do.
    if !is_better || !cross_validates_halves(&open, &found.best, &own.best) {
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
        let is_own =
            |(_, (effect, _)): &(usize, (usize, usize))| fit.model.numbers[*effect].only_in.as_deref() == Some(file);
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
    use crate::diagnose::fit::{Model, simulate};
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
