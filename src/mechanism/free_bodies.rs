//! Bodies that are no part of the URDF.

use rapier3d_f64::dynamics::{RigidBodyBuilder, RigidBodyHandle};

use super::convert::pose_from_urdf;
use super::error::MechanismError;
use super::geometry::{Pose, Shape, Visual};
use super::shapes::{collider, engine_frame};
use super::spec::{BodyMotion, BodyShapeSpec, FreeBodySpec, MechanismSpec};
use super::world::Built;

/// Inserts the bodies; their indices follow those of the links.
pub(super) fn insert(
    spec: &MechanismSpec,
    link_names: &mut Vec<String>,
    visuals: &mut Vec<Visual>,
    built: &mut Built,
) -> Result<Vec<RigidBodyHandle>, MechanismError> {
    let default_friction = spec.contact.clone().unwrap_or_default().friction_coefficient;
    let mut handles = Vec::with_capacity(spec.body.len());
    for body in &spec.body {
        check(body, link_names)?;
        let index = link_names.len();
        link_names.push(body.name.clone());
        let shape = plain_shape(&body.shape);
        let handle = built.world.insert_body(engine_body(body));
        if let Some(builder) = collider(&shape) {
            let friction = body.friction_coefficient.unwrap_or(default_friction);
            let builder = builder.position(engine_frame(&shape)).friction(friction);
            let builder = builder.user_data(index as u128).mass(body.mass_kg);
            built.world.insert_collider(builder, Some(handle));
        }
        visuals.push(Visual { link: index, pose: Pose::IDENTITY, shape, colour_rgba: body.colour_rgba });
        handles.push(handle);
    }
    Ok(handles)
}

fn engine_body(body: &FreeBodySpec) -> RigidBodyBuilder {
    let builder = match body.motion {
        BodyMotion::Free => RigidBodyBuilder::dynamic(),
        BodyMotion::Fixed => RigidBodyBuilder::fixed(),
    };
    builder
        .pose(pose_from_urdf(body.position_m, body.rpy_rad))
        .gravity_scale(if body.has_weight { 1.0 } else { 0.0 })
        .can_sleep(false)
}

fn plain_shape(shape: &BodyShapeSpec) -> Shape {
    match *shape {
        BodyShapeSpec::Sphere { radius_m } => Shape::Sphere { radius_m },
        BodyShapeSpec::Box { size_m } => Shape::Box { size_m },
        BodyShapeSpec::Cylinder { radius_m, length_m } => Shape::Cylinder { radius_m, length_m },
    }
}

fn check(body: &FreeBodySpec, taken: &[String]) -> Result<(), MechanismError> {
    let error = |problem: String, remedy: &str| Err(MechanismError::spec("body", &body.name, problem, remedy));
    if taken.contains(&body.name) {
        return error("a link or body has this name already".into(), "rename it");
    }
    let sizes = match body.shape {
        BodyShapeSpec::Sphere { radius_m } => vec![radius_m],
        BodyShapeSpec::Box { size_m } => size_m.to_vec(),
        BodyShapeSpec::Cylinder { radius_m, length_m } => vec![radius_m, length_m],
    };
    if !sizes.iter().all(|s| *s > 0.0 && s.is_finite()) {
        return error(format!("shape sizes {sizes:?} must be > 0"), "give sizes above zero, in m");
    }
    if !body.position_m.iter().chain(&body.rpy_rad).all(|v| v.is_finite()) {
        return error("its position or rpy_rad is not finite".into(), "give finite numbers, in m and rad");
    }
    if body.friction_coefficient.is_some_and(|f| !(f >= 0.0 && f.is_finite())) {
        return error("friction_coefficient must be >= 0".into(), "give 0 for none");
    }
    match body.motion {
        BodyMotion::Free if !(body.mass_kg > 0.0 && body.mass_kg.is_finite()) => {
            let remedy = "give it a mass, or motion = \"fixed\"";
            error(format!("mass_kg = {} must be > 0", body.mass_kg), remedy)
        }
        BodyMotion::Fixed if body.mass_kg != 0.0 => {
            error("a fixed body has no use for mass_kg".into(), "leave mass_kg out")
        }
        _ => Ok(()),
    }
}
