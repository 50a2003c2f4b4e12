//! Links that cannot move against each other become one rigid body.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use rapier3d_f64::math::{Pose, Rotation, Vector};
use urdf_rs::{Link, Robot};

use super::convert::{na_vector, pose_from_urdf};
use super::coordinate::CoordinateKind;
use super::error::{MechanismError, known_names};
use super::inertia::Inertial;
use super::joints::JointModel;
use super::remarks::Remarks;
use super::spec::MechanismSpec;
use super::tree::Tree;
use super::xml_scan::XmlScan;

/// A rigid group of links. Body 0 is the one fixed in the world.
#[derive(Clone, Debug)]
pub(super) struct BodyModel {
    pub parent: usize,
    /// The moving joint that carries it; `None` for body 0.
    pub joint: Option<usize>,
    /// Its frame in the parent's when the joint is at zero.
    pub frame: Pose,
    pub inertial: Inertial,
}

/// A mass on which gravity acts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Weight {
    pub body: usize,
    pub point_m: Vector3<f64>,
    pub mass_kg: f64,
}

/// The whole mechanism as rigid bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct Assembly {
    pub bodies: Vec<BodyModel>,
    /// Body of each link, and the link's frame in it.
    pub placement: Vec<(usize, Pose)>,
    pub weights: Vec<Weight>,
}

/// What the assembly is made from.
pub(super) struct Source<'a> {
    pub file: &'a Path,
    pub robot: &'a Robot,
    pub scan: &'a XmlScan,
    pub tree: &'a Tree,
    pub joints: &'a [JointModel],
    pub spec: &'a MechanismSpec,
}

