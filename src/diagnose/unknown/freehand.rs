//! Non-parametric estimate of a law.
//!
//! Piecewise linear corrections over the law's variable are fitted to the residual, linearised along the runs, with
//! every parameter of the fit free except those of the law. If the law has the right shape, they vanish; otherwise they
//! show how it deviates. Their prior deviation is the height of the law, so a knot where nothing was measured stays on
//! it.

use nalgebra::{DMatrix, DVector};

use super::linear_range::{basis, in_noise, linear_rows, where_linear};
use crate::diagnose::case::CaseRun;
use crate::diagnose::diagnosis::{Curve, Freehand};
use crate::diagnose::fit::{Fit, Placed, Problem, orthogonal};
use crate::diagnose::grammar::{Action, injected, places};
use crate::laws::{Acts, Address, Law, Port};
use crate::system::Signals;

/// Number of knots over the visited range.
const KNOTS: usize = 9;
/// Half a 95 % interval, in standard deviations.
const HALF: f64 = 1.96;

/// The freehand curve of one effect of a fit. `None` for laws on sensors, or if nothing can be said.
pub(in crate::diagnose) fn freehand(problem: &Problem, fit: &Fit, at: usize, curve: &Curve) -> Option<Freehand> {
    let law = &fit.model.effects[at].spec().unlisted()?.law;
    if law.address.port == Port::Sensor {
        return None;
    }
    let parts = parts(problem, law)?;
    let (first, last) = (*curve.x.first()?, *curve.x.last()?);
    let step = (last - first) / (KNOTS - 1) as f64;
    let x: Vec<f64> = (0..KNOTS).map(|k| first + step * k as f64).collect();
    let seen = signatures(problem, fit, &parts, &|value, knot| {
        let hat = (1.0 - (value - x[knot]).abs() / step).max(0.0);
        // What scales is scaled beside the law that is there.
        if law.acts == Acts::Scales { hat / read(curve, value) } else { hat }
    })?;
    let linear = linear_rows(problem, fit);
    let (basis, left) = others(problem, fit, at, &linear)?;
    let seen: Vec<DVector<f64>> =
        seen.into_iter().map(|column| orthogonal(&basis, &where_linear(column, &linear))).collect();
    let seen = DMatrix::from_columns(&seen);
    let (low, high) = curve.y.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(*y), h.max(*y)));
    let (gram, onto, known) = (seen.tr_mul(&seen), seen.tr_mul(&left), 1.0 / (high - low).powi(2));
    let solved = |unit: f64| {
        let covariance = (&gram / unit + DMatrix::identity(KNOTS, KNOTS) * known).try_inverse()?;
        Some((&covariance * &onto / unit, covariance))
    };
    // What even this leaves counts as noise.
    let (off, _) = solved(1.0)?;
    let rows = linear.iter().filter(|linear| **linear).count().max(1) as f64;
    let (off, covariance) = solved(((&left - &seen * off).norm_squared() / rows).max(1.0))?;
    let (off, covariance) =
        if law.acts == Acts::Scales { about_its_level(&off, &covariance) } else { (off, covariance) };
    let y: Vec<f64> = x.iter().zip(&off).map(|(x, off)| read(curve, *x) + off).collect();
    let half = |k: usize| HALF * covariance[(k, k)].max(0.0).sqrt();
    let low = (0..KNOTS).map(|k| y[k] - half(k)).collect();
    let high = (0..KNOTS).map(|k| y[k] + half(k)).collect();
    y.iter().all(|y| y.is_finite()).then_some(Freehand { x, y, low, high })
}

/// Corrections with zero mean, and their covariance: the mean of a law that scales is absorbed by the calibration.
fn about_its_level(off: &DVector<f64>, covariance: &DMatrix<f64>) -> (DVector<f64>, DMatrix<f64>) {
    let with_mean = covariance.column_sum();
    let of_mean = with_mean.sum();
    (off - &with_mean * (off.sum() / of_mean), covariance - &with_mean * with_mean.transpose() / of_mean)
}

/// One constant law at the place of a law, or on each equal element that it acts on.
fn parts(problem: &Problem, law: &Law) -> Option<Vec<(Law, Placed)>> {
    let all = places(problem.case);
    let own = law.address.to_string();
    let here = all.iter().find(|place| place.address == own)?;
    let action = Action::at(law.address.port).filter(|action| action.acts == law.acts)?;
    let addresses = match here.is_of_several(&all) {
        false => vec![law.address.clone()],
        true => {
            let equal = all.iter().filter(|place| place.port == here.port && !place.is_of_several(&all));
            equal.filter_map(|place| Address::parse(&place.address).ok()).collect()
        }
    };
    let part = |address: Address| {
        let acts = injected(problem.case, &address.to_string(), &action)?;
        Some((Law { address, ..law.clone() }, acts))
    };
    addresses.into_iter().map(part).collect()
}

/// For each knot, the response of all measured channels to a unit value there; `hat` is the knot's share at a value of
/// the variable.
fn signatures(
    problem: &Problem,
    fit: &Fit,
    parts: &[(Law, Placed)],
    hat: &(dyn Fn(f64, usize) -> f64 + Sync),
) -> Option<Vec<DVector<f64>>> {
    let mut all = vec![Vec::new(); KNOTS];
    for run in &problem.runs {
        for (all, own) in all.iter_mut().zip(in_run(problem, fit, run, parts, hat)?) {
            all.extend(own);
        }
    }
    Some(all.into_iter().map(DVector::from_vec).collect())
}

