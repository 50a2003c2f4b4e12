//! A coil wound tight.

use super::smooth::ln_cosh;
use crate::scalar::Scalar;

/// Elongation over which the turns come apart, m.
const OPENING_M: f64 = 0.25e-3;

/// Force that opens a close-wound coil, `F0 tanh(e/0.25 mm)`, N, added to the pull.
///
/// Source: initial tension of extension springs (Wahl), rounded where the turns touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoilPreload<D> {
    pub preload_n: D,
}

impl<D: Scalar> CoilPreload<D> {
    /// Pull, N, and its slope, N/m.
    pub fn pull_and_stiffness(&self, elongation_m: D) -> (D, D) {
        let share = (elongation_m / OPENING_M).tanh();
        (self.preload_n * share, self.preload_n * (-(share * share) + 1.0) / OPENING_M)
    }

    /// Energy held, J: the integral of the pull.
    pub fn energy_j(&self, elongation_m: D) -> D {
        self.preload_n * ln_cosh(elongation_m / OPENING_M) * OPENING_M
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_and_saturating() {
        let law = CoilPreload { preload_n: 0.1 };
        assert_eq!(law.pull_and_stiffness(0.0), (0.0, 0.1 / OPENING_M));
        assert!((law.pull_and_stiffness(5e-3).0 - 0.1).abs() < 1e-12);
        assert_eq!(law.pull_and_stiffness(1e-4).0, -law.pull_and_stiffness(-1e-4).0);
        let slope = (law.energy_j(2e-4 + 1e-8) - law.energy_j(2e-4 - 1e-8)) / 2e-8;
        assert!((slope / law.pull_and_stiffness(2e-4).0 - 1.0).abs() < 1e-6);
    }
}
