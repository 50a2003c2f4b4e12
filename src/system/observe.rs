//! What a running scene shows to whoever watches it: a file writer, a viewer, a progress bar.

use crate::mechanism::geometry::{Contact, Pose, Visual};

/// What stays the same during a run.
#[derive(Clone, Debug, Default)]
pub struct SceneGraph {
    /// Name of the scene, as in its file.
    pub name: String,
    /// Columns of the recording in order, with their units in the name (`pressure_1_kpa`): inputs first.
    pub channels: Vec<String>,
    /// How many of `channels` are inputs.
    pub input_count: usize,
    /// Links and free bodies; `Frame::link_poses` follows this order.
    pub links: Vec<String>,
    pub visuals: Vec<Visual>,
    /// One per free joint coordinate; `Frame::joint_positions` follows this order.
    pub joints: Vec<JointGraph>,
    /// One name per cable; `Frame::cables` follows this order.
    pub cables: Vec<String>,
    /// One per muscle: how to draw it.
    pub muscles: Vec<MuscleGraph>,
    /// One per law and element on which it acts; `Frame::laws` follows this order. Laws of sensors are not among them.
    pub laws: Vec<LawGraph>,
    /// Horizontal and vertical channel of the scene's hysteresis loops (indices into `channels`).
    pub loops: Vec<(usize, usize)>,
    /// Where a camera should look and from where, m.
    pub camera_target_m: [f64; 3],
    pub camera_position_m: [f64; 3],
    /// Link that carries the working tip, if the scene has one.
    pub tip_link: Option<usize>,
}

impl SceneGraph {
    /// Position of every joint (degrees, of sliders mm) and place of the tip (mm) in a frame: name, value, unit.
    pub fn readings(&self, frame: &Frame) -> Vec<(String, f64, &'static str)> {
        let joints = self.joints.iter().zip(&frame.joint_positions);
        let mut readings: Vec<_> = joints.map(|(j, q)| (j.name.clone(), j.shown(*q), j.unit())).collect();
        let tip = self.tip_link.and_then(|link| Some((self.links.get(link)?, frame.link_poses.get(link)?)));
        if let Some((link, pose)) = tip {
            let places = ["x", "y", "z"].iter().zip(pose.translation_m);
            readings.extend(places.map(|(axis, x)| (format!("{link} {axis}"), x * 1e3, "mm")));
        }
        readings
    }
}

/// What of a joint coordinate stays the same.
#[derive(Clone, Debug, PartialEq)]
pub struct JointGraph {
    pub name: String,
    /// Position in rad; else in m.
    pub is_angle: bool,
    /// The link that it moves: its frame stands in the joint.
    pub link: usize,
    /// Direction of the joint's axis in that frame.
    pub axis: [f64; 3],
}

impl JointGraph {
    /// A position as people read it: degrees, or mm of a slider.
    pub fn shown(&self, position: f64) -> f64 {
        if self.is_angle { position.to_degrees() } else { position * 1e3 }
    }

    /// Unit of [`Self::shown`].
    pub fn unit(&self) -> &'static str {
        if self.is_angle { "°" } else { "mm" }
    }
}

/// What of a muscle stays the same.
#[derive(Clone, Debug, PartialEq)]
pub struct MuscleGraph {
    pub name: String,
    pub outer_diameter_m: f64,
    pub coil_turns: f64,
    pub rest_length_m: f64,
    /// Fixed end and the direction in which the muscle extends when it elongates.
    pub anchor_m: [f64; 3],
    pub direction: [f64; 3],
}

/// What of a law on one element stays the same.
#[derive(Clone, Debug, PartialEq)]
pub struct LawGraph {
    /// Its name in the scene; with a number where it acts on several elements.
    pub name: String,
    /// `muscle_1.friction scales 1 + a * x`.
    pub text: String,
    /// The first variable of its expression, if it has one (`speed_m_s`).
    pub variable: Option<String>,
}

/// One instant of a run.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    pub time_s: f64,
    /// Values in the units of `SceneGraph::channels`.
    pub channels: Vec<f64>,
    pub link_poses: Vec<Pose>,
    pub cables: Vec<CableFrame>,
    pub muscles: Vec<MuscleFrame>,
    pub contacts: Vec<Contact>,
    pub laws: Vec<LawFrame>,
    /// Angle of each joint coordinate, rad (m for sliders), in the mechanism's order.
    pub joint_positions: Vec<f64>,
    /// What happened since the last frame, in words (`muscle_1: cavitation begins`).
    pub events: Vec<String>,
    /// Stored, dissipated, delivered and input energy so far, J, by name; empty unless asked for.
    pub energy_j: Vec<(String, f64)>,
}

/// One cable at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CableFrame {
    /// Polyline in the world, m.
    pub points_m: Vec<[f64; 3]>,
    pub tension_n: f64,
}

/// One muscle at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MuscleFrame {
    pub elongation_m: f64,
    pub pressure_pa: f64,
    pub pull_n: f64,
}

/// A law on one element at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawFrame {
    /// What it adds, or scales by; SI.
    pub value: f64,
    /// Value of its first variable, SI; NaN where it has none.
    pub variable: f64,
}

/// A recorded run beside two simulations of it, at the recorded times.
#[derive(Clone, Debug, Default)]
pub struct SideBySide {
    /// Name of the run.
    pub run: String,
    pub graph: SceneGraph,
    /// What was recorded.
    pub measured: Vec<MeasuredChannel>,
    /// Poses of the links as far as the recording tells them; empty where it tells none.
    pub measured_poses: Vec<Vec<Pose>>,
    /// The scene as calibrated, and with what it lacked; as many frames as samples.
    pub calibrated: Vec<Frame>,
    pub corrected: Vec<Frame>,
    /// Where the calibrated scene is off by more than noise, s.
    pub windows_s: Vec<(f64, f64)>,
}

/// One recorded channel.
#[derive(Clone, Debug, Default)]
pub struct MeasuredChannel {
    /// Index into `SceneGraph::channels`.
    pub channel: usize,
    /// Samples in the channel's unit, NaN where missing.
    pub values: Vec<f64>,
    pub noise_sd: f64,
}

/// Watches a run. Called in order of time, at the output instants only.
pub trait Observer {
    /// What makes it stop the run.
    type Error;

    /// Called once, before the first frame.
    fn begin(&mut self, graph: &SceneGraph) -> Result<(), Self::Error>;

    /// Called at every output instant.
    fn frame(&mut self, frame: &Frame) -> Result<(), Self::Error>;
}
