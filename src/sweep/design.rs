//! The points of a sweep before anything is known of a scene: values of the keys by index.

use super::SweepError;
use super::sampling::{Place, Shares};
use super::spec::{SamplingSpec, VarySpec};

/// Points of one sweep: rows of more would not fit into the memory of one machine.
const MOST_POINTS: u64 = 100_000_000;

const FEWER: &str = "take fewer values or samples, or split the ranges over several sweeps";

/// Keys and how their values are chosen.
#[derive(Clone, Debug)]
pub struct Design {
    shares: Shares,
    vary: Vec<VarySpec>,
    count: u64,
}

impl Design {
    /// # Errors
    /// Ranges that are not clear; no points, more than can be counted, or more keys than the method has.
    pub fn new(sampling: SamplingSpec, vary: &[VarySpec]) -> Result<Self, SweepError> {
        vary.iter().try_for_each(|v| v.check(sampling))?;
        let refuse = |message: String, remedy: &str| Err(SweepError::Sampling { message, remedy: remedy.to_owned() });
        let count = match count(sampling, vary) {
            None => return refuse("more points than can be counted".to_owned(), FEWER),
            Some(count) if count > MOST_POINTS => {
                return refuse(format!("{count} points are more than the {MOST_POINTS} that a sweep may have"), FEWER);
            }
            Some(0) => {
                return refuse("there is no point".to_owned(), "give at least one key, and a count of at least 1");
            }
            Some(count) => count,
        };
        Ok(Self { shares: Shares::new(sampling, vary)?, vary: vary.to_vec(), count })
    }

    /// Number of points.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Number of keys.
    pub fn keys(&self) -> usize {
        self.vary.len()
    }

    /// Values of the keys at a point, in their order; of NSGA-II those of its first generation.
    pub fn point(&self, index: u64) -> Vec<f64> {
        self.values(&self.shares.at(index))
    }

    /// Values at places.
    pub(super) fn values(&self, places: &[Place]) -> Vec<f64> {
        places.iter().zip(&self.vary).map(|(place, vary)| vary.value(*place)).collect()
    }
}

/// Number of points; none where it cannot be counted.
fn count(sampling: SamplingSpec, vary: &[VarySpec]) -> Option<u64> {
    let keys = vary.len() as u64;
    match sampling {
        _ if keys == 0 => Some(0),
        SamplingSpec::Grid => vary.iter().try_fold(1u64, |all, v| all.checked_mul(v.grid_count())),
        SamplingSpec::LatinHypercube { count, .. }
        | SamplingSpec::Sobol { count, .. }
        | SamplingSpec::MonteCarlo { count, .. } => Some(count),
        SamplingSpec::Saltelli { count, .. } => count.checked_mul(keys + 2),
        SamplingSpec::Morris { trajectories, .. } => trajectories.checked_mul(keys + 1),
        SamplingSpec::Nsga2 { population, generations, .. } => population.checked_mul(generations),
    }
}
