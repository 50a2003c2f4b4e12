//! Alternatives at other places: what the sensors cannot distinguish.
//!
//! When two places look alike, the search finds one of them by chance. Signals are therefore injected at every port
//! along the runs of the answer. A slot is an alternative if a curve over its variable imitates what the effect does,
//! up to chance and with the calibration free. Slots have the effect's variable, no variable, or, for laws, one that
//! correlates with it in these runs.

use super::shown::{Located, Shown};
use super::sums::shapes_of_sum;
use super::unlisted::is_law_of;
use crate::diagnose::fit::{Fit, Placed, Problem};
use crate::diagnose::grammar::{
    MORE_SHAPES, Reach, Reading, SCALE, Shape, Slot, is_in_pieces, is_sum, slots, steady, variant,
};
use crate::diagnose::verdict;

/// A slot may miss this share of what the effect does, or this many ties of chi²: a curve is not yet a law.
const LEFT_SHARE: f64 = 0.03;
const LEFT_TIES: f64 = 3.0;
/// Maximum number of slots refitted, per address, and shapes for each.
const PLACES: usize = 10;
const OF_ADDRESS: usize = 2;
const SHAPES: usize = 3;

/// Rough fits with a law elsewhere in place of the last effect, cheapest first. Fits within `tie` of chi² are equally
/// good.
pub(super) fn elsewhere(problem: &Problem, fit: &Fit, tie: f64) -> Vec<Fit> {
    let Some(mut shown) = Shown::last_effect(problem, fit) else { return Vec::new() };
    let all = alike(problem, fit);
    let own = all.iter().find(|slot| is_place_of(fit, slot));
    let more = own.and_then(|slot| shape(problem, fit, slot));
    let in_pieces = own.filter(|_| fit.model.effects.last().is_some_and(|law| is_in_pieces(law.spec())));
    match (own, in_pieces) {
        (_, Some(own)) => shown.keep_pieces(&all, own),
        (Some(own), None) => shown.keep(&all, own, more),
        (None, None) => {}
    }
    let located = shown.locate(&all, &all, more);
    let may_leave = f64::max(LEFT_SHARE * shown.whole(), LEFT_TIES * tie);
    // Of a sum, one of its shapes may do: with other weights, or once something else is modelled beside it.
    let is_sum = fit.model.effects.last().is_some_and(|law| is_sum(law.spec()));
    let is_other = |slot: &Slot| is_sum || !is_place_of(fit, slot);
    let does_the_same = |l: &&Located| l.gain > shown.whole() - may_leave && is_other(&l.slot);
    let mut places = some_of_each(located.iter().filter(does_the_same).map(|l| &l.slot));
    let summed = own.and_then(|own| Some((own, shapes_of_sum(problem, fit, own)?)));
    let mut sums = summed.map_or_else(Vec::new, |(own, shapes)| {
        let at: Vec<&Slot> = places.iter().copied().filter(|slot| is_over_the_same(slot, own)).collect();
        shown.sums_elsewhere(&all, &at, &shapes)
    });
    let bent: Vec<Slot> = places.iter().filter(|slot| !slot.is_constant()).map(|slot| slot.bent()).collect();
    places.extend(&bent);
    // What looks alike may well have the same shape there.
    let mut fits = shown.refits_with(&all, &places, SHAPES, more.map_or("", |(shape, _)| shape.text));
    fits.append(&mut sums);
    if let Some(own) = in_pieces {
        let at: Vec<&Slot> = all.iter().filter(|slot| is_over_the_same(slot, own)).collect();
        fits.extend(shown.pieces_elsewhere(&all, &at, shown.whole() - may_leave));
    }
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    fits
}

/// Whether a slot is over the variable of another, somewhere else.
fn is_over_the_same(slot: &Slot, own: &Slot) -> bool {
    (&slot.variable, &slot.reading) == (&own.variable, &own.reading) && slot.address != own.address
}

