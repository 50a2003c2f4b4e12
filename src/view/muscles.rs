//! Muscles as coils: the coil is logged once; each frame only stretches and colours it.

use rerun::{LineStrip3D, LineStrips3D, Points3D, Radius, RecordingStream, Transform3D};

use super::coil::{coil, z_towards};
use super::colour::{AXIS, opaque, pressure};
use super::error::ViewError;
use super::layer::{Layer, path, times};
use super::options::ViewOptions;
use super::solids::quaternion;
use crate::system::observe::{Frame, MuscleFrame, MuscleGraph, SceneGraph};

pub(super) struct Muscles {
    root: &'static str,
    muscles: Vec<MuscleGraph>,
    scale_pa: f64,
}

impl Muscles {
    pub(super) fn new(root: &'static str, graph: &SceneGraph, options: &ViewOptions) -> Self {
        Muscles { root, muscles: graph.muscles.clone(), scale_pa: options.pressure_scale_pa }
    }
}

impl Layer for Muscles {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let mut numbered = self.muscles.iter().enumerate();
        numbered.try_for_each(|(number, muscle)| log_coil(out, self.root, muscle, number))
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        for (number, muscle) in self.muscles.iter().enumerate() {
            let states = frames.iter().map(|frame| frame.muscles[number]);
            log_stretch(out, self.root, muscle, frames, states.clone())?;
            let colours = states.map(|state| opaque(pressure(state.pressure_pa, self.scale_pa)));
            let coil = path([self.root, "muscles", &muscle.name, "coil"]);
            let lines = LineStrips3D::update_fields().with_colors(colours);
            out.send_columns(coil, [times(frames)], lines.columns_of_unit_batches()?)?;
        }
        Ok(())
    }
}

fn log_coil(out: &RecordingStream, root: &str, muscle: &MuscleGraph, number: usize) -> Result<(), ViewError> {
    let coil = coil(muscle);
    let strip = LineStrips3D::update_fields()
        .with_strips([LineStrip3D::from_iter(&coil.points_m)])
        .with_radii([Radius::new_scene_units(coil.wire_radius_m as f32)]);
    out.log_static(path([root, "muscles", &muscle.name, "coil"]), &strip)?;
    // Beside the coil's middle; neighbours stand close together, so that names are staggered along them.
    let along_m = muscle.rest_length_m * if number.is_multiple_of(2) { 0.35 } else { 0.65 };
    let name = Points3D::new([[-0.12 * muscle.rest_length_m, 0.0, along_m]])
        .with_colors([opaque(AXIS)])
        .with_radii([Radius::new_ui_points(0.0)])
        .with_labels([muscle.name.as_str()])
        .with_show_labels(true);
    out.log_static(path([root, "muscles", &muscle.name, "name"]), &name)?;
    Ok(())
}

/// A transform's columns replace each other as a whole, so each row carries all three parts.
fn log_stretch(
    out: &RecordingStream,
    root: &str,
    muscle: &MuscleGraph,
    frames: &[Frame],
    states: impl Iterator<Item = MuscleFrame>,
) -> Result<(), ViewError> {
    let length_m = muscle.rest_length_m.max(1e-6);
    let stretches = states.map(|state| [1.0, 1.0, (1.0 + state.elongation_m / length_m) as f32]);
    let turned = quaternion(z_towards(muscle.direction));
    let transforms = Transform3D::update_fields()
        .with_many_translation(frames.iter().map(|_| muscle.anchor_m))
        .with_many_quaternion(frames.iter().map(|_| turned))
        .with_many_scale(stretches);
    let entity = path([root, "muscles", &muscle.name]);
    out.send_columns(entity, [times(frames)], transforms.columns_of_unit_batches()?)?;
    Ok(())
}
