//! Estimates the noise in a residual: standard deviation and autocorrelation.
//!
//! Sensor noise is modelled as white noise plus an exponentially correlated part. Only residuals faster than half a
//! second are used, because slower ones may be misfit. The autocovariance that this model predicts at larger lags is
//! subtracted from the residual's; the rest is misfit.

use std::borrow::Cow;

use super::{Case, CaseRun};
use crate::recording::figures::range;
use crate::recording::{median_interval_s, noise_sd};

mod covariance;

use covariance::{filtered, mean_product, two_parts, usual_product, without_slow_part};

/// Window of the running mean that separates misfit from noise, s, and its bounds in samples.
const WINDOW_S: f64 = 0.5;
const WINDOW: (usize, usize) = (21, 51);
/// A recording shorter than this many windows moves as fast as its noise. There, if no size is stated, noise is
/// estimated from neighbouring samples.
const LEAST_WINDOWS: f64 = 8.0;
/// Longest correlation time of noise, s, and its bounds in samples.
const MEMORY_S: f64 = 0.1;
const MEMORY: (f64, f64) = (2.0, 10.0);
/// Samples of a piece over which a covariance is taken.
const PIECE: usize = 200;
/// Lags from which the autocorrelation is estimated.
const READ: usize = 26;
/// Lags over which misfit is still correlated and most of the noise is not.
const LAGS: std::ops::Range<usize> = 8..17;
/// Relative error of the noise's slow part: counts as an error of the misfit.
const COLOUR_ERROR: f64 = 0.15;

/// Noise of one channel: covariance `sd² ((1 - s) [lag = 0] + s rho^lag)`.
///
/// ```
/// use smam::diagnose::Noise;
///
/// let white = Noise::white(0.02);
/// assert_eq!(white.inflation(), 1.0);
/// // Half of the variance keeps 0.9 from sample to sample: 1 + 2 (0.5) 0.9/0.1, ten times as strong against
/// // slow signals.
/// let slow = Noise { slow_share: 0.5, kept: 0.9, ..white };
/// assert!((slow.inflation() - 10.0).abs() < 1e-12);
/// assert!((slow.scale() - 0.02 * 10.0_f64.sqrt()).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Standard deviation of all of it, in the channel's unit.
    pub sd: f64,
    /// Share `s` of the variance that is correlated.
    pub slow_share: f64,
    /// Its correlation from one sample to the next, `rho`.
    pub kept: f64,
}

impl Noise {
    pub fn white(sd: f64) -> Self {
        Self { sd, slow_share: 0.0, kept: 0.0 }
    }

    /// Ratio to white noise of the same deviation for slow signals, >= 1.
    pub fn inflation(&self) -> f64 {
        1.0 + 2.0 * self.slow_share * self.kept / (1.0 - self.kept)
    }

    /// The same, or white noise of this deviation where that is more.
    fn at_least(self, sd: f64) -> Self {
        if self.sd < sd { Self::white(sd) } else { self }
    }

    /// Whether weights from one are good enough for the other.
    pub(crate) fn is_near(&self, other: &Self) -> bool {
        (self.scale() / other.scale() - 1.0).abs() < 0.1
    }

    /// What a residual is divided by so that differences of its square sum are those of white noise.
    pub fn scale(&self) -> f64 {
        self.sd * self.inflation().sqrt()
    }

    /// Mean of its covariance over [`LAGS`], in units of its variance.
    fn far(&self) -> f64 {
        LAGS.map(|lag| self.slow_share * self.kept.powi(lag as i32)).sum::<f64>() / LAGS.len() as f64
    }

    /// Variance of that mean when it is taken from `count` samples (Bartlett), and what misjudged colour adds.
    fn far_variance(&self, count: f64) -> f64 {
        let (white, slow, kept) = (1.0 - self.slow_share, self.slow_share, self.kept);
        let products = |j: usize| {
            let decayed = kept.powi(j as i32);
            let of_slow = slow * slow * decayed * (j as f64 + (1.0 + kept * kept) / (1.0 - kept * kept));
            of_slow + 2.0 * white * slow * decayed + if j == 0 { white * white } else { 0.0 }
        };
        let pairs: f64 = LAGS.map(|k| LAGS.map(|l| products(k.abs_diff(l))).sum::<f64>()).sum();
        pairs / (LAGS.len() as f64).powi(2) / count + (COLOUR_ERROR * self.far()).powi(2)
    }
}

