//! Weights and steps of the search: set by the baseline, renewed around what was found.

use super::baseline::Baseline;
use super::candidates::Variant;
use super::case::{Case, Sealed};
use super::fit::Problem;
use super::noise::{self, Noise};
use super::search::{self, Found};

/// Searches, and again where what was found asks for other weights or other steps.
pub fn search_and_weigh(
    case: &mut Case,
    base: &Baseline,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> Option<(Found, Vec<Noise>)> {
    let mut noise = base.noise.clone();
    let mut found = search::search(&open_runs(case, &noise), base.fit.clone(), base.fit.clone(), variants, say);
    for _ in 0..2 {
        if found.best.model.effects.is_empty() {
            break;
        }
        let residuals = open_runs(case, &noise).residuals(&found.best.model, &found.best.x)?;
        let renewed = noise::estimate(case, &residuals);
        let weights_hold = renewed.iter().zip(&noise).all(|(new, old)| new.is_near(old));
        noise = renewed;
        let setting = found.best.model.setting(case, &found.best.x);
        // What cannot be simulated on a sealed run is taken back later; the steps stay as they are.
        if case.plan_steps(&setting, &noise).is_none() {
            break;
        }
        case.leave_out_unheld(&setting)?;
        let problem = open_runs(case, &noise);
        let start = problem.fit(&found.best.model, &found.best.x)?;
        if weights_hold && (start.cost - found.best.cost).abs() < SAME_COST * search::least_gain(problem.samples()) {
            break;
        }
        let baseline = problem.fit(&found.baseline.model, &found.baseline.x)?;
        found = search::search(&problem, baseline, start, variants, say);
    }
    Some((found, noise))
}

/// Steps hold when new ones change chi² by less than this share of the least gain.
const SAME_COST: f64 = 0.3;

fn open_runs<'a>(case: &'a Case, noise: &'a [Noise]) -> Problem<'a> {
    Problem { case, runs: case.subset(Sealed::Open), noise }
}
