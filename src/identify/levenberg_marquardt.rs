//! Bounded least squares.
//!
//! The crates looked at (`levenberg-marquardt`, `argmin`) have no bounds on the parameters; with them comes most of
//! the rest of the method, so it stands here on nalgebra's Cholesky.

use nalgebra::{DMatrix, DVector};

use crate::parallel;

/// Dampings tried for one step, each four times the last.
const TRIES: usize = 16;

/// Range of one parameter, in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    pub min: f64,
    pub max: f64,
}

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LmOptions {
    pub max_iterations: usize,
    /// Stop when the cost falls by less than this share.
    pub relative_decrease: f64,
    /// Step of the forward differences, as a share of the range.
    pub difference: f64,
}

impl Default for LmOptions {
    fn default() -> Self {
        Self { max_iterations: 30, relative_decrease: 1e-5, difference: 1e-5 }
    }
}

/// Where the search ended.
#[derive(Clone, Debug, PartialEq)]
pub struct LmResult {
    pub parameters: Vec<f64>,
    /// Sum of squares there.
    pub cost: f64,
    pub evaluations: usize,
}

/// Residuals at a point, `None` where the model cannot be evaluated.
pub type Residuals<'a> = dyn Fn(&[f64]) -> Option<DVector<f64>> + Sync + 'a;
/// Jacobian of the residuals at a point.
pub type Jacobian<'a> = dyn Fn(&[f64]) -> Option<DMatrix<f64>> + Sync + 'a;

/// Minimises `sum r_i(x)²` within bounds (Levenberg-Marquardt with projection, forward differences).
///
/// `residuals` returns `None` where the model cannot be evaluated; such points are stepped back from. Returns `None`
/// when the start itself cannot be evaluated.
///
/// ```
/// use nalgebra::DVector;
/// use smam::identify::{Bounds, LmOptions, minimise};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // The spring, N/m, and preload, N, behind three pulls.
/// let (elongation_m, pull_n) = ([0.0_f64, 0.01, 0.02], [0.1, 0.383, 0.666]);
/// let residuals = |p: &[f64]| {
///     Some(DVector::from_iterator(3, elongation_m.iter().zip(&pull_n).map(|(e, f)| p[0] * e + p[1] - f)))
/// };
/// let bounds = [Bounds { min: 0.0, max: 100.0 }, Bounds { min: 0.0, max: 1.0 }];
/// let found = minimise(&residuals, &[50.0, 0.5], &bounds, LmOptions::default()).ok_or("it can be evaluated")?;
/// assert!((found.parameters[0] - 28.3).abs() < 0.01 && (found.parameters[1] - 0.1).abs() < 1e-4);
/// # Ok(())
/// # }
/// ```
pub fn minimise(residuals: &Residuals<'_>, start: &[f64], bounds: &[Bounds], options: LmOptions) -> Option<LmResult> {
    descend(Search { residuals, jacobian: None, bounds, evaluations: 0 }, start, options)
}

/// As [`minimise`], with an exact Jacobian: `jacobian` returns the Jacobian of the residuals at a point, in the parameters' own
/// units. Each of its columns counts as one evaluation.
pub fn minimise_with_jacobian(
    residuals: &Residuals<'_>,
    jacobian: &Jacobian<'_>,
    start: &[f64],
    bounds: &[Bounds],
    options: LmOptions,
) -> Option<LmResult> {
    descend(Search { residuals, jacobian: Some(jacobian), bounds, evaluations: 0 }, start, options)
}

