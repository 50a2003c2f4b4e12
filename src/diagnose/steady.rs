//! Step 7, from run to run: does every run by itself ask for the same size of an effect?

use std::borrow::Cow;

use super::answer::{Estimate, NamedEffect};
use super::case::Case;
use super::fit::{Fit, Problem};
use super::model::Sides;
use super::noise::Noise;
use super::normal::Normal;
use super::verdict::is_said;
use crate::effects::Range;

/// Runs disagree when their sizes spread by this many standard errors and by this share of the size.
const SIGMA: f64 = 4.0;
const SHARE: f64 = 0.25;

/// Size of one effect as each run by itself would have it.
pub struct RunSizes {
    /// Index of the effect in the model.
    pub effect: usize,
    pub key: &'static str,
    pub runs: Vec<(String, Estimate)>,
}

/// Sizes of the first number of every effect, by run: one step of least squares from a common fit, calibration held.
pub fn sizes_by_run(case: &Case, fit: &Fit, noise: &[Noise]) -> Vec<RunSizes> {
    let first = case.parameters.len();
    let mut sizes: Vec<RunSizes> = Vec::new();
    for (place, (effect, index)) in fit.model.places().into_iter().enumerate().filter(|(_, (_, index))| *index == 0) {
        let key = fit.model.effects[effect].spec().parameters[index].key;
        let runs = case.runs.iter().filter_map(|run| {
            let problem = Problem { case, runs: vec![Cow::Borrowed(run)], noise };
            Some((run.file.clone(), size_in(&problem, fit, first, place)?))
        });
        sizes.push(RunSizes { effect, key, runs: runs.collect() });
    }
    sizes
}

fn size_in(problem: &Problem, fit: &Fit, first: usize, place: usize) -> Option<Estimate> {
    let numbers = &problem.numbers(&fit.model)[first..];
    let rows = problem.rows(&fit.model, &fit.x, first..fit.x.len(), Sides::Both)?;
    let normal = Normal::of(&rows, numbers, &fit.x[first..]);
    let step = normal.bounded_step(numbers, &fit.x[first..], 0.0)?[place] * numbers[place].scale;
    let half = 1.96 * normal.covariance()[(place, place)].max(0.0).sqrt() * numbers[place].scale;
    let value = fit.x[first + place] + step;
    half.is_finite().then_some(Estimate { value, ci95: [value - half, value + half] })
}

/// The first effect that a run by itself would have at a size that its law cannot, and that run's file.
pub fn impossible_size(case: &Case, fit: &Fit, noise: &[Noise]) -> Option<(usize, String)> {
    sizes_by_run(case, fit, noise).into_iter().find_map(|s| {
        let range = fit.model.effects[s.effect].spec().parameters[0].range;
        let (file, _) = s.runs.into_iter().find(|(_, size)| is_outside(*size, range))?;
        Some((s.effect, file))
    })
}

/// Whether a size lies outside a range by [`SIGMA`] standard errors.
fn is_outside(size: Estimate, range: Range) -> bool {
    let margin = SIGMA * (size.ci95[1] - size.ci95[0]) / 2.0 / 1.96;
    size.value + margin < range.min || size.value - margin > range.max
}

/// Puts the sizes into the answer, and says where runs disagree.
pub fn report(sizes: Vec<RunSizes>, fit: &Fit, effects: &mut [NamedEffect], warnings: &mut Vec<String>) {
    for s in sizes {
        let placed = &fit.model.effects[s.effect];
        if disagree(&s.runs) {
            let each: Vec<String> = s.runs.iter().map(|(file, e)| format!("{:.3e} in {file}", e.value)).collect();
            warnings.push(format!(
                "runs disagree on {} of {}: {}; the rig changed between them, or the law is not quite this",
                s.key,
                placed.title(),
                each.join(", ")
            ));
        }
        let own = effects.iter_mut().find(|e| is_said(e, placed));
        if let Some(own) = own.filter(|e| e.size_by_run.is_empty()) {
            own.size_by_run = s.runs.into_iter().collect();
        }
    }
}

fn disagree(runs: &[(String, Estimate)]) -> bool {
    let apart = |(_, a): &(String, Estimate), (_, b): &(String, Estimate)| {
        let half = |e: &Estimate| (e.ci95[1] - e.ci95[0]) / 2.0;
        let error = half(a).hypot(half(b)) / 1.96;
        let difference = (a.value - b.value).abs();
        difference > SIGMA * error && difference > SHARE * a.value.abs().max(b.value.abs())
    };
    runs.iter().enumerate().any(|(i, a)| runs[..i].iter().any(|b| apart(a, b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(value: f64, half: f64) -> (String, Estimate) {
        ("run.csv".to_owned(), Estimate { value, ci95: [value - half, value + half] })
    }

    #[test]
    fn a_size_is_impossible_only_by_four_errors() {
        let from_zero = Range { min: 0.0, max: 1.0 };
        let size = |value, half| run(value, half).1;
        assert!(is_outside(size(-0.5, 0.2), from_zero) && is_outside(size(1.5, 0.2), from_zero));
        assert!(!is_outside(size(-0.3, 0.2), from_zero) && !is_outside(size(0.5, 0.2), from_zero));
    }

    #[test]
    fn runs_disagree_when_both_error_and_share_say_so() {
        assert!(!disagree(&[run(1.0, 0.1), run(1.1, 0.1)]));
        // Many errors apart, but near in size: idealised laws do that.
        assert!(!disagree(&[run(1.0, 1e-3), run(1.1, 1e-3)]));
        assert!(!disagree(&[run(1.0, 1.0), run(2.0, 1.0)]));
        assert!(disagree(&[run(1.0, 0.05), run(1.0, 0.05), run(1.6, 0.05)]));
    }
}
