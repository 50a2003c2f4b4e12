//! Chooses among equally good fits, and the alternatives that an answer names.

use super::elsewhere::elsewhere;
use super::freed::freed_elsewhere;
use super::simpler::simpler;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::search::{Found, cross_validates, cross_validates_runs, least_gain};
use crate::diagnose::verdict::{self, misfit};
use crate::parallel;

/// Fits are called equally good within so many units of chi²: odds of one to twenty.
pub(in crate::diagnose) const SAME: f64 = 6.0;
/// Two laws at one place whose chi² differ by no more are the same law in other words.
const SAME_LAW: f64 = 0.01;
/// Rough fits are converged if they lie within this many ties of the best.
const NEARLY: f64 = 20.0;
/// A rough fit leaves at most this many times what the converged one leaves.
const STILL_TO_COME: f64 = 2.0;
/// Significance of the remaining misfit, standard errors.
const SEEN: f64 = 3.0;
/// An answer with a law replaces one of the catalogue if its criterion is lower by this much.
pub(super) const CLEARLY: f64 = 20.0;
/// Price per letter of a law among equally good forms, in units of the criterion.
const PER_LETTER: f64 = 0.02;
/// Maximum number of alternatives named.
const MOST_FORMS: usize = 4;

/// Schwarz's criterion with the dispersion of the best of several models: `chi² / dispersion + parameters ln(samples)`.
pub(super) struct Criterion {
    dispersion: f64,
    per_parameter: f64,
}

impl Criterion {
    pub fn of<'a>(problem: &Problem, fits: impl IntoIterator<Item = &'a Fit>) -> Self {
        let least = fits.into_iter().map(|f| f.cost).fold(f64::INFINITY, f64::min);
        let dispersion = (least / problem.noise_cost().max(1.0)).max(1.0);
        Self { dispersion, per_parameter: (problem.samples() as f64).ln() }
    }

    pub fn at(&self, fit: &Fit) -> f64 {
        fit.cost / self.dispersion + fit.model.effect_parameters() as f64 * self.per_parameter
    }
}

/// Whether a fit with a law is clearly better than the answer and cross-validates better. An effect of the catalogue is
/// replaced only if the law predicts whole left-out runs better; by one that leaves something itself, only if the two differ by
/// more than equally good ones do: both are descriptions then, and the effect is the one with a name.
pub(super) fn is_clearly_better(open: &Problem, found: &Found, lawful: &Fit) -> bool {
    if !found.best.model.effects.is_empty() && is_as_good_as_a_name(open, found, lawful) {
        return false;
    }
    let criterion = Criterion::of(open, [&found.best, lawful]);
    let predicts = || match found.best.model.effects.is_empty() {
        true => cross_validates(open, &found.baseline, lawful),
        false => cross_validates_runs(open, &found.best, lawful),
    };
    criterion.at(lawful) < criterion.at(&found.best) - CLEARLY && predicts()
}

/// Whether the answer's effects do as well as a law, by what the law itself leaves to be seen.
fn is_as_good_as_a_name(open: &Problem, found: &Found, lawful: &Fit) -> bool {
    let left = misfit::left(open, lawful).map_or(0.0, |(excess, _)| excess.max(0.0) * open.samples() as f64);
    found.best.cost - lawful.cost < SAME * verdict::unit(found.baseline.cost - lawful.cost, left)
}

/// Whether a fit leaves more than noise, and enough for a search to act on.
pub(in crate::diagnose) fn leaves_something(open: &Problem, fit: &Fit) -> bool {
    misfit::left(open, fit).is_none_or(|(excess, error)| {
        excess > SEEN * error && excess * open.samples() as f64 > least_gain(open.samples())
    })
}

/// A fit with a law, the converged fits with a law elsewhere that does the same, and those with a simpler one. If one of these is better, also
/// the alternatives to that one, which may bring another shape at the first place. `before`: chi² without the law.
pub(super) fn with_elsewhere(open: &Problem, fit: Fit, before: f64) -> Vec<Fit> {
    let others = |fit: &Fit| -> Vec<Fit> {
        let tie = tie(open, fit, before);
        let rough = elsewhere(open, fit, tie);
        let named = other_forms(fit, rough.iter().take_while(|f| f.cost < fit.cost + NEARLY * tie));
        let mut fits: Vec<Fit> = parallel::map(&named, |f| open.fit(&f.model, &f.x)).into_iter().flatten().collect();
        // With a free exponent what comes near may do as well, and the law itself better.
        let near = fits.iter().filter(|f| f.cost > fit.cost + tie);
        let near: Vec<&Fit> = std::iter::once(fit).chain(near).collect();
        fits.extend(freed_elsewhere(open, &near));
        fits
    };
    let mut fits = others(&fit);
    fits.extend(simpler(open, &fit));
    let better = fits.iter().filter(|other| other.cost < fit.cost - SAME_LAW).min_by(|a, b| a.cost.total_cmp(&b.cost));
    let more = better.map(others);
    fits.extend(more.into_iter().flatten());
    fits.push(fit);
    fits
}

