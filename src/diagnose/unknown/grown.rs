//! A law located again along its own runs: in the same variable at another place, or with more to it, its variable
//! remembered or in a product with another.
//!
//! Where the scene is far off, derivatives at the calibration point elsewhere. A law that explains some of the misfit has
//! brought the model nearer, so what belongs in its place is looked for along its runs (as Gauss and Newton would: once
//! more from the better point).

use super::elsewhere::shape;
use super::forms::{CLEARLY, Criterion, finished, leaves_something, with_elsewhere};
use super::shown::{Located, Shown};
use super::unlisted::{is_law_of, several_ports};
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::grammar::{Reach, Reading, Slot, slots};
use crate::diagnose::verdict::port;

/// Maximum number of slots refitted, shapes for each, and refits that are converged.
const SLOTS: usize = 8;
const SHAPES: usize = 3;
const FINISHED: usize = 4;
/// Maximum number of times that a law is located again, of slots refitted then, and of slots with more than simple shapes.
const ROUNDS: usize = 3;
const AGAIN: usize = 5;
const BEST: usize = 2;
/// Share of the misfit that a law may leave and grow: what explains less is hardly over the right variable.
const MOST: f64 = 0.5;
/// Places at which a simple law grows: so many, if they promise this share of the best.
const PLACES: usize = 3;
const AS_GOOD: f64 = 0.9;

/// Fits that leave nothing where a simple law leaves little: the law at another place, or what it grows into. Cheapest
/// first, and empty where neither is found; `before`: chi² without a law.
pub(super) fn completed(problem: &Problem, simple: &Fit, before: f64) -> Vec<Fit> {
    let mut moved = with_elsewhere(problem, simple.clone(), before);
    moved.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    match moved.first() {
        Some(best) if leaves_something(problem, best) => grown(problem, best, before),
        _ => moved,
    }
}

/// Fits with a law, cheapest first, and such with a law in its place that is located along the runs of the best one. Again and again, while
/// that is clearly better. `before`: chi² without a law.
pub(super) fn located_again(problem: &Problem, mut fits: Vec<Fit>, before: f64, say: &dyn Fn(String)) -> Vec<Fit> {
    for _ in 0..ROUNDS {
        let Some(best) = fits.first().filter(|fit| leaves_something(problem, fit)).cloned() else { break };
        say(format!("located again along {}", best.model.title()));
        let others = in_its_place(problem, &best, before);
        let is_better = is_clearly_below(problem, &others, &best);
        fits.extend(others);
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        if !is_better {
            break;
        }
        let of = |fit: &Fit| fit.model.title();
        say(format!("instead of {}, {}: chi2 {:.0} -> {:.0}", of(&best), of(&fits[0]), best.cost, fits[0].cost));
    }
    fits
}

/// Whether a law explains most of the misfit, and leaves something.
pub(super) fn is_near(problem: &Problem, fit: &Fit, before: f64) -> bool {
    let noise = problem.noise_cost();
    fit.cost - noise < MOST * (before - noise) && leaves_something(problem, fit)
}

/// Fits with a law in place of the last one, at the slots that promise most along its runs: in further shapes and in sums of two at the best.
pub(super) fn in_its_place(problem: &Problem, fit: &Fit, before: f64) -> Vec<Fit> {
    let all = slots(problem.case, fit, Reach::Plain);
    let Some(shown) = Shown::in_place_of_last(problem, fit) else { return Vec::new() };
    let more = all.iter().find(|slot| is_law_of(fit, slot)).and_then(|slot| shape(problem, fit, slot));
    let located = shown.locate(&all, &all, more);
    let plain: Vec<&Slot> = several_ports(&located, &[]).into_iter().take(AGAIN).collect();
    let over_variables = plain.iter().copied().filter(|slot| !slot.is_constant());
    let best: Vec<&Slot> = over_variables.take(BEST).collect();
    let bent: Vec<Slot> = best.iter().map(|slot| slot.bent()).collect();
    let both: Vec<&Slot> = plain.iter().copied().chain(&bent).collect();
    let own = more.map_or("", |(shape, _)| shape.text);
    let mut fits = shown.refits_with(&all, &both, SHAPES, own);
    if fits.first().is_none_or(|first| leaves_something(problem, first)) {
        fits.extend(shown.recognised(&all, &best, fit).fits);
    }
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    finished(problem, fits, FINISHED, before)
}

/// Fits with a law that remembers or is a product, in place of the last law of a fit, if one is clearly better. Cheapest first; `before`: chi²
/// without a law.
pub(super) fn grown(problem: &Problem, simple: &Fit, before: f64) -> Vec<Fit> {
    let variables = over(simple);
    let plain: Vec<Slot> = slots(problem.case, simple, Reach::Plain);
    let plain: Vec<Slot> = plain.into_iter().filter(|slot| variables.contains(&slot.variable)).collect();
    let all = slots(problem.case, simple, Reach::Wide);
    let Some(shown) = Shown::in_place_of_last(problem, simple).filter(|_| !plain.is_empty()) else { return Vec::new() };
    let places = as_good(&shown.locate(&all, &plain, None), simple);
    let own: Vec<Slot> = all.iter().filter(|slot| grows_from(&variables, slot)).cloned().collect();
    let own: Vec<Slot> = own.into_iter().filter(|slot| places.contains(&slot.address)).collect();
    let located = shown.locate(&all, &own, None);
    let best: Vec<&Slot> = located.iter().take(SLOTS).map(|l| &l.slot).collect();
    let fits = finished(problem, shown.refits(&all, &best, SHAPES), FINISHED, before);
    if is_clearly_below(problem, &fits, simple) { fits } else { Vec::new() }
}

