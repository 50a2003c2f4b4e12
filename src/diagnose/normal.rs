//! Normal equations in scaled numbers, and the steps they give.

use nalgebra::{DMatrix, DVector};

/// Range, scale and prior of one fitted number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    pub min: f64,
    pub max: f64,
    pub scale: f64,
    /// Where the prior sits, and one over its standard deviation; 0: there is none.
    pub prior: f64,
    pub prior_weight: f64,
}

/// Residuals in units of the noise and their derivatives to numbers in units of each scale, one row per sample.
pub(super) struct Rows {
    pub slopes: DMatrix<f64>,
    pub residual: DVector<f64>,
}

impl Rows {
    /// All parts below each other; none without parts.
    pub fn stack(parts: &[Self]) -> Option<Self> {
        let count = parts.iter().map(|p| p.residual.len()).sum();
        let mut all =
            Self { slopes: DMatrix::zeros(count, parts.first()?.slopes.ncols()), residual: DVector::zeros(count) };
        let mut at = 0;
        for part in parts {
            all.slopes.rows_mut(at, part.residual.len()).copy_from(&part.slopes);
            all.residual.rows_mut(at, part.residual.len()).copy_from(&part.residual);
            at += part.residual.len();
        }
        Some(all)
    }
}

/// `J^T J`, `J^T r` and `r^T r`, `r` measured minus simulated, `J` the derivatives of what is simulated.
#[derive(Clone, Debug)]
pub(super) struct Normal {
    pub matrix: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub cost: f64,
}

impl Normal {
    pub fn empty(numbers: usize) -> Self {
        Self { matrix: DMatrix::zeros(numbers, numbers), gradient: DVector::zeros(numbers), cost: 0.0 }
    }

    /// Adds rows.
    pub fn add(&mut self, rows: &Rows) {
        self.matrix += rows.slopes.tr_mul(&rows.slopes);
        self.gradient += rows.slopes.tr_mul(&rows.residual);
        self.cost += rows.residual.norm_squared();
    }

    /// A damped step in scaled numbers from `x`; numbers that a bound holds back stay.
    pub fn bounded_step(&self, numbers: &[Number], x: &[f64], damping: f64) -> Option<DVector<f64>> {
        let mut held = vec![false; x.len()];
        loop {
            let step = self.damped(&held, damping).cholesky()?.solve(&self.free_gradient(&held));
            let blocked = (0..x.len()).find(|&i| {
                let n = &numbers[i];
                !held[i] && ((x[i] <= n.min && step[i] < 0.0) || (x[i] >= n.max && step[i] > 0.0))
            });
            match blocked {
                Some(i) => held[i] = true,
                None => return Some(step),
            }
        }
    }

    fn damped(&self, held: &[bool], damping: f64) -> DMatrix<f64> {
        let mut damped = self.matrix.clone();
        for i in 0..held.len() {
            damped[(i, i)] += damping * self.matrix[(i, i)] + 1e-14 * self.largest();
            if held[i] {
                damped.row_mut(i).fill(0.0);
                damped.column_mut(i).fill(0.0);
                damped[(i, i)] = 1.0;
            }
        }
        damped
    }

    fn free_gradient(&self, held: &[bool]) -> DVector<f64> {
        DVector::from_fn(held.len(), |i, _| if held[i] { 0.0 } else { self.gradient[i] })
    }

    /// By how much the cost falls over a step if all is linear.
    pub fn promised_gain(&self, step: &DVector<f64>) -> f64 {
        2.0 * self.gradient.dot(step) - step.dot(&(&self.matrix * step))
    }

    /// Inverse of the matrix; directions the data do not see get a very large variance.
    pub fn covariance(&self) -> DMatrix<f64> {
        let n = self.matrix.nrows();
        let lifted = &self.matrix + DMatrix::identity(n, n) * (1e-13 * self.largest());
        lifted.try_inverse().unwrap_or_else(|| DMatrix::from_element(n, n, f64::INFINITY))
    }

    fn largest(&self) -> f64 {
        self.matrix.diagonal().max().max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(at: &[f64]) -> Normal {
        let rows = Rows {
            slopes: DMatrix::from_fn(at.len(), 2, |i, j| if j == 0 { 1.0 } else { at[i] }),
            residual: DVector::from_fn(at.len(), |i, _| 2.0 - 0.5 * at[i]),
        };
        let mut normal = Normal::empty(2);
        normal.add(&rows);
        normal
    }

    #[test]
    fn a_step_solves_what_is_linear_and_stops_at_bounds() {
        let normal = line(&[0.0, 1.0, 2.0, 5.0]);
        let free = Number { min: -9.0, max: 9.0, scale: 1.0, prior: 0.0, prior_weight: 0.0 };
        let step = normal.bounded_step(&[free, free], &[0.0, 0.0], 0.0).expect("definite");
        assert!((step[0] - 2.0).abs() < 1e-9 && (step[1] + 0.5).abs() < 1e-9, "{step}");
        assert!((normal.promised_gain(&step) - normal.cost).abs() < 1e-9);
        let floor = Number { min: 0.0, ..free };
        let held = normal.bounded_step(&[free, floor], &[0.0, 0.0], 0.0).expect("definite");
        assert!(held[1] == 0.0 && (held[0] - 1.0).abs() < 1e-9, "{held}");
    }
}
