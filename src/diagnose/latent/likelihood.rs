//! Likelihood of condensed recordings if signals at some ports follow random walks: a Kalman filter.

use nalgebra::{DMatrix, DVector};

use super::stretches::{Condensed, Measured};

/// Initial variance of a signal, relative to a clearly visible one: it may begin anywhere.
const FIRST: f64 = 100.0;
/// A parameter with less than this share of its own information is held, because others do the same.
const FAINT: f64 = 1e-10;

/// Signals at some ports, and the variance that each gains per second.
pub struct Walk<'a> {
    pub ports: &'a [usize],
    pub variance_s: f64,
}

/// Result of the filter for all runs.
pub struct Likelihood {
    /// Minus twice the log likelihood, up to a constant, maximised over calibration and free zeros.
    pub cost: f64,
    /// By run, the innovations' sum of squares above that of noise, in standard errors.
    pub left_sigma: Vec<f64>,
    /// The same of all runs, in units of chi².
    pub left: f64,
}

/// Normalised innovations of one run.
struct Innovations {
    /// Their products: residual first, then the columns of the Jacobian.
    products: DMatrix<f64>,
    /// Sum of the logarithms of their variances.
    spread: f64,
    count: f64,
}

impl Likelihood {
    pub fn of(runs: &[Condensed], walk: &Walk) -> Self {
        let runs: Vec<Innovations> = runs.iter().map(|run| filtered(run, walk).without_own(run.shared)).collect();
        let Some(first) = runs.first() else { return Self { cost: 0.0, left_sigma: Vec::new(), left: 0.0 } };
        let all = runs.iter().skip(1).fold(first.products.clone(), |sum, run| sum + &run.products);
        // Residual less Jacobian times parameters.
        let direction = DVector::from_iterator(all.nrows(), std::iter::once(1.0).chain(sizes(&all).iter().map(|x| -x)));
        let square = |run: &Innovations| direction.dot(&(&run.products * &direction));
        let sigma = |run: &Innovations| (square(run) - run.count) / (2.0 * run.count.max(1.0)).sqrt();
        Self {
            cost: runs.iter().map(|run| square(run) + run.spread).sum(),
            left_sigma: runs.iter().map(sigma).collect(),
            left: runs.iter().map(|run| (square(run) - run.count).max(0.0)).sum(),
        }
    }
}

impl Innovations {
    /// Profiles out the run's own parameters, which follow `shared` others.
    fn without_own(self, shared: usize) -> Self {
        let own = self.products.nrows() - shared;
        if own == 0 {
            return self;
        }
        let between = self.products.view((shared, 0), (own, shared)).into_owned();
        let explained = inverse(&self.products.view((shared, shared), (own, own)).into_owned()) * &between;
        let products = self.products.view((0, 0), (shared, shared)) - between.transpose() * explained;
        Self { products, ..self }
    }
}

/// Least-squares parameters for the residual, from the products.
fn sizes(products: &DMatrix<f64>) -> DVector<f64> {
    let n = products.nrows() - 1;
    let jacobian = products.view((1, 1), (n, n)).into_owned();
    inverse(&jacobian) * products.view((1, 0), (n, 1)).column(0)
}

/// Pseudo-inverse of a matrix of products, without redundant directions.
fn inverse(products: &DMatrix<f64>) -> DMatrix<f64> {
    let length: Vec<f64> = products.diagonal().iter().map(|x| x.max(f64::MIN_POSITIVE).sqrt()).collect();
    let scaled = DMatrix::from_fn(length.len(), length.len(), |i, j| products[(i, j)] / (length[i] * length[j]));
    let lifted = scaled + DMatrix::identity(length.len(), length.len()) * FAINT;
    let inverse = lifted.try_inverse().unwrap_or_else(|| DMatrix::zeros(length.len(), length.len()));
    DMatrix::from_fn(length.len(), length.len(), |i, j| inverse[(i, j)] / (length[i] * length[j]))
}