/// The first slots, a few per address; first ones of all addresses come before second ones.
fn some_of_each<'a>(slots: impl Iterator<Item = &'a Slot>) -> Vec<&'a Slot> {
    let mut ranked: Vec<(usize, &Slot)> = Vec::new();
    for slot in slots {
        let is_alike =
            |(_, own): &&(usize, &Slot)| own.address == slot.address && own.is_constant() == slot.is_constant();
        let before = ranked.iter().filter(is_alike).count();
        if before < OF_ADDRESS {
            ranked.push((before, slot));
        }
    }
    ranked.sort_by_key(|(before, _)| *before);
    ranked.into_iter().map(|(_, slot)| slot).take(PLACES).collect()
}

/// Whether a slot has the port and variable of the last effect.
fn is_place_of(fit: &Fit, slot: &Slot) -> bool {
    let is_listed_there = |e: &Placed| {
        let variables = &e.spec().variables;
        let is_over_own = variables.contains(&slot.variable) || variables.is_empty() && slot.is_constant();
        let is_over = is_over_own && slot.reading == Reading::Plain;
        // No curve of what is there now is a place for what remembers.
        e.spec().unlisted().is_none() && !e.spec().remembers && is_over && slot.address == verdict::port(e)
    };
    is_law_of(fit, slot) || fit.model.effects.last().is_some_and(is_listed_there)
}

/// The shape of the last law of a fit, if it belongs to this slot, and its scale.
pub(super) fn shape(problem: &Problem, fit: &Fit, slot: &Slot) -> Option<(&'static Shape, f64)> {
    let last = fit.model.effects.len().checked_sub(1)?;
    let law = &fit.model.effects[last].spec().unlisted()?.law;
    let is_its = |shape: &&Shape| {
        let own = variant(problem.case, slot, shape, 1.0);
        own.and_then(|v| v.placed.spec().unlisted()).is_some_and(|own| own.law.expression == law.expression)
    };
    // Of those with an exponent the function has the one that it starts with.
    let more = MORE_SHAPES.iter().filter(|shape| shape.start.is_none());
    let shape = slot.shapes().iter().chain(more).find(is_its)?;
    let values = &fit.model.effects_at(&fit.x[problem.case.parameters.len()..])[last].values;
    let parameters = &fit.model.effects[last].spec().parameters;
    let scale = parameters.iter().position(|p| p.key.starts_with(SCALE))?;
    Some((shape, values[scale]))
}

