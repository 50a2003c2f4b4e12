//! Syringe and line: geometry to lumped coefficients.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Fluid;

/// A syringe: `A_s = pi d_s² / 4`, flow into the line `A_s dx_p/dt`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Syringe {
    /// Inner diameter of the barrel, m.
    pub bore_m: f64,
}

impl Syringe {
    /// Piston area, m².
    ///
    /// ```
    /// use smam::hydraulics::Syringe;
    ///
    /// // 3 mm of a 1 mL syringe displace 47.7 uL.
    /// let syringe = Syringe { bore_m: 4.5e-3 };
    /// assert!((syringe.area_m2() * 3e-3 / 47.7e-9 - 1.0).abs() < 1e-3);
    /// ```
    pub fn area_m2(&self) -> f64 {
        PI * self.bore_m * self.bore_m / 4.0
    }
}

/// A round line in laminar flow, cut into equal segments.
///
/// Per length: resistance `128 mu / (pi d⁴)`, inertance `f rho / A`. The momentum factor `f` is 4/3 for the
/// parabolic profile of slow laminar flow and 1 for the flat profile of a fast wave front. Valid while the flow is
/// laminar (Re < 2300) and slow against `nu / d²` (here 1.6 1/s, so the factor is an approximation above ~1 Hz).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// Length, m.
    pub length_m: f64,
    /// Inner diameter, m.
    pub bore_m: f64,
    /// Number of equal segments, >= 1.
    #[serde(default = "one_segment")]
    pub segments: usize,
    /// Compliance of fluid and wall spread along the line, m³/Pa; must be > 0 for more than one segment.
    #[serde(default)]
    pub compliance_m3_pa: f64,
    /// Momentum factor of the velocity profile, 1..=4/3.
    #[serde(default = "laminar_momentum_factor")]
    pub momentum_factor: f64,
}

fn one_segment() -> usize {
    1
}

fn laminar_momentum_factor() -> f64 {
    4.0 / 3.0
}

impl Line {
    /// Cross-section of the bore, m².
    pub fn area_m2(&self) -> f64 {
        PI * self.bore_m * self.bore_m / 4.0
    }

    /// Laminar (Hagen-Poiseuille) resistance of the whole line, `128 mu l / (pi d⁴)`, Pa s/m³.
    ///
    /// ```
    /// use smam::hydraulics::{Fluid, Line};
    ///
    /// let line =
    ///     Line { length_m: 1.0, bore_m: 0.8e-3, segments: 1, compliance_m3_pa: 0.0, momentum_factor: 4.0 / 3.0 };
    /// let (thin, water) = (Line { bore_m: 0.4e-3, ..line }, Fluid::default());
    /// // Half the bore: sixteen times the resistance, four times the inertance, a quarter of the 0.5 mL.
    /// assert!((thin.resistance_pa_s_m3(&water) / line.resistance_pa_s_m3(&water) - 16.0).abs() < 1e-9);
    /// assert!((thin.inertance_pa_s2_m3(&water) / line.inertance_pa_s2_m3(&water) - 4.0).abs() < 1e-9);
    /// assert!((thin.volume_m3() / 0.1257e-6 - 1.0).abs() < 1e-3);
    /// ```
    pub fn resistance_pa_s_m3(&self, fluid: &Fluid) -> f64 {
        128.0 * fluid.viscosity_pa_s * self.length_m / (PI * self.bore_m.powi(4))
    }

    /// Inertance of the whole line, `f rho l / A`, Pa s²/m³.
    pub fn inertance_pa_s2_m3(&self, fluid: &Fluid) -> f64 {
        self.momentum_factor * fluid.density_kg_m3 * self.length_m / self.area_m2()
    }

    /// Volume of fluid in the line, m³.
    pub fn volume_m3(&self) -> f64 {
        self.area_m2() * self.length_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stock_line_matches_hand_calculation() {
        let line =
            Line { length_m: 1.0, bore_m: 0.8e-3, segments: 1, compliance_m3_pa: 0.0, momentum_factor: 4.0 / 3.0 };
        let fluid = Fluid::default();
        assert!((line.volume_m3() - 0.503e-6).abs() < 1e-9, "0.50 mL");
        assert!((line.resistance_pa_s_m3(&fluid) / 9.967e10 - 1.0).abs() < 1e-3);
        assert!((line.inertance_pa_s2_m3(&fluid) / 2.647e9 - 1.0).abs() < 1e-3);
        assert!((Syringe { bore_m: 4.5e-3 }.area_m2() - 15.904e-6).abs() < 1e-9);
    }
}