/// Estimates of states and signals, with their covariance.
struct Filter {
    /// Means, for the residual and each column of the Jacobian.
    mean: DMatrix<f64>,
    covariance: DMatrix<f64>,
    found: Innovations,
}

/// Runs the filter over one run.
fn filtered(run: &Condensed, walk: &Walk) -> Innovations {
    let own = walk.ports;
    let columns = run.measured.first().map_or(run.shared, |m| m.rows.ncols());
    let nothing = Innovations { products: DMatrix::zeros(columns, columns), spread: 0.0, count: 0.0 };
    let (n, signals) = (run.start.nrows(), own.len());
    let pick = |from: &DMatrix<f64>| {
        let mut some = from.columns(0, n).into_owned().resize_horizontally(n + signals, 0.0);
        own.iter().enumerate().for_each(|(i, &port)| some.set_column(n + i, &from.column(n + port)));
        some
    };
    let mut begun = DMatrix::zeros(n + signals, signals);
    own.iter().enumerate().for_each(|(i, &port)| {
        begun.view_mut((0, i), (n, 1)).copy_from(&run.start.column(port));
        begun[(n + i, i)] = 1.0;
    });
    let covariance = &begun * begun.transpose() * FIRST;
    let mut filter = Filter { mean: DMatrix::zeros(n + signals, columns), covariance, found: nothing };
    let mut moves = DMatrix::identity(n + signals, n + signals);
    for (map, measured) in run.maps.iter().zip(&run.measured) {
        (n..n + signals).for_each(|i| filter.covariance[(i, i)] += walk.variance_s * measured.lasts_s);
        filter.look(&pick(&map.seen), measured);
        moves.view_mut((0, 0), (n, n + signals)).copy_from(&pick(&map.end));
        filter.go_on(&moves);
    }
    filter.found
}

impl Filter {
    /// Measurement update with one stretch, channel by channel.
    fn look(&mut self, seen: &DMatrix<f64>, measured: &Measured) {
        for c in (0..measured.counts.len()).filter(|&c| measured.counts[c] > 0.0) {
            let shown = seen.row(c).transpose();
            let gain = &self.covariance * &shown;
            let variance = 1.0 + shown.dot(&gain);
            let innovation = measured.rows.row(c).transpose() - self.mean.tr_mul(&shown);
            self.found.products.ger(1.0 / variance, &innovation, &innovation, 1.0);
            self.found.spread += variance.ln();
            self.found.count += 1.0;
            self.mean.ger(1.0 / variance, &gain, &innovation, 1.0);
            self.covariance.ger(-1.0 / variance, &gain, &gain, 1.0);
        }
    }

