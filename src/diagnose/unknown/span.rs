//! Joint least squares of signatures.

use nalgebra::{DMatrix, DVector};

/// Directions with less than this share of the largest eigenvalue are dropped.
const FAINT: f64 = 1e-6;

/// The part of the residual that all signatures together explain.
pub fn explained(signatures: &[DVector<f64>], left: &DVector<f64>) -> DVector<f64> {
    let sizes = sizes(signatures, left);
    signatures.iter().zip(sizes).fold(DVector::zeros(left.len()), |sum, (s, size)| sum + s * size)
}

/// Amplitudes of the signatures that together fit the residual best.
pub fn sizes(signatures: &[DVector<f64>], left: &DVector<f64>) -> Vec<f64> {
    let signatures: Vec<&DVector<f64>> = signatures.iter().collect();
    let mut sizes = vec![0.0; signatures.len()];
    for d in directions(&signatures, left) {
        sizes.iter_mut().zip(&d.sizes).for_each(|(size, own)| *size += d.along / d.length * own);
    }
    sizes
}

/// One of several orthogonal directions spanned by signatures.
struct Direction {
    /// Projection of the residual, and the squared length of the direction.
    along: f64,
    length: f64,
    /// Amplitudes of the signatures in it.
    sizes: Vec<f64>,
}

/// The directions spanned by signatures, without degenerate ones.
fn directions(signatures: &[&DVector<f64>], left: &DVector<f64>) -> Vec<Direction> {
    let n = signatures.len();
    if n == 0 {
        return Vec::new();
    }
    let lengths: Vec<f64> = signatures.iter().map(|s| s.norm().max(f64::MIN_POSITIVE)).collect();
    let gram = DMatrix::from_fn(n, n, |i, j| signatures[i].dot(signatures[j]) / (lengths[i] * lengths[j]));
    let onto = DVector::from_fn(n, |i, _| signatures[i].dot(left) / lengths[i]);
    let eigen = gram.symmetric_eigen();
    let floor = FAINT * eigen.eigenvalues.max();
    let loud = (0..n).filter(|&k| eigen.eigenvalues[k] > floor);
    loud.map(|k| {
        let vector = eigen.eigenvectors.column(k);
        let sizes = vector.iter().zip(&lengths).map(|(v, length)| v / length).collect();
        Direction { along: vector.dot(&onto), length: eigen.eigenvalues[k], sizes }
    })
    .collect()
}
