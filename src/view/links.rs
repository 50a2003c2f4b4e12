//! Links and free bodies: static shapes that move with their link's pose.

use rerun::{EntityPath, EntityPathPart, RecordingStream, Transform3D, ViewCoordinates};

use super::error::ViewError;
use super::layer::{Layer, path, times};
use super::solids::{Look, quaternion, solid};
use crate::mechanism::geometry::{Pose, Visual};
use crate::system::observe::{Frame, SceneGraph};

pub(super) struct Links {
    place: Vec<&'static str>,
    names: Vec<String>,
    visuals: Vec<Visual>,
    look: Look,
}

impl Links {
    /// Links under `<root>/links`.
    pub(super) fn new(root: &'static str, graph: &SceneGraph) -> Self {
        Links {
            place: vec![root, "links"],
            names: graph.links.clone(),
            visuals: graph.visuals.clone(),
            look: Look::Solid,
        }
    }

    /// See-through links under `<root>/measured`, of those alone that `moves` marks: the rest would only cover what
    /// is there already.
    pub(super) fn ghost(root: &'static str, graph: &SceneGraph, moves: &[bool]) -> Self {
        let visuals = graph.visuals.iter().filter(|visual| moves[visual.link]).cloned().collect();
        Links { place: vec![root, "measured"], names: graph.links.clone(), visuals, look: Look::Ghost }
    }

    fn entity(&self, link: &str) -> EntityPath {
        EntityPath::from(self.place.iter().map(|part| EntityPathPart::new(*part)).collect::<Vec<_>>())
            .join(&path([link]))
    }
}

impl Layer for Links {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        out.log_static(path([self.place[0]]), &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        for (number, visual) in self.visuals.iter().enumerate() {
            let name = format!("visual_{number}");
            let entity = self.entity(&self.names[visual.link]).join(&path([&name]));
            out.log_static(entity.clone(), &transform(visual.pose))?;
            out.log_static(entity, solid(visual, self.look).as_ref())?;
        }
        Ok(())
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        for (link, name) in self.names.iter().enumerate() {
            let poses = frames.iter().map(|frame| frame.link_poses[link]);
            log_poses(out, self.entity(name), frames, poses)?;
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
