//! Where in its range a key stands at a point: a share between 0 and 1, and the value that it means.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use statrs::distribution::{ContinuousCDF, Normal};

use super::SweepError;
use super::spec::{SamplingSpec, VarySpec};

/// Shares of all keys at every point.
#[derive(Clone, Debug)]
pub enum Shares {
    Grid {
        counts: Vec<u64>,
    },
    /// For each key, the part of the range in which each point lies.
    LatinHypercube {
        parts: Vec<Vec<u64>>,
        seed: u32,
    },
    Sobol {
        keys: usize,
        count: u64,
        seed: u32,
    },
    MonteCarlo {
        keys: usize,
        count: u64,
        seed: u32,
    },
}

/// Dimensions and length that Sobol's sequence is tabulated for.
const SOBOL_KEYS: usize = 256;
const SOBOL_COUNT: u64 = 1 << 16;
/// Points of one sweep: rows of more would not fit into the memory of one machine.
const MOST_POINTS: u64 = 100_000_000;

impl Shares {
    /// # Errors
    /// No points, more than can be counted, or more keys than the method has.
    pub fn new(sampling: SamplingSpec, vary: &[VarySpec]) -> Result<Self, SweepError> {
        let refuse = |message: String, remedy: &str| Err(SweepError::Sampling { message, remedy: remedy.to_owned() });
        let keys = vary.len();
        if sampling.count().is_some_and(|count| count > MOST_POINTS) {
            return refuse(format!("more than {MOST_POINTS} points"), "split the sweep");
        }
        let shares = match sampling {
            SamplingSpec::Grid => Self::Grid { counts: vary.iter().map(VarySpec::grid_count).collect() },
            SamplingSpec::LatinHypercube { count, seed } => {
                Self::LatinHypercube { parts: parts(keys, count, seed), seed }
            }
            SamplingSpec::Sobol { count, seed } if keys <= SOBOL_KEYS && count <= SOBOL_COUNT => {
                Self::Sobol { keys, count, seed }
            }
            SamplingSpec::Sobol { count, .. } => {
                let message = format!("sobol: {count} points of {keys} keys");
                return refuse(message, "take at most 65536 points of 256 keys, or method = \"latin_hypercube\"");
            }
            SamplingSpec::MonteCarlo { count, seed } => Self::MonteCarlo { keys, count, seed },
        };
        match shares.count() {
            None => refuse("the grid has more points than can be counted".to_owned(), "take fewer values, or samples"),
            Some(count) if count > MOST_POINTS => refuse(format!("the grid has {count} points"), "split the sweep"),
            Some(0) => refuse("there is no point".to_owned(), "give at least one key, and a count of at least 1"),
            Some(_) => Ok(shares),
        }
    }

    /// Number of points; none where it cannot be counted.
    pub fn count(&self) -> Option<u64> {
        match self {
            Self::Grid { counts } => counts.iter().try_fold(1u64, |all, n| all.checked_mul(*n)),
            Self::LatinHypercube { parts, .. } => parts.first().map(|p| p.len() as u64).or(Some(0)),
            Self::Sobol { count, .. } | Self::MonteCarlo { count, .. } => Some(*count),
        }
    }

