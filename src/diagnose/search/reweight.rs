//! Noise weights and integration steps of the search: set at the baseline, renewed at the answer.

use super::screening::least_gain;
use super::stepwise::{Begun, Found};
use super::way::Bound;
use crate::diagnose::case::{Case, Noise, RunSet, noise};
use crate::diagnose::fit::{Fit, Problem, Variant};

/// Repeats the search from the answer if that changes weights or steps.
pub(in crate::diagnose) fn weigh(
    case: &mut Case,
    mut noise: Vec<Noise>,
    mut found: Found,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> (Found, Vec<Noise>) {
    for _ in 0..2 {
        if found.best.model.effects.is_empty() {
            break;
        }
        let former = case.runs.clone();
        let Some(renewed) = renew(case, &noise, &found) else {
            // With the former steps the reduced-order model could follow; what it cannot on a held-out run is taken back later.
            case.runs = former;
            break;
        };
        let with_new_steps = open_runs(case, &noise).cost_at(&found.best.model, &found.best.x);
        noise = renewed.noise;
        let problem = open_runs(case, &noise);
        let least = SAME_COST * least_gain(problem.samples());
        let steps_hold = with_new_steps.is_some_and(|cost| (cost - found.best.cost).abs() < least);
        let is_lowest = renewed.start.cost > found.best.cost - least;
        if renewed.weights_hold && steps_hold && is_lowest {
            break;
        }
        let begun = Begun::again(&problem, (renewed.baseline, renewed.start), variants, found.known(), say);
        found = begun.finish(&problem, variants, Bound::default(), say);
    }
    (found, noise)
}

/// Steps are kept if new ones change chi² by less than this share of the least gain.
const SAME_COST: f64 = 0.3;

/// Answer and baseline, fitted with renewed weights and steps.
pub(in crate::diagnose) struct Renewed {
    pub noise: Vec<Noise>,
    /// Whether the old weights were good enough.
    weights_hold: bool,
    pub start: Fit,
    pub baseline: Fit,
}

/// Estimates the noise from the answer's residual, plans steps around it, and refits. `None` if the reduced-order model
/// then diverges; the case keeps the steps it diverged with.
pub(in crate::diagnose) fn renew(case: &mut Case, former: &[Noise], found: &Found) -> Option<Renewed> {
    let residuals = open_runs(case, former).residuals(&found.best.model, &found.best.x)?;
    let noise = noise::estimate(case, &residuals);
    let weights_hold = noise.iter().zip(former).all(|(new, old)| new.is_near(old));
    let settings = found.best.model.settings(case, &found.best.x);
    case.plan_steps(&settings, &noise)?;
    case.leave_out_slack(&settings)?;
    let problem = open_runs(case, &noise);
    let start = problem.fit(&found.best.model, &found.best.x)?;
    let start = problem.fit_afresh(&start).unwrap_or(start);
    let baseline = problem.fit(&found.baseline.model, &found.baseline.x)?;
    let baseline = problem.fit_afresh(&baseline).unwrap_or(baseline);
    Some(Renewed { noise, weights_hold, start, baseline })
}

/// The fit of the runs that are not held out.
pub(in crate::diagnose) fn open_runs<'a>(case: &'a Case, noise: &'a [Noise]) -> Problem<'a> {
    Problem { case, runs: case.subset(RunSet::Open), noise }
}