    /// Time update to the end of a stretch.
    fn go_on(&mut self, moves: &DMatrix<f64>) {
        self.mean = moves * &self.mean;
        let moved = moves * &self.covariance * moves.transpose();
        self.covariance = (&moved + moved.transpose()) * 0.5;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::latent::stretches::Map;

    const STRETCHES: usize = 6;
    const CHANNELS: usize = 2;

    /// A run of two states and two ports, with one parameter of the fit and one free zero: all entries of one smooth disorder.
    fn run(salt: f64) -> Condensed {
        let entry =
            |i: usize, j: usize, k: usize| (salt + 1.7 * i as f64 + 2.9 * j as f64 + 4.3 * k as f64).powi(2).sin();
        let shared = 2;
        let measured = |k: usize| Measured {
            rows: DMatrix::from_fn(CHANNELS, shared + 1, |i, j| 3.0 * entry(i, j, k)),
            // A stretch in which the second channel shows nothing.
            counts: vec![4.0, if k == 2 { 0.0 } else { 1.0 }],
            lasts_s: 0.5 + 0.1 * k as f64,
        };
        let map = |k: usize| Map {
            end: DMatrix::from_fn(2, 4, |i, j| 0.6 * entry(j, i, k + 7)),
            seen: DMatrix::from_fn(CHANNELS, 4, |i, j| entry(i + 3, j, k)),
        };
        Condensed {
            measured: (0..STRETCHES).map(measured).collect(),
            shared,
            start: DMatrix::from_fn(2, 2, |i, j| entry(i, j, 11)),
            maps: (0..STRETCHES).map(map).collect(),
        }
    }

    /// Covariance of what is measured and its rows, from what the signals' beginnings and gains come to one by one.
    fn written_out(run: &Condensed, walk: &Walk) -> (DMatrix<f64>, DMatrix<f64>) {
        let own = walk.ports;
        let n = run.start.nrows();
        let there: Vec<(usize, usize)> = (0..STRETCHES)
            .flat_map(|k| (0..CHANNELS).map(move |c| (k, c)))
            .filter(|&(k, c)| run.measured[k].counts[c] > 0.0)
            .collect();
        let mut covariance = DMatrix::identity(there.len(), there.len());
        for &port in own {
            for gained in 0..=STRETCHES {
                let variance = match gained {
                    0 => FIRST,
                    k => walk.variance_s * run.measured[k - 1].lasts_s,
                };
                let mut state = if gained == 0 { run.start.column(port).into_owned() } else { DVector::zeros(n) };
                let mut shown = Vec::new();
                for k in 0..STRETCHES {
                    let acts = f64::from(gained == 0 || gained - 1 <= k);
                    let of = |map: &DMatrix<f64>| map.columns(0, n) * &state + map.column(n + port) * acts;
                    let (seen, end) = (of(&run.maps[k].seen), of(&run.maps[k].end));
                    shown.extend(there.iter().filter(|there| there.0 == k).map(|there| seen[there.1]));
                    state = end;
                }
                let shown = DVector::from_vec(shown);
                covariance += &shown * shown.transpose() * variance;
            }
        }
        let rows = DMatrix::from_fn(there.len(), run.shared + 1, |i, j| run.measured[there[i].0].rows[(there[i].1, j)]);
        (covariance, rows)
    }

    /// Minus twice the logarithm, with the number that both runs share and each run's own zero at their best.
    fn dense(runs: &[Condensed], walk: &Walk) -> f64 {
        let parts: Vec<_> = runs.iter().map(|run| written_out(run, walk)).collect();
        let mut spread = 0.0;
        let mut whitened: Vec<DMatrix<f64>> = Vec::new();
        for (covariance, rows) in parts {
            let root = covariance.cholesky().expect("positive");
            spread += root.l().diagonal().iter().map(|x| 2.0 * x.ln()).sum::<f64>();
            whitened.push(root.l().solve_lower_triangular(&rows).expect("regular"));
        }
        let count: usize = whitened.iter().map(DMatrix::nrows).sum();
        let mut jacobian = DMatrix::zeros(count, 1 + runs.len());
        let mut residual = DVector::zeros(count);
        let mut at = 0;
        for (r, rows) in whitened.iter().enumerate() {
            residual.rows_mut(at, rows.nrows()).copy_from(&rows.column(0));
            jacobian.view_mut((at, 0), (rows.nrows(), 1)).copy_from(&rows.column(1));
            jacobian.view_mut((at, 1 + r), (rows.nrows(), 1)).copy_from(&rows.column(2));
            at += rows.nrows();
        }
        let sizes = jacobian.clone().svd(true, true).solve(&residual, 1e-12).expect("both sides");
        spread + (residual - jacobian * sizes).norm_squared()
    }

    #[test]
    fn the_filter_gives_the_likelihood_of_all_samples_together() {
        let runs = [run(0.3), run(5.1)];
        for (ports, variance_s) in [(&[][..], 0.0), (&[0][..], 0.7), (&[1][..], 1e-3), (&[0, 1][..], 4.0)] {
            let walk = Walk { ports, variance_s };
            let [filtered, dense] = [Likelihood::of(&runs, &walk).cost, dense(&runs, &walk)];
            assert!((filtered - dense).abs() < 1e-6 * dense.abs(), "{ports:?}: {filtered} {dense}");
        }
    }
}
