//! Where in its range a key stands at a point: a share between 0 and 1, and the value that it means.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::SweepError;
use super::morris::Trajectories;
use super::sobol_indices::saltelli_point;
use super::spec::{SamplingSpec, VarySpec};

/// Shares of all keys at every point.
#[derive(Clone, Debug)]
pub enum Shares {
    Grid {
        counts: Vec<u64>,
    },
    /// For each key, the part of the range in which each point lies. The first generation of NSGA-II is one too.
    LatinHypercube {
        parts: Vec<Vec<u64>>,
        seed: u32,
    },
    Sobol {
        keys: usize,
        seed: u32,
    },
    MonteCarlo {
        keys: usize,
        seed: u32,
    },
    Saltelli {
        keys: usize,
        seed: u32,
    },
    Morris(Trajectories),
}

/// Dimensions and length that Sobol's sequence is tabulated for.
const SOBOL_KEYS: usize = 256;
const SOBOL_COUNT: u64 = 1 << 16;

impl Shares {
    /// # Errors
    /// More keys or samples than the method has.
    pub fn new(sampling: SamplingSpec, vary: &[VarySpec]) -> Result<Self, SweepError> {
        let keys = vary.len();
        Ok(match sampling {
            SamplingSpec::Grid => Self::Grid { counts: vary.iter().map(VarySpec::grid_count).collect() },
            SamplingSpec::LatinHypercube { count, seed } | SamplingSpec::Nsga2 { population: count, seed, .. } => {
                Self::LatinHypercube { parts: parts(keys, count, seed), seed }
            }
            SamplingSpec::Sobol { count, seed } => {
                tabulated("sobol", keys, count)?;
                Self::Sobol { keys, seed }
            }
            SamplingSpec::Saltelli { count, seed } => {
                // Two points of the sequence side by side are one sample.
                tabulated("saltelli", 2 * keys, count)?;
                Self::Saltelli { keys, seed }
            }
            SamplingSpec::MonteCarlo { seed, .. } => Self::MonteCarlo { keys, seed },
            SamplingSpec::Morris { levels, seed, .. } => Self::Morris(Trajectories::new(keys, levels, seed)?),
        })
    }

    /// Places of all keys at a point.
    pub fn at(&self, index: u64) -> Vec<Place> {
        let shares = |all: Vec<f64>| all.into_iter().map(Place::Share).collect();
        match self {
            Self::Grid { counts } => {
                let mut rest = index;
                let mut places: Vec<Place> = Vec::with_capacity(counts.len());
                for count in counts.iter().rev() {
                    places.push(Place::Nth(rest % count));
                    rest /= count;
                }
                places.reverse();
                places
            }
            Self::LatinHypercube { parts, seed } => {
                let mut random = stream(*seed, index);
                let mut share = |own: &Vec<u64>| {
                    let part = own[index as usize % own.len()] as f64;
                    (part + random.random_range(0.0..1.0)) / own.len() as f64
                };
                shares(parts.iter().map(&mut share).collect())
            }
            Self::Sobol { keys, seed } => shares((0..*keys).map(|key| sobol(index, key, *seed)).collect()),
            Self::MonteCarlo { keys, seed } => {
                let mut random = stream(*seed, index);
                shares((0..*keys).map(|_| random.random_range(0.0..1.0)).collect())
            }
            Self::Saltelli { keys, seed } => shares(saltelli_point(*keys, *seed, index)),
            Self::Morris(trajectories) => shares(trajectories.point(index)),
        }
    }
}

fn tabulated(method: &str, dimensions: usize, count: u64) -> Result<(), SweepError> {
    if dimensions <= SOBOL_KEYS && count <= SOBOL_COUNT {
        return Ok(());
    }
    Err(SweepError::Sampling {
        message: format!("{method}: {count} samples in {dimensions} dimensions"),
        remedy: format!(
            "Sobol's sequence is known for {SOBOL_COUNT} samples in {SOBOL_KEYS} dimensions: take fewer keys or samples"
        ),
    })
}

