//! The working fluid.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Working fluid and the air outside it. Defaults: water at 20 °C at sea level.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Fluid {
    /// Mass density, kg/m³.
    pub density_kg_m3: f64,
    /// Dynamic viscosity, Pa s.
    pub viscosity_pa_s: f64,
    /// Absolute pressure below which the fluid boils, Pa.
    pub vapour_pressure_pa: f64,
    /// Tension, below its vapour pressure, that the fluid bears before it boils, Pa, >= 0. Degassed water bears some 1e7 in clean glass
    /// (Briggs 1950, J. Appl. Phys. 21, 721), in a syringe as good as none.
    pub tensile_strength_pa: f64,
    /// Absolute pressure of the surroundings, Pa; gauge pressures count from here.
    pub atmospheric_pressure_pa: f64,
}

impl Default for Fluid {
    fn default() -> Self {
        Self {
            density_kg_m3: 998.0,
            viscosity_pa_s: 1.002e-3,
            vapour_pressure_pa: 2.3e3,
            tensile_strength_pa: 0.0,
            atmospheric_pressure_pa: 101_325.0,
        }
    }
}

impl Fluid {
    /// Lowest gauge pressure the liquid can have, Pa: `p_vapour - tensile strength - p_atm` (negative).
    ///
    /// ```
    /// use smam::hydraulics::Fluid;
    ///
    /// // Water boils at 99 kPa below the surroundings.
    /// assert_eq!(Fluid::default().cavitation_gauge_pressure_pa(), -99_025.0);
    /// ```
    pub fn cavitation_gauge_pressure_pa(&self) -> f64 {
        self.vapour_pressure_pa - self.tensile_strength_pa - self.atmospheric_pressure_pa
    }
}
