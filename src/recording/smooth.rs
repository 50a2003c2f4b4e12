//! Noise of an input, and the resolution with which it was recorded, taken out again.
//!
//! What drives a rig goes through dry friction and a small compliance: a shake of a micrometre that the rig never made lets a
//! simulated friction slip. Outputs are never smoothed.

use nalgebra::{Matrix3, Vector3};

use super::gap_limit_s;
use super::noise::{alternation, resolution, white_sd};

/// White noise makes neighbouring third differences alternate: their correlation is -3/4. Of a smooth signal it is near 1.
const ALTERNATES: f64 = -0.4;
/// Noise below this share of the range is what numbers of five digits leave.
const DIGITS: f64 = 1e-5;
/// Rounded numbers differ by whole steps, to this share of one.
const OFF_GRID: f64 = 0.01;
/// Rounding shows in third differences by this share of a step and more.
const SHOWS: f64 = 0.1;
/// A residual of noise alone exceeds its limit once in `exp(LIKELY)`.
const LIKELY: f64 = 7.0;
/// Half of the narrowest window, in samples: of five a parabola leaves two degrees of freedom. Wider ones grow by a third.
const NARROWEST: usize = 2;
const WIDEST: usize = 512;

/// An input without its noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Smoothed {
    /// In the unit of what was given; missing samples stay missing.
    pub values: Vec<f64>,
    /// Standard deviation of the noise, in the same unit.
    pub noise_sd: f64,
}

/// What an input was without its noise: at each sample a parabola, by least squares over the widest window in which it leaves no more than
/// noise.
///
/// ```text
/// sum r² <= sd² (k + 2 sqrt(7 k) + 14),  k = samples - 3
/// ```
/// holds of noise alone but for one window in a thousand (Laurent and Massart, Ann. Statist. 28 (2000), lemma 1), so windows are narrow
/// where the input bends and wide where it does not; from sample to sample half of a window changes by one at most. `sd` is stated, or that of
/// third differences as in [`noise_sd`](super::noise_sd); of numbers rounded to `q` it is `q/sqrt(12)` at least.
///
/// `None` where nothing is to be done: the noise is stated as zero, or none is seen (third differences of neighbours do not alternate),
/// or it is below 1e-5 of the range.
///
/// ```
/// use smam::recording::smoothed;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A piston at 0.05 Hz and 1 mm, recorded in steps of 0.01 mm.
/// let time_s: Vec<f64> = (0..2000).map(|i| 0.02 * f64::from(i)).collect();
/// let plunger_mm: Vec<f64> = time_s.iter().map(|t| (0.314 * t).sin()).collect();
/// let recorded_mm: Vec<f64> = plunger_mm.iter().map(|x| (x / 0.01).round() * 0.01).collect();
/// let smooth = smoothed(&time_s, &recorded_mm, None).ok_or("it is rounded")?;
/// let error = |x: &[f64]| x.iter().zip(&plunger_mm).map(|(a, b)| (a - b).abs()).sum::<f64>() / 2000.0;
/// assert!(error(&smooth.values) < 0.3 * error(&recorded_mm));
/// assert_eq!(smoothed(&time_s, &plunger_mm, None), None);
/// # Ok(())
/// # }
/// ```
pub fn smoothed(time_s: &[f64], values: &[f64], stated_sd: Option<f64>) -> Option<Smoothed> {
    let there: Vec<usize> = (0..values.len()).filter(|&i| values[i].is_finite()).collect();
    let times: Vec<f64> = there.iter().map(|&i| time_s[i]).collect();
    let known: Vec<f64> = there.iter().map(|&i| values[i]).collect();
    let noise_sd = match stated_sd {
        Some(sd) => sd,
        None => seen(&times, &known)?,
    };
    let range = super::figures::range(&known);
    if noise_sd <= DIGITS * range {
        return None;
    }
    let limit_s = gap_limit_s(&times);
    let pieces = piece_ends(&times, limit_s);
    let mut smooth = values.to_vec();
    let mut begins = 0;
    for ends in pieces {
        let (times, known) = (&times[begins..ends], &known[begins..ends]);
        let halves = halves(times, known, noise_sd);
        for (k, half) in halves.into_iter().enumerate() {
            if let Some((value, _)) = parabola(times, known, k, half) {
                smooth[there[begins + k]] = value;
            }
        }
        begins = ends;
    }
    Some(Smoothed { values: smooth, noise_sd })
}

