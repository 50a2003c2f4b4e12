//! Refits a model with a law more, at slots that were shown to explain some of the misfit.

use std::ops::Range;

use nalgebra::DVector;
use rayon::prelude::*;

use super::shown::{Shown, Wanted, of_curve};
use super::span::sizes;
use crate::diagnose::fit::{Fit, Model, Rows, Sides, Underway, Variant};
use crate::diagnose::grammar::{Reading, Shape, Slot, curve, variant};
use crate::parallel;

/// Scales tried for a shape, relative to the slot's.
pub(super) const SCALES: [f64; 3] = [1.0, 0.4, 2.0];
/// Sizes to start with are made smaller by this share, at most so many times, if they leave so many times what was there without the law.
const SHORTEN: f64 = 0.25;
const SHORTER: usize = 4;
const FAR_OFF: f64 = 30.0;
/// Steps of every refit; number of refits that continue, and their further steps.
const FIRST_STEPS: usize = 4;
pub(super) const GOING_ON: usize = 8;
/// Of these, refits over one variable at one place: after a few steps chi² says little of shapes that have yet to find their scale.
const GOING_ON_OF_PLACE: usize = 3;
const MORE_STEPS: usize = 20;

/// The shape that a slot's law has before any other, and the share of the most promising one's gain that it must promise.
const SIMPLEST: &str = "x";
const NEARLY: f64 = 0.5;

/// A model with one law more, its start values, and where among them the sizes of its shapes are.
pub(super) struct Candidate {
    pub model: Model,
    pub x: Vec<f64>,
    sizes: Range<usize>,
}

/// Refits, cheapest first, with those beyond the first few of a place and variable behind all others.
fn some_of_each_place(underway: Vec<Underway>) -> Vec<Underway> {
    let place = |own: &Underway| -> Option<(String, Vec<String>)> {
        let law = &own.model.effects.last()?.spec().unlisted()?.law;
        Some((law.address.to_string(), law.variables().iter().map(|v| v.name()).collect()))
    };
    let mut known = Vec::new();
    let (first, others): (Vec<Underway>, Vec<Underway>) = underway.into_iter().partition(|own| {
        let place = place(own);
        let before = known.iter().filter(|other| **other == place).count();
        known.push(place);
        before < GOING_ON_OF_PLACE
    });
    first.into_iter().chain(others).collect()
}