fn in_run(
    problem: &Problem,
    fit: &Fit,
    run: &CaseRun,
    parts: &[(Law, Placed)],
    hat: &(dyn Fn(f64, usize) -> f64 + Sync),
) -> Option<Vec<Vec<f64>>> {
    let setting = fit.model.setting(problem.case, run, &fit.x);
    let laws: Vec<Law> = parts.iter().map(|(law, _)| law.clone()).collect();
    let visited = run.rom.visited(&run.drive, &setting, &laws)?;
    let at: Vec<_> = parts.iter().map(|(_, acts)| acts.with(&[0.0])).collect();
    let of_knot = |series: &Vec<f64>, knot| series.iter().map(|value| hat(*value, knot)).collect();
    let signals = at
        .iter()
        .zip(&visited)
        .map(|(at, series)| Signals { at, values: (0..KNOTS).map(|knot| of_knot(series, knot)).collect() });
    let changes = run.rom.injected(&run.drive, &setting, &signals.collect::<Vec<_>>());
    let of_knot = |knot: usize| -> Option<Vec<f64>> {
        let mut sum: Option<Vec<f64>> = None;
        for part in &changes {
            let own = in_noise(problem, run, part[knot].as_ref()?, 1.0);
            sum = Some(match sum {
                Some(sum) => sum.iter().zip(&own).map(|(a, b)| a + b).collect(),
                None => own,
            });
        }
        sum
    };
    (0..KNOTS).map(of_knot).collect()
}

/// Basis of what the other parameters and the free zeros can imitate in the linear range, and the residual without it.
fn others(problem: &Problem, fit: &Fit, at: usize, linear: &[bool]) -> Option<(DMatrix<f64>, DVector<f64>)> {
    let rows = problem.rows_of(fit)?;
    let calibration = problem.case.parameters.len();
    let is_other =
        |column: &usize| column.checked_sub(calibration).is_none_or(|number| fit.model.places()[number].0 != at);
    let parameters =
        (0..rows.jacobian.ncols()).filter(is_other).map(|column| rows.jacobian.column(column).into_owned());
    let basis = basis(parameters.chain(problem.free_zeros()), linear, rows.residual.len());
    let left = orthogonal(&basis, &where_linear(rows.residual, linear));
    Some((basis, left))
}

/// A curve at a value of its variable, straight between its points.
fn read(curve: &Curve, x: f64) -> f64 {
    let above = curve.x.partition_point(|own| *own < x).clamp(1, curve.x.len() - 1);
    let (a, b) = (curve.x[above - 1], curve.x[above]);
    let share = ((x - a) / (b - a)).clamp(0.0, 1.0);
    curve.y[above - 1] * (1.0 - share) + curve.y[above] * share
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::Model;
    use crate::diagnose::grammar::{Reach, slots, variant};
    use crate::diagnose::verdict;
    use crate::scene::Override;

    const GROWTH_1_M: f64 = 4.0;

    /// A muscle whose bore grows with elongation, answered with a law there of this shape: its curve and the freehand one.
    fn of(shape: &str) -> (Curve, Freehand) {
        let grows = Override::parse(&format!("muscles.tube.area_growth_1_m={GROWTH_1_M}")).expect("a key");
        let channels = ["elongation_mm", "pressure_kpa"];
        let case = made::recorded("muscle_bench", &[grows], &["plunger_mm"], &channels);
        let noise = [0.01, 1.0].map(Noise::white);
        let problem = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let fit = |model: &Model| problem.fit(model, &problem.start(model, None)).expect("it does not diverge");
        let all = slots(&case, &fit(&Model::baseline()), Reach::Plain);
        let slot = all.iter().find(|s| s.address == "muscle.area" && s.variable == "elongation_m").expect("a slot");
        let shape = slot.shapes().iter().find(|own| own.text == shape).expect("a shape");
        let own = variant(&case, slot, shape, 1.0).expect("a law");
        let answered = fit(&Model::baseline().plus(&own.placed, &own.values));
        let curve = verdict::curve(&case, &answered, 0).expect("a curve");
        let freehand = freehand(&problem, &answered, 0, &curve).expect("something is said");
        (curve, freehand)
    }

    /// How far points are from a curve, about their mean.
    fn off(points: &[f64], x: &[f64], curve: &Curve) -> f64 {
        let off: Vec<f64> = points.iter().zip(x).map(|(y, x)| y - read(curve, *x)).collect();
        let mean = off.iter().sum::<f64>() / off.len() as f64;
        off.iter().map(|o| (o - mean).abs()).fold(0.0, f64::max)
    }

    /// A law of the right shape is what the recordings say; of a law that bends where nothing does they say where it is wrong.
    #[test]
    fn the_recordings_say_how_a_law_bends() {
        let (right, said) = of("x");
        let along: Vec<f64> = said.x.iter().map(|x| read(&right, *x)).collect();
        assert!((0..KNOTS).all(|k| (said.low[k]..=said.high[k]).contains(&along[k])), "{said:?} {along:?}");
        let (wrong, said) = of("x^2");
        let along: Vec<f64> = said.x.iter().map(|x| read(&wrong, *x)).collect();
        let [law, said] = [&along, &said.y].map(|y| off(y, &said.x, &right));
        // One linear step from there.
        assert!(said < law * 2.0 / 3.0, "{said} and {law}");
    }
}
