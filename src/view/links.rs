//! Links and free bodies: static shapes that move with their link's pose.

use rerun::{EntityPath, RecordingStream, Transform3D, ViewCoordinates};

use super::error::ViewError;
use super::layer::{Layer, path, times};
use super::solids::{quaternion, solid};
use crate::mechanism::geometry::{Pose, Visual};
use crate::system::observe::{Frame, SceneGraph};

pub(super) struct Links {
    names: Vec<String>,
    visuals: Vec<Visual>,
}

impl Links {
    pub(super) fn new(graph: &SceneGraph) -> Self {
        Links { names: graph.links.clone(), visuals: graph.visuals.clone() }
    }
}

impl Layer for Links {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        out.log_static("world", &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        for (number, visual) in self.visuals.iter().enumerate() {
            let name = format!("visual_{number}");
            let entity = path(["world", "links", &self.names[visual.link], &name]);
            out.log_static(entity.clone(), &transform(visual.pose))?;
            out.log_static(entity, solid(visual).as_ref())?;
        }
        Ok(())
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        for (link, name) in self.names.iter().enumerate() {
            let poses = frames.iter().map(|frame| frame.link_poses[link]);
            log_poses(out, path(["world", "links", name]), frames, poses)?;
        }
        Ok(())
    }
}

fn log_poses(
    out: &RecordingStream,
    entity: EntityPath,
    frames: &[Frame],
    poses: impl Iterator<Item = Pose> + Clone,
) -> Result<(), ViewError> {
    let transforms = Transform3D::update_fields()
        .with_many_translation(poses.clone().map(|pose| pose.translation_m))
        .with_many_quaternion(poses.map(|pose| quaternion(pose.rotation_xyzw)));
    out.send_columns(entity, [times(frames)], transforms.columns_of_unit_batches()?)?;
    Ok(())
}

fn transform(pose: Pose) -> Transform3D {
    Transform3D::update_fields().with_translation(pose.translation_m).with_quaternion(quaternion(pose.rotation_xyzw))
}
