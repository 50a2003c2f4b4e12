//! Laws of two shapes: what a curve over one slot's variable is recognised as where no single shape follows it.

use nalgebra::DVector;

use super::shape_refits::{Candidate, GOING_ON, SCALES};
use super::shown::{Shown, Wanted};
use super::span::sizes;
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::grammar::{SHAPES, Shape, Slot, Term, scales_of_sum, sum};
use crate::parallel;

/// Sums that are refitted, and that go on: they are alike, and shapes with an exponent are to be converged beside them.
const SUMS: usize = 6;
const BEST: usize = 2;
/// Values of a curve that sums are held against.
const POINTS: usize = 400;

impl Shown<'_> {
    /// Rough fits with the sums of two shapes that come nearest to a curve at a slot, from a calibration; `curve` is thinned.
    pub(super) fn sums_like(&self, slot: &Slot, curve: &[f64], calibration: &[f64]) -> Vec<Fit> {
        let terms = alike(slot, curve);
        let refit = |terms: &[Term; 2]| {
            let own = sum(self.problem.case, slot, terms)?;
            let Candidate { model, mut x, .. } = self.with(&own, terms.len());
            x[..calibration.len()].copy_from_slice(calibration);
            self.coarse.fit(&model, &x)
        };
        let mut fits: Vec<Fit> = parallel::map(&terms, refit).into_iter().flatten().collect();
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        fits.truncate(BEST);
        fits
    }

    /// Rough fits with a sum of the same two shapes at each of some slots.
    pub(super) fn sums_elsewhere(&self, all: &[Slot], places: &[&Slot], shapes: &ScaledShapes) -> Vec<Fit> {
        let each = |slot| shapes.map(|(shape, scale)| Wanted { slot, shape, scale });
        let wanted: Vec<Wanted> = places.iter().flat_map(|&slot| each(slot)).collect();
        let signatures = self.signatures(all, &wanted);
        let candidate = |(slot, own): (&&Slot, &[Option<DVector<f64>>])| {
            let own: Vec<DVector<f64>> = own.iter().cloned().collect::<Option<_>>()?;
            let found = sizes(&own, &self.left);
            let term = |i: usize| Term { shape: shapes[i].0, scale: shapes[i].1, size: found[i] * slot.action.typical };
            Some(self.with(&sum(self.problem.case, slot, &[term(0), term(1)])?, shapes.len()))
        };
        let candidates: Vec<Candidate> =
            places.iter().zip(signatures.chunks(shapes.len())).filter_map(candidate).collect();
        self.refitted(&candidates, GOING_ON)
    }
}

