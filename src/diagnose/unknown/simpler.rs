//! Simpler laws in the place of one that has grown: of a sum each shape alone, of a product or of what is remembered the shape of the
//! variable itself. They start from its numbers, where a search from the calibration may not have come.

use super::elsewhere::shape;
use super::stead::{in_stead, numbers};
use super::sums::shapes_of_sum;
use super::unlisted::is_law_of;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::grammar::{Reach, Reading, SECOND_SIZE, Shape, Slot, is_sum, slots, variant};
use crate::parallel;

/// A shape at its scale, with its size, to start from.
struct Part<'a> {
    slot: &'a Slot,
    shape: &'static Shape,
    scale: f64,
    size: f64,
}

/// Converged fits with each simpler law in place of the last one.
pub(super) fn simpler(problem: &Problem, fit: &Fit) -> Vec<Fit> {
    let Some(last) = fit.model.effects.last() else { return Vec::new() };
    let Some(own) = last.spec().unlisted() else { return Vec::new() };
    let is_grown = is_sum(last.spec()) || !own.law.states.is_empty() || own.law.variables().len() > 1;
    if !is_grown {
        return Vec::new();
    }
    let plain = slots(problem.case, fit, Reach::Plain);
    let parts = if is_sum(last.spec()) { of_sum(problem, fit, &plain) } else { of_wide(problem, fit, &plain) };
    parallel::map(&parts, |part| refit(problem, fit, part)).into_iter().flatten().collect()
}

/// The shapes of a sum.
fn of_sum<'a>(problem: &Problem, fit: &Fit, plain: &'a [Slot]) -> Vec<Part<'a>> {
    let Some(slot) = plain.iter().find(|slot| is_law_of(fit, slot)) else { return Vec::new() };
    let Some(shapes) = shapes_of_sum(problem, fit, slot) else { return Vec::new() };
    let known = numbers(problem, fit);
    let value = |name: &str| known.iter().find(|(own, _)| own == name).map(|(_, value)| *value);
    let sizes = ["a", SECOND_SIZE].map(value);
    let part =
        |((shape, scale), size): ((&'static Shape, f64), Option<f64>)| Some(Part { slot, shape, scale, size: size? });
    shapes.into_iter().zip(sizes).filter_map(part).collect()
}

/// The shape of a product or of what is remembered, over its variable alone at the same place.
fn of_wide<'a>(problem: &Problem, fit: &Fit, plain: &'a [Slot]) -> Vec<Part<'a>> {
    let wide = slots(problem.case, fit, Reach::Wide);
    let size = numbers(problem, fit).into_iter().find(|(name, _)| name == "a");
    let part = |slot: &Slot| {
        let (shape, scale) = shape(problem, fit, slot)?;
        let same = |p: &&Slot| p.address == slot.address && p.variable == slot.variable && p.reading == Reading::Plain;
        Some(Part { slot: plain.iter().find(same)?, shape, scale, size: size.as_ref()?.1 })
    };
    wide.iter().filter(|slot| is_law_of(fit, slot)).find_map(part).into_iter().collect()
}

fn refit(problem: &Problem, fit: &Fit, part: &Part<'_>) -> Option<Fit> {
    let own = variant(problem.case, part.slot, part.shape, part.scale / part.slot.scale)?;
    in_stead(problem, fit, &own, &[("a".to_owned(), part.size)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::{Model, made::Bench};
    use crate::diagnose::grammar::{Term, sum};

    fn equation(fit: &Fit) -> String {
        fit.model.effects[0].spec().equation.clone()
    }

    /// A stop whose law was taken for one that grows with pressure, which rises with the elongation.
    #[test]
    fn a_product_that_stands_in_for_a_shape_gives_way_to_it() {
        let bench = Bench::hiding("muscle.pull adds 0.5*max(elongation_m/8e-3 - 1, 0)");
        let (problem, baseline) = (bench.open(), bench.baseline());
        let wide = slots(&bench.case, &baseline, Reach::Wide);
        let is_its = |slot: &&Slot| {
            let by_pressure = matches!(&slot.reading, Reading::Times(other, _) if other.spec().name() == "pressure_pa");
            slot.address == "muscle.pull" && slot.variable == "elongation_m" && by_pressure
        };
        let slot = wide.iter().find(is_its).expect("a product");
        let hinge = slot.shapes().iter().find(|shape| shape.text == "max(x - 1, 0)").expect("a shape");
        let own = variant(&bench.case, slot, hinge, 8e-3 / slot.scale).expect("a law");
        let product = bench.fit(&Model::baseline().plus(&own.placed, &own.values));
        let found = simpler(&problem, &product);
        let [simple] = &found[..] else { panic!("{} fits", found.len()) };
        assert!(!equation(simple).contains("pressure_pa"), "{}", equation(simple));
        assert!(simple.cost < 0.1 * product.cost, "{} {}", simple.cost, product.cost);
        assert!(simpler(&problem, simple).is_empty(), "it has nothing to lose");
    }

    /// One of the two shapes of a sum does all.
    #[test]
    fn each_shape_of_a_sum_is_tried_alone() {
        let bench = Bench::hiding("muscle.pull adds 0.3*tanh(elongation_m/5e-3)");
        let (problem, baseline) = (bench.open(), bench.baseline());
        let plain = slots(&bench.case, &baseline, Reach::Plain);
        let at = |slot: &&Slot| slot.address == "muscle.pull" && slot.variable == "elongation_m";
        let slot = plain.iter().find(at).expect("a slot");
        let term = |text: &str, size: f64| {
            let shape = slot.shapes().iter().find(|shape| shape.text == text).expect("a shape");
            Term { shape, scale: 5e-3, size }
        };
        let own = sum(&bench.case, slot, &[term("tanh(x)", 0.2), term("exp(-x^2)", 1e-3)]).expect("a law");
        let both = bench.fit(&Model::baseline().plus(&own.placed, &own.values));
        let found = simpler(&problem, &both);
        assert!(!found.is_empty());
        let least = found.iter().map(|fit| fit.cost).fold(f64::INFINITY, f64::min);
        assert!(least < 1e-3 * baseline.cost, "{least} {}", baseline.cost);
    }
}