/// Noise of each channel from residuals by run, channel and time. Its size is the stated one, else that of what is left
/// when a running mean is taken off.
pub fn estimate(case: &Case, residuals: &[Vec<Vec<f64>>]) -> Vec<Noise> {
    let interval_s = case.runs.first().and_then(|r| median_interval_s(r.times_s())).unwrap_or(0.01);
    let lasts_s = |r: &CaseRun| r.times_s().last().zip(r.times_s().first()).map_or(0.0, |(end, start)| end - start);
    let is_short = case.runs.iter().map(lasts_s).fold(0.0, f64::max) < LEAST_WINDOWS * WINDOW_S;
    (0..case.channels.len())
        .map(|c| {
            let stated_sd = case.channels[c].stated_sd;
            let least = |noise: Noise| if stated_sd.is_none() { noise.at_least(least(case, c)) } else { noise };
            if is_short && stated_sd.is_none() {
                return least(Noise::white(of_recording(case, c)));
            }
            let channel = on_own_clock(residuals, c);
            let runs: Vec<&[f64]> = channel.runs.iter().map(AsRef::as_ref).collect();
            let found = of_channel(&runs, channel.rows_per_sample * interval_s, stated_sd);
            least(found.unwrap_or_else(|| Noise::white(of_recording(case, c))))
        })
        .collect()
}

/// Share of a channel's range below which no estimate of its noise is believed: what a converter of 17 bits resolves, and more than two
/// integrators of the same equations differ by. A recording with less is one of a simulation.
const LEAST_SHARE: f64 = 1e-5;

/// The least noise of a channel that is believed where none is stated, in its unit.
pub fn least(case: &Case, channel: usize) -> f64 {
    let all = case.runs.iter().flat_map(|r| r.measured[channel].iter().copied()).filter(|v| v.is_finite());
    LEAST_SHARE * range(&all.collect::<Vec<f64>>())
}

/// Residuals of a channel as it was sampled.
struct OwnClock<'a> {
    runs: Vec<Cow<'a, [f64]>>,
    rows_per_sample: f64,
}

/// A sensor slower than the others has a sample in every so many rows: those that are there stand side by side.
fn on_own_clock(residuals: &[Vec<Vec<f64>>], channel: usize) -> OwnClock<'_> {
    let runs = residuals.iter().map(|run| run[channel].as_slice()).filter(|r| r.iter().any(|v| v.is_finite()));
    let runs: Vec<&[f64]> = runs.collect();
    let rows: usize = runs.iter().map(|r| r.len()).sum();
    let there = runs.iter().copied().flatten().filter(|v| v.is_finite()).count();
    if 2 * there > rows {
        return OwnClock { runs: runs.into_iter().map(Cow::Borrowed).collect(), rows_per_sample: 1.0 };
    }
    let finite = |r: &[f64]| Cow::Owned(r.iter().copied().filter(|v| v.is_finite()).collect());
    OwnClock { runs: runs.into_iter().map(finite).collect(), rows_per_sample: rows as f64 / there.max(1) as f64 }
}

/// Deviation of a channel that the fitted runs do not have, or hardly: that of the recordings themselves, held back or not;
/// of still fewer samples a thousandth of their range.
fn of_recording(case: &Case, channel: usize) -> f64 {
    let of_run = |r: &CaseRun| noise_sd(r.times_s(), &r.measured[channel]);
    let found = case.runs.iter().filter_map(of_run).fold(0.0, f64::max);
    let all = case.runs.iter().flat_map(|r| r.measured[channel].iter().copied()).filter(|v| v.is_finite());
    let range = 1e-3 * range(&all.collect::<Vec<f64>>());
    [found, range].into_iter().find(|sd| *sd > 0.0).unwrap_or(1.0)
}

