//! Laws of straight pieces, and what they are recognised as: for what no shape of the grammar follows from where a search begins.
//!
//! A curve of straight pieces is fitted first, at the slots where it promises most. Shapes are then held against the curve itself, which
//! costs no simulation: at many scales, so that a fit begins near the right one. The curve itself is kept as a
//! description: with its eight sizes it may take in what two simpler things do, so it neither ends a search nor bounds it.

use nalgebra::DVector;

use super::forms::{CLEARLY, Criterion, leaves_something};
use super::shape_refits::{Candidate, GOING_ON};
use super::shown::{Shown, Wanted, of_pieces};
use super::span::{explained, sizes};
use super::sums::{nearest, thinned, visited};
use super::unlisted::is_law_of;
use crate::diagnose::fit::Fit;
use crate::diagnose::grammar::{MORE_SHAPES, SHAPES, Shape, Slot, drawn, in_pieces, pieces, variant};
use crate::diagnose::search::leaves_much;
use crate::laws::Acts;
use crate::parallel;

/// Curves that are fitted roughly.
const CURVES: usize = 3;
/// Shapes that are refitted.
const SHAPES_TRIED: usize = 4;
/// Scales at which a shape is held against a curve, from the least to the greatest, relative to the slot's.
const SCALES: usize = 32;
const FROM: f64 = 0.03;
const TO: f64 = 4.0;

/// A law of pieces, and rough fits with what it is recognised as, cheapest first.
#[derive(Default)]
pub(super) struct Recognised {
    pub curve: Option<Fit>,
    pub fits: Vec<Fit>,
}

impl Shown<'_> {
    /// A law of pieces at the slot where that explains most, and the shapes and sums that it is recognised as; nothing where it is not
    /// clearly better than `simple`, the best law so far.
    pub(super) fn recognised(&self, all: &[Slot], slots: &[&Slot], simple: &Fit) -> Recognised {
        let promised = self.begun_in_pieces(all, slots).into_iter();
        let candidates: Vec<Candidate> = promised.take(CURVES).map(|(_, candidate)| candidate).collect();
        let rough = self.refitted(&candidates, CURVES);
        let Some(curve) = rough.first().and_then(|rough| self.coarse.fit(&rough.model, &rough.x)) else {
            return Recognised::default();
        };
        let criterion = Criterion::of(self.problem, [simple, &curve]);
        let own = slots.iter().find(|slot| is_law_of(&curve, slot));
        let Some(slot) = own.filter(|_| criterion.at(&curve) < criterion.at(simple) - CLEARLY) else {
            return Recognised::default();
        };
        let known = self.from.x.len();
        let values = thinned(drawn(slot, &curve.x[known..]));
        let mut fits = self.shapes_like(slot, &values, &curve.x[..known]);
        let is_explained = fits.iter().any(|fit| !leaves_something(self.problem, fit));
        if !is_explained && !leaves_much(self.problem, &self.from, &curve) {
            fits.extend(self.sums_like(slot, &values, &curve.x[..known]));
        }
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        Recognised { fits, curve: Some(curve) }
    }

    /// Rough fits with a law of pieces at each of some slots where that promises as much as `least`.
    pub(super) fn pieces_elsewhere(&self, all: &[Slot], slots: &[&Slot], least: f64) -> Vec<Fit> {
        let promised = self.begun_in_pieces(all, slots).into_iter().filter(|(gain, _)| *gain >= least);
        let candidates: Vec<Candidate> = promised.take(GOING_ON).map(|(_, candidate)| candidate).collect();
        self.refitted(&candidates, GOING_ON)
    }

    /// Keeps the part of the misfit that a law of pieces at a slot can explain.
    pub(super) fn keep_pieces(&mut self, all: &[Slot], own: &Slot) {
        let signatures: Option<Vec<DVector<f64>>> = self.signatures(all, &of_pieces(own)).into_iter().collect();
        let Some(signatures) = signatures else { return };
        self.left = explained(&signatures, &self.left);
    }

    /// What a law of pieces at each slot promises, and the law with sizes to start from; the most promising first.
    fn begun_in_pieces(&self, all: &[Slot], slots: &[&Slot]) -> Vec<(f64, Candidate)> {
        let plain = slots.iter().copied().filter(|slot| slot.may_be_in_pieces());
        let plain: Vec<(&Slot, Vec<_>)> = plain.map(|slot| (slot, pieces(slot))).collect();
        let wanted: Vec<Wanted> = plain.iter().flat_map(|(slot, _)| of_pieces(slot)).collect();
        let mut signatures = self.signatures(all, &wanted).into_iter();
        let mut promised: Vec<(f64, Candidate)> = Vec::new();
        for (slot, pieces) in &plain {
            let own: Vec<Option<DVector<f64>>> = signatures.by_ref().take(pieces.len()).collect();
            let Some(own) = own.into_iter().collect::<Option<Vec<_>>>() else { continue };
            let sizes = sizes(&own, &self.left);
            let starts: Vec<f64> =
                sizes.iter().zip(pieces).map(|(size, p)| size * slot.action.typical / p.times).collect();
            let Some(law) = in_pieces(self.problem.case, slot, &starts) else { continue };
            promised.push((explained(&own, &self.left).norm_squared(), self.with(&law, starts.len())));
        }
        promised.sort_by(|a, b| b.0.total_cmp(&a.0));
        promised
    }

    /// Rough fits with the shapes that come nearest to a curve, each at its best scale.
    fn shapes_like(&self, slot: &Slot, curve: &[f64], calibration: &[f64]) -> Vec<Fit> {
        let refit = |(shape, scale, size): &(&'static Shape, f64, f64)| {
            let mut own = variant(self.problem.case, slot, shape, scale / slot.scale)?;
            let range = own.placed.spec().parameters[0].range;
            own.values[0] = size.clamp(range.min, range.max);
            let Candidate { model, mut x, .. } = self.with(&own, 1);
            x[..calibration.len()].copy_from_slice(calibration);
            self.coarse.fit(&model, &x)
        };
        parallel::map(&alike(slot, curve), refit).into_iter().flatten().collect()
    }
}