/// One coordinate of a point of Sobol's sequence, Owen-scrambled by the seed.
pub(super) fn sobol(index: u64, dimension: usize, seed: u32) -> f64 {
    f64::from(sobol_burley::sample(index as u32, dimension as u32, seed))
}

/// Where a key stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// At its n-th value.
    Nth(u64),
    /// At this share of its range or of its distribution.
    Share(f64),
}

/// Draws of one point, whatever the others draw.
pub(super) fn stream(seed: u32, index: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(u64::from(seed));
    random.set_stream(index);
    random
}

fn parts(keys: usize, count: u64, seed: u32) -> Vec<Vec<u64>> {
    let shuffled = |key: usize| {
        let mut all: Vec<u64> = (0..count).collect();
        // Streams of the keys lie beyond those of the points.
        all.shuffle(&mut stream(seed, u64::MAX - key as u64));
        all
    };
    (0..keys).map(shuffled).collect()
}

#[cfg(test)]
mod tests {
    use super::super::design::Design;
    use super::*;

    fn range(count: u64) -> VarySpec {
        VarySpec { key: "a".to_owned(), from: Some(1.0), to: Some(3.0), count: Some(count), ..VarySpec::default() }
    }

    #[test]
    fn the_last_key_of_a_grid_changes_fastest_and_ends_are_met() {
        let vary = [range(2), range(3)];
        let grid = Design::new(SamplingSpec::Grid, &vary).expect("a grid");
        assert_eq!(grid.count(), 6);
        assert_eq!([0, 1, 2, 3, 5].map(|i| grid.point(i)).concat(), [1., 1., 1., 2., 1., 3., 3., 1., 3., 3.]);
    }

    #[test]
    fn every_part_of_a_latin_hypercube_holds_one_point() {
        let shares =
            Shares::new(SamplingSpec::LatinHypercube { count: 50, seed: 3 }, &[range(1), range(1)]).expect("50");
        for key in 0..2 {
            let mut parts: Vec<u64> = (0..50)
                .map(|i| match shares.at(i)[key] {
                    Place::Share(s) => (s * 50.0) as u64,
                    Place::Nth(_) => panic!("a share"),
                })
                .collect();
            parts.sort_unstable();
            assert_eq!(parts, (0..50).collect::<Vec<u64>>());
        }
    }

    #[test]
    fn samples_have_their_distribution_and_do_not_depend_on_each_other() {
        let normal = VarySpec { key: "a".to_owned(), mean: Some(2.0), sd: Some(0.5), ..VarySpec::default() };
        for sampling in
            [SamplingSpec::Sobol { count: 4096, seed: 1 }, SamplingSpec::MonteCarlo { count: 4096, seed: 1 }]
        {
            normal.check(sampling).expect("valid");
            let design = Design::new(sampling, std::slice::from_ref(&normal)).expect("points");
            let values: Vec<f64> = (0..4096).map(|i| design.point(i)[0]).collect();
            let mean = values.iter().sum::<f64>() / 4096.0;
            let sd = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4096.0).sqrt();
            assert!((mean - 2.0).abs() < 0.03 && (sd - 0.5).abs() < 0.02, "{mean} {sd}");
            assert_eq!(design.point(77)[0], values[77]);
        }
    }

    #[test]
    fn what_is_not_clear_is_refused() {
        let grid = SamplingSpec::Grid;
        assert!(VarySpec { count: None, ..range(1) }.check(grid).is_err());
        assert!(VarySpec { to: None, ..range(2) }.check(grid).is_err());
        assert!(VarySpec { from: Some(-1.0), logarithmic: true, ..range(2) }.check(grid).is_err());
        assert!(VarySpec { sd: Some(1.0), ..range(2) }.check(grid).is_err());
        assert!(range(2).check(grid).is_ok());
        assert!(Design::new(grid, &vec![range(u64::MAX / 2); 3]).is_err());
        assert!(Design::new(grid, &vec![range(10_000); 3]).is_err());
        let sobol = |count| Design::new(SamplingSpec::Sobol { count, seed: 1 }, &[range(1)]);
        assert!(sobol(1 << 16).is_ok() && sobol((1 << 16) + 1).is_err());
    }
}
