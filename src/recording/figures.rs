//! Figures of a series of samples: NaN where there are no samples, or a missing one.

use statrs::statistics::Statistics;

/// The least of them.
pub fn least(values: &[f64]) -> f64 {
    values.min()
}

/// The greatest of them.
pub fn greatest(values: &[f64]) -> f64 {
    values.max()
}

/// Greatest less least.
pub fn range(values: &[f64]) -> f64 {
    values.max() - values.min()
}

/// Their mean.
pub fn mean(values: &[f64]) -> f64 {
    values.mean()
}

/// Root of the mean of their squares.
pub fn rms(values: &[f64]) -> f64 {
    values.quadratic_mean()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_of_two_samples_of_none_and_of_a_missing_one() {
        let all = |v: &[f64]| [least(v), greatest(v), range(v), mean(v), rms(v)];
        assert_eq!(all(&[7.0, -1.0]), [-1.0, 7.0, 8.0, 3.0, 5.0]);
        assert!(all(&[]).iter().chain(&all(&[1.0, f64::NAN])).all(|v| v.is_nan()));
    }
}
