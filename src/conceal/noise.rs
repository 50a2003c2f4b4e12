//! Noise of a sensor: part of it slow.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

use super::programme::SAMPLE_S;

/// Noise of one channel, in its unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelNoise {
    /// Standard deviation of all of it.
    pub sd: f64,
    /// Share of the variance that is slow, and its correlation time, s.
    pub slow_share: f64,
    pub correlation_s: f64,
}

impl ChannelNoise {
    /// White noise of a deviation.
    pub fn white(sd: f64) -> Self {
        Self { sd, slow_share: 0.0, correlation_s: SAMPLE_S }
    }

    /// A channel's noise about that of such sensors; `coloured` or white.
    pub fn draw(typical_sd: f64, coloured: bool, random: &mut ChaCha8Rng) -> Self {
        let sd = typical_sd * 2f64.powf(random.random_range(-1.0..1.0));
        let slow_share = if coloured { random.random_range(0.2..0.7) } else { 0.0 };
        Self { sd, slow_share, correlation_s: random.random_range(0.02..0.08) }
    }

    /// Deviation of white noise that would hide a slow signal as well.
    pub fn against_slow_signals(&self) -> f64 {
        let kept = (-SAMPLE_S / self.correlation_s).exp();
        self.sd * (1.0 + 2.0 * self.slow_share * kept / (1.0 - kept)).sqrt()
    }

    /// So many samples at the rig's interval: white noise and an Ornstein-Uhlenbeck process beside it.
    pub fn series(&self, count: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
        let mut unit = || -> f64 { StandardNormal.sample(random) };
        let kept = (-SAMPLE_S / self.correlation_s).exp();
        let (fast, slow) = (self.sd * (1.0 - self.slow_share).sqrt(), self.sd * self.slow_share.sqrt());
        let mut state = unit();
        (0..count)
            .map(|_| {
                state = kept * state + (1.0 - kept * kept).sqrt() * unit();
                fast * unit() + slow * state
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn it_has_its_deviation_and_its_colour() {
        let noise = ChannelNoise { sd: 2.0, slow_share: 0.5, correlation_s: 0.05 };
        let x = noise.series(200_000, &mut ChaCha8Rng::seed_from_u64(3));
        let covariance = |lag: usize| x.iter().zip(&x[lag..]).map(|(a, b)| a * b).sum::<f64>() / x.len() as f64;
        assert!((covariance(0) - 4.0).abs() < 0.1, "{}", covariance(0));
        assert!((covariance(5) - 2.0 * (-1.0f64).exp()).abs() < 0.1, "{}", covariance(5));
    }
}
