//! Intervals by drawing samples anew.

use rand::RngExt;
use serde::Serialize;

use super::sampling::stream;
use crate::parallel;

/// A number and the interval that holds it with 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

const ROUNDS: usize = 500;

/// Estimates of `of`, which makes numbers of samples picked by index, with percentile intervals of 500 bootstrap rounds
/// (Efron 1979). The same for any number of threads.
pub fn estimates(samples: usize, seed: u32, of: impl Fn(&[usize]) -> Vec<f64> + Sync) -> Vec<Estimate> {
    let all: Vec<usize> = (0..samples).collect();
    let values = of(&all);
    let round = |round: usize| {
        // Streams far beyond those of points and keys.
        let mut random = stream(seed, u64::MAX / 2 + round as u64);
        let picks: Vec<usize> = (0..samples).map(|_| random.random_range(0..samples)).collect();
        of(&picks)
    };
    let rounds: Vec<Vec<f64>> = if samples == 0 { Vec::new() } else { parallel::map_indices(ROUNDS, round) };
    let interval = |(at, value): (usize, f64)| {
        let mut drawn: Vec<f64> = rounds.iter().map(|r| r[at]).filter(|v| v.is_finite()).collect();
        drawn.sort_by(f64::total_cmp);
        let quantile = |share: f64| {
            let last = drawn.len().saturating_sub(1);
            drawn.get((share * last as f64).round() as usize).copied().unwrap_or(f64::NAN)
        };
        Estimate { value, low: quantile(0.025), high: quantile(0.975) }
    };
    values.into_iter().enumerate().map(interval).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interval_of_a_mean_is_that_of_its_standard_error() {
        // Mean of 400 numbers spread evenly over 0..1: standard error 1/sqrt(12 * 400) = 0.0144.
        let numbers: Vec<f64> = (0..400).map(|i| (f64::from(i) + 0.5) / 400.0).collect();
        let mean = |picks: &[usize]| vec![picks.iter().map(|i| numbers[*i]).sum::<f64>() / picks.len() as f64];
        let found = estimates(numbers.len(), 1, mean)[0];
        assert!((found.value - 0.5).abs() < 1e-12);
        for half in [found.value - found.low, found.high - found.value] {
            assert!((half / (1.96 * 0.01443) - 1.0).abs() < 0.15, "{found:?}");
        }
        assert!(estimates(0, 1, |_| vec![f64::NAN])[0].low.is_nan());
    }
}
