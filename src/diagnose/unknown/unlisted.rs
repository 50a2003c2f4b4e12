//! Proposes laws that nobody listed.
//!
//! Every slot of the grammar (a port and a variable) is screened first: small signals of several shapes are injected at
//! its port, and their best combination tells how much any law there could explain. All shapes, and the constant, are
//! then screened around the best slots; the best candidates are refitted jointly with the calibration.

use super::forms::{finished, leaves_something};
use super::grown::located_again;
use super::shown::{Located, Shown};
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::grammar::{Reach, Reading, Slot, slots};
use crate::diagnose::latent::{Latent, latents, likely};
use crate::parallel;

/// Maximum number of slots whose best shape is refitted. All shapes are tried around the best [`WIDENED`].
const SLOTS: usize = 14;
/// Of these, slots at the places where an unknown signal is most likely come first: in all, at ports of one kind, and at one place.
const SLOTS_BY_PLACE: usize = 8;
const SLOTS_OF_PORT: usize = 3;
const SLOTS_OF_PLACE: usize = 2;
/// So many promise most, each on an element of its own, and are refitted whatever they are like: ports of one element crowd out others.
const SLOTS_BY_GAIN: usize = 4;
/// Slots are alike if they explain the same part of the misfit but for this share.
const ALIKE: f64 = 0.03;
/// Slots that promise less than this share of the best are skipped.
const WORTH: f64 = 0.1;
/// Number of the best slots that are compared with each other.
const COMPARED: usize = 60;
const WIDENED: usize = 4;
/// Against an answer, the best curve must promise this share of what the answer explains beyond the fit that laws are added to. A
/// choice: derivatives promise too little where the scene is far off, by how much was not measured.
const HALF_WAY: f64 = 0.5;
/// Constant laws that are refitted beside them.
const NUMBERS: usize = 4;
/// Shapes refitted per slot; refits that are converged.
const SHAPES_OF_SLOT: usize = 6;
const FINISHED: usize = 6;

/// Laws proposed for the misfit of a fit.
pub(in crate::diagnose) struct Proposals {
    /// Refits with one law more, cheapest first; the law is the last effect.
    pub fits: Vec<Fit>,
    /// A curve of pieces, if one is clearly better than the best simple law: a description, where nothing else comes near.
    pub curve: Option<Fit>,
}

impl Proposals {
    /// Refits the best of them with other weights or steps.
    pub fn again(self, problem: &Problem) -> Self {
        let best = &self.fits[..self.fits.len().min(FINISHED)];
        let mut fits: Vec<Fit> = parallel::map(best, |f| problem.fit(&f.model, &f.x)).into_iter().flatten().collect();
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        Self { fits, ..self }
    }
}

/// Screens all slots at a fit and refits the best laws. `None` if the fit cannot be simulated.
pub(in crate::diagnose) fn propose(
    problem: &Problem,
    from: &Fit,
    reach: Reach,
    say: &dyn Fn(String),
) -> Option<Proposals> {
    propose_against(problem, (from, None), reach, say)
}