/// Candidate slots: all plain ones, those with the same kind of memory or product as the last effect, and for a law of
/// a coefficient the product that says the same. For effects of the catalogue only their own variables and constants,
/// since a law has a low prior beside them; for those with memory, any law with memory over their variables.
fn alike(problem: &Problem, fit: &Fit) -> Vec<Slot> {
    let mut plain = slots(problem.case, fit, Reach::Plain);
    let Some(last) = fit.model.effects.last() else { return Vec::new() };
    let Some(own) = last.spec().unlisted() else {
        let is_over_own = |slot: &Slot| last.spec().variables.contains(&slot.variable);
        plain.retain(|slot| slot.is_constant() || is_over_own(slot));
        plain.extend(steady(problem.case));
        if last.spec().remembers {
            let wide = slots(problem.case, fit, Reach::Wide).into_iter();
            plain.extend(wide.filter(|slot| slot.reading.remembers() && is_over_own(slot)));
        }
        return plain;
    };
    let variables: Vec<String> = own.law.variables().iter().map(|v| v.name()).collect();
    let product = own.law.address.port.as_product().filter(|_| !variables.is_empty());
    if own.law.states.is_empty() && variables.len() < 2 && product.is_none() {
        return plain;
    }
    let mut wide = slots(problem.case, fit, Reach::Wide);
    let own: Vec<Reading> = wide.iter().filter(|slot| is_law_of(fit, slot)).map(|slot| slot.reading.clone()).collect();
    let is_read_so = |slot: &Slot| own.iter().any(|reading| reading.is_like(&slot.reading));
    // The same law in other words: a resistance over time is a pressure drop over time and flow.
    let is_product = |slot: &Slot| {
        product.is_some_and(|(port, by)| slot.port == port && matches!(slot.reading, Reading::Times(q, _) if q == by))
    };
    let is_alike = |slot: &Slot| is_read_so(slot) || is_product(slot);
    wide.retain(|slot| slot.reading != Reading::Plain && variables.contains(&slot.variable) && is_alike(slot));
    plain.extend(wide);
    plain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::{Model, made::Bench};
    use crate::diagnose::grammar::{SHAPES, Term, sum};
    use crate::effects::{Element, find};
    use crate::laws::Quantity;
    use crate::scene::Override;

    /// A softer syringe, answered by a factor of the line's compliance: the syringe's compliance is an alternative,
    /// nothing in the muscle is.
    #[test]
    fn a_mere_number_has_other_places() {
        let softer = Override::parse("hydraulics.upstream_compliance_m3_pa=9e-15").expect("a key");
        let bench = Bench::with(&[softer]);
        let (problem, baseline) = (bench.open(), bench.baseline());
        let all = slots(&bench.case, &baseline, Reach::Plain);
        let of_line = all.iter().find(|slot| slot.is_constant() && slot.address == "line.compliance").expect("a slot");
        let own = variant(&bench.case, of_line, &of_line.shapes()[0], 1.0).expect("a law");
        let answered = bench.fit(&Model::baseline().plus(&own.placed, &[0.05]));
        let others = elsewhere(&problem, &answered, 6.0);
        let as_good = others.iter().filter(|fit| fit.cost < answered.cost + 6.0);
        let last = as_good.filter_map(|fit| fit.model.effects.last());
        let parameters = last.filter(|law| law.spec().unlisted().is_some_and(|own| own.law.variables().is_empty()));
        let parameters: Vec<String> = parameters.map(verdict::port).collect();
        assert_eq!(parameters, ["syringe.compliance"]);
        let is_in_muscle =
            |fit: &Fit| fit.model.effects.last().map(verdict::port).is_some_and(|p| p.starts_with("muscle"));
        assert!(answered.cost < baseline.cost - 1000.0 && !others.iter().any(is_in_muscle));
    }
    /// Laws with memory are alternatives only to effects with memory, over the same variables.
    #[test]
    fn only_what_remembers_has_places_that_do() {
        let case = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        let noise = [Noise::white(0.02)];
        let problem = Problem { case: &case, runs: case.subset(RunSet::Open), noise: &noise };
        let remembered = |id: &str| -> Vec<String> {
            let entry = find(id).expect("of the catalogue");
            let placed = Placed { entry, element: Element::of(entry.element, 0, 1), channel: None };
            let model = Model::baseline().plus(&placed, &entry.typical());
            let fit = problem.fit(&model, &problem.start(&model, None)).expect("it does not diverge");
            let all = alike(&problem, &fit).into_iter().filter(|slot| slot.reading.remembers());
            all.map(|slot| slot.variable.to_string()).collect()
        };
        let of_softening = remembered("mullins_softening");
        assert!(of_softening.len() > 10 && of_softening.iter().all(|v| v == "elongation_m"), "{of_softening:?}");
        assert!(remembered("leak").is_empty());
    }

    /// A resistance that grows with time is a pressure drop over time and flow.
    #[test]
    fn a_law_of_a_coefficient_has_the_product_that_says_the_same() {
        let bench = Bench::with(&[]);
        let (problem, fit) = (bench.open(), bench.baseline());
        let all = slots(&bench.case, &fit, Reach::Plain);
        let of_line = all.iter().find(|slot| slot.variable == "time_s" && slot.address == "line.resistance");
        let of_line = of_line.expect("a slot");
        let own = variant(&bench.case, of_line, &of_line.shapes()[0], 1.0).expect("a law");
        let model = Model::baseline().plus(&own.placed, &own.values);
        let x = problem.start(&model, None);
        let answered = Fit { model, x, cost: 0.0, ..fit };
        let products = alike(&problem, &answered).into_iter().filter(|slot| slot.reading != Reading::Plain);
        let products: Vec<(String, String, Reading)> =
            products.map(|slot| (slot.address, slot.variable, slot.reading)).collect();
        assert!(
            matches!(&products[..], [(at, over, Reading::Times(Quantity::Flow, _))] if at == "line.pressure_drop" && over == "time_s"),
            "{products:?}"
        );
        let others = elsewhere(&problem, &answered, 6.0);
        let is_product = |fit: &Fit| {
            let law = fit.model.effects.last().and_then(|e| e.spec().unlisted());
            law.is_some_and(|own| own.law.name == "line_pressure_drop_product")
        };
        assert!(others.iter().any(is_product), "{} others", others.len());
    }

    /// What is lost at the syringe is nearly what is lost behind the line, whatever its shape.
    #[test]
    fn a_sum_of_two_shapes_has_other_places_as_that_sum() {
        let bench = Bench::hiding("line.outflow adds 4e-11*(time_s/10.0)^2 - 6e-11*tanh(time_s/4.0)");
        let (problem, baseline) = (bench.open(), bench.baseline());
        let all = slots(&bench.case, &baseline, Reach::Plain);
        let slot = all.iter().find(|slot| slot.address == "line.outflow" && slot.variable == "time_s").expect("a slot");
        let shape = |text: &str| SHAPES.iter().find(|shape| shape.text == text).expect("a shape");
        let terms = [("x^2", 4e-11), ("tanh(x)", -6e-11)];
        let terms = terms.map(|(text, size)| Term { shape: shape(text), scale: slot.scale, size });
        let own = sum(&bench.case, slot, &terms).expect("a law");
        let answered = bench.fit(&Model::baseline().plus(&own.placed, &own.values));
        let known = shapes_of_sum(&problem, &answered, slot).expect("its shapes");
        assert_eq!(known.map(|(shape, _)| shape.text), ["x^2", "tanh(x)"]);
        let others = elsewhere(&problem, &answered, 6.0);
        let is_sum_at_syringe = |fit: &&Fit| {
            let last = fit.model.effects.last();
            last.is_some_and(|law| is_sum(law.spec()) && verdict::port(law) == "syringe.flow")
        };
        let other = others.iter().find(is_sum_at_syringe).expect("a sum at the syringe");
        let explained = baseline.cost - answered.cost;
        assert!(other.cost - answered.cost < 0.03 * explained, "{} {} {}", other.cost, answered.cost, baseline.cost);
    }

    /// A steady loss behind the line is as well one at the syringe.
    #[test]
    fn a_steady_flow_has_other_places() {
        let bench = Bench::hiding("syringe.flow adds -2e-12");
        let problem = bench.open();
        let entry = find("thermal_expansion").expect("of the catalogue");
        let placed = Placed { entry, element: Element::of(entry.element, 0, 1), channel: None };
        let model = Model::baseline().plus(&placed, &[-1e-12]);
        let answered = bench.fit(&model);
        let others = elsewhere(&problem, &answered, 6.0);
        let is_steady_at_syringe = |fit: &&Fit| {
            let last = fit.model.effects.last();
            let is_constant = |law: &Placed| law.spec().unlisted().is_some_and(|own| own.law.variables().is_empty());
            last.is_some_and(|law| is_constant(law) && verdict::port(law) == "syringe.flow")
        };
        let other = others.iter().find(is_steady_at_syringe).expect("a steady flow at the syringe");
        assert!(other.cost < answered.cost + 6.0, "{} {}", other.cost, answered.cost);
    }
}
