//! How well the data tell each parameter: covariance, intervals, correlations, condition.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// What the Jacobian at the optimum says.
#[derive(Clone, Debug, PartialEq)]
pub struct Certainty {
    /// Half the 95 % interval of each free parameter; infinite where the data say nothing.
    pub half_width: Vec<f64>,
    pub correlation: DMatrix<f64>,
    /// Condition number of `JᵀJ`, its columns scaled to length one.
    pub condition: f64,
    /// Correlation of neighbouring residuals.
    pub colour: f64,
    /// Lags over which residuals are taken as related; 0 is white.
    pub memory: usize,
}

/// Certainty at residuals `r` with a `jacobian`.
///
/// White residuals: `s² (JᵀJ)⁻¹`, `s² = rᵀr/(N - p)`. Coloured ones: `(JᵀJ)⁻¹ Jᵀ Γ J (JᵀJ)⁻¹ N/(N - p)`, `Γ` the Toeplitz matrix of
/// the residuals' own autocovariance, tapered (Bartlett) to zero at twice the lag where it first vanishes in its own scatter.
/// Times Student's t of `N - p`. In either case this is scatter from repeated noise about the same misfit; a form
/// that is wrong is wrong within its narrow intervals too.
pub fn certainty(r: &DVector<f64>, jacobian: &DMatrix<f64>) -> Certainty {
    let (n, p) = (r.len(), jacobian.ncols());
    let covariances = autocovariances(r);
    let memory = memory(&covariances, n);
    // Columns of length one, so that units do not enter what is inverted.
    let lengths: Vec<f64> = (0..p).map(|j| jacobian.column(j).norm().max(f64::MIN_POSITIVE)).collect();
    let scaled = DMatrix::from_fn(n, p, |i, j| jacobian[(i, j)] / lengths[j]);
    let normal = scaled.tr_mul(&scaled);
    let eigen = SymmetricEigen::new(normal.clone());
    let (least, most) = (eigen.eigenvalues.min(), eigen.eigenvalues.max());
    let condition = if least > 0.0 { most / least } else { f64::INFINITY };
    let inverse = normal.try_inverse().filter(|_| condition < 1e15);
    let degrees = (n.max(p + 1) - p) as f64;
    let covariance = inverse.map(|inverse| {
        let middle = weighted(&scaled, &covariances, memory);
        &inverse * middle * &inverse * (n as f64 / degrees)
    });
    let covariance = covariance.unwrap_or_else(|| DMatrix::from_diagonal_element(p, p, f64::INFINITY));
    // A negative variance is none that the data told.
    let deviation = |j: usize| if covariance[(j, j)] >= 0.0 { covariance[(j, j)].sqrt() } else { f64::INFINITY };
    let student = StudentsT::new(0.0, 1.0, degrees).map_or(1.96, |t| t.inverse_cdf(0.975));
    let correlation =
        DMatrix::from_fn(p, p, |i, j| if i == j { 1.0 } else { covariance[(i, j)] / (deviation(i) * deviation(j)) });
    Certainty {
        half_width: (0..p).map(|j| student * deviation(j) / lengths[j]).collect(),
        correlation,
        condition,
        colour: if covariances[0] > 0.0 { covariances.get(1).map_or(0.0, |c| c / covariances[0]) } else { 0.0 },
        memory,
    }
}

/// `sum r_i r_(i+k)/N` for lags up to a tenth of the samples.
///
/// Samples that do not count are closed up: their neighbours are taken as neighbours.
fn autocovariances(r: &DVector<f64>) -> Vec<f64> {
    let n = r.len();
    let at = |lag: usize| r.rows(0, n - lag).dot(&r.rows(lag, n - lag)) / n as f64;
    (0..=n / 10).map(at).collect()
}

/// Twice the last lag before the covariance lies within two of its deviations of zero; 0 if the first one does. Never more
/// than there are lags, or the taper would be cut off.
fn memory(covariances: &[f64], n: usize) -> usize {
    let threshold = 2.0 / (n as f64).sqrt() * covariances[0];
    let vanished = covariances.iter().skip(1).position(|c| c.abs() < threshold);
    (2 * vanished.unwrap_or(covariances.len() / 2)).min(covariances.len() - 1)
}

/// `Jᵀ Γ J` with the tapered autocovariances.
fn weighted(jacobian: &DMatrix<f64>, covariances: &[f64], memory: usize) -> DMatrix<f64> {
    let n = jacobian.nrows();
    let mut sum = jacobian.tr_mul(jacobian) * covariances[0];
    for (lag, covariance) in covariances.iter().enumerate().take(memory + 1).skip(1) {
        let taper = 1.0 - lag as f64 / (memory + 1) as f64;
        let cross = jacobian.rows(0, n - lag).tr_mul(&jacobian.rows(lag, n - lag));
        sum += (&cross + cross.transpose()) * (covariance * taper);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// Residuals of a mean: `J = 1`, so the interval is that of a mean.
    fn mean_interval(residuals: Vec<f64>) -> Certainty {
        let n = residuals.len();
        certainty(&DVector::from_vec(residuals), &DMatrix::from_element(n, 1, 1.0))
    }

    #[test]
    fn white_noise_gives_the_textbook_interval() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let noise: Vec<f64> = (0..4_000).map(|_| StandardNormal.sample(&mut random)).collect();
        let found = mean_interval(noise);
        assert_eq!(found.memory, 0);
        assert!((found.half_width[0] / (1.96 / 4_000f64.sqrt()) - 1.0).abs() < 0.05, "{found:?}");
    }

    /// An AR(1) noise of memory `a` widens the interval of a mean by `sqrt((1 + a)/(1 - a))`.
    #[test]
    fn coloured_noise_widens_it_as_theory_says() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let (a, mut last) = (0.8, 0.0f64);
        let mut next = || {
            let kick: f64 = StandardNormal.sample(&mut random);
            last = a * last + (1.0 - a * a).sqrt() * kick;
            last
        };
        let found = mean_interval((0..20_000).map(|_| next()).collect());
        let white = 1.96 / 20_000f64.sqrt();
        let expected: f64 = white * ((1.0 + a) / (1.0 - a)).sqrt();
        assert!((found.half_width[0] / expected - 1.0).abs() < 0.12, "{} for {expected}", found.half_width[0]);
        assert!((found.colour - a).abs() < 0.03);
    }

    #[test]
    fn columns_that_cannot_be_told_apart_are_seen() {
        let jacobian = DMatrix::from_fn(100, 2, |i, j| i as f64 * if j == 0 { 1.0 } else { -3.0 });
        let found = certainty(&DVector::from_element(100, 0.1), &jacobian);
        assert!(found.condition > 1e12 && found.half_width[0].is_infinite(), "{found:?}");
    }
}
