//! How noisy a channel is, from the channel itself.

use super::gap_limit_s;
use super::survey::median;

/// Median of |x| over the standard deviation of a normal distribution.
const MEDIAN_OVER_SD: f64 = 0.674_489_750_196_081_7;
/// Fewer residuals than this give no estimate.
const MIN_RESIDUALS: usize = 20;

/// Standard deviation of white measurement noise, in the unit of `values`.
///
/// ```text
/// r_i = sum_j w_j y_{i+j} / sqrt(sum_j w_j^2),  w_j = 1 / prod_{k != j} (t_{i+j} - t_{i+k}),  j = 0..3
/// sd  = max(median |r| / 0.6745, q / sqrt(12))
/// ```
/// `r` is the third divided difference of four neighbouring samples, scaled so that white noise of
/// standard deviation `sd` gives `r` the same one (on an even grid the third difference over
/// `sqrt(20)`); it removes any quadratic trend, at uneven sampling too. The median is not misled by
/// steps and outliers. `q` is the smallest change between neighbours: the floor that quantisation sets.
///
/// Stretches with a missing sample or across a gap are left out; where too little is left, as of a channel sampled more slowly
/// than the others, the samples that are there stand for themselves. `None` with fewer than 20 residuals or a constant channel.
///
/// Limits: noise that is filtered or otherwise correlated is underestimated; a signal that is not
/// smooth over four samples counts as noise, so does vibration near the sampling rate. State
/// `noise_sd` where it is known.
///
/// ```
/// use smam::recording::noise_sd;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A slow rise, shown in steps of 0.5 kPa: the error of rounding, q/sqrt(12).
/// let time_s: Vec<f64> = (0..1000).map(f64::from).collect();
/// let pressure_kpa: Vec<f64> = time_s.iter().map(|t| (t / 100.0).floor() * 0.5).collect();
/// let sd_kpa = noise_sd(&time_s, &pressure_kpa).ok_or("enough samples")?;
/// assert!((sd_kpa - 0.5 / 12_f64.sqrt()).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
pub fn noise_sd(time_s: &[f64], values: &[f64]) -> Option<f64> {
    if let Some(sd) = noise_of_neighbours(time_s, values) {
        return Some(sd);
    }
    let there = time_s.iter().zip(values).filter(|(_, y)| y.is_finite());
    let (time_s, values): (Vec<f64>, Vec<f64>) = there.unzip();
    noise_of_neighbours(&time_s, &values)
}

fn noise_of_neighbours(time_s: &[f64], values: &[f64]) -> Option<f64> {
    let sd = white_sd(time_s, values)?.max(resolution(values)? / 12f64.sqrt());
    (sd > 0.0).then_some(sd)
}

/// The same without the floor of quantisation.
pub(super) fn white_sd(time_s: &[f64], values: &[f64]) -> Option<f64> {
    let limit_s = gap_limit_s(time_s);
    let mut residuals: Vec<f64> = time_s
        .windows(4)
        .zip(values.windows(4))
        .filter(|(t, y)| is_whole(t, y, limit_s))
        .map(|(t, y)| third_difference(t, y).abs())
        .collect();
    if residuals.len() < MIN_RESIDUALS {
        return None;
    }
    Some(median(&mut residuals)? / MEDIAN_OVER_SD)
}

/// Correlation of neighbouring third differences: -3/4 of white noise, near 1 of what is smooth. `None` of too few.
pub(super) fn alternation(time_s: &[f64], values: &[f64]) -> Option<f64> {
    let limit_s = gap_limit_s(time_s);
    let whole = time_s.windows(5).zip(values.windows(5)).filter(|(t, y)| is_whole(t, y, limit_s));
    let pairs: Vec<[f64; 2]> =
        whole.map(|(t, y)| [third_difference(&t[..4], &y[..4]), third_difference(&t[1..], &y[1..])]).collect();
    let size: f64 = pairs.iter().map(|[a, b]| 0.5 * (a * a + b * b)).sum();
    let shared: f64 = pairs.iter().map(|[a, b]| a * b).sum();
    (pairs.len() >= MIN_RESIDUALS && size > 0.0).then(|| shared / size)
}