    /// Places of all keys at a point.
    pub fn at(&self, index: u64) -> Vec<Place> {
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
                let share = |own: &Vec<u64>, u: f64| (own[index as usize] as f64 + u) / own.len() as f64;
                parts.iter().map(|own| Place::Share(share(own, random.random_range(0.0..1.0)))).collect()
            }
            Self::Sobol { keys, seed, .. } => (0..*keys as u32)
                .map(|key| Place::Share(f64::from(sobol_burley::sample(index as u32, key, *seed))))
                .collect(),
            Self::MonteCarlo { keys, seed, .. } => {
                let mut random = stream(*seed, index);
                (0..*keys).map(|_| Place::Share(random.random_range(0.0..1.0))).collect()
            }
        }
    }
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
fn stream(seed: u32, index: u64) -> ChaCha8Rng {
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

impl VarySpec {
    fn grid_count(&self) -> u64 {
        if self.values.is_empty() { self.count.unwrap_or(0) } else { self.values.len() as u64 }
    }

    /// The keys that get the value.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.key.split('+').map(str::trim)
    }

    /// # Errors
    /// Numbers that contradict each other or lack for the sampling.
    pub fn check(&self, sampling: SamplingSpec) -> Result<(), SweepError> {
        let refuse = |message: &str, remedy: &str| {
            let (key, message, remedy) = (self.key.clone(), message.to_owned(), remedy.to_owned());
            Err(SweepError::Vary { key, message, remedy })
        };
        let is_grid = sampling == SamplingSpec::Grid;
        let numbers = [self.from, self.to, self.mean, self.sd];
        if numbers.iter().flatten().chain(&self.values).any(|v| !v.is_finite()) {
            return refuse("a number is not finite", "give finite numbers");
        }
        match (self.from, self.to, self.mean, self.sd, self.values.is_empty()) {
            (None, None, None, None, false) if is_grid => Ok(()),
            (None, None, Some(_), Some(sd), true) if !is_grid && sd > 0.0 => Ok(()),
            (Some(from), Some(to), None, None, true) => {
                if is_grid && self.count.is_none_or(|n| n < 1) {
                    refuse("a grid needs a count", "give count = 1 or more, or values = [...]")
                } else if self.logarithmic && (from <= 0.0 || to <= 0.0) {
                    refuse("equal ratios need a range above 0", "leave logarithmic out, or give from and to above 0")
                } else if from > to {
                    refuse("from is greater than to", "swap them")
                } else {
                    Ok(())
                }
            }
            _ => refuse(
                "it is not clear what values it takes",
                "give from and to (and count in a grid), or values in a grid, or mean and sd > 0 in samples",
            ),
        }
    }

    /// The value at a place.
    pub fn value(&self, place: Place) -> f64 {
        match place {
            Place::Nth(n) if !self.values.is_empty() => self.values[n as usize],
            Place::Nth(n) => {
                let last = self.count.unwrap_or(1).saturating_sub(1);
                match self.to {
                    Some(to) if n == last && last > 0 => to,
                    _ => tidy(self.between(n as f64 / last.max(1) as f64)),
                }
            }
            Place::Share(share) => match (self.mean, self.sd) {
                (Some(mean), Some(sd)) => {
                    let inside = share.clamp(1e-12, 1.0 - 1e-12);
                    mean + sd * Normal::standard().inverse_cdf(inside)
                }
                _ => self.between(share),
            },
        }
    }

    fn between(&self, share: f64) -> f64 {
        let (from, to) = (self.from.unwrap_or(0.0), self.to.unwrap_or(0.0));
        if self.logarithmic { from * (to / from).powf(share) } else { from + share * (to - from) }
    }
}

/// To twelve digits: 0.3 instead of 0.30000000000000004.
fn tidy(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(count: u64) -> VarySpec {
        VarySpec { key: "a".to_owned(), from: Some(1.0), to: Some(3.0), count: Some(count), ..VarySpec::default() }
    }

    #[test]
    fn the_last_key_of_a_grid_changes_fastest_and_ends_are_met() {
        let vary = [range(2), range(3)];
        let shares = Shares::new(SamplingSpec::Grid, &vary).expect("a grid");
        let at = |i: u64| -> Vec<f64> { shares.at(i).iter().zip(&vary).map(|(p, v)| v.value(*p)).collect() };
        assert_eq!(shares.count(), Some(6));
        assert_eq!([at(0), at(1), at(2), at(3), at(5)].concat(), [1., 1., 1., 2., 1., 3., 3., 1., 3., 3.]);
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
            let shares = Shares::new(sampling, std::slice::from_ref(&normal)).expect("points");
            let values: Vec<f64> = (0..4096).map(|i| normal.value(shares.at(i)[0])).collect();
            let mean = values.iter().sum::<f64>() / 4096.0;
            let sd = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 4096.0).sqrt();
            assert!((mean - 2.0).abs() < 0.03 && (sd - 0.5).abs() < 0.02, "{mean} {sd}");
            assert_eq!(normal.value(shares.at(77)[0]), values[77]);
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
        assert!(Shares::new(grid, &vec![range(u64::MAX / 2); 3]).is_err());
        assert!(Shares::new(grid, &vec![range(10_000); 3]).is_err());
        let sobol = |count| Shares::new(SamplingSpec::Sobol { count, seed: 1 }, &[range(1)]);
        assert!(sobol(1 << 16).is_ok() && sobol((1 << 16) + 1).is_err());
    }
}
