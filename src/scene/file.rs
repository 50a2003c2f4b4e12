//! The scene file as it stands on disk.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::file_channels::{CalibrateSpec, ConditionSpec, ExpectSpec, InputSpec, OutputSpec, ViewSpec};
use super::file_muscles::{HydraulicsSpec, MuscleSpec, MusclesSpec};
use super::file_standalone::{AxisSpec, ChamberSpec, StripSpec};
use crate::effects::EffectTable;
use crate::laws::LawTable;
use crate::mechanism::{MechanismSpec, RouteSpec};

/// A whole scene file. Lengths in m, forces in N, pressures in Pa (gauge), angles in rad, times in s.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Version of this format: 1.
    pub format: u32,
    pub name: String,
    /// One line for `smam scenes`.
    pub title: String,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    pub simulation: SimulationSpec,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hydraulics: Option<HydraulicsSpec>,
    /// The make that all muscles of the scene share.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub muscles: Option<MusclesSpec>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mechanism: Option<MechanismSpec>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub muscle: Vec<MuscleSpec>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cable: Vec<CableSpec>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub load: Vec<LoadSpec>,
    /// Physics beyond the stock rig, from the catalogue (`smam effects`).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effect: Vec<EffectTable>,
    /// Physics of your own: expressions that act at ports of the chain (`smam laws`).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub law: Vec<LawTable>,
    /// An axis moved at a recorded position that answers with a force; stands alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<AxisSpec>,
    /// A strip of rubber pulled by a testing machine; stands alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub strip: Option<StripSpec>,
    /// Gas in a closed volume; stands alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chamber: Option<ChamberSpec>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub input: Vec<InputSpec>,
    pub output: Vec<OutputSpec>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub condition: Vec<ConditionSpec>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calibrate: Vec<CalibrateSpec>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub expect: Vec<ExpectSpec>,
    #[serde(default)]
    pub view: ViewSpec,
}

/// Duration and steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SimulationSpec {
    /// Length of the stock programme, s.
    pub duration_s: f64,
    /// Step of the rigid-body engine, s; shortened to fit the output instants.
    pub step_s: f64,
    /// Fine steps of hydraulics, muscles and cables within one engine step.
    pub substeps: usize,
    /// Interval of the recording, s.
    pub output_interval_s: f64,
    /// Recordings are pieces of longer runs: inputs are led from zero to where a recording begins, and its first moments, which
    /// depend on what was before them, are not compared.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub recorded_in_motion: bool,
}

/// A cable: pulls when stretched, never pushes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CableSpec {
    pub name: String,
    pub stiffness_n_m: f64,
    #[serde(default)]
    pub damping_n_s_m: f64,
    /// Tension at the start, N.
    #[serde(default)]
    pub pretension_n: f64,
    /// Angle by which the cable is wrapped in a sheath, rad; matters only to friction along it.
    #[serde(default)]
    pub sheath_angle_rad: f64,
    pub route: RouteSpec,
    /// A recorded motion that pulls at the near end instead of a muscle.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drive: Option<CableDriveSpec>,
}

/// Motion of a cable's near end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CableDriveSpec {
    pub input: String,
    /// Pull per unit of the input, m per rad or m per m.
    pub lever_m: f64,
}

/// A constant load on a joint: a force on a slider, a torque on a hinge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadSpec {
    pub joint: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_n: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub torque_n_m: Option<f64>,
}