/// Noise of an input, if some is seen: third differences of neighbours alternate.
fn seen(times_s: &[f64], values: &[f64]) -> Option<f64> {
    alternation(times_s, values).filter(|correlation| *correlation < ALTERNATES)?;
    let white = white_sd(times_s, values)?;
    Some(white.max(step(values, white).unwrap_or(0.0) / 12f64.sqrt())).filter(|sd| *sd > 0.0)
}

/// The step of rounded numbers. A ramp sampled evenly has steps as well, one like the other: those of rounding differ from sample to sample, which
/// shows as noise, or stand alone between samples that do not change.
fn step(values: &[f64], white_sd: f64) -> Option<f64> {
    let step = resolution(values)?;
    let changes: Vec<f64> = values.windows(2).map(|pair| (pair[1] - pair[0]) / step).collect();
    let is_whole = |change: &f64| (change - change.round()).abs() < OFF_GRID;
    let changed = || (1..changes.len().saturating_sub(1)).filter(|&i| changes[i] != 0.0);
    let alone = changed().filter(|&i| changes[i - 1] == 0.0 && changes[i + 1] == 0.0).count();
    let is_rounded = white_sd > SHOWS * step || 2 * alone > changed().count();
    (is_rounded && changes.iter().all(is_whole)).then_some(step)
}

/// Where pieces without a gap end.
fn piece_ends(times_s: &[f64], limit_s: f64) -> Vec<usize> {
    let gaps = (1..times_s.len()).filter(|&i| times_s[i] - times_s[i - 1] > limit_s);
    gaps.chain(std::iter::once(times_s.len())).collect()
}

/// Half of the window around each sample.
fn halves(times_s: &[f64], values: &[f64], noise_sd: f64) -> Vec<usize> {
    let mut halves: Vec<usize> = (0..values.len()).map(|k| widest(times_s, values, k, noise_sd)).collect();
    for k in 1..halves.len() {
        halves[k] = halves[k].min(halves[k - 1] + 1);
    }
    for k in (1..halves.len()).rev() {
        halves[k - 1] = halves[k - 1].min(halves[k] + 1);
    }
    halves
}

/// Half of the widest window around a sample in which, as in all narrower ones, a parabola leaves no more than noise.
fn widest(times_s: &[f64], values: &[f64], k: usize, noise_sd: f64) -> usize {
    let (mut widest, mut half) = (0, NARROWEST);
    while half <= WIDEST && half < values.len() {
        let (begins, ends) = window(values.len(), k, half);
        let free = (ends - begins).saturating_sub(3) as f64;
        let limit = noise_sd.powi(2) * (free + 2.0 * (LIKELY * free).sqrt() + 2.0 * LIKELY);
        match parabola(times_s, values, k, half) {
            Some((_, left)) if left <= limit => widest = half,
            _ => break,
        }
        half += (half / 3).max(1);
    }
    widest
}

/// The samples of a window: first, and one beyond the last.
fn window(count: usize, k: usize, half: usize) -> (usize, usize) {
    (k.saturating_sub(half), (k + half + 1).min(count))
}