/// The same against an answer that leaves this chi²: `None` also where no curve at any slot promises half of the way there, because refits
/// cost nearly all of the time.
pub(super) fn propose_against(
    problem: &Problem,
    (from, answer): (&Fit, Option<f64>),
    reach: Reach,
    say: &dyn Fn(String),
) -> Option<Proposals> {
    let all = slots(problem.case, from, reach);
    if all.is_empty() {
        return None;
    }
    let known = problem.rows_of(from)?;
    // What channels show is no place in the rig.
    let likely = if reach == Reach::Channels { Vec::new() } else { likely(latents(problem, from, &known)) };
    let is_likely = |slot: &&Slot| likely.is_empty() || likely.iter().any(|latent| latent.address == slot.address);
    let some: Vec<Slot> = all.iter().filter(is_likely).cloned().collect();
    let shown = Shown::misfit(problem, from, known);
    let located = shown.locate(&all, &some, None);
    let place = likely.first().map_or("no place is asked for", |latent| &latent.address);
    say(format!(
        "an unknown signal: {place}; {} slots of {} screened, the best {} on {}",
        some.len(),
        all.len(),
        address(&located),
        variable(&located)
    ));
    let needed = answer.map_or(0.0, |cost| HALF_WAY * (from.cost - cost));
    if located.first().is_some_and(|best| best.gain < needed) {
        say(format!("no law beside {} comes near the answer", from.model.title()));
        return None;
    }
    let best = several_ports(&located, &likely);
    let (mut fits, mut curve) = (shown.refits(&all, &best, 1), None);
    // Curves show where laws of other shapes are worth trying. A shape that explains it all needs no other.
    let is_explained = fits.first().is_some_and(|fit| !leaves_something(problem, fit));
    let curves = if is_explained { Vec::new() } else { shown.curves(&all, &best) };
    let wide = worth_widening(&best, fits.iter().chain(&curves));
    say(format!(
        "shapes of {} at {}",
        wide.first().map_or("", |s| &s.variable),
        wide.first().map_or("", |s| &s.address)
    ));
    let parameters = some.iter().filter(|slot| slot.is_constant() && !best.contains(slot));
    let parameters = parameters.filter(|slot| wide.iter().any(|w| w.address == slot.address));
    let more: Vec<&Slot> = wide.iter().copied().chain(parameters).collect();
    fits.extend(shown.refits(&all, &more, SHAPES_OF_SLOT));
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    if let Some(simple) = fits.first().filter(|fit| reach == Reach::Plain && leaves_something(problem, fit)) {
        say(format!("a curve of pieces, beside {}", simple.model.title()));
        let other = shown.recognised(&all, &asked_for_curves(&best, &some, &likely), simple);
        curve = other.curve;
        fits.extend(other.fits);
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    }
    if reach == Reach::Wide {
        fits.extend(bent(&shown, &all, &wide, &fits));
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    }
    fits.dedup_by(|a, b| a.model.effects == b.model.effects);
    Some(Proposals { fits: to_the_end(problem, fits, from.cost, (reach, say)), curve })
}

/// The best of some rough refits converged, and laws located again along the runs of the first. `before`: chi² without a law.
fn to_the_end(problem: &Problem, fits: Vec<Fit>, before: f64, (reach, say): (Reach, &dyn Fn(String))) -> Vec<Fit> {
    say(format!("the best {FINISHED} of {} refits to the end", fits.len()));
    let fits = finished(problem, fits, FINISHED, before);
    if reach == Reach::Plain { located_again(problem, fits, before, say) } else { fits }
}

/// The slots at the most likely place, and the best ones elsewhere.
fn asked_for_curves<'a>(best: &[&'a Slot], some: &'a [Slot], likely: &[Latent]) -> Vec<&'a Slot> {
    let is_there = |slot: &&Slot| likely.first().is_some_and(|first| first.address == slot.address);
    some.iter().filter(is_there).chain(best.iter().copied().filter(|slot| !is_there(slot))).collect()
}

/// Refits with further shapes at the slot of the best law, if that leaves something and the slot has had the simple ones alone.
fn bent(shown: &Shown, all: &[Slot], wide: &[&Slot], fits: &[Fit]) -> Vec<Fit> {
    let first = fits.first().filter(|fit| leaves_something(shown.problem, fit));
    let own = first.and_then(|fit| wide.iter().find(|slot| is_law_of(fit, slot)));
    let own = own.filter(|slot| slot.reading != Reading::Plain).map(|slot| slot.bent());
    own.map_or_else(Vec::new, |own| shown.refits(all, &[&own], SHAPES_OF_SLOT))
}

/// The slots whose law or curve leaves least.
fn worth_widening<'a, 'f>(best: &[&'a Slot], fits: impl Iterator<Item = &'f Fit>) -> Vec<&'a Slot> {
    let mut fits: Vec<&'f Fit> = fits.collect();
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut wide: Vec<&Slot> = Vec::new();
    for fit in fits {
        let own = best.iter().copied().find(|slot| is_law_of(fit, slot));
        let own = own.filter(|slot| !slot.is_constant() && !wide.contains(slot));
        wide.extend(own.filter(|_| wide.len() < WIDENED));
    }
    wide
}

