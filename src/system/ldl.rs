//! `L D L^T` of a small symmetric matrix, in place and over any [`Scalar`].
//!
//! nalgebra's Cholesky takes its matrix by value and so allocates at every factorisation; here that would be the
//! most frequent allocation of the program.

use crate::scalar::Scalar;

/// Factors of a symmetric positive definite matrix.
#[derive(Clone, Debug)]
pub(super) struct Ldl<D> {
    n: usize,
    /// Unit lower triangle, row by row; the diagonal holds `1/D`.
    factors: Vec<D>,
    /// `D`.
    pivots: Vec<D>,
}

impl<D: Scalar> Ldl<D> {
    pub(super) fn new(n: usize) -> Self {
        Self { n, factors: vec![D::constant(0.0); n * n], pivots: vec![D::constant(0.0); n] }
    }

    /// Factorises; reads the lower triangle only. `N`: the size where it is known when compiling, else 0.
    pub(super) fn factorise<const N: usize>(&mut self, matrix: &[D]) {
        let n = if N == 0 { self.n } else { N };
        let (f, pivots, matrix) = (&mut self.factors[..n * n], &mut self.pivots[..n], &matrix[..n * n]);
        for j in 0..n {
            for i in j..n {
                let mut x = matrix[i * n + j];
                for k in 0..j {
                    x -= f[i * n + k] * f[j * n + k] * pivots[k];
                }
                if i == j {
                    pivots[j] = x;
                    f[i * n + j] = x.recip();
                } else {
                    f[i * n + j] = x * f[j * n + j];
                }
            }
        }
    }

    /// Solves in place.
    #[inline]
    pub(super) fn solve<const N: usize>(&self, x: &mut [D]) {
        let n = if N == 0 { self.n } else { N };
        let (x, f) = (&mut x[..n], &self.factors[..n * n]);
        for i in 0..n {
            for k in 0..i {
                let known = x[k];
                x[i] -= f[i * n + k] * known;
            }
        }
        for i in (0..n).rev() {
            x[i] *= f[i * n + i];
            for k in i + 1..n {
                let known = x[k];
                x[i] -= f[k * n + i] * known;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_a_symmetric_system() {
        let a = [4.0, 1.0, 0.5, 1.0, 3.0, -0.2, 0.5, -0.2, 2.0];
        let expected = [1.0, -2.0, 0.5];
        let mut x: Vec<f64> = (0..3).map(|i| (0..3).map(|j| a[i * 3 + j] * expected[j]).sum()).collect();
        let mut ldl = Ldl::new(3);
        ldl.factorise::<0>(&a);
        ldl.solve::<3>(&mut x);
        for (x, e) in x.iter().zip(expected) {
            assert!((x - e).abs() < 1e-14, "{x} against {e}");
        }
    }
}
