//! Friction of a tendon along its way.

use crate::scalar::Scalar;

/// Capstan friction: behind a wrap of `phi` the tension is `T exp(-mu z phi)`, `z` the Dahl state of the sliding.
///
/// `mu` 1, `phi` rad. `z > 0` while the near end draws the cable in, so that the far end feels less; returning, it
/// feels more. Source: Euler and Eytelwein, with Dahl's presliding.
///
/// ```
/// use smam::effects::TendonFriction;
///
/// let tendon = TendonFriction { friction_coefficient: 0.1_f64, fixed_wrap_rad: 0.0, presliding_m: 1e-4 };
/// let half_turn = std::f64::consts::PI;
/// // 73 % of the tension is left behind half a turn; on the way back it is as much greater.
/// assert!((tendon.transmission(1.0, half_turn) - 0.7304).abs() < 1e-4);
/// assert!((tendon.transmission(1.0, half_turn) * tendon.transmission(-1.0, half_turn) - 1.0).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TendonFriction<D> {
    pub friction_coefficient: D,
    /// Wrap that does not move with the joints, rad: a sheath.
    pub fixed_wrap_rad: f64,
    /// Travel over which the sliding turns, m.
    pub presliding_m: D,
}

impl<D: Scalar> TendonFriction<D> {
    /// Tension behind the wrap over tension before it.
    pub fn transmission(&self, sliding: D, wrap_rad: D) -> D {
        (-(self.friction_coefficient * sliding * (wrap_rad + self.fixed_wrap_rad))).exp()
    }

    /// `dz/dt` at a cable speed `v` (m/s, > 0 drawing in): `|v|/s0 (sgn v - z)`.
    pub fn rate_1_s(&self, sliding: D, speed_m_s: D) -> D {
        (speed_m_s - speed_m_s.abs() * sliding) / self.presliding_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_is_left_after_a_full_turn() {
        let law =
            TendonFriction { friction_coefficient: 0.1f64, fixed_wrap_rad: std::f64::consts::TAU, presliding_m: 1e-4 };
        assert!((law.transmission(1.0, 0.0) - 0.533_488).abs() < 1e-6);
        assert!((law.transmission(1.0, 0.0) * law.transmission(-1.0, 0.0) - 1.0).abs() < 1e-15);
    }
}
