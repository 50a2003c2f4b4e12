//! Other places at which a law would do the same: what the sensors cannot tell apart.
//!
//! Where two places come out alike, the search stumbles on one of them. Along the runs of the model that was found signals are injected at
//! every port; a slot whose curves imitate all that the found law does, the numbers of the calibration free, is another place for it.

use super::shown::{Located, Shown};
use super::unlisted::is_law_of;
use crate::diagnose::fit::{Fit, Placed, Problem};
use crate::diagnose::grammar::{Reach, Reading, Shape, Slot, slots, variant};
use crate::diagnose::verdict;

/// Share of what an effect does that a slot's curve must imitate.
const AS_MUCH: f64 = 0.97;
/// Other places that are tried, at most so many at one address, in so many shapes each.
const PLACES: usize = 8;
const OF_ADDRESS: usize = 2;
const SHAPES: usize = 3;

/// Fits with a law at another place instead of the last effect of a fit, cheapest first: of those places that may do the same.
pub(super) fn elsewhere(problem: &Problem, fit: &Fit) -> Vec<Fit> {
    let Some(mut shown) = Shown::last_effect(problem, fit) else { return Vec::new() };
    let all = alike(problem, fit);
    let own = all.iter().find(|slot| is_place_of(fit, slot));
    let more = own.and_then(|slot| shape(problem, fit, slot));
    if let Some(own) = own {
        shown.keep(&all, own, more);
    }
    let located = shown.locate(&all, &all, more);
    let does_the_same = |l: &&Located| l.gain > AS_MUCH * shown.whole() && !is_place_of(fit, &l.slot);
    let mut places: Vec<&Slot> = Vec::new();
    for own in located.iter().filter(does_the_same) {
        let of_address = places.iter().filter(|p| p.address == own.slot.address).count();
        if of_address < OF_ADDRESS && places.len() < PLACES {
            places.push(&own.slot);
        }
    }
    let bent: Vec<Slot> = places.iter().filter(|slot| !slot.is_constant()).map(|slot| slot.bent()).collect();
    places.extend(&bent);
    shown.refits(&all, &places, SHAPES)
}

/// Whether a slot is where the last effect of a fit acts, over what that depends on.
fn is_place_of(fit: &Fit, slot: &Slot) -> bool {
    let is_listed_there = |e: &Placed| {
        let is_over = e.spec().variables.contains(&slot.variable) && slot.reading == Reading::Plain;
        e.spec().unlisted().is_none() && is_over && slot.address == verdict::port(e)
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

/// The slots over the variables of a fit's last effect, read as it reads them, and mere numbers. Over another variable it is another law: that
/// two go together in these runs is for the search to find.
fn alike(problem: &Problem, fit: &Fit) -> Vec<Slot> {
    let Some(last) = fit.model.effects.last() else { return Vec::new() };
    let variables: Vec<String> = match last.spec().unlisted() {
        Some(own) => own.law.variables().iter().map(|v| v.name()).collect(),
        None => last.spec().variables.clone(),
    };
    let is_over = |slot: &Slot| slot.is_constant() || variables.contains(&slot.variable);
    let mut plain = slots(problem.case, fit, Reach::Plain);
    plain.retain(is_over);
    let remembers = last.spec().unlisted().is_some_and(|own| !own.law.states.is_empty());
    if !remembers && variables.len() < 2 {
        return plain;
    }
    let mut wide = slots(problem.case, fit, Reach::Wide);
    let own: Vec<Reading> = wide.iter().filter(|slot| is_law_of(fit, slot)).map(|slot| slot.reading.clone()).collect();
    wide.retain(|slot| is_over(slot) && own.iter().any(|reading| reading.is_like(&slot.reading)));
    if wide.is_empty() { plain } else { wide }
}