/// Value at a sample of the parabola through the window around it, and the sum of squares that it leaves; `None` of too few samples.
fn parabola(times_s: &[f64], values: &[f64], k: usize, half: usize) -> Option<(f64, f64)> {
    let (begins, ends) = window(values.len(), k, half);
    if half < NARROWEST || ends - begins <= 3 {
        return None;
    }
    let long_s = times_s[ends - 1] - times_s[begins];
    let row = |i: usize| {
        let x = (times_s[i] - times_s[k]) / long_s;
        Vector3::new(1.0, x, x * x)
    };
    // From the value at the sample, so that squares of what is small beside a large offset keep their digits.
    let beyond = |i: usize| values[i] - values[k];
    let (mut normal, mut onto) = (Matrix3::zeros(), Vector3::zeros());
    for i in begins..ends {
        normal += row(i) * row(i).transpose();
        onto += row(i) * beyond(i);
    }
    let fit = normal.cholesky()?.solve(&onto);
    let left = (begins..ends).map(|i| (beyond(i) - row(i).dot(&fit)).powi(2)).sum();
    Some((values[k] + fit[0], left))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    fn times(count: u32) -> Vec<f64> {
        (0..count).map(|i| 0.02 * f64::from(i)).collect()
    }

    fn noisy(signal: &[f64], sd: f64) -> Vec<f64> {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
        signal.iter().map(|x| x + sd * noise()).collect()
    }

    fn rms_of(a: &[f64], b: &[f64]) -> f64 {
        (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
    }

    /// Ramp, hold, and a slow sine: what bends keeps its shape, what does not loses two thirds of its noise and more.
    #[test]
    fn noise_goes_and_corners_stay() {
        let time_s = times(3000);
        let signal: Vec<f64> = time_s
            .iter()
            .map(|&t| match t {
                t if t < 10.0 => 0.1 * t,
                t if t < 20.0 => 1.0,
                t => 1.0 + 0.5 * (0.6 * (t - 20.0)).sin(),
            })
            .collect();
        for sd in [0.001, 0.01] {
            let found = smoothed(&time_s, &noisy(&signal, sd), None).expect("it is noisy");
            assert!((found.noise_sd / sd - 1.0).abs() < 0.1, "{}", found.noise_sd);
            let off = rms_of(&found.values, &signal) / sd;
            assert!(off < 0.33, "{off} of {sd}");
            let worst = found.values.iter().zip(&signal).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / sd;
            assert!(worst < 5.0, "{worst} of {sd}");
        }
    }

    /// Ramps that were sampled evenly have steps of their own; a clock that jitters gives them noise, far below those.
    #[test]
    fn corners_of_even_ramps_stay() {
        let time_s = times(1000);
        let triangle: Vec<f64> = (0..1000).map(|i| f64::from((i % 200 - 100i32).abs())).collect();
        assert_eq!(smoothed(&time_s, &triangle, None), None);
        let jittered: Vec<f64> = noisy(&triangle, 1e-2);
        let found = smoothed(&time_s, &jittered, None).expect("it is noisy");
        assert!((found.noise_sd / 1e-2 - 1.0).abs() < 0.1, "{}", found.noise_sd);
        let worst = found.values.iter().zip(&triangle).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 5e-2, "{worst}");
    }

    /// Slow stairs: most samples stand still, and a step stands alone.
    #[test]
    fn slow_stairs_become_a_ramp() {
        let time_s = times(2000);
        let stairs: Vec<f64> = (0..2000).map(|i| f64::from(i / 13) * 0.01).collect();
        let found = smoothed(&time_s, &stairs, None).expect("it is rounded");
        assert!((found.noise_sd - 0.01 / 12f64.sqrt()).abs() < 1e-6, "{}", found.noise_sd);
        let ramp = |i: usize| 0.01 * (i as f64 - 6.0) / 13.0;
        let worst = (100..1900).map(|i| (found.values[i] - ramp(i)).abs()).fold(0.0, f64::max);
        assert!(worst < 0.002, "{worst}");
    }

    /// A step between two samples stays one.
    #[test]
    fn a_step_stays_a_step() {
        let time_s = times(1000);
        let signal: Vec<f64> = time_s.iter().map(|t| if *t < 10.0 { 0.0 } else { 1.0 }).collect();
        let found = smoothed(&time_s, &noisy(&signal, 1e-3), None).expect("it is noisy");
        let (before, after) = (found.values[499], found.values[500]);
        assert!(before.abs() < 4e-3 && (after - 1.0).abs() < 4e-3, "{before}, {after}");
    }

    #[test]
    fn what_has_no_noise_stays_as_it_is() {
        let time_s = times(1000);
        let sine: Vec<f64> = time_s.iter().map(|t| (3.0 * t).sin()).collect();
        let written: Vec<f64> = sine.iter().map(|x| (x * 1e5).round() / 1e5).collect();
        let constant = vec![2.5; 1000];
        for values in [&sine, &written, &constant] {
            assert_eq!(smoothed(&time_s, values, None), None);
        }
        assert_eq!(smoothed(&time_s, &noisy(&sine, 0.01), Some(0.0)), None);
        assert_eq!(smoothed(&[], &[], None), None);
    }

    /// A channel slower than the others, across a gap: missing samples stay missing, and a window ends at the gap.
    #[test]
    fn missing_samples_and_gaps_stay() {
        let time_s: Vec<f64> = times(2000).into_iter().map(|t| if t > 20.0 { t + 5.0 } else { t }).collect();
        let signal: Vec<f64> = time_s.iter().map(|t| if *t > 22.0 { 5.0 } else { 0.0 }).collect();
        let mut recorded = noisy(&signal, 0.01);
        recorded.iter_mut().enumerate().filter(|(i, _)| i % 4 != 0).for_each(|(_, x)| *x = f64::NAN);
        let found = smoothed(&time_s, &recorded, Some(0.01)).expect("it is noisy");
        for ((found, signal), recorded) in found.values.iter().zip(&signal).zip(&recorded) {
            assert_eq!(found.is_nan(), recorded.is_nan());
            assert!(found.is_nan() || (found - signal).abs() < 0.03, "{found} for {signal}");
        }
    }
}