/// The shapes that come nearest to a curve where the slot's variable has been, each with a scale and a size.
fn alike(slot: &Slot, curve: &[f64]) -> Vec<(&'static Shape, f64, f64)> {
    let scales = |shape: &Shape| -> Vec<f64> {
        if !shape.has_scale {
            return vec![slot.scale];
        }
        (0..SCALES).map(|k| slot.scale * FROM * (TO / FROM).powf(k as f64 / (SCALES - 1) as f64)).collect()
    };
    let has_level = slot.action.acts == Acts::Scales;
    let mut found: Vec<(f64, (&Shape, f64, f64))> = Vec::new();
    for shape in slot.distinct(&SHAPES).into_iter().chain(slot.distinct(&MORE_SHAPES)) {
        let at = |scale: f64| {
            let (left, size) = nearest_multiple(curve, &visited(slot, shape, scale), has_level)?;
            Some((left, (shape, scale, size)))
        };
        let best = scales(shape).into_iter().filter_map(at).min_by(|a, b| a.0.total_cmp(&b.0));
        found.extend(best);
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().take(SHAPES_TRIED).map(|(_, own)| own).collect()
}

/// What is left of a curve by the nearest multiple of another, and that multiple. What scales has a level, which belongs to the calibration:
/// the multiple is then that of a law around one.
fn nearest_multiple(curve: &[f64], shape: &[f64], has_level: bool) -> Option<(f64, f64)> {
    if !has_level {
        let dot = |x: &[f64]| -> f64 { x.iter().zip(shape).map(|(x, y)| x * y).sum() };
        let size = dot(curve) / dot(shape);
        let left = curve.iter().zip(shape).map(|(y, s)| (y - size * s).powi(2)).sum();
        return size.is_finite().then_some((left, size));
    }
    let (left, [size, level]) = nearest(curve, shape, &vec![1.0; shape.len()])?;
    (level > -1.0).then(|| (left, size / (1.0 + level)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::made::Bench;
    use crate::diagnose::grammar::{Reach, slots};
    use crate::diagnose::unknown::propose;
    use crate::diagnose::unknown::unlisted::Proposals;
    use crate::diagnose::verdict::port;

    fn proposed(hiding: &str) -> (Proposals, Fit) {
        let bench = Bench::hiding(hiding);
        let baseline = bench.baseline();
        (propose(&bench.open(), &baseline, Reach::Plain, &|_| {}).expect("laws"), baseline)
    }

    fn equation(fit: &Fit) -> &str {
        fit.model.effects[0].spec().equation.as_str()
    }

    /// A wave is out of reach of every shape at the scales that a search begins with, and recognised from its curve.
    #[test]
    fn what_no_shape_follows_at_first_is_recognised_from_its_curve() {
        let (proposals, baseline) = proposed("muscle.pull adds 0.1 * sin(elongation_m/3e-3)");
        let first = &proposals.fits[0];
        assert_eq!(equation(first), "muscle.pull adds a * sin((elongation_m/scale_m))");
        assert!(first.cost < 1e-3 * baseline.cost, "{} {}", first.cost, baseline.cost);
    }

    /// Two bumps are no shape of the grammar: the curve itself describes them. It is none of the proposals, which may end a search.
    #[test]
    fn what_no_shape_follows_stays_a_curve() {
        let (proposals, baseline) = proposed(
            "muscle.pull adds 0.1 * exp(-((elongation_m - 5e-3)/2e-3)^2) - 0.15 * exp(-((elongation_m - 14e-3)/3e-3)^2)",
        );
        let curve = proposals.curve.expect("a curve");
        let at = port(&curve.model.effects[0]);
        assert!(at.starts_with("muscle.") && equation(&curve).matches("max(").count() == 7, "{}", equation(&curve));
        assert!(curve.cost < 0.1 * baseline.cost, "{} {}", curve.cost, baseline.cost);
        assert!(proposals.fits.iter().all(|fit| equation(fit) != equation(&curve)));
    }

    /// Of a single run a curve over the clock explains anything.
    #[test]
    fn no_curve_is_over_the_clock_of_one_run() {
        let bench = Bench::hiding("muscle.pull adds 0.1 * sin(time_s/5.0)");
        let (problem, baseline) = (bench.open(), bench.baseline());
        let all = slots(&bench.case, &baseline, Reach::Plain);
        let shown = Shown::misfit(&problem, &baseline, problem.rows_of(&baseline).expect("it does not diverge"));
        let over = |variable: &str| -> Vec<&Slot> { all.iter().filter(|slot| slot.variable == variable).collect() };
        assert!(!over("time_s").is_empty() && shown.begun_in_pieces(&all, &over("time_s")).is_empty());
        assert!(!shown.begun_in_pieces(&all, &over("elongation_m")).is_empty());
    }

    #[test]
    fn the_level_of_what_scales_belongs_to_the_calibration() {
        let shape: Vec<f64> = (0..50).map(|i| (f64::from(i) / 10.0).sin()).collect();
        // 1 + y = 1.25 (1 + 0.4 shape)
        let curve: Vec<f64> = shape.iter().map(|s| 1.25 * (1.0 + 0.4 * s) - 1.0).collect();
        let (left, size) = nearest_multiple(&curve, &shape, true).expect("a multiple");
        assert!(left < 1e-20 && (size - 0.4).abs() < 1e-12, "{left} {size}");
        let (left, _) = nearest_multiple(&curve, &shape, false).expect("a multiple");
        assert!(left > 1e-3);
    }

    /// The scale at which a shape is nearest, between those of a search.
    #[test]
    fn a_shape_is_held_against_a_curve_at_many_scales() {
        let bench = Bench::with(&[]);
        let all = slots(&bench.case, &bench.baseline(), Reach::Plain);
        let slot = all.iter().find(|slot| slot.address == "muscle.pull" && slot.variable == "time_s").expect("a slot");
        let wave = MORE_SHAPES.iter().find(|shape| shape.text == "sin(x)").expect("a shape");
        let scale = 0.17 * slot.scale;
        let curve: Vec<f64> = visited(slot, wave, scale).into_iter().map(|y| -0.3 * y).collect();
        let (shape, own, size) = alike(slot, &curve)[0];
        assert_eq!(shape.text, "sin(x)");
        assert!((own / scale - 1.0).abs() < 0.1 && (size + 0.3).abs() < 0.1, "{own} {scale} {size}");
    }
}
