//! The scene file as it stands on disk.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::effects::EffectTable;
use crate::hydraulics::{Fluid, Line, Syringe};
use crate::hysteresis::HysteresisModel;
use crate::mechanism::{MechanismSpec, RouteSpec};
use crate::muscle::Material;

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
    /// An axis moved at a recorded position that answers with a force; stands alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub axis: Option<AxisSpec>,
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
}

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
    /// Where to draw its fixed end, and the direction in which it extends.
    #[serde(default)]
    pub anchor_m: [f64; 3],
    #[serde(default = "x_axis")]
    pub direction: [f64; 3],
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
    /// Width of the window over which speed and acceleration are taken from the recorded position, s.
    pub derivative_window_s: f64,
}

/// An input channel, and what it does when no recording drives it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InputSpec {
    /// Column name with its unit.
    pub channel: String,
    /// The stock programme; its keys carry the SI unit of the channel.
    #[schemars(schema_with = "super::schema::program")]
    pub program: toml::Table,
}

/// An output channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OutputSpec {
    /// Column name with its unit.
    pub channel: String,
    pub quantity: Quantity,
    /// The muscle, cable, joint or body whose quantity it is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub of: Vec<String>,
    /// A recording's zero is its first sample: a comparison shifts the simulation to begin where the recording does.
    #[serde(default)]
    pub counts_from_start: bool,
}

/// What an output channel shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Elongation of a muscle.
    Elongation,
    /// Pressure at a muscle's syringe.
    SyringePressure,
    /// Pressure in a muscle.
    MusclePressure,
    /// Pull of a muscle at its free end.
    Pull,
    /// Tension of a cable.
    Tension,
    /// Sum of the positions of joints.
    JointPosition,
    /// Position of a free body along x, y or z; with a second name in `of`, in that link's frame.
    BodyX,
    BodyY,
    BodyZ,
    /// Force of the axis.
    AxisForce,
}

/// A known condition of a run: a key of `[[run]]` in recordings.toml and the scene keys it sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConditionSpec {
    pub name: String,
    pub keys: Vec<String>,
}

/// A parameter that a lab cannot know.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CalibrateSpec {
    /// A calibration name (`tube_c1_pa`) or a scene key.
    pub key: String,
    pub min: f64,
    pub max: f64,
    /// There is no stock value: the number belongs to the rig recorded, so a comparison fits it first.
    #[serde(default)]
    pub belongs_to_rig: bool,
}

/// A check on a channel of the stock run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExpectSpec {
    pub name: String,
    pub channel: String,
    pub measure: Measure,
    /// Only this part of the run, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub from_s: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub to_s: Option<f64>,
    /// For `value_at`: the time; s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at_s: Option<f64>,
    /// For the loop measures and the fit: the horizontal channel.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub against: Option<String>,
    /// For the loop measures: where on the horizontal channel, in its unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub at: Option<f64>,
    /// For `rmse`: the recording to compare with, relative to the scene file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<std::path::PathBuf>,
    /// Least and greatest value that pass, in the channel's unit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Where the bound comes from.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
}

/// What an `[[expect]]` looks at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    Min,
    Max,
    Range,
    Final,
    ValueAt,
    /// Unloading minus loading value of a loop at a point of the horizontal channel.
    LoopWidth,
    /// Coefficient of determination of a straight line through the channel against another.
    RSquared,
    Rmse,
}

/// Where to look.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ViewSpec {
    /// Tension drawn in full colour, N.
    pub tension_scale_n: f64,
    /// Muscle pressure drawn in full colour, Pa.
    pub pressure_scale_pa: f64,
    pub camera_target_m: [f64; 3],
    pub camera_position_m: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tip_link: Option<String>,
    /// Pairs of channels that draw hysteresis loops: horizontal, vertical.
    pub loops: Vec<(String, String)>,
}

impl Default for ViewSpec {
    fn default() -> Self {
        Self {
            tension_scale_n: 1.0,
            pressure_scale_pa: 2.0e6,
            camera_target_m: [0.0; 3],
            camera_position_m: [0.0; 3],
            tip_link: None,
            loops: Vec::new(),
        }
    }
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
