//! Elements that stand alone in a scene file: they answer a recorded input, or time alone, without muscles or a mechanism.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::muscle::Material;

/// `F = F0 + A p + c dx/dt + m d²x/dt²`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AxisSpec {
    pub position_input: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pressure_input: Option<String>,
    #[serde(default)]
    pub piston_area_m2: f64,
    #[serde(default)]
    pub mass_kg: f64,
    #[serde(default)]
    pub damping_n_s_m: f64,
    #[serde(default)]
    pub offset_n: f64,
    /// Width of the window over which speed and acceleration are taken from the position, s. Left out, a recording's own noise and
    /// sampling decide; without a recording it is two steps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derivative_window_s: Option<f64>,
}

/// A strip of rubber clamped at both ends and pulled: `F = A0 P(1 + x/L0)`, `P` the nominal stress of its law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StripSpec {
    /// The crosshead, counted from the slack length.
    pub position_input: String,
    /// Free length between the clamps, m.
    pub length_m: f64,
    /// Cross-section of the strip unstretched, m².
    pub section_m2: f64,
    pub material: Material<f64>,
}

/// Gas in a closed rigid volume at constant temperature.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChamberSpec {
    /// Pressure at the start, on the scale of `reads`, Pa. A recording's own first second replaces it.
    pub start_pressure_pa: f64,
    /// Whether pressures of this scene count from the surroundings or from a vacuum.
    #[serde(default)]
    pub reads: PressureScale,
    /// Absolute pressure of the surroundings, Pa.
    #[serde(default = "atmospheric_pa")]
    pub ambient_pressure_pa: f64,
    /// Which of several chambers it is, counted from 1: an effect on `line_2` is the second's alone. A diagnosis numbers them by run.
    #[serde(default = "first", skip_serializing_if = "is_first")]
    pub number: usize,
}

/// Where a pressure counts from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PressureScale {
    /// From the surroundings.
    #[default]
    Gauge,
    /// From a vacuum.
    Absolute,
}

impl ChamberSpec {
    /// Absolute pressure of the zero of `reads`, Pa.
    pub(crate) fn zero_pa(&self) -> f64 {
        match self.reads {
            PressureScale::Gauge => self.ambient_pressure_pa,
            PressureScale::Absolute => 0.0,
        }
    }
}

fn first() -> usize {
    1
}

fn is_first(number: &usize) -> bool {
    *number == 1
}

fn atmospheric_pa() -> f64 {
    101_325.0
}