fn descend(mut search: Search<'_>, start: &[f64], options: LmOptions) -> Option<LmResult> {
    let mut u = search.to_unit(start);
    let mut r = search.evaluate(&u)?;
    // Nearly Gauss-Newton at first: more would creep along a valley in which two parameters trade off.
    let mut damping = 1e-6;
    for _ in 0..options.max_iterations {
        let jacobian = search.jacobian(&u, &r, options.difference);
        let Some((next_u, next_r, next_damping)) = search.step(&u, &r, &jacobian, damping, options.relative_decrease)
        else {
            break;
        };
        let decrease = 1.0 - next_r.norm_squared() / r.norm_squared();
        (u, r, damping) = (next_u, next_r, next_damping);
        if decrease < options.relative_decrease {
            break;
        }
    }
    Some(LmResult { parameters: search.scaled_back(&u), cost: r.norm_squared(), evaluations: search.evaluations })
}

/// Parameters are searched as shares of their ranges, so that their units do not matter.
struct Search<'a> {
    residuals: &'a Residuals<'a>,
    jacobian: Option<&'a Jacobian<'a>>,
    bounds: &'a [Bounds],
    evaluations: usize,
}

impl Search<'_> {
    fn to_unit(&self, x: &[f64]) -> DVector<f64> {
        let shares = x.iter().zip(self.bounds).map(|(x, b)| ((x - b.min) / (b.max - b.min)).clamp(0.0, 1.0));
        DVector::from_iterator(x.len(), shares)
    }

    fn scaled_back(&self, u: &DVector<f64>) -> Vec<f64> {
        u.iter().zip(self.bounds).map(|(u, b)| b.min + u * (b.max - b.min)).collect()
    }

    fn evaluate(&mut self, u: &DVector<f64>) -> Option<DVector<f64>> {
        self.evaluations += 1;
        self.at(u)
    }

    fn at(&self, u: &DVector<f64>) -> Option<DVector<f64>> {
        (self.residuals)(&self.scaled_back(u)).filter(|r| r.iter().all(|x| x.is_finite()))
    }

    fn jacobian(&mut self, u: &DVector<f64>, r: &DVector<f64>, difference: f64) -> DMatrix<f64> {
        self.evaluations += u.len();
        if let Some(jacobian) = self.jacobian {
            let mut jacobian = jacobian(&self.scaled_back(u)).unwrap_or_else(|| DMatrix::zeros(r.len(), u.len()));
            for (mut column, b) in jacobian.column_iter_mut().zip(self.bounds) {
                column *= b.max - b.min;
            }
            return jacobian;
        }
        let column = |j: usize| {
            // Away from the nearer bound.
            let h = if u[j] < 0.5 { difference } else { -difference };
            let mut moved = u.clone();
            moved[j] += h;
            self.at(&moved).map_or_else(|| DVector::zeros(r.len()), |there| (there - r) / h)
        };
        let columns: Vec<DVector<f64>> = parallel::map_indices(u.len(), column);
        DMatrix::from_columns(&columns)
    }

    /// A step that lowers the cost, or `None` when damping finds none or the linear model promises too little.
    ///
    /// Parameters on a bound that the descent would leave stay there. A step that the box cuts and that then promises
    /// nothing is no sign of the end: a more damped one turns towards the gradient.
    fn step(
        &mut self,
        u: &DVector<f64>,
        r: &DVector<f64>,
        jacobian: &DMatrix<f64>,
        mut damping: f64,
        worth_while: f64,
    ) -> Option<(DVector<f64>, DVector<f64>, f64)> {
        let (normal, gradient) = self.free_of_bounds(u, jacobian.tr_mul(jacobian), jacobian.tr_mul(r));
        let scale = normal.diagonal().max().max(f64::MIN_POSITIVE);
        for _ in 0..TRIES {
            let mut damped = normal.clone();
            for j in 0..u.len() {
                damped[(j, j)] += damping * (normal[(j, j)] + 1e-9 * scale);
            }
            if let Some(cholesky) = damped.cholesky() {
                let whole = u - cholesky.solve(&gradient);
                let next = whole.map(|x| x.clamp(0.0, 1.0));
                let promised = 1.0 - (r + jacobian * (&next - u)).norm_squared() / r.norm_squared();
                if promised < worth_while && whole == next {
                    return None;
                }
                if promised > 0.0
                    && let Some(there) = self.evaluate(&next).filter(|t| t.norm_squared() < r.norm_squared())
                {
                    return Some((next, there, (damping / 10.0).max(1e-12)));
                }
            }
            damping = (damping * 4.0).max(1e-9);
        }
        None
    }

    /// The normal equations with the parameters held that stand on a bound and would go beyond it.
    fn free_of_bounds(
        &self,
        u: &DVector<f64>,
        mut normal: DMatrix<f64>,
        mut gradient: DVector<f64>,
    ) -> (DMatrix<f64>, DVector<f64>) {
        for j in 0..u.len() {
            if (u[j] <= 0.0 && gradient[j] > 0.0) || (u[j] >= 1.0 && gradient[j] < 0.0) {
                let own = normal[(j, j)];
                normal.row_mut(j).fill(0.0);
                normal.column_mut(j).fill(0.0);
                normal[(j, j)] = own;
                gradient[j] = 0.0;
            }
        }
        (normal, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_an_exponential_within_bounds() {
        let data: Vec<f64> = (0..20).map(|i| 3.0 * (-0.4 * f64::from(i)).exp()).collect();
        let residuals = |x: &[f64]| {
            Some(DVector::from_iterator(20, data.iter().enumerate().map(|(i, d)| x[0] * (-x[1] * i as f64).exp() - d)))
        };
        let bounds = [Bounds { min: 0.0, max: 10.0 }, Bounds { min: 0.0, max: 2.0 }];
        let result = minimise(&residuals, &[1.0, 1.0], &bounds, LmOptions::default()).expect("start is valid");
        assert!((result.parameters[0] - 3.0).abs() < 1e-5 && (result.parameters[1] - 0.4).abs() < 1e-5, "{result:?}");
    }

    /// Two parameters that nearly trade off: the undamped step leaves the box, and cut off it leads uphill.
    #[test]
    fn a_step_cut_off_at_a_bound_is_shortened() {
        let residuals = |x: &[f64]| Some(DVector::from_vec(vec![30.0 * (x[0] - x[1]), 0.1 * (x[0] + x[1] - 6.0)]));
        let bounds = [Bounds { min: 0.0, max: 1.0 }, Bounds { min: 0.0, max: 10.0 }];
        let result = minimise(&residuals, &[0.5, 0.5], &bounds, LmOptions::default()).expect("valid");
        assert!((result.parameters[0] - 1.0).abs() < 1e-3 && (result.parameters[1] - 1.0).abs() < 1e-2, "{result:?}");
    }

    #[test]
    fn an_exact_jacobian_ends_at_the_same_place() {
        let at = |x: &[f64], i: usize| x[0] * (-x[1] * i as f64).exp();
        let residuals = |x: &[f64]| Some(DVector::from_fn(20, |i, _| at(x, i) - at(&[3.0, 0.4], i)));
        let slope = |x: &[f64], i: usize, j: usize| if j == 0 { at(x, i) / x[0] } else { -(i as f64) * at(x, i) };
        let jacobian = |x: &[f64]| Some(DMatrix::from_fn(20, 2, |i, j| slope(x, i, j)));
        let bounds = [Bounds { min: 0.0, max: 10.0 }, Bounds { min: 0.0, max: 2.0 }];
        let result = minimise_with_jacobian(&residuals, &jacobian, &[1.0, 1.0], &bounds, LmOptions::default());
        let found = result.expect("start is valid").parameters;
        assert!((found[0] - 3.0).abs() < 1e-7 && (found[1] - 0.4).abs() < 1e-7, "{found:?}");
    }

    #[test]
    fn a_minimum_outside_ends_on_the_bound() {
        let residuals = |x: &[f64]| Some(DVector::from_vec(vec![x[0] - 5.0]));
        let result =
            minimise(&residuals, &[0.5], &[Bounds { min: 0.0, max: 1.0 }], LmOptions::default()).expect("valid");
        assert_eq!(result.parameters, [1.0]);
    }
}
