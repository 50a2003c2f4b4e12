//! Normal equations in scaled parameters, and the steps they give.

use nalgebra::{DMatrix, DVector};

/// Range, scale and prior of one fitted number.
#[derive(Clone, Copy, Debug)]
pub(in crate::diagnose) struct FitParameter {
    pub min: f64,
    pub max: f64,
    pub scale: f64,
    /// Step of its difference quotient, in scales.
    pub step: f64,
    /// Mean of the prior, and one over its standard deviation; 0: no prior.
    pub prior: f64,
    pub prior_weight: f64,
}

/// Residuals in units of the noise and the derivatives of what is simulated to parameters in units of each scale, one row
/// per sample.
#[derive(Clone, Debug)]
pub(in crate::diagnose) struct Rows {
    pub jacobian: DMatrix<f64>,
    pub residual: DVector<f64>,
}

impl Rows {
    /// Stacks all parts; `None` if there are none.
    pub fn stack(parts: &[Self]) -> Option<Self> {
        let count = parts.iter().map(|p| p.residual.len()).sum();
        let mut all =
            Self { jacobian: DMatrix::zeros(count, parts.first()?.jacobian.ncols()), residual: DVector::zeros(count) };
        let mut at = 0;
        for part in parts {
            all.jacobian.rows_mut(at, part.residual.len()).copy_from(&part.jacobian);
            all.residual.rows_mut(at, part.residual.len()).copy_from(&part.residual);
            at += part.residual.len();
        }
        Some(all)
    }

    /// Moves by `step` to where the residual is `residual`, and updates the Jacobian to agree with the observed change
    /// (Broyden's least-change update).
    pub fn move_on(&mut self, step: &DVector<f64>, residual: DVector<f64>) {
        let length = step.norm_squared();
        if length > 0.0 {
            let unforeseen = &self.residual - &residual - &self.jacobian * step;
            self.jacobian.ger(1.0 / length, &unforeseen, step, 1.0);
        }
        self.residual = residual;
    }
}

/// `J^T J`, `J^T r` and `r^T r`, `r` measured minus simulated, `J` the derivatives of what is simulated.
#[derive(Clone, Debug)]
pub(in crate::diagnose) struct Normal {
    pub matrix: DMatrix<f64>,
    pub gradient: DVector<f64>,
    pub cost: f64,
}

impl Normal {
    /// Those of rows and of the parameters' priors at `x`.
    pub fn of(rows: &Rows, parameters: &[FitParameter], x: &[f64]) -> Self {
        let mut normal = Self {
            matrix: rows.jacobian.tr_mul(&rows.jacobian),
            gradient: rows.jacobian.tr_mul(&rows.residual),
            cost: rows.residual.norm_squared() + prior_cost(parameters, x),
        };
        for (i, (n, x)) in parameters.iter().zip(x).enumerate() {
            let weight = n.prior_weight * n.scale;
            normal.matrix[(i, i)] += weight * weight;
            normal.gradient[i] -= weight * (x - n.prior) * n.prior_weight;
        }
        normal
    }

    /// A damped step in scaled parameters from `x`; parameters held by a bound stay.
    pub fn bounded_step(&self, parameters: &[FitParameter], x: &[f64], damping: f64) -> Option<DVector<f64>> {
        let mut held = vec![false; x.len()];
        loop {
            let step = self.damped(&held, damping).cholesky()?.solve(&self.free_gradient(&held));
            let blocked = (0..x.len()).find(|&i| {
                let n = &parameters[i];
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

    /// Predicted reduction of the cost over a step.
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

/// Squared distance of parameters from their priors.
pub(super) fn prior_cost(parameters: &[FitParameter], x: &[f64]) -> f64 {
    parameters.iter().zip(x).map(|(n, x)| ((x - n.prior) * n.prior_weight).powi(2)).sum()
}

/// The part of `v` orthogonal to the columns of an orthonormal `basis`.
pub(in crate::diagnose) fn orthogonal(basis: &DMatrix<f64>, v: &DVector<f64>) -> DVector<f64> {
    v - basis * basis.tr_mul(v)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FREE: FitParameter =
        FitParameter { min: -9.0, max: 9.0, scale: 1.0, step: 1e-3, prior: 0.0, prior_weight: 0.0 };

    fn line(at: &[f64]) -> Rows {
        Rows {
            jacobian: DMatrix::from_fn(at.len(), 2, |i, j| if j == 0 { 1.0 } else { at[i] }),
            residual: DVector::from_fn(at.len(), |i, _| 2.0 - 0.5 * at[i]),
        }
    }

    #[test]
    fn a_step_solves_what_is_linear_and_stops_at_bounds() {
        let normal = Normal::of(&line(&[0.0, 1.0, 2.0, 5.0]), &[FREE, FREE], &[0.0, 0.0]);
        let step = normal.bounded_step(&[FREE, FREE], &[0.0, 0.0], 0.0).expect("definite");
        assert!((step[0] - 2.0).abs() < 1e-9 && (step[1] + 0.5).abs() < 1e-9, "{step}");
        assert!((normal.promised_gain(&step) - normal.cost).abs() < 1e-9);
        let floor = FitParameter { min: 0.0, ..FREE };
        let held = normal.bounded_step(&[FREE, floor], &[0.0, 0.0], 0.0).expect("definite");
        assert!(held[1] == 0.0 && (held[0] - 1.0).abs() < 1e-9, "{held}");
    }
    /// Two parameters that are seen through a square: a wrong Jacobian corrects itself on the way to the answer.
    #[test]
    fn slopes_carried_from_elsewhere_still_lead_to_the_answer() {
        let at = [0.0, 0.5, 1.0, 2.0, 3.0];
        let simulated =
            |x: &[f64]| DVector::from_fn(at.len(), |i, _| x[0] + x[1] * at[i] + 0.1 * (x[1] * at[i]).powi(2));
        let measured = simulated(&[0.7, -1.2]);
        let mut x = vec![0.0, 0.0];
        let mut rows = Rows { residual: &measured - simulated(&x), ..line(&at) };
        for _ in 0..20 {
            let step = Normal::of(&rows, &[FREE, FREE], &x).bounded_step(&[FREE, FREE], &x, 0.0).expect("definite");
            x.iter_mut().zip(step.iter()).for_each(|(x, s)| *x += s);
            rows.move_on(&step, &measured - simulated(&x));
        }
        assert!((x[0] - 0.7).abs() < 1e-6 && (x[1] + 1.2).abs() < 1e-6, "{x:?}");
    }
}