fn is_whole(time_s: &[f64], values: &[f64], limit_s: f64) -> bool {
    values.iter().all(|y| y.is_finite()) && time_s.windows(2).all(|w| w[1] - w[0] <= limit_s)
}

/// Third divided difference, scaled to unit noise gain.
fn third_difference(time_s: &[f64], values: &[f64]) -> f64 {
    let mut sum = 0.0;
    let mut gain_squared = 0.0;
    for (j, (tj, yj)) in time_s.iter().zip(values).enumerate() {
        let others = time_s.iter().enumerate().filter(|(k, _)| *k != j);
        let weight = 1.0 / others.map(|(_, tk)| tj - tk).product::<f64>();
        sum += weight * yj;
        gain_squared += weight * weight;
    }
    sum / gain_squared.sqrt()
}

/// The smallest change between neighbouring samples; `None` when nothing ever changes.
pub(super) fn resolution(values: &[f64]) -> Option<f64> {
    values.windows(2).map(|w| (w[1] - w[0]).abs()).filter(|change| *change > 0.0).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Normal deviates from a fixed linear congruential generator: sum of twelve uniform ones.
    fn normal_deviates(count: usize) -> Vec<f64> {
        let mut state: u64 = 42;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..count).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
    }

    fn noisy_sine(time_s: &[f64], sd: f64) -> Vec<f64> {
        let noise = normal_deviates(time_s.len());
        let sine = time_s.iter().map(|t| 10.0 * t.sin());
        sine.zip(noise).map(|(y, n)| y + sd * n).collect()
    }

    #[test]
    fn white_noise_on_a_sine_is_found() {
        let time_s: Vec<f64> = (0..4000).map(|i| f64::from(i) * 0.01).collect();
        let found = noise_sd(&time_s, &noisy_sine(&time_s, 0.05)).unwrap();
        assert!((found / 0.05 - 1.0).abs() < 0.05, "{found}");
    }

    #[test]
    fn uneven_sampling_steps_missing_and_gaps_do_not_mislead() {
        let jitter = |i: u32| if i.is_multiple_of(3) { 0.004 } else { 0.0 };
        let gap = |i: u32| if i > 2000 { 7.0 } else { 0.0 };
        let time_s: Vec<f64> = (0..4000).map(|i| f64::from(i) * 0.01 + jitter(i) + gap(i)).collect();
        let mut values = noisy_sine(&time_s, 0.05);
        values.iter_mut().skip(1000).for_each(|y| *y += 30.0);
        values.iter_mut().step_by(97).for_each(|y| *y = f64::NAN);
        let found = noise_sd(&time_s, &values).unwrap();
        assert!((found / 0.05 - 1.0).abs() < 0.06, "{found}");
    }

    #[test]
    fn a_channel_slower_than_the_others_has_its_own_noise() {
        let time_s: Vec<f64> = (0..8000).map(|i| f64::from(i) * 0.01).collect();
        let mut values = noisy_sine(&time_s, 0.05);
        values.iter_mut().enumerate().filter(|(i, _)| i % 5 != 0).for_each(|(_, y)| *y = f64::NAN);
        let found = noise_sd(&time_s, &values).unwrap();
        assert!((found / 0.05 - 1.0).abs() < 0.08, "{found}");
    }

    #[test]
    fn coarse_quantisation_sets_a_floor() {
        let time_s: Vec<f64> = (0..1000).map(f64::from).collect();
        let values: Vec<f64> = time_s.iter().map(|t| (t / 100.0).floor() * 0.5).collect();
        let found = noise_sd(&time_s, &values).unwrap();
        assert!((found - 0.5 / 12f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn too_little_or_constant_gives_none() {
        let time_s: Vec<f64> = (0..100).map(f64::from).collect();
        assert_eq!(noise_sd(&time_s, &[3.0; 100]), None);
        assert_eq!(noise_sd(&time_s[..10], &noisy_sine(&time_s[..10], 1.0)), None);
    }
}