/// The best slots and the best constants: some at the most likely places, those that promise most, then such as are unlike these. What derivatives
/// promise is little to go by where the scene is far off, and slots that are alike then fail together; where it is not, they are told apart by
/// refits alone.
pub(super) fn several_ports<'a>(located: &'a [Located], latents: &'a [Latent]) -> Vec<&'a Slot> {
    let least = WORTH * located.first().map_or(0.0, |best| best.gain);
    let over_variables = || located.iter().filter(|l| !l.slot.is_constant() && l.gain > least);
    let of_place =
        |latent: &'a Latent| over_variables().filter(move |l| l.slot.address == latent.address).take(SLOTS_OF_PLACE);
    let mut promising: Vec<&Slot> = Vec::new();
    for own in over_variables().map(|l| &l.slot) {
        if promising.len() < SLOTS_BY_GAIN && promising.iter().all(|other| other.element() != own.element()) {
            promising.push(own);
        }
    }
    let mut best: Vec<&Located> = Vec::new();
    let mut others: Vec<(usize, &Located)> = Vec::new();
    for own in latents.iter().flat_map(of_place).chain(over_variables().take(COMPARED)) {
        let mut known = best.iter().copied().chain(others.iter().map(|(_, other)| *other));
        if known.any(|other| other.slot == own.slot) {
            continue;
        }
        let of_port = best.iter().filter(|b| b.slot.port == own.slot.port).count();
        let is_by_gain = promising.contains(&&own.slot);
        if is_by_gain || of_port < SLOTS_OF_PORT && best.len() < SLOTS_BY_PLACE {
            best.push(own);
        } else {
            let before = others.iter().map(|(_, other)| *other).chain(best.iter().copied());
            others.push((before.filter(|other| own.is_like(other, ALIKE)).count(), own));
        }
    }
    others.sort_by_key(|(alike, _)| *alike);
    let numbers = located.iter().map(|l| &l.slot).filter(|slot| slot.is_constant()).take(NUMBERS);
    let slots = best.into_iter().chain(others.into_iter().map(|(_, other)| other)).map(|l| &l.slot);
    slots.take(SLOTS).chain(numbers).collect()
}

/// Whether the last effect of a fit is a law at this slot.
pub(super) fn is_law_of(fit: &Fit, slot: &Slot) -> bool {
    let Some(written) = fit.model.effects.last().and_then(|e| e.spec().unlisted()) else { return false };
    let law = &written.law;
    let variables = law.variables();
    let is_over = match slot.is_constant() {
        true => variables.is_empty(),
        false => variables.iter().any(|v| v.name() == slot.variable),
    };
    // Of a product, the variable that has the shape.
    let has_scale = slot.is_constant() || law.parameter(&slot.scale_name()).is_some();
    law.name == slot.name() && is_over && has_scale
}

fn address(located: &[Located]) -> &str {
    located.first().map_or("none", |l| &l.slot.address)
}

fn variable(located: &[Located]) -> &str {
    located.first().map_or("nothing", |l| &l.slot.variable)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::made::Bench;

    /// Wherever an unknown signal seems to be: the latents in the wrong order, the unlikeliest first.
    #[test]
    fn those_that_promise_most_are_refitted() {
        let bench = Bench::hiding("muscle.pull adds 0.1 * (time_s/10.0)^2");
        let (problem, baseline) = (bench.open(), bench.baseline());
        let all = slots(&bench.case, &baseline, Reach::Plain);
        let known = problem.rows_of(&baseline).expect("it does not diverge");
        let mut latents = latents(&problem, &baseline, &known);
        latents.reverse();
        let located = Shown::misfit(&problem, &baseline, known).locate(&all, &all, None);
        let mut promising: Vec<&Slot> = Vec::new();
        let least = WORTH * located[0].gain;
        for slot in located.iter().filter(|l| l.gain > least).map(|l| &l.slot).filter(|slot| !slot.is_constant()) {
            if promising.iter().all(|other| other.element() != slot.element()) {
                promising.push(slot);
            }
        }
        let chosen = several_ports(&located, &latents);
        assert!(chosen.len() <= SLOTS + NUMBERS && promising.len() >= 2, "{}", promising.len());
        for slot in promising.iter().take(SLOTS_BY_GAIN) {
            assert!(chosen.contains(slot), "{} over {}", slot.address, slot.variable);
        }
    }
}
