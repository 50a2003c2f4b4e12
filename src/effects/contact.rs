//! Something that the mechanism meets on its way.

use crate::scalar::Scalar;

/// A one-sided spring on an angle `q`: beyond `q0` it answers with `-k (q - q0)`.
///
/// `q0` rad: for `q0 >= 0` it acts above, for `q0 < 0` below; `k` N m/rad. Tissue, a wall, notches that close.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall<D> {
    pub angle_rad: D,
    pub stiffness_n_m_rad: D,
}

impl<D: Scalar> Wall<D> {
    /// Torque, N m; zero before the contact.
    pub fn torque_n_m(&self, angle_rad: D) -> D {
        if self.is_met(angle_rad) { -(self.stiffness_n_m_rad * (angle_rad - self.angle_rad)) } else { D::constant(0.0) }
    }

    /// Energy in the spring, J.
    pub fn energy_j(&self, angle_rad: D) -> D {
        let depth = angle_rad - self.angle_rad;
        if self.is_met(angle_rad) { self.stiffness_n_m_rad * depth * depth / 2.0 } else { D::constant(0.0) }
    }

    /// Whether the spring is touched.
    pub fn is_met(&self, angle_rad: D) -> bool {
        let depth = angle_rad - self.angle_rad;
        if self.angle_rad.is_below(0.0) { depth.is_below(0.0) } else { depth.is_above(0.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pushes_back_on_its_own_side() {
        let (above, below) =
            (Wall { angle_rad: 0.5, stiffness_n_m_rad: 2.0 }, Wall { angle_rad: -0.5, stiffness_n_m_rad: 2.0 });
        assert_eq!((above.torque_n_m(0.4), above.torque_n_m(1.0)), (0.0, -1.0));
        assert_eq!((below.torque_n_m(-0.4), below.torque_n_m(-1.0)), (0.0, 1.0));
        assert_eq!((below.energy_j(-0.4), below.energy_j(-1.0)), (0.0, 0.25));
    }
}
