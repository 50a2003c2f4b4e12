//! Other places at which a law would do the same: what the sensors cannot tell apart.
//!
//! Where two places come out alike, the search stumbles on one of them. Along the runs of the model that was found signals are injected at
//! every port; a slot whose curves imitate what the found effect does, all but what chance could make, the parameters of the calibration free,
//! is another place for it: over the same variable, over none, or, of a law, over another that goes with it in these runs.

use super::shown::{Located, Shown};
use super::unlisted::is_law_of;
use crate::diagnose::fit::{Fit, Placed, Problem};
use crate::diagnose::grammar::{Reach, Reading, Shape, Slot, slots, variant};
use crate::diagnose::verdict;

/// Share of what an effect does that a slot's curve may leave, or so many times the chi² by which other models are as good: the curve is no
/// law yet.
const LEFT_SHARE: f64 = 0.03;
const LEFT_TIES: f64 = 3.0;
/// Other places that are tried, at most so many over a variable at one address, in so many shapes each.
const PLACES: usize = 10;
const OF_ADDRESS: usize = 2;
const SHAPES: usize = 3;

/// Fits with a law at another place instead of the last effect of a fit, cheapest first: of those places that may do the same. Other models
/// are as good within `tie` of chi².
pub(super) fn elsewhere(problem: &Problem, fit: &Fit, tie: f64) -> Vec<Fit> {
    let Some(mut shown) = Shown::last_effect(problem, fit) else { return Vec::new() };
    let all = alike(problem, fit);
    let own = all.iter().find(|slot| is_place_of(fit, slot));
    let more = own.and_then(|slot| shape(problem, fit, slot));
    if let Some(own) = own {
        shown.keep(&all, own, more);
    }
    let located = shown.locate(&all, &all, more);
    let may_leave = f64::max(LEFT_SHARE * shown.whole(), LEFT_TIES * tie);
    let does_the_same = |l: &&Located| l.gain > shown.whole() - may_leave && !is_place_of(fit, &l.slot);
    let mut places = some_of_each(located.iter().filter(does_the_same).map(|l| &l.slot));
    let bent: Vec<Slot> = places.iter().filter(|slot| !slot.is_constant()).map(|slot| slot.bent()).collect();
    places.extend(&bent);
    shown.refits(&all, &places, SHAPES)
}

/// The first slots, a few of each address; one of each address comes before a second.
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

/// Whether a slot is where the last effect of a fit acts, over what that depends on.
fn is_place_of(fit: &Fit, slot: &Slot) -> bool {
    let is_listed_there = |e: &Placed| {
        let is_over = e.spec().variables.contains(&slot.variable) && slot.reading == Reading::Plain;
        // No curve of what is there now is a place for what remembers.
        e.spec().unlisted().is_none() && !e.spec().remembers && is_over && slot.address == verdict::port(e)
    };
    is_law_of(fit, slot) || fit.model.effects.last().is_some_and(is_listed_there)
}

/// The shape of a fit's last law, which is one of this slot, and its scale.
fn shape(problem: &Problem, fit: &Fit, slot: &Slot) -> Option<(&'static Shape, f64)> {
    let last = fit.model.effects.len().checked_sub(1)?;
    let law = &fit.model.effects[last].spec().unlisted()?.law;
    let is_its = |shape: &&Shape| {
        let own = variant(problem.case, slot, shape, 1.0);
        own.and_then(|v| v.placed.spec().unlisted()).is_some_and(|own| own.law.expression == law.expression)
    };
    let shape = slot.shapes().iter().find(is_its)?;
    let values = &fit.model.effects_at(&fit.x[problem.case.parameters.len()..])[last].values;
    let parameters = &fit.model.effects[last].spec().parameters;
    let scale = parameters.iter().position(|p| p.key.starts_with("scale"))?;
    Some((shape, values[scale]))
}

/// Every slot over a variable or none, and those whose law remembers or multiplies as the last effect of a fit does. For an effect of the
/// catalogue those over its own variables and over none must do: beside it a law counts little. Of one that remembers it is not known how a
/// law would.
fn alike(problem: &Problem, fit: &Fit) -> Vec<Slot> {
    let mut plain = slots(problem.case, fit, Reach::Plain);
    let Some(last) = fit.model.effects.last() else { return Vec::new() };
    let Some(own) = last.spec().unlisted() else {
        let is_over_own = |slot: &Slot| last.spec().variables.contains(&slot.variable);
        plain.retain(|slot| slot.is_constant() || is_over_own(slot));
        if last.spec().remembers {
            let wide = slots(problem.case, fit, Reach::Wide).into_iter();
            plain.extend(wide.filter(|slot| slot.reading.remembers() && is_over_own(slot)));
        }
        return plain;
    };
    let variables: Vec<String> = own.law.variables().iter().map(|v| v.name()).collect();
    if own.law.states.is_empty() && variables.len() < 2 {
        return plain;
    }
    let mut wide = slots(problem.case, fit, Reach::Wide);
    let own: Vec<Reading> = wide.iter().filter(|slot| is_law_of(fit, slot)).map(|slot| slot.reading.clone()).collect();
    let is_read_so = |slot: &Slot| own.iter().any(|reading| reading.is_like(&slot.reading));
    wide.retain(|slot| slot.reading != Reading::Plain && variables.contains(&slot.variable) && is_read_so(slot));
    plain.extend(wide);
    plain
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::Model;
    use crate::effects::{Element, find};
    use crate::scene::Override;

    /// A syringe that gives more, answered with the line's compliance times a number: the syringe's does the same, and nothing in the muscle.
    #[test]
    fn a_mere_number_has_other_places() {
        let softer = Override::parse("hydraulics.upstream_compliance_m3_pa=9e-15").expect("a key");
        let channels = ["elongation_mm", "pressure_kpa"];
        let mut case = made::recorded("muscle_bench", &[softer], &["plunger_mm"], &channels);
        case.parameters.clear();
        let noise = [0.01, 1.0].map(Noise::white);
        let problem = Problem { case: &case, runs: case.subset(RunSet::Open), noise: &noise };
        let fit = |model: &Model| problem.fit(model, &problem.start(model, None)).expect("it does not diverge");
        let baseline = fit(&Model::baseline());
        let all = slots(&case, &baseline, Reach::Plain);
        let of_line = all.iter().find(|slot| slot.is_constant() && slot.address == "line.compliance").expect("a slot");
        let own = variant(&case, of_line, &of_line.shapes()[0], 1.0).expect("a law");
        let answered = fit(&Model::baseline().plus(&own.placed, &[0.05]));
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
    /// Of what remembers are asked laws that do as well, over its own variables; of what does not, none.
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
}
