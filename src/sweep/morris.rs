//! Morris' screening: how much a measure changes with each key over its range, and how unevenly.
//!
//! A trajectory starts at a random point of a grid of `levels` levels and changes one key after the other by
//! `D = levels / (2 (levels - 1))` of its range. The elementary effect of a key is the change of the measure over D: in the
//! measure's unit, per range of the key. Source: Morris, Technometrics 33 (1991) 161; `mu*` after Campolongo et al.,
//! Environ. Model. Softw. 22 (2007) 1509.

use rand::RngExt;
use rand::seq::SliceRandom;

use super::SweepError;
use super::bootstrap::{Estimate, estimates};
use super::sampling::stream;

/// Trajectories over a number of keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trajectories {
    keys: usize,
    levels: u64,
    seed: u32,
}

/// One trajectory: where it starts, and what it changes.
struct Trajectory {
    /// Shares of all keys at the start.
    start: Vec<f64>,
    /// Change of each key, as a share of its range.
    change: Vec<f64>,
    /// Keys in the order of their change.
    order: Vec<usize>,
}

/// Effects of all keys on one measure, each in the measure's unit per range of the key.
#[derive(Clone, Debug, PartialEq)]
pub struct MorrisEffects {
    /// Trajectories whose points are all there.
    pub trajectories: usize,
    /// Mean effect of each key.
    pub mu: Vec<Estimate>,
    /// Mean size of the effect.
    pub mu_star: Vec<Estimate>,
    /// Standard deviation of the effect: beside a mu* of its size, the key is nonlinear or acts with others.
    pub sigma: Vec<Estimate>,
}

impl Trajectories {
    /// # Errors
    /// An odd number of levels, or less than 2.
    pub fn new(keys: usize, levels: u64, seed: u32) -> Result<Self, SweepError> {
        if levels < 2 || levels % 2 == 1 || levels > 1 << 20 {
            let message = format!("morris: levels = {levels}");
            return Err(SweepError::Sampling { message, remedy: "take an even number of levels, as 4".to_owned() });
        }
        Ok(Self { keys, levels, seed })
    }

    /// Shares at a point; the points of a trajectory follow each other.
    pub(super) fn point(&self, index: u64) -> Vec<f64> {
        let block = self.keys as u64 + 1;
        let trajectory = self.trajectory(index / block);
        let mut shares = trajectory.start;
        for &key in &trajectory.order[..(index % block) as usize] {
            shares[key] += trajectory.change[key];
        }
        shares
    }

    fn trajectory(&self, number: u64) -> Trajectory {
        let mut random = stream(self.seed, number);
        let (half, last) = (self.levels / 2, (self.levels - 1) as f64);
        let step = half as f64 / last;
        let (mut start, mut change) = (Vec::new(), Vec::new());
        for _ in 0..self.keys {
            let low = random.random_range(0..half) as f64 / last;
            let up = random.random_bool(0.5);
            start.push(if up { low } else { low + step });
            change.push(if up { step } else { -step });
        }
        let mut order: Vec<usize> = (0..self.keys).collect();
        order.shuffle(&mut random);
        Trajectory { start, change, order }
    }

    /// Effects from the values of a measure at all points in their order, NaN where there is none.
    pub fn effects(&self, values: &[f64]) -> MorrisEffects {
        let blocks = values.chunks_exact(self.keys + 1).enumerate();
        let whole = blocks.filter(|(_, block)| block.iter().all(|v| v.is_finite()));
        let all: Vec<Vec<f64>> = whole.map(|(number, block)| self.elementary(number as u64, block)).collect();
        let found = estimates(all.len(), self.seed, |picks| of_effects(self.keys, &all, picks));
        let part = |i: usize| found[i * self.keys..(i + 1) * self.keys].to_vec();
        MorrisEffects { trajectories: all.len(), mu: part(0), mu_star: part(1), sigma: part(2) }
    }

    fn elementary(&self, number: u64, values: &[f64]) -> Vec<f64> {
        let trajectory = self.trajectory(number);
        let mut effects = vec![0.0; self.keys];
        for (step, &key) in trajectory.order.iter().enumerate() {
            effects[key] = (values[step + 1] - values[step]) / trajectory.change[key];
        }
        effects
    }
}

/// mu, mu* and sigma of all keys.
fn of_effects(keys: usize, all: &[Vec<f64>], picks: &[usize]) -> Vec<f64> {
    let n = picks.len() as f64;
    let mean = |of: &dyn Fn(f64) -> f64, key: usize| picks.iter().map(|&i| of(all[i][key])).sum::<f64>() / n;
    let mu: Vec<f64> = (0..keys).map(|key| mean(&|e| e, key)).collect();
    let mu_star = (0..keys).map(|key| mean(&f64::abs, key));
    let sigma = (0..keys).map(|key| (mean(&|e| (e - mu[key]).powi(2), key) * n / (n - 1.0)).sqrt());
    mu.iter().copied().chain(mu_star).chain(sigma).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_changes_one_key_and_stays_in_the_range() {
        let trajectories = Trajectories::new(3, 4, 5).expect("even");
        for t in 0..20 {
            let points: Vec<Vec<f64>> = (0..4).map(|s| trajectories.point(4 * t + s)).collect();
            assert!(points.iter().flatten().all(|v| (-1e-12..=1.0 + 1e-12).contains(v)), "{points:?}");
            for pair in points.windows(2) {
                let changed = pair[0].iter().zip(&pair[1]).filter(|(a, b)| (*a - *b).abs() > 0.5);
                assert_eq!(changed.count(), 1, "{points:?}");
            }
        }
        assert!(Trajectories::new(3, 5, 1).is_err() && Trajectories::new(3, 0, 1).is_err());
    }

    #[test]
    fn a_plane_has_its_slopes_and_no_spread() {
        let trajectories = Trajectories::new(2, 4, 1).expect("even");
        let values: Vec<f64> = (0..30).map(|i| trajectories.point(i)).map(|x| 3.0 * x[0] - 5.0 * x[1]).collect();
        let found = trajectories.effects(&values);
        assert_eq!(found.trajectories, 10);
        assert!((found.mu[1].value + 5.0).abs() < 1e-9 && (found.mu_star[1].value - 5.0).abs() < 1e-9, "{found:?}");
        assert!(found.sigma.iter().all(|s| s.value < 1e-9), "{found:?}");
    }
}
