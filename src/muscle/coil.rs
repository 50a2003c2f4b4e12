//! The coil: a spring around the tube, and its closed stop.

use super::error::{MuscleError, not_negative};
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// Stretch at which the muscle yields: plastic deformation at 175 mm of 50 mm (Thai et al. 2021).
pub const YIELD_STRETCH: f64 = 3.5;
/// Stretch up to which the muscle is safe in use (Thai et al. 2021).
pub const SAFE_STRETCH: f64 = 2.45;

/// A linear spring with preload: `U = F0 e + k e^2/2`, `F = F0 + k e`. Stock: 28.3 N/m, 0 N.
///
/// `e` elongation, m; `k` N/m; `F0` N. Range: up to the wire's yield, [`YIELD_STRETCH`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coil<D> {
    pub stiffness_n_m: D,
    pub preload_n: D,
}

/// Rate of a close-coiled helical spring, N/m: `k = G d^4/(8 D^3 N)`.
///
/// `G` shear modulus of the wire, Pa; `d` wire diameter, m; `D` mean coil diameter, m; `N` active turns.
/// Range: spring index `D/d` above about 4. Source: Wahl, Mechanical Springs.
///
/// ```
/// use smam::muscle::spring_rate;
///
/// // The stock coil: 250 turns of 0.2 mm steel wire, 1.25 mm wide.
/// let stiffness_n_m = spring_rate(69.1e9_f64, 0.2e-3, 1.25e-3, 250.0);
/// assert!((stiffness_n_m - 28.3).abs() < 0.05);
/// ```
pub fn spring_rate<D: Scalar>(shear_modulus_pa: D, wire_diameter_m: D, mean_diameter_m: D, turns: D) -> D {
    shear_modulus_pa * wire_diameter_m.powi(4) / (mean_diameter_m.powi(3) * turns * 8.0)
}

impl<D: Scalar> Coil<D> {
    /// Refuses negative or infinite numbers.
    pub fn check(&self) -> Result<(), MuscleError> {
        not_negative("stiffness_n_m", self.stiffness_n_m.value())?;
        not_negative("preload_n", self.preload_n.value())
    }

    pub fn energy_j(&self, elongation_m: D) -> D {
        elongation_m * (self.preload_n + self.stiffness_n_m * elongation_m * 0.5)
    }

    pub fn pull_n(&self, elongation_m: D) -> D {
        self.preload_n + self.stiffness_n_m * elongation_m
    }
}

/// The closed coil: `F_push = max(0, -k e - c de/dt)` for `e < 0`, else 0. Stock: 2e4 N/m, 3 N s/m.
///
/// It pushes the ends apart and never holds them together; its force is *subtracted* from the muscle's pull.
///
/// ```
/// use smam::muscle::Stop;
///
/// let closed = Stop { stiffness_n_m: 2e4_f64, damping_n_s_m: 3.0 };
/// assert!((closed.push(-1e-4, -0.1).push_n - 2.3).abs() < 1e-12);
/// // However fast the ends part, it does not hold them.
/// assert_eq!(closed.push(-1e-4, 1.0).push_n, 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stop<D> {
    pub stiffness_n_m: D,
    pub damping_n_s_m: D,
}

/// The stop's push and its slopes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopPush<D> {
    /// Push, N, >= 0.
    pub push_n: D,
    /// `d push / d e`, N/m.
    pub dpush_de: D,
    /// `d push / d (de/dt)`, N s/m.
    pub dpush_dv: D,
}

impl<D: Scalar> Stop<D> {
    /// Refuses negative or infinite numbers.
    pub fn check(&self) -> Result<(), MuscleError> {
        not_negative("stiffness_n_m", self.stiffness_n_m.value())?;
        not_negative("damping_n_s_m", self.damping_n_s_m.value())
    }

    /// The push at elongation `e` (m) and its rate (m/s).
    pub fn push(&self, elongation_m: D, velocity_m_s: D) -> StopPush<D> {
        let push = -(self.stiffness_n_m * elongation_m + self.damping_n_s_m * velocity_m_s);
        if elongation_m.is_below(0.0) && push.is_above(0.0) {
            return StopPush { push_n: push, dpush_de: -self.stiffness_n_m, dpush_dv: -self.damping_n_s_m };
        }
        let zero = D::constant(0.0);
        StopPush { push_n: zero, dpush_de: zero, dpush_dv: zero }
    }

    /// Energy stored in the compressed stop, J.
    pub fn energy_j(&self, elongation_m: D) -> D {
        if elongation_m.is_below(0.0) {
            self.stiffness_n_m * elongation_m * elongation_m * 0.5
        } else {
            D::constant(0.0)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::wall_tests::near;
    use super::*;
    use num_dual::{Dual64, first_derivative};

    #[test]
    fn coil_and_stop() {
        near(spring_rate(69.1e9, 0.2e-3, 1.25e-3, 250.0), 28.3, 2e-3);
        let (_, pull) = first_derivative(
            |e| Coil { stiffness_n_m: Dual64::from(28.3), preload_n: Dual64::from(0.1) }.energy_j(e),
            0.02,
        );
        near(pull, 28.3 * 0.02 + 0.1, 1e-14);
        let stop = Stop { stiffness_n_m: 2e4, damping_n_s_m: 3.0 };
        near(stop.push(-1e-4, -0.1).push_n, 2.3, 1e-12);
        assert_eq!(stop.push(-1e-4, 1.0).push_n, 0.0, "it never holds the ends together");
        assert_eq!(stop.push(1e-4, -1.0).push_n, 0.0);
    }
}
