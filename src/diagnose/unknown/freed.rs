//! Laws whose exponent is set free: what shapes of whole numbers nearly follow. Such a fit begins where the shape is itself.

use super::elsewhere::shape;
use super::forms::{CLEARLY, Criterion, place};
use super::stead::{in_stead, numbers};
use super::unlisted::is_law_of;
use crate::diagnose::fit::{Fit, Problem, Variant};
use crate::diagnose::grammar::{Reach, slots, variant};
use crate::diagnose::verdict::port;
use crate::parallel;

/// Laws whose exponent is set free at once.
const MOST: usize = 3;

/// The first at each of some places with a free exponent in its last law, where that is worth a parameter: a few units less are chance, and
/// would make other places look worse than they are.
pub(super) fn freed_elsewhere(problem: &Problem, fits: &[&Fit]) -> Vec<Fit> {
    let at = |fit: &Fit| fit.model.effects.last().map(port);
    let mut first: Vec<&Fit> = Vec::new();
    for fit in fits {
        if first.len() < MOST && first.iter().all(|other| at(other) != at(fit)) {
            first.push(fit);
        }
    }
    let is_worth = |fit: &Fit, free: &Fit| {
        let criterion = Criterion::of(problem, [fit, free]);
        criterion.at(free) < criterion.at(fit)
    };
    let worth = |fit: &&Fit| free(problem, fit).filter(|free| is_worth(fit, free));
    parallel::map(&first, worth).into_iter().flatten().collect()
}

/// The best of some fits, cheapest first, with a free exponent in place of one whose place is theirs, if it is clearly better than that.
pub(super) fn freed_in_place(problem: &Problem, fits: &[Fit], best: &Fit) -> Option<Fit> {
    let there = fits
        .iter()
        .filter(|fit| place(fit) == place(best))
        .filter_map(|fit| free_variant(problem, fit).map(|own| (fit, own)));
    let there: Vec<(&Fit, Variant)> = there.take(MOST).collect();
    let freed = parallel::map(&there, |(fit, own)| in_stead(problem, fit, own, &numbers(problem, fit)));
    let first = freed.into_iter().flatten().min_by(|a, b| a.cost.total_cmp(&b.cost))?;
    let criterion = Criterion::of(problem, [&first, best]);
    (criterion.at(&first) < criterion.at(best) - CLEARLY).then_some(first)
}

/// A fit with the exponent of its last law set free.
fn free(problem: &Problem, fit: &Fit) -> Option<Fit> {
    in_stead(problem, fit, &free_variant(problem, fit)?, &numbers(problem, fit))
}

/// The last law of a fit with its exponent set free.
fn free_variant(problem: &Problem, fit: &Fit) -> Option<Variant> {
    let law = &fit.model.effects.last()?.spec().unlisted()?.law;
    let is_plain = law.states.is_empty() && law.variables().len() == 1;
    let all = slots(problem.case, fit, if is_plain { Reach::Plain } else { Reach::Wide });
    let free = |slot| {
        let (own, scale) = shape(problem, fit, slot)?;
        variant(problem.case, slot, own.freed()?, scale / slot.scale)
    };
    all.iter().filter(|slot| is_law_of(fit, slot)).find_map(free)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::{Model, made::Bench};
    use crate::diagnose::grammar::{Shape, Slot};
    use crate::laws::Symbol;

    fn equation(fit: &Fit) -> &str {
        fit.model.effects[0].spec().equation.as_str()
    }

    /// Neither a Gaussian nor an exponential: the exponent between them is found from either.
    #[test]
    fn an_exponent_is_found_from_the_shape_beside_it() {
        let bench = Bench::hiding("muscle.pull adds 0.4*exp(-abs(elongation_m/7e-3)^1.6)");
        let (problem, baseline) = (bench.open(), bench.baseline());
        let all = slots(&bench.case, &baseline, Reach::Plain);
        let slot = all.iter().find(|s| is_over(s, "muscle.pull", "elongation_m")).expect("a slot");
        for text in ["exp(-x^2)", "exp(-abs(x))"] {
            let shape = slot.shapes().iter().find(|shape| shape.text == text).expect("a shape");
            let own = variant(&bench.case, slot, shape, 7e-3 / slot.scale).expect("a law");
            let near = bench.fit(&Model::baseline().plus(&own.placed, &own.values));
            let found = freed_elsewhere(&problem, &[&near]);
            let [free] = &found[..] else { panic!("{} fits", found.len()) };
            assert_eq!(equation(free), "muscle.pull adds a * exp(-abs((elongation_m/scale_m))^p)");
            assert!(free.cost < 1e-3 * near.cost, "{text}: {} {}", near.cost, free.cost);
            let p = numbers(&problem, free).into_iter().find(|(name, _)| name == "p").expect("an exponent").1;
            assert!((p - 1.6).abs() < 0.02, "{text}: {p}");
            assert!(freed_elsewhere(&problem, &[free]).is_empty(), "it is free already");
            let in_place = freed_in_place(&problem, std::slice::from_ref(&near), &near).expect("clearly better");
            assert_eq!(in_place.cost, free.cost);
            assert!(freed_in_place(&problem, std::slice::from_ref(&near), free).is_none());
            assert!(freed_in_place(&problem, std::slice::from_ref(&baseline), &near).is_none());
        }
    }

    fn is_over(slot: &Slot, address: &str, variable: &str) -> bool {
        slot.address == address && slot.variable == variable
    }

    /// The text of every freed shape is a law, and where its exponent starts it says what the shape's text does.
    #[test]
    fn a_freed_law_begins_as_the_law_itself() {
        let bench = Bench::with(&[]);
        let all = slots(&bench.case, &bench.baseline(), Reach::Plain);
        let slot = all.iter().find(|s| is_over(s, "muscle.damping", "speed_m_s")).expect("a slot");
        let value = |shape: &Shape, x: f64| {
            let own = variant(&bench.case, slot, shape, 0.7).expect("a law");
            let (spec, values) = (own.placed.spec(), &own.values);
            let law = &spec.unlisted().expect("of the grammar").law;
            let named = |name: &str| spec.parameters.iter().zip(values).find(|(p, _)| p.key == name).map(|(_, v)| *v);
            let read = |symbol: &Symbol| match symbol {
                Symbol::Parameter(p) => named(&law.parameters[*p].name).expect("a value"),
                Symbol::Constant(c) => *c,
                Symbol::Variable(_) | Symbol::State(_) => x,
            };
            law.programs.value.value(&law.symbols.iter().map(read).collect::<Vec<_>>())
        };
        for shape in slot.shapes() {
            let Some(free) = shape.freed() else { continue };
            for x in [-2.0, -0.4, 0.3, 1.1].map(|x| x * slot.scale) {
                let [own, freed] = [shape, free].map(|shape| value(shape, x));
                assert!((own - freed).abs() < 1e-12 * own.abs(), "{} at {x}: {own} {freed}", shape.text);
            }
        }
    }
}
