//! Terms that stand for physics nobody has named yet: found by regression, labelled as such.

use crate::scalar::Scalar;

/// Elongation and pressure in which the terms count, m and Pa: what a stock muscle reaches.
const ELONGATION_M: f64 = 0.01;
const PRESSURE_PA: f64 = 1.0e6;

/// A pull that depends on elongation and pressure, `F_h (e/10 mm)^i (p/1 MPa)^j`, N; `i`, `j` whole, 0 to 4.
///
/// No law of nature: a monomial that regression chose. Source: sparse identification of dynamics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HypotheticalForce<D> {
    pub force_n: D,
    pub elongation_power: i32,
    pub pressure_power: i32,
}

impl<D: Scalar> HypotheticalForce<D> {
    /// Pull, N, and its slope to elongation, N/m.
    pub fn pull_and_stiffness(&self, elongation_m: D, pressure_pa: D) -> (D, D) {
        let e = elongation_m / ELONGATION_M;
        let at_pressure = self.force_n * power(pressure_pa / PRESSURE_PA, self.pressure_power);
        let slope = if self.elongation_power == 0 {
            D::constant(0.0)
        } else {
            power(e, self.elongation_power - 1) * f64::from(self.elongation_power) / ELONGATION_M
        };
        (at_pressure * power(e, self.elongation_power), at_pressure * slope)
    }
}

/// A flow out of the line's end, `Q_h (p/1 MPa)^j`, m³/s; `j` whole, 0 to 4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HypotheticalFlow<D> {
    pub flow_m3_s: D,
    pub pressure_power: i32,
}

impl<D: Scalar> HypotheticalFlow<D> {
    /// Flow, m³/s.
    pub fn flow_m3_s(&self, pressure_pa: D) -> D {
        self.flow_m3_s * power(pressure_pa / PRESSURE_PA, self.pressure_power)
    }
}

/// A small whole power; nothing to the power of nothing is one.
fn power<D: Scalar>(x: D, n: i32) -> D {
    (0..n).fold(D::constant(1.0), |product, _| product * x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_monomial_and_its_slope() {
        let law = HypotheticalForce { force_n: 0.3_f64, elongation_power: 2, pressure_power: 1 };
        let (pull, slope) = law.pull_and_stiffness(0.02, 0.5e6);
        assert!((pull - 0.3 * 4.0 * 0.5).abs() < 1e-12, "{pull}");
        let ahead = law.pull_and_stiffness(0.02 + 1e-7, 0.5e6).0;
        assert!(((ahead - pull) / 1e-7 - slope).abs() < 1e-3, "{slope}");
        let constant = HypotheticalForce { elongation_power: 0, pressure_power: 0, ..law };
        assert_eq!(constant.pull_and_stiffness(0.02, 0.5e6), (0.3, 0.0));
    }

    #[test]
    fn a_flow_grows_with_its_power() {
        let law = HypotheticalFlow { flow_m3_s: 1e-12_f64, pressure_power: 2 };
        assert!((law.flow_m3_s(2.0e6) - 4e-12).abs() < 1e-24);
    }
}
