//! Consistency between runs: does every run alone give the same size?

use std::borrow::Cow;

use crate::diagnose::case::{Case, Noise};
use crate::diagnose::diagnosis::{Estimate, NamedEffect};
use crate::diagnose::fit::{Fit, Normal, Problem, Sides};
use crate::diagnose::search::is_broad;
use crate::diagnose::verdict::is_said;
use crate::effects::Range;

/// Runs disagree if their sizes differ by this many standard errors and this share of the size.
const SIGMA: f64 = 4.0;
const SHARE: f64 = 0.25;

/// Size of one effect by run.
pub struct RunSizes {
    /// Index of the effect in the model.
    pub effect: usize,
    pub key: &'static str,
    pub runs: Vec<(String, Estimate)>,
}

/// Size of every effect by run: one least-squares step from the common fit, calibration held. Intervals grow with the
/// run's residual. Left out are what differs from run to run anyway, and logarithmic creep: its size is the stiffness at
/// the first instant, which a run at rest hardly shows.
pub fn sizes_by_run(case: &Case, fit: &Fit, noise: &[Noise]) -> Vec<RunSizes> {
    let first = case.parameters.len();
    let mut sizes: Vec<RunSizes> = Vec::new();
    let is_of_all = |effect: usize| fit.model.numbers[effect].only_in.is_none();
    let sizes_of = |&(_, (effect, index)): &(usize, (usize, usize))| {
        index == 0 && !is_broad(&fit.model, effect) && is_of_all(effect)
    };
    for (place, (effect, index)) in fit.model.places().into_iter().enumerate().filter(sizes_of) {
        let key = fit.model.effects[effect].spec().parameters[index].key.as_str();
        let runs = case.runs.iter().filter_map(|run| {
            let problem = Problem { case, runs: vec![Cow::Borrowed(run)], noise };
            Some((run.file.clone(), size_in(&problem, fit, first, place)?))
        });
        sizes.push(RunSizes { effect, key, runs: runs.collect() });
    }
    sizes
}

fn size_in(problem: &Problem, fit: &Fit, first: usize, place: usize) -> Option<Estimate> {
    let parameters = &problem.parameters(&fit.model)[first..];
    let rows = problem.rows(&fit.model, &fit.x, first..fit.x.len(), Sides::Both)?;
    let normal = Normal::of(&rows, parameters, &fit.x[first..]);
    let step = normal.bounded_step(parameters, &fit.x[first..], 0.0)?[place] * parameters[place].scale;
    // Where a run is not explained down to its noise, what is left pulls at the sizes as well.
    let unit = (rows.residual.norm_squared() / rows.residual.len().max(1) as f64).max(1.0).sqrt();
    let half = 1.96 * unit * normal.covariance()[(place, place)].max(0.0).sqrt() * parameters[place].scale;
    let value = fit.x[first + place] + step;
    half.is_finite().then_some(Estimate { value, ci95: [value - half, value + half] })
}

/// The first effect that a single run contradicts, and why: its size there is outside the law's range, or far from
/// another run's.
pub fn contradiction(case: &Case, fit: &Fit, noise: &[Noise]) -> Option<(usize, String)> {
    sizes_by_run(case, fit, noise).into_iter().find_map(|s| {
        let placed = &fit.model.effects[s.effect];
        let range = placed.spec().parameters[0].range;
        let impossible = s.runs.iter().find(|(_, size)| is_outside(*size, range));
        let how = match impossible {
            Some((file, _)) => format!("would have a size in {file} that it cannot have"),
            None if placed.entry.trying.of_the_day => return None,
            None => {
                let (larger, smaller) = far_apart(&s.runs)?;
                format!("would be larger in {larger} than in {smaller}, by more than an idealised law allows")
            }
        };
        Some((s.effect, how))
    })
}

/// Two runs contradict one law if their sizes differ by this factor even after moving [`SIGMA`] standard errors closer.
/// For effects that were present, altered forms included, it never exceeded 1.25.
const FAR: f64 = 1.3;

/// Two runs with contradicting sizes, the larger first.
fn far_apart(runs: &[(String, Estimate)]) -> Option<(&str, &str)> {
    let is_far = |a: &Estimate, b: &Estimate| {
        let nearest = a.value.abs() - SIGMA * error(a);
        let of_other = a.value.signum() * b.value + SIGMA * error(b);
        nearest > FAR * of_other.max(0.0)
    };
    let mut pairs = runs.iter().flat_map(|a| runs.iter().map(move |b| (a, b)));
    pairs.find(|(a, b)| is_far(&a.1, &b.1)).map(|(a, b)| (a.0.as_str(), b.0.as_str()))
}

/// Standard error of an estimate.
fn error(size: &Estimate) -> f64 {
    (size.ci95[1] - size.ci95[0]) / 2.0 / 1.96
}

/// Whether a size lies outside a range by [`SIGMA`] standard errors.
fn is_outside(size: Estimate, range: Range) -> bool {
    let margin = SIGMA * error(&size);
    size.value + margin < range.min || size.value - margin > range.max
}

/// Adds the sizes to the answer; returns the parameters in which runs disagree.
pub fn report(sizes: Vec<RunSizes>, fit: &Fit, effects: &mut [NamedEffect], warnings: &mut Vec<String>) -> Vec<String> {
    let mut contradicted = Vec::new();
    for s in sizes {
        let placed = &fit.model.effects[s.effect];
        if disagree(&s.runs) {
            let each: Vec<String> = s.runs.iter().map(|(file, e)| format!("{:.3e} in {file}", e.value)).collect();
            let what = format!("{} of {}", s.key, placed.title());
            warnings.push(format!(
                "runs disagree on {what}: {}; the rig changed between them, or the law is not quite this",
                each.join(", ")
            ));
            contradicted.push(what);
        }
        let own = effects.iter_mut().find(|e| is_said(e, placed));
        if let Some(own) = own.filter(|e| e.size_by_run.is_empty()) {
            own.size_by_run = s.runs.into_iter().collect();
        }
    }
    contradicted
}

fn disagree(runs: &[(String, Estimate)]) -> bool {
    let apart = |(_, a): &(String, Estimate), (_, b): &(String, Estimate)| {
        let difference = (a.value - b.value).abs();
        difference > SIGMA * error(a).hypot(error(b)) && difference > SHARE * a.value.abs().max(b.value.abs())
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
    fn sizes_are_far_apart_only_by_errors_and_a_factor() {
        assert!(far_apart(&[run(1.0, 0.1), run(1.2, 0.01)]).is_none());
        assert!(far_apart(&[run(1.0, 1.0), run(2.0, 1.0)]).is_none());
        let (small, large) = (("a.csv".to_owned(), run(1.0, 0.1).1), ("b.csv".to_owned(), run(2.0, 0.1).1));
        assert_eq!(far_apart(&[small, large]), Some(("b.csv", "a.csv")));
        // Of the other sign: no size stands behind both.
        assert!(far_apart(&[run(-1.0, 0.1), run(-1.1, 0.1), run(0.5, 0.1)]).is_some());
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