/// White and slow part whose covariance, once a running mean is taken off, is nearest to what was found; none where too
/// little was recorded and nothing is stated.
fn of_channel(runs: &[&[f64]], interval_s: f64, stated_sd: Option<f64>) -> Option<Noise> {
    let half = ((WINDOW_S / interval_s) as usize).clamp(WINDOW.0, WINDOW.1) / 2;
    let fast: Vec<Vec<f64>> = runs.iter().map(|r| without_slow_part(r, half)).collect();
    if stated_sd.is_none() && !fast.iter().flatten().any(|v| v.is_finite()) {
        return None;
    }
    let found: Vec<f64> = (0..READ).map(|lag| usual_product(&fast, lag)).collect();
    let filtered = |covariance: &dyn Fn(usize) -> f64| filtered(covariance, half);
    let white = filtered(&|lag| if lag == 0 { 1.0 } else { 0.0 });
    let longest = (MEMORY_S / interval_s).clamp(MEMORY.0, MEMORY.1);
    let memories = [0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0];
    let fits = memories.into_iter().filter(|m| *m <= longest).map(|memory| {
        let kept = f64::exp(-1.0 / memory);
        let slow = filtered(&|lag| kept.powi(lag as i32));
        let [w, s] = two_parts(&white, &slow, &found);
        let missed = found.iter().zip(white.iter().zip(&slow)).map(|(f, (a, b))| (f - w * a - s * b).powi(2)).sum();
        (w, s, kept, missed)
    });
    let least = |a: (f64, f64, f64, f64), b: (f64, f64, f64, f64)| if b.3 < a.3 { b } else { a };
    let (white, mut slow, kept, _) = fits.fold((found[0] / white[0], 0.0, 0.0, f64::INFINITY), least);
    let mut variance = white + slow;
    if let Some(sd) = stated_sd {
        variance = sd * sd;
        // What is more than was stated is misfit.
        slow = slow.min((variance - white).max(0.0));
    }
    let share = slow / variance.max(f64::MIN_POSITIVE);
    let is_seen = slow > 2.0 * error_of_slow(variance, fast.iter().flatten().filter(|v| v.is_finite()).count());
    let sd = variance.sqrt().max(f64::MIN_POSITIVE);
    Some(if is_seen { Noise { sd, slow_share: share.min(1.0), kept } } else { Noise::white(sd) })
}

/// Slow part that white noise alone may seem to have.
fn error_of_slow(variance: f64, count: usize) -> f64 {
    2.0 * variance / (count.max(1) as f64).sqrt()
}

