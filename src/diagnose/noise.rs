//! What of a residual is noise: its size, and how far it remembers itself.

use super::case::Case;

/// Samples over which the running mean is taken that separates misfit from noise.
const WINDOW: usize = 21;
/// Lags over which a misfit still agrees with itself and noise no longer does.
const LAGS: std::ops::Range<usize> = 8..17;

/// Noise of one channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Standard deviation, in the channel's unit.
    pub sd: f64,
    /// By how much slow noise is stronger than white noise of that deviation: `(1 + rho)/(1 - rho)`, >= 1.
    pub inflation: f64,
}

impl Noise {
    /// Whether weights from one are good enough for the other.
    pub fn is_near(&self, other: &Self) -> bool {
        (self.scale() / other.scale() - 1.0).abs() < 0.1
    }

    /// What a residual is divided by so that differences of its square sum are those of white noise.
    pub fn scale(&self) -> f64 {
        self.sd * self.inflation.sqrt()
    }
}

/// Noise of each channel from residuals by run, channel and time: the stated deviation, else that of what is left when
/// a running mean is taken off.
pub fn estimate(case: &Case, residuals: &[Vec<Vec<f64>>]) -> Vec<Noise> {
    (0..case.channels.len())
        .map(|c| {
            let fast: Vec<Vec<f64>> = residuals.iter().map(|run| without_slow_part(&run[c])).collect();
            // A running mean takes 1/WINDOW of white noise with it.
            let taken = 1.0 - 1.0 / WINDOW as f64;
            let found = (mean_product(&fast, 0) / taken).sqrt();
            let rho = correlation(&fast);
            let sd = case.channels[c].stated_sd.unwrap_or(found).max(f64::MIN_POSITIVE);
            Noise { sd, inflation: (1.0 + rho) / (1.0 - rho) }
        })
        .collect()
}

/// Correlation of neighbouring samples, 0 to 0.9; what the running mean adds (-1/WINDOW) is undone.
fn correlation(fast: &[Vec<f64>]) -> f64 {
    let raw = mean_product(fast, 1) / mean_product(fast, 0).max(f64::MIN_POSITIVE) + 1.0 / WINDOW as f64;
    if raw > 0.05 { raw.min(0.9) } else { 0.0 }
}

fn without_slow_part(r: &[f64]) -> Vec<f64> {
    let half = WINDOW / 2;
    (0..r.len())
        .map(|i| {
            if i < half || i + half >= r.len() {
                return f64::NAN;
            }
            r[i] - r[i - half..=i + half].iter().sum::<f64>() / WINDOW as f64
        })
        .collect()
}

/// Mean of `r_i r_(i+lag)` over what is finite.
fn mean_product(runs: &[Vec<f64>], lag: usize) -> f64 {
    let (mut sum, mut count) = (0.0, 0usize);
    for r in runs {
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

/// Excess of residuals over noise, per sample in units of the noise's variance, and its standard error under white
/// noise: the mean of `r_i r_(i+k)` over lags that noise does not reach. Whatever the noise's size, misfit stands out.
pub fn structured_excess(residuals: &[Vec<Vec<f64>>], noise: &[Noise]) -> (f64, f64) {
    let lags = LAGS.len() as f64;
    let (mut sum, mut weight, mut variance) = (0.0, 0.0, 0.0);
    for (c, noise) in noise.iter().enumerate() {
        let channel: Vec<Vec<f64>> = residuals.iter().map(|run| run[c].clone()).collect();
        let count: f64 = channel.iter().flatten().filter(|r| r.is_finite()).count() as f64;
        let power = LAGS.map(|lag| mean_product(&channel, lag)).sum::<f64>() / lags;
        let own = mean_product(&channel, 0) / (noise.sd * noise.sd);
        sum += count * power / (noise.sd * noise.sd);
        weight += count;
        // Each lag's mean has variance own²/n; neighbouring lags share nothing for white noise.
        variance += count * own.min(2.0).powi(2) * noise.inflation / lags;
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
    fn misfit_stands_out_of_noise_of_any_size() {
        let unit = [Noise { sd: 1.0, inflation: 1.0 }];
        let quiet = vec![vec![noise(5000, 1)]];
        let (excess, error) = structured_excess(&quiet, &unit);
        assert!(excess.abs() < 4.0 * error, "{excess} {error}");
        let wave = |i: usize| (i as f64 / 100.0).sin() * 0.5f64.sqrt();
        let loud = vec![vec![quiet[0][0].iter().enumerate().map(|(i, n)| n + wave(i)).collect()]];
        let (excess, _) = structured_excess(&loud, &unit);
        assert!((excess - 0.25).abs() < 0.03, "{excess}");
    }

    #[test]
    fn coloured_noise_is_seen_as_such() {
        let mut last = 0.0;
        let coloured: Vec<f64> = noise(20_000, 7)
            .iter()
            .map(|n| {
                last = 0.6 * last + n;
                last
            })
            .collect();
        let rho = correlation(&[without_slow_part(&coloured)]);
        assert!((rho - 0.6).abs() < 0.1, "{rho}");
        assert_eq!(correlation(&[without_slow_part(&noise(20_000, 3))]), 0.0);
    }
}
