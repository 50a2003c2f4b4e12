//! Single relaxations, or logarithmic creep over decades of time.
//!
//! A polymer creeps along the logarithm of time. Exponentials fit the recorded part, one per decade, and then end: they
//! do not predict the next decade. Logarithmic creep does, with fewer parameters.

use super::refits::cross_validates_runs;
use super::reweight::open_runs;
use super::screening::least_gain;
use super::stepwise::{Found, converged};
use crate::diagnose::case::{Case, Noise, Step};
use crate::diagnose::fit::{Fit, Model, Placed, Problem, Variant};
use crate::effects::Native;

/// Decades of logarithmic creep: from the shortest time to beyond the length of any recording, so that the end does not
/// matter.
const DECADES: f64 = 5.0;
/// Start values of the shortest time, as shares of the shortest relaxation found.
const SHORTER: [f64; 2] = [1.0, 0.1];

/// Replaces all relaxations of a muscle by logarithmic creep, if that cross-validates better and has fewer parameters
/// or leaves less. If there is nothing to cross-validate, it must leave less.
///
/// Its shortest time is far below the others': both models are compared with steps short enough for it. The case keeps
/// those steps if creep is accepted.
pub(in crate::diagnose) fn broaden(
    case: &mut Case,
    noise: &[Noise],
    mut found: Found,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> Found {
    for placed in relaxing(&found.best) {
        let former = case.runs.clone();
        let Some([baseline, was, broad]) = with_steps_of_broad(case, noise, &found, &placed) else {
            case.runs = former;
            continue;
        };
        let problem = open_runs(case, noise);
        if is_better(&problem, &was, &broad) {
            say(format!("{} over decades: chi2 {:.0} -> {:.0}", placed.title(), was.cost, broad.cost));
            found = converged(&problem, Found { baseline, ..found }, broad, variants, say);
        } else {
            case.runs = former;
        }
    }
    found
}

/// Baseline, answer, and the answer with logarithmic creep, all fitted with the steps that the last one needs.
fn with_steps_of_broad(case: &mut Case, noise: &[Noise], found: &Found, placed: &Placed) -> Option<[Fit; 3]> {
    let broad = as_broad(&open_runs(case, noise), &found.best, placed)?;
    case.plan_steps(&broad.model.settings(case, &broad.x), noise)?;
    let problem = open_runs(case, noise);
    let again = |fit: &Fit| problem.fit(&fit.model, &fit.x);
    Some([again(&found.baseline)?, again(&found.best)?, again(&broad)?])
}

fn is_better(problem: &Problem, was: &Fit, broad: &Fit) -> bool {
    let is_nearer = broad.cost < was.cost - least_gain(problem.samples());
    if problem.case.is_without(Step::CrossValidation) {
        return is_nearer;
    }
    (is_nearer || broad.x.len() < was.x.len()) && cross_validates_runs(problem, was, broad)
}

/// Whether an effect is logarithmic creep.
pub(in crate::diagnose) fn is_broad(model: &Model, effect: usize) -> bool {
    relaxes(&model.effects[effect]) && model.numbers[effect].values[2] > 0.0
}

fn relaxes(placed: &Placed) -> bool {
    placed.entry.native == Some(Native::Viscoelasticity)
}

/// Each relaxing muscle once.
fn relaxing(fit: &Fit) -> Vec<Placed> {
    let mut relaxing: Vec<Placed> = Vec::new();
    for placed in fit.model.effects.iter().filter(|e| relaxes(e)) {
        if !relaxing.contains(placed) {
            relaxing.push(placed.clone());
        }
    }
    relaxing
}

/// The best fit with logarithmic creep in place of all relaxations of a muscle. `None` if it has none any more.
fn as_broad(problem: &Problem, fit: &Fit, placed: &Placed) -> Option<Fit> {
    let calibrated = problem.case.parameters.len();
    let mut rest = fit.clone();
    let (mut stiffness_n_m, mut shortest_s) = (0.0, f64::INFINITY);
    while let Some(index) = rest.model.effects.iter().position(|e| e == placed) {
        let values = &rest.model.effects_at(&rest.x[calibrated..])[index].values;
        (stiffness_n_m, shortest_s) = (stiffness_n_m + values[0], values[1].min(shortest_s));
        rest.x = problem.start_without(&rest, index);
        rest.model = rest.model.without(index);
    }
    if shortest_s.is_infinite() {
        return None;
    }
    let begun = |share: f64| {
        let values = [stiffness_n_m, share * shortest_s, DECADES];
        let start = [&rest.x[..], &values[..2]].concat();
        problem.fit(&rest.model.plus(placed, &values), &start)
    };
    SHORTER.into_iter().filter_map(begun).min_by(|a, b| a.cost.total_cmp(&b.cost))
}
