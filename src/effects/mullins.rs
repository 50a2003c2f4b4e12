//! Softening of the silicone by its first stretch.

use super::smooth::ln_cosh;
use crate::scalar::Scalar;

/// The wall's force times `1 - d tanh((W_max - W)/W_m)`, `W` its energy (J), `W_max` the greatest so far, `W_m` 0.02 J.
///
/// On the first stretch `W = W_max` and nothing changes; below it the wall is softer by up to `d`. Range `0 <= d < 1`.
/// Source: Ogden and Roxburgh 1999, with tanh in place of erf.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mullins<D> {
    pub softening_ratio: D,
    pub energy_scale_j: D,
}

impl<D: Scalar> Mullins<D> {
    /// The factor on the wall's force, and its derivative to `W`, 1/J.
    pub fn factor(&self, energy_j: D, greatest_j: D) -> (D, D) {
        let below = greatest_j - energy_j;
        let share = (below / self.energy_scale_j).tanh();
        let slope = (-(share * share) + 1.0) * self.softening_ratio / self.energy_scale_j;
        let [zero, one] = [0.0, 1.0].map(D::constant);
        (below.select_above(zero, -(self.softening_ratio * share) + 1.0, one), below.select_above(zero, slope, zero))
    }

    /// Of the energy that the wall took up to its greatest stretch, what it has not given back on the way to `W`, J:
    /// `d W_m ln cosh((W_max - W)/W_m)`.
    pub(crate) fn withheld_j(&self, energy_j: D, greatest_j: D) -> D {
        let below = greatest_j - energy_j;
        let zero = D::constant(0.0);
        let below = below.select_above(zero, below, zero);
        self.softening_ratio * self.energy_scale_j * ln_cosh(below / self.energy_scale_j)
    }

    /// What the wall will not give back on the whole way to rest, J: lost when it was stretched.
    pub fn lost_j(&self, greatest_j: D) -> D {
        self.withheld_j(D::constant(0.0), greatest_j)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn softens_below_the_greatest_energy_only() {
        let law = Mullins { softening_ratio: 0.2f64, energy_scale_j: 0.02 };
        assert_eq!(law.factor(0.05, 0.05), (1.0, 0.0));
        assert_eq!(law.factor(0.06, 0.05), (1.0, 0.0));
        let (deep, slope) = law.factor(0.0, 0.2);
        assert!((deep - 0.8).abs() < 1e-6 && slope > 0.0);
        let difference = (law.factor(0.03 + 1e-7, 0.05).0 - law.factor(0.03 - 1e-7, 0.05).0) / 2e-7;
        assert!((difference / law.factor(0.03, 0.05).1 - 1.0).abs() < 1e-6);
        // What is withheld over dW is the part of the force that is missing.
        let slope = (law.withheld_j(0.03 + 1e-7, 0.05) - law.withheld_j(0.03 - 1e-7, 0.05)) / 2e-7;
        assert!((slope - (law.factor(0.03, 0.05).0 - 1.0)).abs() < 1e-6);
        assert_eq!(law.withheld_j(0.05, 0.05), 0.0);
    }
}
