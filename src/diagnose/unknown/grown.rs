//! A simple law that nearly explains the misfit: as simple at another place, or with more to it, its variable remembered
//! or in a product with another.
//!
//! Where the scene is far off, derivatives at the calibration point elsewhere. The simple law has brought the model
//! near, so what is missing is looked for along its runs: first where the sensors hardly tell its place from another
//! one, then at its own.

use super::forms::{CLEARLY, Criterion, finished, leaves_something, with_elsewhere};
use super::shown::Shown;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::grammar::{Reach, Reading, Slot, slots};
use crate::diagnose::verdict;

/// Maximum number of slots refitted, shapes for each, and refits that are converged.
const SLOTS: usize = 8;
const SHAPES: usize = 3;
const FINISHED: usize = 4;

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

/// Fits with a law that remembers or is a product, in place of the last law of a fit, if one is clearly better. Cheapest first; `before`: chi²
/// without a law.
fn grown(problem: &Problem, simple: &Fit, before: f64) -> Vec<Fit> {
    let all = slots(problem.case, simple, Reach::Wide);
    let own: Vec<Slot> = all.iter().filter(|slot| grows_from(simple, slot)).cloned().collect();
    let Some(shown) = Shown::in_place_of_last(problem, simple).filter(|_| !own.is_empty()) else { return Vec::new() };
    let located = shown.locate(&all, &own, None);
    let best: Vec<&Slot> = located.iter().take(SLOTS).map(|l| &l.slot).collect();
    let fits = finished(problem, shown.refits(&all, &best, SHAPES), FINISHED, before);
    let criterion = Criterion::of(problem, fits.first().into_iter().chain([simple]));
    let is_better = fits.first().is_some_and(|fit| criterion.at(fit) < criterion.at(simple) - CLEARLY);
    if is_better { fits } else { Vec::new() }
}

/// Whether a slot is at the place of the last law of a fit, over its variable and more than that.
fn grows_from(simple: &Fit, slot: &Slot) -> bool {
    let Some(last) = simple.model.effects.last() else { return false };
    let Some(own) = last.spec().unlisted() else { return false };
    let variables: Vec<String> = own.law.variables().iter().map(|v| v.name()).collect();
    let is_own = |name: &String| variables.contains(name);
    let by = match slot.reading {
        Reading::Times(other, _) => Some(other.spec().name()),
        _ => None,
    };
    slot.reading != Reading::Plain
        && own.law.states.is_empty()
        && slot.address == verdict::port(last)
        && (is_own(&slot.variable) || by.as_ref().is_some_and(is_own))
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
