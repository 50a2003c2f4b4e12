//! Sobol indices: which share of a measure's variance each key makes, alone and with all others.
//!
//! Of every sample two independent points A, B and, for each key i, AB_i: A with the key of B. Estimators as recommended
//! by Saltelli et al., Comput. Phys. Commun. 181 (2010) 259, Table 2 (b) and (f):
//! `S_i = mean(f(B) (f(AB_i) - f(A))) / V` and (Jansen) `T_i = mean((f(A) - f(AB_i))^2) / (2 V)`,
//! `V` the variance of f over A and B, f counted from its mean there (which takes no part in S, and much of its noise).

use super::bootstrap::{Estimate, estimates};
use super::sampling::sobol;

/// Indices of one measure.
#[derive(Clone, Debug, PartialEq)]
pub struct SobolIndices {
    /// Samples whose points are all there.
    pub samples: usize,
    /// First order of each key: the share of the variance that it makes alone.
    pub first: Vec<Estimate>,
    /// Total order: the share that would remain if all other keys were known.
    pub total: Vec<Estimate>,
}

/// Shares at a point: of each sample first A, then B, then each AB_i, so that a part of a sweep holds whole samples.
pub(super) fn saltelli_point(keys: usize, seed: u32, index: u64) -> Vec<f64> {
    let block = keys as u64 + 2;
    let (sample, which) = (index / block, (index % block) as usize);
    let from_b = |key: usize| which == 1 || which == key + 2;
    (0..keys).map(|key| sobol(sample, if from_b(key) { keys + key } else { key }, seed)).collect()
}

/// f(A), f(B) and all f(AB_i) of one sample.
type Sample<'a> = &'a [f64];

/// Indices from the values of a measure at all points of a `saltelli` design in their order, NaN where there is none.
///
/// ```
/// use smam::sweep::{Design, SamplingSpec, VarySpec, sobol_indices};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let key = |name: &str| VarySpec { key: name.to_owned(), from: Some(0.0), to: Some(1.0), ..VarySpec::default() };
/// let design = Design::new(SamplingSpec::Saltelli { count: 1024, seed: 1 }, &[key("u"), key("v")])?;
/// let value = |i: u64| design.point(i).iter().zip([3.0_f64, 4.0]).map(|(x, weight)| weight * x).sum::<f64>();
/// let values: Vec<f64> = (0..design.count()).map(value).collect();
/// // Of y = 3 u + 4 v the shares of the variance are 9/25 and 16/25, and nothing is in their interaction.
/// let found = sobol_indices(2, &values, 1);
/// assert!((found.first[0].value - 0.36).abs() < 0.02 && (found.total[1].value - 0.64).abs() < 0.02);
/// # Ok(())
/// # }
/// ```
pub fn sobol_indices(keys: usize, values: &[f64], seed: u32) -> SobolIndices {
    let whole: Vec<Sample> = values.chunks_exact(keys + 2).filter(|s| s.iter().all(|v| v.is_finite())).collect();
    let found = estimates(whole.len(), seed, |picks| of_samples(keys, &whole, picks));
    let (first, total) = found.split_at(keys);
    SobolIndices { samples: whole.len(), first: first.to_vec(), total: total.to_vec() }
}

/// First, then total indices.
fn of_samples(keys: usize, samples: &[Sample], picks: &[usize]) -> Vec<f64> {
    let n = picks.len() as f64;
    let sum = |of: &dyn Fn(Sample) -> f64| picks.iter().map(|&i| of(samples[i])).sum::<f64>();
    let mean = sum(&|s| s[0] + s[1]) / (2.0 * n);
    let variance = sum(&|s| (s[0] - mean).powi(2) + (s[1] - mean).powi(2)) / (2.0 * n);
    // A measure that never changes has no shares of a variance.
    let share = |part: f64| if variance > 1e-24 * mean * mean { part / variance } else { f64::NAN };
    let first = (0..keys).map(|i| share(sum(&|s| (s[1] - mean) * (s[i + 2] - s[0])) / n));
    let total = (0..keys).map(|i| share(sum(&|s| (s[0] - s[i + 2]).powi(2)) / (2.0 * n)));
    first.chain(total).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_a_b_and_a_with_each_key_of_b() {
        let at = |i| saltelli_point(2, 7, i);
        let (a, b) = (at(4), at(5));
        assert!(a[0] != b[0] && a[1] != b[1]);
        assert_eq!((at(6), at(7)), (vec![b[0], a[1]], vec![a[0], b[1]]));
    }

    #[test]
    fn shares_of_a_sum_are_those_of_its_terms() {
        // y = 3 u + 4 v: variances 9/12 and 16/12, no interaction.
        let point = |i| saltelli_point(3, 1, i);
        let y = |x: Vec<f64>| 100.0 + 3.0 * x[0] + 4.0 * x[1];
        let values: Vec<f64> = (0..1024 * 5).map(|i| y(point(i))).collect();
        let found = sobol_indices(3, &values, 1);
        for (i, expected) in [0.36, 0.64, 0.0].into_iter().enumerate() {
            assert!((found.first[i].value - expected).abs() < 0.01, "{found:?}");
            assert!((found.total[i].value - expected).abs() < 0.01, "{found:?}");
        }
    }

    #[test]
    fn failed_points_cost_their_sample_and_a_constant_has_no_indices() {
        let mut values = vec![2.0; 40];
        values[5] = f64::NAN;
        let found = sobol_indices(2, &values, 1);
        assert!(found.samples == 9 && found.first[0].value.is_nan(), "{found:?}");
    }
}
