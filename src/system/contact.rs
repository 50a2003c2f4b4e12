//! What the plant must foresee of the engine's contacts.

use nalgebra::{DMatrix, DVector};

use super::coordinates::ContactSpring;

/// Stiffness of the foreseen contact over `M_eff/h²`. Stiffer would move less under a change of the force, but must
/// stay below what a fine step can meet unforeseen (a jaw that bounces and comes back within one engine step).
const STIFFNESS_RATIO: f64 = 2.0;

/// The spring that stands for a contact reaction `force` over the next step; `None` for no reaction.
///
/// The reaction of frictionless contact points along the gradient of the gap, so its direction in the coordinates is
/// known from the force itself. `positions` is where it was touched, `fine_s` the fine step.
pub(super) fn foreseen(
    force: &[f64],
    positions: &[f64],
    inertia: &DMatrix<f64>,
    dim: usize,
    fine_s: f64,
) -> Option<ContactSpring> {
    let n = DVector::from_column_slice(force);
    let size = n.norm();
    if !(size > f64::MIN_POSITIVE && size.is_finite()) {
        return None;
    }
    let n = n / size;
    let mobility = n.dot(&inertia.clone().cholesky()?.solve(&n));
    let mass = 1.0 / mobility;
    let stiffness = STIFFNESS_RATIO * mass / (fine_s * fine_s);
    let mut direction = vec![0.0; dim];
    direction[..n.len()].copy_from_slice(n.as_slice());
    let offset = n.iter().zip(positions).map(|(n, q)| n * q).sum();
    Some(ContactSpring { direction, preload: size, offset, stiffness, damping: (stiffness * mass).sqrt() })
}
