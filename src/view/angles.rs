//! Joints: a marker in every hinge, and a table of all positions at the cursor.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rerun::{LineStrip3D, LineStrips3D, Radius, RecordingStream};

use super::colour::{MARKER, opaque};
use super::error::ViewError;
use super::headline::log_texts;
use super::layer::{Layer, path};
use crate::mechanism::geometry::{Shape, Visual};
use crate::system::observe::{Frame, JointGraph, SceneGraph};

/// Rows of the table no closer than this, s: nobody reads faster.
const ROW_EVERY_S: f64 = 0.1;

/// A pin through each hinge, a little longer than the link is wide; its name shows under the pointer.
pub(super) struct Hinges {
    root: &'static str,
    pins: Vec<Pin>,
}

struct Pin {
    link: String,
    joint: String,
    /// Half the pin, from the hinge, m.
    half_m: [f64; 3],
}

/// Length of a pin over the width of its link.
const OVER_WIDTH: f64 = 1.15;

impl Hinges {
    pub(super) fn new(root: &'static str, graph: &SceneGraph) -> Self {
        let pin = |j: &JointGraph| {
            let shapes = graph.visuals.iter().filter(|v| v.link == j.link);
            let half_width_m = shapes.map(|v| reach_m(v, j.axis)).fold(0.0, f64::max);
            let half_m = j.axis.map(|x| OVER_WIDTH * half_width_m * x);
            Pin { link: graph.links[j.link].clone(), joint: j.name.clone(), half_m }
        };
        Self { root, pins: graph.joints.iter().filter(|j| j.is_angle).map(pin).collect() }
    }
}

impl Layer for Hinges {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        for pin in &self.pins {
            let ends = [pin.half_m.map(|x| -x), pin.half_m];
            let line = LineStrips3D::new([LineStrip3D::from_iter(ends)])
                .with_radii([Radius::new_ui_points(2.0)])
                .with_colors([opaque(MARKER)])
                .with_labels([pin.joint.as_str()])
                .with_show_labels(false);
            out.log_static(path([self.root, "links", &pin.link, "hinge"]), &line)?;
        }
        Ok(())
    }

    fn stretch(&mut self, _: &RecordingStream, _: &[Frame]) -> Result<(), ViewError> {
        Ok(())
    }
}

/// How far a visual reaches from its link's origin along a direction, either way, m.
fn reach_m(visual: &Visual, direction: [f64; 3]) -> f64 {
    let [x, y, z, w] = visual.pose.rotation_xyzw;
    let turned = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z));
    let direction = Vector3::from(direction);
    let along = turned.inverse() * direction;
    let half_m = match &visual.shape {
        Shape::Box { size_m } => along.abs().dot(&Vector3::from(*size_m)) / 2.0,
        Shape::Cylinder { radius_m, length_m } => along.z.abs() * length_m / 2.0 + along.xy().norm() * radius_m,
        Shape::Sphere { radius_m } => *radius_m,
        Shape::Mesh { vertices_m, .. } => {
            vertices_m.iter().map(|v| Vector3::from(*v).dot(&along).abs()).fold(0.0, f64::max)
        }
    };
    Vector3::from(visual.pose.translation_m).dot(&direction).abs() + half_m
}

/// What `smam run --angles` prints, at the cursor.
pub(super) struct Angles {
    graph: SceneGraph,
    last_s: f64,
}

impl Angles {
    /// None if the scene has no joint.
    pub(super) fn new(graph: &SceneGraph) -> Option<Self> {
        (!graph.joints.is_empty()).then(|| Self { graph: graph.clone(), last_s: f64::NEG_INFINITY })
    }

    fn table(&self, frame: &Frame) -> String {
        let rows = self.graph.readings(frame);
        let row = |(name, value, unit): &(String, f64, &str)| format!("| {name} | {value:.2} | {unit} |\n");
        format!("| | | |\n|:---|---:|:---|\n{}", rows.iter().map(row).collect::<String>())
    }
}

impl Layer for Angles {
    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        let (mut times_s, mut texts) = (Vec::new(), Vec::new());
        for frame in frames {
            if frame.time_s >= self.last_s + ROW_EVERY_S * (1.0 - 1e-9) {
                self.last_s = frame.time_s;
                times_s.push(frame.time_s);
                texts.push(self.table(frame));
            }
        }
        log_texts(out, "angles", times_s, texts)
    }
}
