//! What goes in and what is shown, in a scene file: channels, conditions, calibration, expectations, the view.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
    /// Length of the rod that `of` bends, m; for `arc_tip_x` and `arc_tip_z`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arc_length_m: Option<f64>,
    /// A recording's zero is its own (a laser zeroed before each run, a camera with another origin): a comparison shifts the simulation
    /// by the mean difference of each run.
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
    /// Orientation of a link or a free body: component of its rotation vector, axis times angle, below half a turn; with a second name
    /// in `of`, from that link.
    BodyRotationX,
    BodyRotationY,
    BodyRotationZ,
    /// Force of the axis.
    AxisForce,
    /// Force of the strip on its clamps.
    StripForce,
    /// Pressure of the closed chamber.
    ChamberPressure,
    /// Tip of a slender rod that a joint's angle bends to an arc of constant curvature: sideways, along.
    ArcTipX,
    ArcTipZ,
}

impl Quantity {
    /// Whether it is where a body is: cameras and trackers have origins of their own.
    pub fn is_place(self) -> bool {
        matches!(self, Self::BodyX | Self::BodyY | Self::BodyZ)
    }
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
    /// Of a key under `muscles`: `each = "muscle"` gives every muscle a number of its own instead of one that all share.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub each: Option<Each>,
}

/// Of what a calibrated number is its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Each {
    Muscle,
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