/// Whether the first of some fits, cheapest first, is clearly better than another.
fn is_clearly_below(problem: &Problem, fits: &[Fit], other: &Fit) -> bool {
    fits.first().is_some_and(|first| {
        let criterion = Criterion::of(problem, [first, other]);
        criterion.at(first) < criterion.at(other) - CLEARLY
    })
}

/// Variables of the last law of a fit, if it is one that can grow.
fn over(fit: &Fit) -> Vec<String> {
    let own = fit.model.effects.last().and_then(|last| last.spec().unlisted());
    let own = own.filter(|own| own.law.states.is_empty());
    own.map_or_else(Vec::new, |own| own.law.variables().iter().map(|v| v.name()).collect())
}

/// The place of the last law of a fit, and others that promise nearly as much over its variable.
fn as_good(located: &[Located], fit: &Fit) -> Vec<String> {
    let mut places: Vec<String> = fit.model.effects.last().map(port).into_iter().collect();
    let least = AS_GOOD * located.first().map_or(0.0, |best| best.gain);
    for own in located.iter().filter(|l| l.gain >= least) {
        if places.len() < PLACES && !places.contains(&own.slot.address) {
            places.push(own.slot.address.clone());
        }
    }
    places
}

/// Whether a slot is over one of these variables and more than that.
fn grows_from(variables: &[String], slot: &Slot) -> bool {
    let is_own = |name: &String| variables.contains(name);
    let by = match slot.reading {
        Reading::Times(other, _) => Some(other.spec().name()),
        _ => None,
    };
    slot.reading != Reading::Plain && (is_own(&slot.variable) || by.as_ref().is_some_and(is_own))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::{Model, made::Bench};
    use crate::diagnose::grammar::variant;
    use crate::laws::Law;

    fn over_time(bench: &Bench, address: &str, from: &Fit) -> Fit {
        let all = slots(&bench.case, from, Reach::Plain);
        let slot = all.iter().find(|slot| slot.address == address && slot.variable == "time_s").expect("a slot");
        let own = variant(&bench.case, slot, &slot.shapes()[0], 1.0).expect("a law");
        bench.fit(&Model::baseline().plus(&own.placed, &own.values))
    }

    fn law_of(fit: &Fit) -> Law {
        fit.model.effects[0].spec().unlisted().expect("a law").law.clone()
    }

    /// From a place where a law explains little, over another variable, to the law that is hidden.
    #[test]
    fn a_law_is_located_along_the_runs_of_one_that_explains_little() {
        let bench = Bench::hiding("muscle.area scales 1 + 0.3*tanh(elongation_m/5e-3)");
        let (problem, baseline) = (bench.open(), bench.baseline());
        let simple = over_time(&bench, "muscle.pull", &baseline);
        assert!(simple.cost > 0.5 * baseline.cost && simple.cost < baseline.cost, "{} {}", simple.cost, baseline.cost);
        let fits = located_again(&problem, vec![simple], baseline.cost, &|_| {});
        let own = law_of(&fits[0]);
        assert_eq!(own.address.to_string(), "muscle.area");
        assert!(fits[0].cost < 1e-6 * baseline.cost, "{} {}", fits[0].cost, baseline.cost);
        // What leaves nothing stays.
        let again = located_again(&problem, fits[..1].to_vec(), baseline.cost, &|_| {});
        assert_eq!(again.len(), 1);
    }

    /// A compliance of the syringe that changes with time is nearly that of the line.
    #[test]
    fn a_simple_law_is_moved_before_it_grows() {
        let bench = Bench::hiding("syringe.compliance scales 1 + 0.6*(time_s/20.0)");
        let problem = bench.open();
        let baseline = bench.baseline();
        let simple = over_time(&bench, "line.compliance", &baseline);
        assert!(simple.cost < 0.1 * baseline.cost, "{} {}", simple.cost, baseline.cost);
        let moved = completed(&problem, &simple, baseline.cost);
        let own = law_of(&moved[0]);
        assert_eq!((own.address.to_string().as_str(), own.variables().len()), ("syringe.compliance", 1));
        assert!(moved[0].cost < 0.1 * simple.cost, "{} {}", moved[0].cost, simple.cost);
    }

    /// A compliance that changes with time and pressure: over time alone it is nearly explained, and grows into the product.
    #[test]
    fn a_law_of_one_variable_grows_into_a_product() {
        let bench = Bench::hiding("line.compliance scales 1 + 0.6*(time_s/20.0)*(pressure_pa/1e6)");
        let problem = bench.open();
        let baseline = bench.baseline();
        let simple = over_time(&bench, "line.compliance", &baseline);
        assert!(simple.cost < 0.5 * baseline.cost, "{} {}", simple.cost, baseline.cost);
        let more = grown(&problem, &simple, baseline.cost);
        let own = law_of(&more[0]);
        let variables: Vec<String> = own.variables().iter().map(|v| v.name()).collect();
        assert_eq!(own.address.to_string(), "line.compliance");
        assert!(["time_s", "pressure_pa"].iter().all(|v| variables.iter().any(|own| own == v)), "{variables:?}");
        assert!(more[0].cost < 0.05 * simple.cost, "{} {}", more[0].cost, simple.cost);
        // The product itself has nothing to grow into.
        assert!(grown(&problem, &more[0], baseline.cost).is_empty());
    }
}
