//! Covariances of residuals with gaps, and their white and slow parts.

use super::{PIECE, READ};
use crate::recording::median;

/// Covariance that is left of `covariance` by lag once a running mean over `2 half + 1` samples is taken off.
pub(super) fn filtered(covariance: &dyn Fn(usize) -> f64, half: usize) -> Vec<f64> {
    let window = (2 * half + 1) as f64;
    let at = |lag: i64| covariance(lag.unsigned_abs() as usize);
    let (half, full) = (half as i64, 2 * half as i64);
    let one = |lag: i64| {
        let once: f64 = (-half..=half).map(|j| at(lag - j)).sum();
        let twice: f64 = (-full..=full).map(|j| (window - j.abs() as f64) * at(lag - j)).sum();
        at(lag) - 2.0 * once / window + twice / (window * window)
    };
    (0..READ as i64).map(one).collect()
}

/// Least squares of `w a + s b = y` with neither below zero.
pub(super) fn two_parts(a: &[f64], b: &[f64], y: &[f64]) -> [f64; 2] {
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let (aa, ab, bb, ay, by) = (dot(a, a), dot(a, b), dot(b, b), dot(a, y), dot(b, y));
    let determinant = aa * bb - ab * ab;
    let (w, s) = ((ay * bb - by * ab) / determinant, (by * aa - ay * ab) / determinant);
    match (w > 0.0, s > 0.0) {
        (true, true) => [w, s],
        (false, true) => [0.0, (by / bb).max(0.0)],
        _ => [(ay / aa).max(0.0), 0.0],
    }
}

/// What a running mean over the samples that are there leaves; nothing where a third of the window is missing.
pub(super) fn without_slow_part(r: &[f64], half: usize) -> Vec<f64> {
    (0..r.len())
        .map(|i| {
            if i < half || i + half >= r.len() {
                return f64::NAN;
            }
            let window = r[i - half..=i + half].iter().filter(|v| v.is_finite());
            let (sum, count) = window.fold((0.0, 0), |(sum, count), v| (sum + v, count + 1));
            if 3 * count > 2 * (2 * half + 1) { r[i] - sum / count as f64 } else { f64::NAN }
        })
        .collect()
}

/// Median over pieces of the mean of `r_i r_(i+lag)`: misfit that comes in bursts does not count.
pub(super) fn usual_product(runs: &[Vec<f64>], lag: usize) -> f64 {
    let piece = |run: &[f64], from: usize| mean_product(&[&run[from..(from + PIECE).min(run.len())]], lag);
    let is_whole = |run: &[f64], from: usize| {
        run.len() >= from + PIECE && run[from..from + PIECE].iter().filter(|v| v.is_finite()).count() > PIECE / 2
    };
    let pieces = runs.iter().flat_map(|run| (0..run.len()).step_by(PIECE).map(move |from| (run.as_slice(), from)));
    let mut products: Vec<f64> = pieces.filter(|(r, f)| is_whole(r, *f)).map(|(r, f)| piece(r, f)).collect();
    median(&mut products).unwrap_or_else(|| mean_product(runs, lag))
}

/// Mean of `r_i r_(i+lag)` over what is finite.
pub(super) fn mean_product<R: AsRef<[f64]>>(runs: &[R], lag: usize) -> f64 {
    let (mut sum, mut count) = (0.0, 0usize);
    for r in runs.iter().map(AsRef::as_ref) {
        for (a, b) in r.iter().zip(&r[lag.min(r.len())..]) {
            let product = a * b;
            if product.is_finite() {
                sum += product;
                count += 1;
            }
        }
    }
    if count == 0 { 0.0 } else { sum / count as f64 }
}
