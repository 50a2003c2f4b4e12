//! Figures of a series of samples: NaN where there are no samples, or a missing one.
//!
//! ```
//! use smam::recording::figures;
//!
//! // A spring of 28.3 N/m with a preload of 0.1 N, and the work of a loop of 10 mm by 0.2 N.
//! let spring = figures::line_of_best_fit(&[0.0, 0.01, 0.02], &[0.1, 0.383, 0.666]);
//! assert!((spring.slope - 28.3).abs() < 1e-9 && (spring.offset - 0.1).abs() < 1e-9);
//! let work_j = figures::enclosed(&[0.0, 0.01, 0.01, 0.0], &[0.0, 0.0, 0.2, 0.2]).abs();
//! assert!((work_j - 2e-3).abs() < 1e-15);
//! ```

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

/// Standard deviation about their mean; 0 of none.
pub fn spread(values: &[f64]) -> f64 {
    if values.is_empty() { 0.0 } else { values.population_std_dev() }
}

/// Correlation of two series of one length; 0 where one does not move.
pub fn correlation(a: &[f64], b: &[f64]) -> f64 {
    let covariance = if a.is_empty() { 0.0 } else { a.population_covariance(b) };
    covariance / (spread(a) * spread(b)).max(f64::MIN_POSITIVE)
}

/// A line over points, and how much of their scatter it explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Units of y over units of x.
    pub slope: f64,
    /// Its value at x = 0.
    pub offset: f64,
    pub r_squared: f64,
}

/// The least-squares line of `y` over `x`, over as many points as both have.
pub fn line_of_best_fit(x: &[f64], y: &[f64]) -> Line {
    let n = x.len().min(y.len());
    let (x, y) = (&x[..n], &y[..n]);
    let (mx, my) = (mean(x), mean(y));
    let product =
        |a: &[f64], ma: f64, b: &[f64], mb: f64| a.iter().zip(b).map(|(a, b)| (a - ma) * (b - mb)).sum::<f64>();
    let (xx, xy, yy) = (product(x, mx, x, mx), product(x, mx, y, my), product(y, my, y, my));
    Line { slope: xy / xx, offset: my - xy / xx * mx, r_squared: xy * xy / (xx * yy) }
}

/// Area enclosed by a path that is closed by a straight line (trapezoids); its sign is that of the turning.
pub fn enclosed(x: &[f64], y: &[f64]) -> f64 {
    let pairs: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
    let next = pairs.iter().cycle().skip(1);
    pairs.iter().zip(next).map(|(a, b)| 0.5 * (b.0 - a.0) * (a.1 + b.1)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_and_a_square_enclosed() {
        let found = line_of_best_fit(&[1.0, 2.0, 4.0], &[3.0, 5.0, 9.0]);
        assert!((found.slope - 2.0).abs() < 1e-12 && (found.offset - 1.0).abs() < 1e-12);
        assert!((found.r_squared - 1.0).abs() < 1e-12);
        assert_eq!(enclosed(&[0.0, 0.0, 1.0, 1.0], &[0.0, 1.0, 1.0, 0.0]).abs(), 1.0);
    }

    #[test]
    fn series_are_alike_against_each_other_or_still() {
        let moves = [1.0, 2.0, 4.0];
        assert!((correlation(&moves, &moves.map(|v| 5.0 - 2.0 * v)) + 1.0).abs() < 1e-12);
        assert_eq!((correlation(&moves, &[3.0; 3]), correlation(&[], &[]), spread(&[])), (0.0, 0.0, 0.0));
        assert!((spread(&[1.0, 3.0]) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn figures_of_two_samples_of_none_and_of_a_missing_one() {
        let all = |v: &[f64]| [least(v), greatest(v), range(v), mean(v), rms(v)];
        assert_eq!(all(&[7.0, -1.0]), [-1.0, 7.0, 8.0, 3.0, 5.0]);
        assert!(all(&[]).iter().chain(&all(&[1.0, f64::NAN])).all(|v| v.is_nan()));
    }
}
