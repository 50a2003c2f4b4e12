//! CMA-ES in the unit box, after Hansen, "The CMA evolution strategy: a tutorial", 2016.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CmaOptions {
    /// Places per generation; two full packs of lanes by default.
    pub population: usize,
    pub most_evaluations: usize,
}

impl Default for CmaOptions {
    fn default() -> Self {
        Self { population: 16, most_evaluations: 25_600 }
    }
}

/// First spread, as a share of the box.
const FIRST_SPREAD: f64 = 0.3;
/// The search ends when it spreads less than this.
const LEAST_SPREAD: f64 = 1e-10;

/// The best place of the unit box found, its value, and how many places were evaluated.
///
/// A place outside the box is evaluated at the box's nearest point and ranked behind by its squared distance.
pub fn cma(
    start: &[f64],
    values: &dyn Fn(&[Vec<f64>]) -> Vec<f64>,
    options: CmaOptions,
    seed: u64,
) -> (Vec<f64>, f64, usize) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    // Of fewer than two none is better.
    let options = CmaOptions { population: options.population.max(2), ..options };
    let mut spread = Spread::new(start, options.population);
    let mut best = (start.to_vec(), f64::INFINITY);
    let mut evaluations = 0;
    while evaluations + options.population <= options.most_evaluations && spread.sigma > LEAST_SPREAD {
        let steps = spread.draw(&mut random, options.population);
        let places: Vec<Vec<f64>> =
            steps.iter().map(|y| spread.place(y).iter().map(|u| u.clamp(0.0, 1.0)).collect()).collect();
        let found = values(&places);
        evaluations += places.len();
        let outside = |i: usize| -> f64 {
            spread.place(&steps[i]).iter().zip(&places[i]).map(|(free, kept)| (free - kept).powi(2)).sum()
        };
        let at = super::swarm::least(&found);
        if found[at] < best.1 {
            best = (places[at].clone(), found[at]);
        }
        let reference = found.iter().copied().filter(|f| f.is_finite()).fold(0.0, f64::max).max(1e-300);
        let ranked: Vec<f64> = (0..found.len()).map(|i| found[i] + reference * outside(i)).collect();
        let mut order: Vec<usize> = (0..found.len()).collect();
        order.sort_by(|&i, &j| ranked[i].total_cmp(&ranked[j]));
        spread.learn(&order.iter().map(|&i| &steps[i]).collect::<Vec<_>>());
    }
    (best.0, best.1, evaluations)
}

/// The normal distribution that places are drawn from, and what it learns by.
struct Spread {
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    /// Square root of the covariance and its inverse.
    root: DMatrix<f64>,
    inverse_root: DMatrix<f64>,
    path_sigma: DVector<f64>,
    path: DVector<f64>,
    weights: Vec<f64>,
    generation: i32,
}

impl Spread {
    fn new(start: &[f64], population: usize) -> Self {
        let n = start.len();
        let parents = population / 2;
        let raw: Vec<f64> = (1..=parents).map(|i| ((population as f64 + 1.0) / 2.0).ln() - (i as f64).ln()).collect();
        let sum: f64 = raw.iter().sum();
        Self {
            mean: DVector::from_column_slice(start),
            sigma: FIRST_SPREAD,
            covariance: DMatrix::identity(n, n),
            root: DMatrix::identity(n, n),
            inverse_root: DMatrix::identity(n, n),
            path_sigma: DVector::zeros(n),
            path: DVector::zeros(n),
            weights: raw.into_iter().map(|w| w / sum).collect(),
            generation: 0,
        }
    }

    /// Steps in units of sigma.
    fn draw(&self, random: &mut ChaCha8Rng, count: usize) -> Vec<DVector<f64>> {
        let n = self.mean.len();
        let mut one = || &self.root * DVector::from_fn(n, |_, _| StandardNormal.sample(random));
        (0..count).map(|_| one()).collect()
    }

    fn place(&self, step: &DVector<f64>) -> DVector<f64> {
        &self.mean + step * self.sigma
    }

    /// Moves mean, paths, covariance and sigma; `ranked` are the steps, best first.
    fn learn(&mut self, ranked: &[&DVector<f64>]) {
        let n = self.mean.len() as f64;
        let effective = 1.0 / self.weights.iter().map(|w| w * w).sum::<f64>();
        let c_sigma = (effective + 2.0) / (n + effective + 5.0);
        let d_sigma = 1.0 + 2.0 * (((effective - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0) + c_sigma;
        let c_path = (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n);
        let c_one = 2.0 / ((n + 1.3).powi(2) + effective);
        let c_mu = (1.0 - c_one).min(2.0 * (effective - 2.0 + 1.0 / effective) / ((n + 2.0).powi(2) + effective));
        let expected = n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));

        let step: DVector<f64> = self.weights.iter().zip(ranked).map(|(w, y)| *y * *w).sum();
        self.mean += &step * self.sigma;
        self.generation += 1;
        self.path_sigma = &self.path_sigma * (1.0 - c_sigma)
            + &self.inverse_root * &step * (c_sigma * (2.0 - c_sigma) * effective).sqrt();
        let length = self.path_sigma.norm();
        let settled = (1.0 - (1.0 - c_sigma).powi(2 * self.generation)).sqrt();
        let moving = length / settled < (1.4 + 2.0 / (n + 1.0)) * expected;
        let kick = if moving { (c_path * (2.0 - c_path) * effective).sqrt() } else { 0.0 };
        self.path = &self.path * (1.0 - c_path) + &step * kick;
        let lost = if moving { 0.0 } else { c_one * c_path * (2.0 - c_path) };
        self.covariance *= 1.0 - c_one - c_mu + lost;
        self.covariance += &self.path * self.path.transpose() * c_one;
        for (w, y) in self.weights.iter().zip(ranked) {
            self.covariance += *y * y.transpose() * (c_mu * w);
        }
        self.sigma = (self.sigma * (c_sigma / d_sigma * (length / expected - 1.0)).exp()).min(1.0);
        self.take_roots();
    }

    fn take_roots(&mut self) {
        let symmetric = (&self.covariance + self.covariance.transpose()) * 0.5;
        let SymmetricEigen { eigenvectors, eigenvalues } = SymmetricEigen::new(symmetric);
        let roots = eigenvalues.map(|v| v.max(1e-30).sqrt());
        self.root = &eigenvectors * DMatrix::from_diagonal(&roots) * eigenvectors.transpose();
        self.inverse_root = &eigenvectors * DMatrix::from_diagonal(&roots.map(|r| 1.0 / r)) * eigenvectors.transpose();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn follows_a_bent_valley_and_keeps_to_the_box() {
        // Rosenbrock's, its bottom at (0.5, 0.5).
        let bent = |places: &[Vec<f64>]| {
            let one = |p: &Vec<f64>| (1.0 - 2.0 * p[0]).powi(2) + 100.0 * (2.0 * p[1] - 4.0 * p[0] * p[0]).powi(2);
            places.iter().map(one).collect()
        };
        let (place, value, evaluations) = cma(&[0.1, 0.9], &bent, CmaOptions::default(), 5);
        assert!(value < 1e-12 && (place[0] - 0.5).abs() < 1e-5, "{place:?} {value} {evaluations}");
        let beyond = |places: &[Vec<f64>]| places.iter().map(|p| 1.0 + (p[0] - 1.4).powi(2)).collect();
        let (place, ..) = cma(&[0.5], &beyond, CmaOptions { population: 8, most_evaluations: 4_000 }, 5);
        assert!((place[0] - 1.0).abs() < 1e-6, "{place:?}");
    }
}