/// Excess of residuals over noise, per sample in units of the noise's variance, and its standard error: the mean of
/// `r_i r_(i+k)` over lags that most of the noise does not reach, less what does. Whatever the noise's size, misfit
/// stands out.
pub fn structured_excess(residuals: &[Vec<Vec<f64>>], noise: &[Noise]) -> (f64, f64) {
    let lags = LAGS.len() as f64;
    let (mut sum, mut weight, mut variance) = (0.0, 0.0, 0.0);
    for (c, noise) in noise.iter().enumerate() {
        let channel = on_own_clock(residuals, c).runs;
        let count: f64 = channel.iter().flat_map(|r| r.iter()).filter(|r| r.is_finite()).count() as f64;
        let power = LAGS.map(|lag| mean_product(&channel, lag)).sum::<f64>() / lags;
        let own = mean_product(&channel, 0) / (noise.sd * noise.sd);
        sum += count * (power / (noise.sd * noise.sd) - noise.far());
        weight += count;
        variance += count.powi(2) * own.min(2.0).powi(2) * noise.far_variance(count.max(1.0));
    }
    if weight == 0.0 { (0.0, f64::INFINITY) } else { (sum / weight, variance.sqrt() / weight) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(n: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut uniform = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        (0..n).map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0).collect()
    }

    #[test]
    fn samples_that_are_missing_do_not_change_what_is_noise() {
        let whole = noise(6000, 11);
        let sparse: Vec<f64> = whole.iter().enumerate().map(|(i, v)| if i % 7 == 3 { f64::NAN } else { *v }).collect();
        let [of_whole, of_sparse] = [&whole, &sparse].map(|r| of_channel(&[r], 0.01, None).unwrap());
        assert!((of_sparse.sd / of_whole.sd - 1.0).abs() < 0.02, "{of_whole:?} {of_sparse:?}");
        assert_eq!(of_sparse.slow_share, 0.0);
    }

    #[test]
    fn misfit_stands_out_of_noise_of_any_size() {
        let unit = [Noise::white(1.0)];
        let quiet = vec![vec![noise(5000, 1)]];
        let (excess, error) = structured_excess(&quiet, &unit);
        assert!(excess.abs() < 4.0 * error, "{excess} {error}");
        let wave = |i: usize| (i as f64 / 100.0).sin() * 0.5f64.sqrt();
        let loud = vec![vec![quiet[0][0].iter().enumerate().map(|(i, n)| n + wave(i)).collect()]];
        let (excess, _) = structured_excess(&loud, &unit);
        assert!((excess - 0.25).abs() < 0.03, "{excess}");
    }

    /// White noise and noise that forgets over `memory` samples, of unit variance together.
    fn coloured(n: usize, slow_share: f64, memory: f64, seed: u64) -> Vec<f64> {
        let kept = f64::exp(-1.0 / memory);
        let mut state = 0.0;
        let slow = noise(n, seed).into_iter().map(|x| {
            state = kept * state + (1.0 - kept * kept).sqrt() * x;
            state
        });
        let white = noise(n, seed + 1);
        slow.zip(white).map(|(s, w)| slow_share.sqrt() * s + (1.0 - slow_share).sqrt() * w).collect()
    }

    #[test]
    fn colour_is_read_and_is_no_misfit() {
        for (slow_share, memory, seed) in [(0.5, 2.0, 3), (0.7, 8.0, 5), (0.3, 5.0, 9), (0.7, 4.0, 11)] {
            let r = coloured(15_000, slow_share, memory, seed);
            let found = of_channel(&[&r], 0.01, None).expect("samples");
            let kept = f64::exp(-1.0 / memory);
            let inflation = 1.0 + 2.0 * slow_share * kept / (1.0 - kept);
            assert!((found.inflation() / inflation - 1.0).abs() < 0.3, "{found:?} {inflation}");
            assert!((found.sd - 1.0).abs() < 0.06, "{found:?}");
            let (excess, error) = structured_excess(&[vec![r]], &[found]);
            assert!(excess.abs() < 4.0 * error, "{excess} {error} {found:?}");
            assert!(error < 0.04, "{error}");
        }
    }

    #[test]
    fn white_noise_has_no_colour_and_a_slow_misfit_gives_it_none() {
        let white = noise(20_000, 3);
        assert!(of_channel(&[&white], 0.01, None).expect("samples").inflation() < 1.15);
        let wave = |i: usize| (i as f64 * 0.01 * std::f64::consts::TAU * 0.15).sin();
        let with_misfit: Vec<f64> = white.iter().enumerate().map(|(i, n)| n + wave(i)).collect();
        let found = of_channel(&[&with_misfit], 0.01, Some(1.0)).expect("samples");
        assert!(found.inflation() < 1.15, "{found:?}");
        let (excess, _) = structured_excess(&[vec![with_misfit]], &[found]);
        assert!((excess - 0.5).abs() < 0.03, "{excess}");
    }

    #[test]
    fn a_slower_sensor_is_read_on_its_own_clock() {
        let white = noise(3000, 5);
        let every_fifth = |i: usize| if i.is_multiple_of(5) { white[i / 5] } else { f64::NAN };
        let residuals = vec![vec![(0..15_000).map(every_fifth).collect::<Vec<f64>>()]];
        let channel = on_own_clock(&residuals, 0);
        assert_eq!((channel.runs[0].len(), channel.rows_per_sample), (3000, 5.0));
        let found = of_channel(&[&channel.runs[0]], 0.05, None).expect("samples");
        assert!((found.sd - 1.0).abs() < 0.06 && found.inflation() < 1.15, "{found:?}");
        let (excess, error) = structured_excess(&residuals, &[found]);
        assert!(excess.abs() < 4.0 * error && error < 0.05, "{excess} {error}");
        assert!(of_channel(&[], 0.01, None).is_none());
    }
}
