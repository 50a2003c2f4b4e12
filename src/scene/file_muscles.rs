//! Hydraulics and muscles in a scene file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::hydraulics::{Fluid, Line, Syringe};
use crate::hysteresis::HysteresisModel;
use crate::muscle::Material;

/// Syringe, line and compliances, the same for every muscle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HydraulicsSpec {
    pub syringe: Syringe,
    pub line: Line,
    /// Barrel, stopper and line wall, before the line's resistance, m³/Pa.
    pub upstream_compliance_m3_pa: f64,
    /// After the line's resistance, m³/Pa.
    pub downstream_compliance_m3_pa: f64,
    #[serde(default)]
    pub fluid: Fluid,
}

/// What every muscle of the scene is made like. Exactly one of `tube`, `linear` and `displacement`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MusclesSpec {
    pub rest_length_m: f64,
    /// Elongation over rest length at the start.
    #[serde(default)]
    pub pre_elongation_ratio: f64,
    /// Outside pull that the starting pressure already carries, N (a mass hung on a pressurised muscle).
    #[serde(default)]
    pub initial_load_n: f64,
    /// Axial damping, N s/m.
    #[serde(default)]
    pub damping_n_s_m: f64,
    /// Moving mass at the end of a muscle that pulls a cable, kg. A muscle on a joint moves the joint's own mass.
    #[serde(default)]
    pub end_mass_kg: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tube: Option<TubeSpec>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub linear: Option<LinearSpec>,
    /// A displacement-form hysteresis instead of hydraulics and muscle: elongation = output of the model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub displacement: Option<HysteresisModel<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionSpec>,
}

/// A silicone microtube in a micro-coil.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TubeSpec {
    pub inner_diameter_m: f64,
    /// Outer diameter of the tube = bore of the coil.
    pub outer_diameter_m: f64,
    pub material: Material<f64>,
    /// Whether the wall stays on the coil (`held`) or may come off it (`unilateral`).
    #[serde(default)]
    pub wall: WallSpec,
    /// `b` of `dV/de = A_c (1 + 2 b e)`, 1/m: a bore that takes more fluid the longer it is. 0: the coil holds it.
    #[serde(default)]
    pub area_growth_1_m: f64,
    pub coil: CoilSpec,
    /// The coil closed on its turns: no elongation below zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closed_stop: Option<ClosedStopSpec>,
}

/// Whether the wall may leave its coil.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WallSpec {
    #[default]
    Held,
    Unilateral,
}

/// The micro-coil.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoilSpec {
    pub stiffness_n_m: f64,
    #[serde(default)]
    pub preload_n: f64,
    /// For drawing only.
    #[serde(default = "default_turns")]
    pub turns: f64,
    #[serde(default = "default_coil_diameter")]
    pub outer_diameter_m: f64,
}

/// One-sided spring and damper of a closed coil.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClosedStopSpec {
    pub stiffness_n_m: f64,
    pub damping_n_s_m: f64,
}

/// A muscle known by its stiffness and by what pressure adds to its pull: `F = k e + b p`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearSpec {
    pub stiffness_n_m: f64,
    /// Pull added per Pa, m²; > 0 for a muscle that contracts when pressurised.
    pub pressure_gain_m2: f64,
}

/// Friction in force form, `(m0 + m1 max(p, 0)) z`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FrictionSpec {
    pub m0_n: f64,
    pub m1_n_pa: f64,
    pub presliding_length_m: f64,
    #[serde(default = "one")]
    pub a: f64,
    #[serde(default = "one")]
    pub nu: f64,
    #[serde(default = "one")]
    pub n: f64,
    #[serde(default)]
    pub rho: f64,
}

/// One muscle of the scene. Exactly one of `joint` and `cable` says what it pulls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MuscleSpec {
    pub name: String,
    /// Channel of its plunger (`_mm`) or of its measured pressure (`_kpa`).
    pub input: String,
    /// Prismatic joint that is its free end; elongation grows with the joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub joint: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cable: Option<String>,
    /// Where to draw its fixed end; else it lies behind the first point of its cable, or beside the others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub anchor_m: Option<[f64; 3]>,
    /// The direction in which it extends.
    #[serde(default = "x_axis")]
    pub direction: [f64; 3],
    /// What is other about this muscle than `[muscles]` says: any of its keys, `{ tube.material.c1_pa = 3.1e5 }`.
    #[serde(default, skip_serializing_if = "toml::Table::is_empty")]
    #[schemars(with = "serde_json::Map<String, serde_json::Value>")]
    pub differs: toml::Table,
}

fn one() -> f64 {
    1.0
}
fn default_turns() -> f64 {
    250.0
}
fn default_coil_diameter() -> f64 {
    1.45e-3
}
fn x_axis() -> [f64; 3] {
    [1.0, 0.0, 0.0]
}
