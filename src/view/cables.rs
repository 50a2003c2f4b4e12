//! Cables as lines in the world, coloured by their tension.

use rerun::{LineStrip3D, LineStrips3D, Radius, RecordingStream};

use super::colour::{opaque, tension};
use super::error::ViewError;
use super::layer::{Layer, path, times};
use super::options::ViewOptions;
use crate::system::observe::{CableFrame, Frame, SceneGraph};

pub(super) struct Cables {
    root: &'static str,
    names: Vec<String>,
    slack_below_n: f64,
    scale_n: f64,
}

impl Cables {
    pub(super) fn new(root: &'static str, graph: &SceneGraph, options: &ViewOptions) -> Self {
        Cables {
            root,
            names: graph.cables.clone(),
            slack_below_n: options.slack_below_n,
            scale_n: options.tension_scale_n,
        }
    }

    fn colour(&self, cable: &CableFrame) -> rerun::Color {
        opaque(tension(cable.tension_n, self.slack_below_n, self.scale_n))
    }
}

impl Layer for Cables {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let thick = LineStrips3D::update_fields().with_radii([Radius::new_ui_points(1.75)]);
        for name in &self.names {
            out.log_static(path([self.root, "cables", name]), &thick)?;
        }
        Ok(())
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        for (number, name) in self.names.iter().enumerate() {
            let cables = || frames.iter().map(|frame| &frame.cables[number]);
            let strips = cables().map(|cable| LineStrip3D::from_iter(&cable.points_m));
            let lines =
                LineStrips3D::update_fields().with_strips(strips).with_colors(cables().map(|cable| self.colour(cable)));
            let entity = path([self.root, "cables", name]);
            out.send_columns(entity, [times(frames)], lines.columns_of_unit_batches()?)?;
        }
        Ok(())
    }
}
