//! URDF geometry as plain shapes, and those as the engine's colliders.

use std::path::Path;

use rapier3d_f64::math::{Pose, Rotation, Vector};
use rapier3d_f64::prelude::ColliderBuilder;
use urdf_rs::{Geometry, Robot};

use super::convert::{plain_pose, pose_from_urdf};
use super::error::MechanismError;
use super::geometry::{Shape, Visual};
use super::mesh;
use super::remarks::Remarks;

const GREY: [f32; 4] = [0.7, 0.7, 0.72, 1.0];

/// Everything the links look like; link indices are the URDF's.
pub(super) fn visuals(file: &Path, robot: &Robot, remarks: &mut Remarks) -> Result<Vec<Visual>, MechanismError> {
    let mut found = Vec::new();
    for (link, model) in robot.links.iter().enumerate() {
        for visual in &model.visual {
            // A drawing that cannot be read does not stop a simulation; a wrong size does.
            match placed_shape(file, &model.name, &visual.origin, &visual.geometry) {
                Ok((pose, shape)) => found.push(Visual {
                    link,
                    pose: plain_pose(&pose),
                    shape,
                    colour_rgba: colour(robot, visual.material.as_ref()),
                }),
                Err(MechanismError::Read { file, reason, remedy }) => {
                    remarks.add(format!("not drawn, {reason} ({remedy})"), file.display().to_string());
                }
                Err(error) => return Err(error),
            }
        }
    }
    Ok(found)
}

fn colour(robot: &Robot, material: Option<&urdf_rs::Material>) -> [f32; 4] {
    let Some(material) = material else {
        return GREY;
    };
    let named = || robot.materials.iter().find(|m| m.name == material.name);
    let own = material.color.as_ref();
    let rgba = own.or_else(|| named().and_then(|m| m.color.as_ref()));
    rgba.map_or(GREY, |c| c.rgba.0.map(|v| v as f32))
}

/// A plain shape and its frame in the link, all numbers checked.
pub(super) fn placed_shape(
    file: &Path,
    link: &str,
    origin: &urdf_rs::Pose,
    geometry: &Geometry,
) -> Result<(Pose, Shape), MechanismError> {
    let pose = pose_from_urdf(origin.xyz.0, origin.rpy.0);
    if !pose.is_finite() {
        let problem = "the origin of a visual or collision is not finite";
        return Err(MechanismError::urdf(file, "link", link, problem, "give xyz in m and rpy in rad, finite"));
    }
    Ok((pose, shape(file, link, geometry)?))
}

fn shape(file: &Path, link: &str, geometry: &Geometry) -> Result<Shape, MechanismError> {
    let positive = |what: &str, values: &[f64]| {
        if values.iter().all(|v| *v > 0.0 && v.is_finite()) {
            return Ok(());
        }
        let problem = format!("{what} = {values:?} must be > 0");
        Err(MechanismError::urdf(file, "link", link, problem, "give sizes above zero, in m"))
    };
    match geometry {
        Geometry::Box { size } => {
            positive("box size", &size.0)?;
            Ok(Shape::Box { size_m: size.0 })
        }
        &Geometry::Cylinder { radius, length } => {
            positive("cylinder radius, length", &[radius, length])?;
            Ok(Shape::Cylinder { radius_m: radius, length_m: length })
        }
        &Geometry::Sphere { radius } => {
            positive("sphere radius", &[radius])?;
            Ok(Shape::Sphere { radius_m: radius })
        }
        Geometry::Capsule { .. } => {
            let remedy = "use a cylinder and two spheres";
            let problem = "has a <capsule>, which is not read";
            Err(MechanismError::urdf(file, "link", link, problem, remedy))
        }
        Geometry::Mesh { filename, scale } => {
            mesh::read(file, filename, scale.map_or([1.0; 3], |s| s.0)).map_err(|fault| MechanismError::Read {
                file: fault.file,
                reason: fault.reason,
                remedy: fault.remedy.into(),
            })
        }
    }
}

/// The engine's collider of a shape; `None` for a mesh without volume.
pub(super) fn collider(shape: &Shape) -> Option<ColliderBuilder> {
    Some(match shape {
        Shape::Box { size_m } => ColliderBuilder::cuboid(size_m[0] / 2.0, size_m[1] / 2.0, size_m[2] / 2.0),
        Shape::Cylinder { radius_m, length_m } => ColliderBuilder::cylinder(length_m / 2.0, *radius_m),
        Shape::Sphere { radius_m } => ColliderBuilder::ball(*radius_m),
        Shape::Mesh { vertices_m, .. } => {
            let points: Vec<Vector> = vertices_m.iter().map(|v| Vector::from_array(*v)).collect();
            ColliderBuilder::convex_hull(&points)?
        }
    })
}

/// Pose of the engine's own shape frame in ours: its cylinders lie along y.
pub(super) fn engine_frame(shape: &Shape) -> Pose {
    match shape {
        Shape::Cylinder { .. } => Pose::from_rotation(Rotation::from_rotation_x(std::f64::consts::FRAC_PI_2)),
        _ => Pose::IDENTITY,
    }
}
