//! The working tip: its frame, and the way it has gone.

use rerun::{Arrows3D, Color, LineStrip3D, LineStrips3D, Radius, RecordingStream};

use super::colour::{TRACE, opaque};
use super::error::ViewError;
use super::layer::{Layer, path};
use super::options::ViewOptions;
use super::trace::Trace;
use crate::system::observe::{Frame, SceneGraph};

/// Axes of the frame over the camera's distance.
const AXIS_SHARE: f64 = 0.12;
/// x, y, z.
const AXES: [[u8; 3]; 3] = [[235, 70, 70], [90, 210, 90], [80, 140, 255]];

/// Frame and trace of the link that the scene calls its tip.
pub(super) struct Tip {
    root: &'static str,
    link: usize,
    name: String,
    axis_m: f32,
    trace: Trace<3>,
}

impl Tip {
    /// None if the scene names no tip.
    pub(super) fn new(root: &'static str, graph: &SceneGraph, options: &ViewOptions) -> Option<Self> {
        let link = graph.tip_link?;
        let way: [f64; 3] = std::array::from_fn(|k| graph.camera_position_m[k] - graph.camera_target_m[k]);
        let distance_m = way.iter().map(|x| x * x).sum::<f64>().sqrt();
        Some(Self {
            root,
            link,
            name: graph.links.get(link)?.clone(),
            axis_m: (AXIS_SHARE * distance_m).max(1e-4) as f32,
            trace: Trace::new(options.loop_points),
        })
    }
}

impl Layer for Tip {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let vectors: [[f32; 3]; 3] =
            std::array::from_fn(|k| std::array::from_fn(|i| if i == k { self.axis_m } else { 0.0 }));
        let arrows = Arrows3D::from_vectors(vectors)
            .with_colors(AXES.map(|[r, g, b]| Color::from_rgb(r, g, b)))
            .with_radii([Radius::new_ui_points(1.5)])
            .with_labels(["x", "y", "z"])
            .with_show_labels(false);
        out.log_static(path([self.root, "links", &self.name, "frame"]), &arrows)?;
        Ok(())
    }

    fn stretch(&mut self, _: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        frames.iter().for_each(|frame| self.trace.push(frame.link_poses[self.link].translation_m));
        Ok(())
    }

    fn settle(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let strip = LineStrips3D::new([LineStrip3D::from_iter(self.trace.points())])
            .with_colors([opaque(TRACE)])
            .with_radii([Radius::new_ui_points(1.0)]);
        out.log_static(path([self.root, "tip"]), &strip)?;
        Ok(())
    }
}