/// Converges up to `most` of the best rough fits, if they may come near the first. `before`: chi² without their last
/// effect.
pub(super) fn finished(open: &Problem, mut rough: Vec<Fit>, most: usize, before: f64) -> Vec<Fit> {
    let to_the_end = |fit: &Fit| open.fit(&fit.model, &fit.x).filter(|f| f.cost < fit.cost);
    let Some(first) = rough.first_mut() else { return rough };
    if let Some(fit) = to_the_end(first) {
        *first = fit;
    }
    let noise = open.noise_cost();
    let near = noise + STILL_TO_COME * (first.cost - noise).max(0.0) + NEARLY * tie(open, first, before);
    let count = rough.iter().take(most).take_while(|fit| fit.cost <= near).count();
    let others: Vec<Option<Fit>> = parallel::map(&rough[1..count.max(1)], to_the_end);
    for (fit, finished) in rough[1..].iter_mut().zip(others) {
        if let Some(finished) = finished {
            *fit = finished;
        }
    }
    rough.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    rough
}

/// Models within this chi² are equally good. `before`: chi² without the last effect.
pub(super) fn tie(open: &Problem, fit: &Fit, before: f64) -> f64 {
    SAME * verdict::unit(before - fit.cost, misfit::left_beyond_noise(open, fit))
}

/// The simplest of the fits that the data cannot distinguish, and the others. Fits cheapest first; `before`: chi²
/// without them.
pub(in crate::diagnose) fn equally_good(open: &Problem, fits: &[Fit], before: f64) -> Option<(Fit, Vec<Fit>)> {
    let first = fits.first()?;
    let criterion = Criterion::of(open, [first]);
    let tie = tie(open, first, before);
    let mut same: Vec<&Fit> = fits.iter().filter(|f| f.cost <= first.cost + tie).collect();
    let price = |fit: &Fit| criterion.at(fit) + PER_LETTER * letters(fit) as f64;
    same.sort_by(|a, b| price(a).total_cmp(&price(b)));
    Some(((*same.first()?).clone(), other_forms(same[0], same.into_iter())))
}

/// The alternatives that an answer names: one on every other element first, then one at every other place, then other
/// shapes. What sensors cannot distinguish matters more than how it is written.
pub(super) fn other_forms<'a>(best: &Fit, same: impl Iterator<Item = &'a Fit>) -> Vec<Fit> {
    let same: Vec<&Fit> = same.filter(|f| f.model.effects != best.model.effects).collect();
    let mut named = vec![best];
    for is_new in [is_on_another_element, is_at_another_place, is_another_law] {
        for fit in &same {
            let is_named = named.iter().any(|own| own.model.effects == fit.model.effects);
            if !is_named && named.iter().all(|own| is_new(own, fit)) {
                named.push(fit);
            }
        }
    }
    named.into_iter().skip(1).take(MOST_FORMS).cloned().collect()
}

fn is_on_another_element(own: &Fit, other: &Fit) -> bool {
    element(own) != element(other)
}

fn is_at_another_place(own: &Fit, other: &Fit) -> bool {
    place(own) != place(other)
}

/// Whether it is more than the same law in other words (`abs(time_s)` and `time_s`).
fn is_another_law(own: &Fit, other: &Fit) -> bool {
    is_at_another_place(own, other) || (own.cost - other.cost).abs() > SAME_LAW
}

/// The element that the last effect of a fit acts on.
fn element(fit: &Fit) -> Option<String> {
    let last = fit.model.effects.last()?;
    Some(last.spec().unlisted().map_or_else(|| last.element.to_string(), |own| own.law.address.element()))
}

/// Port and variables of the last law of a fit.
pub(super) fn place(fit: &Fit) -> Option<(String, Vec<String>)> {
    let law = &fit.model.effects.last()?.spec().unlisted()?.law;
    Some((law.address.to_string(), law.variables().iter().map(|v| v.name()).collect()))
}

/// Length of the last law as text; of equivalent forms the shorter one is chosen.
fn letters(fit: &Fit) -> usize {
    fit.model.effects.last().map_or(0, |e| e.spec().equation.len())
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::{Model, Placed};
    use crate::effects::{Element, ElementKind, find};

    /// Noise-free recordings with nothing hidden: every converged fit leaves nothing. Fits that cannot come near the
    /// first, or are beyond `most`, stay rough.
    #[test]
    fn rough_fits_that_may_come_near_the_first_are_fitted_to_the_end() {
        let case = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        let noise = [Noise::white(0.02)];
        let open = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let (entry, element) = (find("leak").expect("of the catalogue"), Element::of(ElementKind::Line, 0, 1));
        let rough = |size: f64, cost: f64| {
            let model = Model::baseline().plus(&Placed { entry, element, channel: None }, &[size]);
            let x = open.start(&model, None);
            Fit { covariance: DMatrix::zeros(x.len(), x.len()), model, x, cost, on_bound: Vec::new() }
        };
        let of_noise = open.noise_cost();
        let all = vec![rough(1e-18, of_noise), rough(2e-18, of_noise + 1.0), rough(3e-18, 10.0 * of_noise)];
        let costs = |most: usize| finished(&open, all.clone(), most, 20.0 * of_noise).iter().map(|f| f.cost).collect();
        let [both, one]: [Vec<f64>; 2] = [costs(3), costs(1)];
        assert!(both[..2].iter().all(|cost| *cost < 0.5 * of_noise) && both[2] == 10.0 * of_noise, "{both:?}");
        assert!(one[0] < 0.5 * of_noise && one[1..] == [of_noise + 1.0, 10.0 * of_noise], "{one:?}");
        assert!(finished(&open, Vec::new(), 3, 1.0).is_empty());
    }
}
