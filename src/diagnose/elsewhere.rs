//! Other places at which a law would do the same: what the sensors cannot tell apart.
//!
//! Where two places come out alike, the search stumbles on one of them. Along the runs of the model that was found signals are injected at
//! every port; a slot whose curves imitate all that the found law does, the numbers of the calibration free, is another place for it.

use super::fit::{Fit, Problem};
use super::grammar::{Reach, Slot, slots};
use super::reading::Reading;
use super::shown::{Located, Shown};
use super::unlisted::is_law_of;

/// Share of what an effect does that a slot's curve must imitate.
const AS_MUCH: f64 = 0.97;
/// Other places that are tried, at most so many at one address, in so many shapes each.
const PLACES: usize = 8;
const OF_ADDRESS: usize = 2;
const SHAPES: usize = 3;

/// Fits with a law at another place instead of the last effect of a fit, cheapest first: of those places that may do the same.
pub(super) fn elsewhere(problem: &Problem, fit: &Fit) -> Vec<Fit> {
    let Some(shown) = Shown::last_effect(problem, fit) else { return Vec::new() };
    let all = alike(problem, fit);
    let located = shown.locate(&all);
    let does_the_same = |l: &&Located| l.gain > AS_MUCH * shown.whole() && !is_law_of(fit, &l.slot);
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

/// The slots that a law of a kind may have: what reads its variable as it does, and where it reads it plainly, mere numbers as well.
fn alike(problem: &Problem, fit: &Fit) -> Vec<Slot> {
    let plain = slots(problem.case, fit, Reach::Plain);
    let remembers = fit.model.effects.last().and_then(|e| e.spec().unlisted()).is_some_and(|w| !w.law.states.is_empty());
    if !remembers || plain.iter().any(|slot| is_law_of(fit, slot)) {
        return plain;
    }
    let mut wide = slots(problem.case, fit, Reach::Wide);
    let own: Vec<Reading> = wide.iter().filter(|slot| is_law_of(fit, slot)).map(|slot| slot.reading.clone()).collect();
    wide.retain(|slot| own.iter().any(|reading| reading.is_like(&slot.reading)));
    wide
}