impl Source<'_> {
    /// Merges links into bodies and checks their masses.
    pub fn assemble(&self, remarks: &mut Remarks) -> Result<Assembly, MechanismError> {
        let mut made = Assembly { placement: vec![(0, Pose::IDENTITY); self.robot.links.len()], ..Assembly::default() };
        for &link in &self.tree.order {
            self.place(link, &mut made);
            self.load(link, remarks, &mut made)?;
        }
        for hung in &self.spec.link_mass {
            self.hang(&hung.link, hung.mass_kg, &mut made)?;
        }
        self.check_moving_masses(&made)?;
        for body in &mut made.bodies {
            body.inertial = body.inertial.with_floor();
        }
        Ok(made)
    }

    fn place(&self, link: usize, made: &mut Assembly) {
        let empty =
            |parent, joint, frame| BodyModel { parent, joint, frame, inertial: Inertial::point(0.0, Vector3::zeros()) };
        let Some(joint) = self.tree.carrier[link] else {
            made.bodies.push(empty(0, None, Pose::IDENTITY));
            return;
        };
        let origin = &self.robot.joints[joint].origin;
        let (parent, parent_pose) = made.placement[self.tree.parent[joint]];
        let frame = parent_pose * pose_from_urdf(origin.xyz.0, origin.rpy.0);
        made.placement[link] = if self.joints[joint].moves {
            made.bodies.push(empty(parent, Some(joint), frame));
            (made.bodies.len() - 1, Pose::IDENTITY)
        } else {
            (parent, frame * displacement(&self.joints[joint]))
        };
    }

    /// Adds a link's own mass to its body.
    fn load(&self, link: usize, remarks: &mut Remarks, made: &mut Assembly) -> Result<(), MechanismError> {
        let link_model = &self.robot.links[link];
        if !self.scan.links_with_inertial.contains(&link_model.name) {
            return Ok(());
        }
        let about = format!("link \"{}\"", link_model.name);
        // Frames that somebody gave an empty <inertial>: many exporters do.
        if link_model.inertial.mass.value == 0.0 {
            remarks.add("an <inertial> without mass counts as none", about);
            return Ok(());
        }
        let own = self.checked_inertial(link_model)?;
        if let Some(fault) = own.fault() {
            remarks.add(format!("{fault}; no real body has that"), about);
        }
        let (body, pose) = made.placement[link];
        let own = own.seen_from(&pose);
        if self.spec.links_have_weight {
            made.weights.push(Weight { body, point_m: own.com_m, mass_kg: own.mass_kg });
        }
        made.bodies[body].inertial = made.bodies[body].inertial.merged(&own);
        Ok(())
    }

    fn checked_inertial(&self, link: &Link) -> Result<Inertial, MechanismError> {
        let inertial = inertial_from_urdf(link);
        let error =
            |problem: String, remedy: &str| Err(MechanismError::urdf(self.file, "link", &link.name, problem, remedy));
        let finite = inertial.inertia_kg_m2.iter().chain(inertial.com_m.iter()).all(|v| v.is_finite());
        if !finite {
            return error(
                "<inertial> holds a value that is not finite".into(),
                "give finite mass, inertia and origin, in SI units",
            );
        }
        if !(inertial.mass_kg > 0.0 && inertial.mass_kg.is_finite()) {
            let remedy = "give the real mass, or leave <inertial> out of a massless frame";
            return error(format!("mass = {} must be > 0", inertial.mass_kg), remedy);
        }
        Ok(inertial)
    }

    fn hang(&self, name: &str, mass_kg: f64, made: &mut Assembly) -> Result<(), MechanismError> {
        let links = &self.robot.links;
        let error = |problem: String, remedy: String| Err(MechanismError::spec("link_mass", name, problem, remedy));
        let Some(link) = links.iter().position(|l| l.name == name) else {
            let known = known_names(links.iter().map(|l| l.name.as_str()));
            return error("the URDF has no such link".into(), known);
        };
        if !(mass_kg > 0.0 && mass_kg.is_finite()) {
            return error(format!("mass_kg = {mass_kg} must be > 0"), "give the mass in kg, above zero".into());
        }
        let (body, pose) = made.placement[link];
        // A link without <inertial> has its default, the origin.
        let point = pose * pose_from_urdf(links[link].inertial.origin.xyz.0, [0.0; 3]);
        let hung = Inertial::point(mass_kg, na_vector(point.translation));
        made.weights.push(Weight { body, point_m: hung.com_m, mass_kg });
        made.bodies[body].inertial = made.bodies[body].inertial.merged(&hung);
        Ok(())
    }

    fn check_moving_masses(&self, made: &Assembly) -> Result<(), MechanismError> {
        let massless = made.bodies.iter().find(|b| b.inertial.mass_kg <= 0.0 && b.joint.is_some());
        let Some(joint) = massless.and_then(|body| body.joint) else {
            return Ok(());
        };
        let problem = format!("moves with joint \"{}\" but has no mass of its own", self.joints[joint].name);
        let remedy = "give it mass and inertia (or fix it to a link that has them)";
        let link = &self.robot.joints[joint].child.link;
        Err(MechanismError::urdf(self.file, "link", link, problem, remedy))
    }
}

/// What a fixed or locked joint adds at its position.
fn displacement(joint: &JointModel) -> Pose {
    let axis = Vector::from_array(joint.axis);
    match joint.kind {
        CoordinateKind::Angle => Pose::from_rotation(Rotation::from_axis_angle(axis, joint.position)),
        CoordinateKind::Length => Pose::from_translation(axis * joint.position),
    }
}

fn inertial_from_urdf(link: &Link) -> Inertial {
    let i = &link.inertial.inertia;
    let about_com = Inertial {
        mass_kg: link.inertial.mass.value,
        com_m: Vector3::zeros(),
        inertia_kg_m2: Matrix3::new(i.ixx, i.ixy, i.ixz, i.ixy, i.iyy, i.iyz, i.ixz, i.iyz, i.izz),
    };
    let origin = &link.inertial.origin;
    about_com.seen_from(&pose_from_urdf(origin.xyz.0, origin.rpy.0))
}
