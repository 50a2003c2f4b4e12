//! The `[mechanism]` table of a scene file. Units are in the keys; unknown keys are refused.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A URDF and what it cannot say: stiffness, rest, stops, hung masses, free bodies, contacts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MechanismSpec {
    /// The URDF file, relative to the scene file's folder.
    pub urdf: PathBuf,
    /// Acceleration of gravity in the world frame, m/s².
    #[serde(default)]
    pub gravity_m_s2: [f64; 3],
    /// Whether the URDF's own masses have weight. Hung masses (`link_mass`) always do.
    #[serde(default)]
    pub links_have_weight: bool,
    /// Springs, dampings, stops and initial positions of joints.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub joint: Vec<JointSpec>,
    /// Masses hung on links.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub link_mass: Vec<LinkMassSpec>,
    /// Bodies that are no part of the URDF.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub body: Vec<FreeBodySpec>,
    /// Contacts between links and free bodies; without it nothing touches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<ContactSpec>,
}

/// Values of one joint, or of several alike (each of them gets these values).
///
/// Revolute joints take the `_rad` keys, prismatic ones the `_m` keys. What is not given is zero,
/// but for the damping, which defaults to the URDF's `<dynamics damping>`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointSpec {
    /// Names of the joints these values are for.
    pub joints: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_n_m_rad: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_n_m: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_n_m_s_rad: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_n_s_m: Option<f64>,
    /// Position at which the spring is relaxed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest_rad: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest_m: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_rad: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub initial_m: Option<f64>,
    /// The joint is fixed at this position: it is no coordinate any more.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub locked_rad: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub locked_m: Option<f64>,
    /// One-sided spring that pushes back below its position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower_stop: Option<StopSpec>,
    /// One-sided spring that pushes back above its position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper_stop: Option<StopSpec>,
}

/// A one-sided spring and damper.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StopSpec {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position_rad: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position_m: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_n_m_rad: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_n_m: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_n_m_s_rad: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping_n_s_m: Option<f64>,
}

/// A point mass hung at a link's centre of mass (its origin where the link has no `<inertial>`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinkMassSpec {
    pub link: String,
    /// kg, > 0. It has inertia, and weight whatever `links_have_weight` says.
    pub mass_kg: f64,
}

/// A body beside the mechanism: a ball to grip, an obstacle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FreeBodySpec {
    /// Unique among bodies and links.
    pub name: String,
    pub shape: BodyShapeSpec,
    /// kg; > 0 for a free body, left out for a fixed one.
    #[serde(default)]
    pub mass_kg: f64,
    /// Initial position of the shape's centre, m.
    pub position_m: [f64; 3],
    /// Initial orientation, roll, pitch, yaw as in a URDF.
    #[serde(default)]
    pub rpy_rad: [f64; 3],
    /// Whether gravity acts on it.
    #[serde(default)]
    pub has_weight: bool,
    /// Coulomb coefficient, -; a contact uses the mean of its two sides. Default: that of `[mechanism.contact]`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction_coefficient: Option<f64>,
    /// Free (the default) or fixed in the world.
    #[serde(default)]
    pub motion: BodyMotion,
    /// Red, green, blue, opacity, each 0..=1.
    #[serde(default = "default_colour")]
    pub colour_rgba: [f32; 4],
}

/// Whether a free body moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BodyMotion {
    #[default]
    Free,
    Fixed,
}

/// Shape of a free body, centred on its position; `shape.sphere.radius_m = 0.0015` in TOML.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum BodyShapeSpec {
    Sphere {
        radius_m: f64,
    },
    Box {
        size_m: [f64; 3],
    },
    /// Along z.
    Cylinder {
        radius_m: f64,
        length_m: f64,
    },
}

/// Which links touch, and how the contacts are solved.
///
/// Links never touch each other, only free bodies: what stops a joint belongs into its stops.
/// Defaults hold newtons on milligrams at a step of 0.1 ms (softer ones let the jaws pass through);
/// at 1 ms `pgs_iterations` of 100 to 200 are needed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactSpec {
    /// Links whose `<collision>` shapes take part.
    pub links: Vec<String>,
    /// Coulomb coefficient of the links, -.
    #[serde(default = "default_friction")]
    pub friction_coefficient: f64,
    /// Natural frequency of the contact spring, Hz.
    #[serde(default = "default_frequency")]
    pub natural_frequency_hz: f64,
    /// Damping ratio of the contact spring, -.
    #[serde(default = "default_damping_ratio")]
    pub damping_ratio: f64,
    /// Sweeps of the contact solver per step.
    #[serde(default = "default_iterations")]
    pub pgs_iterations: usize,
    /// Size of the smallest touching things, m: sets the engine's tolerances.
    #[serde(default = "default_length_unit")]
    pub length_unit_m: f64,
}

impl Default for ContactSpec {
    fn default() -> Self {
        Self {
            links: Vec::new(),
            friction_coefficient: default_friction(),
            natural_frequency_hz: default_frequency(),
            damping_ratio: default_damping_ratio(),
            pgs_iterations: default_iterations(),
            length_unit_m: default_length_unit(),
        }
    }
}

/// How a cable runs: exactly one of `lever` and `via`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RouteSpec {
    /// The path shortens by `lever_m` per unit of each joint's position.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lever: Vec<LeverSpec>,
    /// Straight segments through points fixed in links.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub via: Vec<PointSpec>,
    /// Points through which a lever route is drawn; no mechanical meaning.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub draw: Vec<PointSpec>,
}

/// Lever of a cable on one joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LeverSpec {
    pub joint: String,
    /// m (per rad) on a revolute joint, m per m on a prismatic one; > 0 when pulling drives the joint positive.
    pub lever_m: f64,
}

/// A point fixed in a link's frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointSpec {
    pub link: String,
    pub point_m: [f64; 3],
}

fn default_colour() -> [f32; 4] {
    [0.85, 0.3, 0.2, 1.0]
}
fn default_friction() -> f64 {
    0.5
}
fn default_frequency() -> f64 {
    1e6
}
fn default_damping_ratio() -> f64 {
    1.0
}
fn default_iterations() -> usize {
    20
}
fn default_length_unit() -> f64 {
    1e-3
}