/// Two shapes, each at its scale of the variable.
pub(super) type ScaledShapes = [(&'static Shape, f64); 2];

/// The shapes of the last law of a fit, if that is a sum at this slot.
pub(super) fn shapes_of_sum(problem: &Problem, fit: &Fit, slot: &Slot) -> Option<ScaledShapes> {
    let last = fit.model.effects.len().checked_sub(1)?;
    let own = fit.model.effects[last].spec();
    let law = &own.unlisted()?.law;
    let values = &fit.model.effects_at(&fit.x[problem.case.parameters.len()..])[last].values;
    let [first, second] = scales_of_sum(own, values)?;
    let mut pairs = SHAPES.iter().enumerate().flat_map(|(i, a)| SHAPES[i + 1..].iter().map(move |b| (a, b)));
    let is_its = |(a, b): &(&Shape, &Shape)| {
        let term = |shape| Term { shape, scale: slot.scale, size: slot.action.typical };
        let other = sum(problem.case, slot, &[term(a), term(b)]);
        other.and_then(|other| other.placed.spec().unlisted()).is_some_and(|o| o.law.expression == law.expression)
    };
    let (a, b) = pairs.find(is_its)?;
    Some([(a, first), (b, second)])
}

/// The sums of two shapes that come nearest to a curve where the slot's variable has been; each pair of shapes once.
fn alike<'a>(slot: &Slot, curve: &[f64]) -> Vec<[Term<'a>; 2]> {
    let over = |shape: &Shape, scale: f64| -> Vec<f64> { visited(slot, shape, scale) };
    let scales = |shape: &Shape| if shape.has_scale { &SCALES[..] } else { &SCALES[..1] };
    let each =
        slot.distinct(&SHAPES).into_iter().flat_map(|shape| scales(shape).iter().map(move |s| (shape, s * slot.scale)));
    let all: Vec<(&Shape, f64, Vec<f64>)> = each.map(|(shape, scale)| (shape, scale, over(shape, scale))).collect();
    let mut found: Vec<(f64, [Term; 2])> = Vec::new();
    for (i, (first, first_scale, a)) in all.iter().enumerate() {
        for (second, second_scale, b) in &all[i + 1..] {
            if let Some((left, [own, other])) = nearest(curve, a, b) {
                let terms = [(*first, *first_scale, own), (*second, *second_scale, other)];
                found.push((left, terms.map(|(shape, scale, size)| Term { shape, scale, size })));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut best: Vec<[Term; 2]> = Vec::new();
    for (_, terms) in found {
        let texts = |terms: &[Term; 2]| terms.map(|term| term.shape.text);
        if best.len() < SUMS && best.iter().all(|own| texts(own) != texts(&terms)) {
            best.push(terms);
        }
    }
    best
}

/// Values of a shape along the open runs, evenly thinned.
pub(super) fn visited(slot: &Slot, shape: &Shape, scale: f64) -> Vec<f64> {
    thinned(slot.signal_of_all(shape, scale))
}

/// Some of many values, evenly.
pub(super) fn thinned(all: Vec<f64>) -> Vec<f64> {
    let stride = all.len().div_ceil(POINTS).max(1);
    all.into_iter().step_by(stride).collect()
}

/// What is left of a curve by the nearest combination of two others, and their sizes there; `None` if one is zero, or both are the same.
pub(super) fn nearest(curve: &[f64], a: &[f64], b: &[f64]) -> Option<(f64, [f64; 2])> {
    let dot = |x: &[f64], y: &[f64]| -> f64 { x.iter().zip(y).map(|(x, y)| x * y).sum() };
    let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
    let determinant = aa * bb - ab * ab;
    if determinant <= SAME * aa * bb {
        return None;
    }
    let (ca, cb) = (dot(curve, a), dot(curve, b));
    let sizes = [(ca * bb - cb * ab) / determinant, (cb * aa - ca * ab) / determinant];
    let left = curve.iter().zip(a.iter().zip(b)).map(|(y, (a, b))| (y - sizes[0] * a - sizes[1] * b).powi(2)).sum();
    Some((left, sizes))
}

/// Two shapes are the same where the sine of the angle between them, squared, is smaller.
const SAME: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::made::Bench;
    use crate::diagnose::grammar::{Reach, slots};

    /// A curve that is a sum is found, with its sizes.
    #[test]
    fn a_curve_that_is_a_sum_is_recognised() {
        let bench = Bench::with(&[]);
        let all = slots(&bench.case, &bench.baseline(), Reach::Plain);
        let slot =
            all.iter().find(|slot| slot.address == "muscle.pull" && slot.variable == "elongation_m").expect("a slot");
        let at = |text: &str| SHAPES.iter().find(|shape| shape.text == text).expect("a shape");
        let [square, bent] = ["x^2", "tanh(x)"].map(|text| visited(slot, at(text), slot.scale));
        let curve: Vec<f64> = square.iter().zip(&bent).map(|(square, bent)| 2.0 * square - 0.5 * bent).collect();
        let best = alike(slot, &curve);
        let own: Vec<(&str, f64)> = best[0].iter().map(|term| (term.shape.text, term.size)).collect();
        assert!(
            matches!(own[..], [("x^2", a), ("tanh(x)", b)] if (a - 2.0).abs() < 1e-6 && (b + 0.5).abs() < 1e-6),
            "{own:?}"
        );
        assert!(best.iter().all(|terms| sum(&bench.case, slot, terms).is_some()));
        assert!(nearest(&[1.0, 2.0], &[1.0, 1.0], &[2.0, 2.0]).is_none());
    }
}
