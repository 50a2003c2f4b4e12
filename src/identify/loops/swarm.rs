//! Particle swarm, the method of Thai et al. 2021.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Size of a swarm and how long it flies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwarmOptions {
    pub particles: usize,
    pub iterations: usize,
}

/// The paper prints neither; these are usual and reach the bottom on its loop.
impl Default for SwarmOptions {
    fn default() -> Self {
        Self { particles: 64, iterations: 400 }
    }
}

/// Clerc and Kennedy 2002: with these a swarm contracts.
const INERTIA: f64 = 0.7298;
const PULL: f64 = 1.496_18;

/// The best place of the unit box found, and its value. `values` evaluates many places at once.
///
/// Global-best topology; a particle that leaves the box stays on its edge and loses that part of its speed.
pub fn swarm(
    dimension: usize,
    values: &dyn Fn(&[Vec<f64>]) -> Vec<f64>,
    options: SwarmOptions,
    seed: u64,
) -> (Vec<f64>, f64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = |low: f64, high: f64| random.random_range(low..high);
    let mut places: Vec<Vec<f64>> =
        (0..options.particles.max(1)).map(|_| (0..dimension).map(|_| uniform(0.0, 1.0)).collect()).collect();
    let mut speeds: Vec<Vec<f64>> =
        (0..options.particles.max(1)).map(|_| (0..dimension).map(|_| uniform(-0.25, 0.25)).collect()).collect();
    let mut own = places.clone();
    let mut own_values = values(&places);
    let mut best = least(&own_values);
    for _ in 0..options.iterations {
        for (i, (place, speed)) in places.iter_mut().zip(&mut speeds).enumerate() {
            for d in 0..dimension {
                let to_own = uniform(0.0, PULL) * (own[i][d] - place[d]);
                let to_best = uniform(0.0, PULL) * (own[best][d] - place[d]);
                let next = place[d] + INERTIA * speed[d] + to_own + to_best;
                speed[d] = next.clamp(0.0, 1.0) - place[d];
                place[d] = next.clamp(0.0, 1.0);
            }
        }
        for (i, value) in values(&places).into_iter().enumerate().filter(|(_, v)| v.is_finite()) {
            if value < own_values[i] {
                own_values[i] = value;
                own[i].clone_from(&places[i]);
            }
        }
        best = least(&own_values);
    }
    (own.swap_remove(best), own_values[best])
}

pub(super) fn least(values: &[f64]) -> usize {
    (0..values.len()).min_by(|&i, &j| values[i].total_cmp(&values[j])).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_bottom_of_a_valley_again_with_the_same_seed() {
        let values =
            |places: &[Vec<f64>]| places.iter().map(|p| (p[0] - 0.3).powi(2) + 9.0 * (p[1] - p[0]).powi(2)).collect();
        let options = SwarmOptions { particles: 20, iterations: 200 };
        let (place, value) = swarm(2, &values, options, 3);
        assert!(value < 1e-12 && (place[1] - 0.3).abs() < 1e-5, "{place:?} {value}");
        assert_eq!(swarm(2, &values, options, 3), (place, value));
    }
}