impl Shown<'_> {
    /// Joint rough refits with a law at each slot in its most promising shapes, at most so many per slot; cheapest
    /// first.
    pub fn refits(&self, all: &[Slot], best: &[&Slot], most: usize) -> Vec<Fit> {
        self.refits_with(all, best, most, SIMPLEST)
    }

    /// The same, with a shape that every slot has if it promises nearly as much as the best there.
    pub fn refits_with(&self, all: &[Slot], best: &[&Slot], most: usize, always: &str) -> Vec<Fit> {
        self.refitted(&self.shapes(all, best, most, always), GOING_ON)
    }

    /// The same with a free curve at each slot. None is converged, because a curve is not an answer.
    pub fn curves(&self, all: &[Slot], best: &[&Slot]) -> Vec<Fit> {
        let plain: Vec<&Slot> =
            best.iter().copied().filter(|s| !s.is_constant() && s.reading == Reading::Plain).collect();
        let wanted: Vec<Wanted> = plain.iter().flat_map(|slot| of_curve(slot, None)).collect();
        let mut signatures = self.signatures(all, &wanted).into_iter();
        let candidates: Vec<Candidate> = plain
            .iter()
            .filter_map(|slot| {
                let own: Vec<Option<DVector<f64>>> = signatures.by_ref().take(slot.basis().count()).collect();
                let own: Vec<DVector<f64>> = own.into_iter().collect::<Option<_>>()?;
                let sizes = sizes(&own, &self.left);
                let mut own = curve(self.problem.case, slot)?;
                own.values.iter_mut().zip(&sizes).for_each(|(value, size)| *value = size * slot.action.typical);
                Some(self.with(&own, sizes.len()))
            })
            .collect();
        self.refitted(&candidates, 0)
    }

    /// A refit begun at start values at which the model is something like itself: derivatives may promise sizes at which it is not. A law may
    /// well leave more at first than there was without it, because the calibration has yet to follow.
    fn begin(&self, candidate: &Candidate) -> Option<Underway> {
        let (model, known) = (&candidate.model, self.from.x.len());
        let problem = &self.coarse;
        let rows = |x: &[f64]| problem.rows(model, x, known..x.len(), Sides::One);
        let is_far_off = |own: &Rows| own.residual.norm_squared() >= FAR_OFF * self.from.cost;
        let mut x = candidate.x.clone();
        let mut own = rows(&x);
        for _ in 0..SHORTER {
            if own.as_ref().is_some_and(|own| !is_far_off(own)) {
                break;
            }
            x[candidate.sizes.clone()].iter_mut().for_each(|size| *size *= SHORTEN);
            own = rows(&x);
        }
        let own = own?;
        let mut jacobian = self.jacobian.clone().resize_horizontally(x.len(), 0.0);
        jacobian.columns_mut(known, own.jacobian.ncols()).copy_from(&own.jacobian);
        Some(problem.begin(model, x, Rows { residual: own.residual, jacobian }))
    }

    /// Rough fits; the best `going_on` of them continue, and their chi² is exact.
    pub(super) fn refitted(&self, candidates: &[Candidate], going_on: usize) -> Vec<Fit> {
        let problem = &self.coarse;
        let begin = |candidate: &Candidate| Some(problem.go_on(self.begin(candidate)?, FIRST_STEPS));
        let mut underway: Vec<Underway> = parallel::map(candidates, begin).into_iter().flatten().collect();
        underway.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
        let underway = some_of_each_place(underway);
        let finish = |(place, fit): (usize, Underway)| {
            if place >= going_on {
                return Some(problem.end(fit));
            }
            let fit = problem.end(problem.go_on(fit, MORE_STEPS));
            Some(Fit { cost: self.problem.cost_at(&fit.model, &fit.x)?, ..fit })
        };
        let mut fits: Vec<Fit> = underway.into_par_iter().enumerate().filter_map(finish).collect();
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        fits
    }

    /// The most promising shapes of these slots, at most so many per slot, as candidates for a refit. The simplest one and `always` are among
    /// them if they promise nearly as much: a shape that is steeper by its extremes may promise more, and leave the model in another valley.
    fn shapes(&self, all: &[Slot], best: &[&Slot], most: usize, always: &str) -> Vec<Candidate> {
        let scales = |shape: &Shape| if shape.has_scale { &SCALES[..] } else { &SCALES[..1] };
        let wanted: Vec<Wanted> = best
            .iter()
            .flat_map(|&slot| slot.distinct(slot.shapes()).into_iter().map(move |shape| (slot, shape)))
            .flat_map(|(slot, shape)| scales(shape).iter().map(move |s| Wanted { slot, shape, scale: s * slot.scale }))
            .collect();
        let signatures = self.signatures(all, &wanted);
        let mut promised: Vec<(f64, f64, Wanted)> = wanted
            .iter()
            .zip(signatures)
            .filter_map(|(w, signature)| {
                let signature = signature?;
                let length = signature.norm().max(f64::MIN_POSITIVE);
                let amplitude = signature.dot(&self.left) / length;
                Some((amplitude * amplitude, amplitude / length * w.slot.action.typical, *w))
            })
            .collect();
        promised.sort_by(|a, b| b.0.total_cmp(&a.0));
        let top = |slot: &Slot| promised.iter().find(|(.., w)| w.slot == slot).map_or(0.0, |(gain, ..)| *gain);
        let is_extra =
            |gain: f64, w: &Wanted| [SIMPLEST, always].contains(&w.shape.text) && gain > NEARLY * top(w.slot);
        let mut taken: Vec<Wanted> = Vec::new();
        let mut candidates = Vec::new();
        for &(gain, size, w) in &promised {
            let is_same = |t: &&Wanted| t.slot == w.slot && t.shape.text == w.shape.text;
            let of_slot = taken.iter().filter(|t| t.slot == w.slot).count();
            if taken.iter().any(|t| is_same(&t)) || (of_slot >= most && !is_extra(gain, &w)) {
                continue;
            }
            taken.push(w);
            candidates.extend(self.candidate(&w, size));
        }
        candidates
    }

    fn candidate(&self, w: &Wanted, size: f64) -> Option<Candidate> {
        let mut own = variant(self.problem.case, w.slot, w.shape, w.scale / w.slot.scale)?;
        let range = own.placed.spec().parameters[0].range;
        own.values[0] = size.clamp(range.min, range.max);
        Some(self.with(&own, 1))
    }

    /// A law added to the model; its first fitted parameters are so many sizes.
    pub(super) fn with(&self, own: &Variant, sizes: usize) -> Candidate {
        let model = self.from.model.plus(&own.placed, &own.values);
        let mut x = self.from.x.clone();
        x.extend(model.numbers.last().into_iter().flat_map(|own| &own.fitted).map(|&i| own.values[i]));
        let first = self.from.x.len();
        Candidate { model, x, sizes: first..first + sizes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::made::Bench;
    use crate::diagnose::grammar::{Reach, slots};
    use crate::diagnose::verdict::port;

    /// Six shapes at one place, and one elsewhere that is behind all of them.
    #[test]
    fn refits_of_another_place_have_their_turn() {
        let bench = Bench::hiding("muscle.pull adds 0.1 * sin(elongation_m/3e-3)");
        let (problem, baseline) = (bench.open(), bench.baseline());
        let all = slots(&bench.case, &baseline, Reach::Plain);
        let shown = Shown::misfit(&problem, &baseline, problem.rows_of(&baseline).expect("it does not diverge"));
        let slot = |address: &str| {
            all.iter().find(|slot| slot.address == address && slot.variable == "elongation_m").expect("a slot")
        };
        let of = |slot: &Slot, most: usize| shown.shapes(&all, &[slot], most, "x").into_iter().take(most);
        let candidates: Vec<Candidate> = of(slot("muscle.pull"), 6).chain(of(slot("muscle.area"), 1)).collect();
        let begun: Vec<Underway> = candidates.iter().filter_map(|candidate| shown.begin(candidate)).collect();
        let ports = |all: &[Underway]| -> Vec<String> {
            all.iter().filter_map(|own| own.model.effects.last()).map(port).collect()
        };
        assert_eq!(ports(&begun).iter().position(|at| at == "muscle.area"), Some(6));
        let ordered = ports(&some_of_each_place(begun));
        assert_eq!(ordered.iter().position(|at| at == "muscle.area"), Some(GOING_ON_OF_PLACE));
        assert_eq!(ordered.len(), 7);
    }
}
