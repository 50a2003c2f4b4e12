//! The engine's world: one multibody for the mechanism, one rigid body per free body.

use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use rapier3d_f64::dynamics::{
    GenericJoint, GenericJointBuilder, JointAxesMask, MassProperties, MultibodyDofCoupling, MultibodyIndex,
    RigidBodyBuilder, RigidBodyHandle, SpringCoefficients,
};
use rapier3d_f64::geometry::ColliderBuilder;
use rapier3d_f64::math::{Pose, Rotation, Vector};
use rapier3d_f64::pipeline::PhysicsWorld;
use urdf_rs::Robot;

use super::assembly::{Assembly, BodyModel};
use super::convert::engine_vector;
use super::coordinate::CoordinateKind;
use super::error::{MechanismError, known_names};
use super::joints::JointModel;
use super::reduce::Share;
use super::shapes::{collider, engine_frame, placed_shape};
use super::spec::ContactSpec;

/// A rigid body of the mechanism as the engine holds it.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub handle: RigidBodyHandle,
    /// Its index in the multibody.
    pub link_id: usize,
    pub parent: usize,
    /// The dofs between it and the root, ascending.
    pub moved_by: Vec<usize>,
    pub mass_kg: f64,
    pub com_m: Vector3<f64>,
    pub inertia_kg_m2: Matrix3<f64>,
}

/// One degree of freedom of the multibody, in the engine's order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dof {
    pub body: usize,
    pub kind: CoordinateKind,
    pub share: Share,
    pub stiffness: f64,
    pub damping: f64,
    pub rest: f64,
}

impl Dof {
    /// The engine's number for the joint's free axis: all our joints move along or about x.
    pub fn axis(&self) -> usize {
        match self.kind {
            CoordinateKind::Angle => 3,
            CoordinateKind::Length => 0,
        }
    }
}

/// The engine's objects and our handles to them.
pub(super) struct Built {
    pub world: PhysicsWorld,
    /// `None` where nothing moves.
    pub multibody: Option<MultibodyIndex>,
    pub bodies: Vec<Body>,
    pub dofs: Vec<Dof>,
}

/// Bodies, joints, springs, dampings, couplings and initial positions.
pub(super) fn build(
    assembly: &Assembly,
    joints: &[JointModel],
    shares: &[Option<Share>],
    gravity_m_s2: [f64; 3],
) -> Built {
    let mut world = PhysicsWorld { gravity: Vector::from_array(gravity_m_s2), ..PhysicsWorld::default() };
    // The engine freezes forces over its own sub-steps, so there is only one of them.
    world.integration_parameters.num_solver_iterations = 1;
    world.integration_parameters.max_ccd_substeps = 0;
    world.integration_parameters.normalized_max_linear_velocity = f64::MAX;
    let mut built =
        Built { world, multibody: None, bodies: Vec::with_capacity(assembly.bodies.len()), dofs: Vec::new() };
    for model in &assembly.bodies {
        built.add_body(model, joints);
    }
    built.settle(assembly, joints, shares);
    built
}

impl Built {
    fn add_body(&mut self, model: &BodyModel, joints: &[JointModel]) {
        let handle = match model.joint {
            None => self.world.insert_body(RigidBodyBuilder::fixed()),
            Some(_) => self.world.insert_body(moving_body(model)),
        };
        if let (Some(joint), Some(parent)) = (model.joint, self.bodies.get(model.parent)) {
            let joint = engine_joint(&joints[joint], &model.frame);
            let parent = parent.handle;
            self.world.multibody_joints.insert(parent, handle, joint, true);
        }
        if let Some(body) = self.world.bodies.get_mut(handle) {
            body.recompute_mass_properties_from_colliders(&self.world.colliders);
        }
        let link = self.world.multibody_joints.rigid_body_link(handle);
        let mut moved_by = self.bodies.get(model.parent).map_or(Vec::new(), |p| p.moved_by.clone());
        if model.joint.is_some() {
            // Every body but the root brings one dof.
            moved_by.push(self.bodies.len() - 1);
        }
        self.bodies.push(Body {
            handle,
            link_id: link.map_or(0, |l| l.id),
            parent: model.parent,
            moved_by,
            mass_kg: model.inertial.mass_kg,
            com_m: model.inertial.com_m,
            inertia_kg_m2: model.inertial.inertia_kg_m2,
        });
        self.multibody = link.map(|l| l.multibody).or(self.multibody);
    }

    fn settle(&mut self, assembly: &Assembly, joints: &[JointModel], shares: &[Option<Share>]) {
        let moving = assembly.bodies.iter().enumerate().skip(1);
        self.dofs = moving
            .filter_map(|(body, model)| {
                let joint = model.joint?;
                Some(dof(body, &joints[joint], shares[joint]?))
            })
            .collect();
        let positions: Vec<f64> = assembly.bodies.iter().filter_map(|b| b.joint.map(|j| joints[j].position)).collect();
        let Some(multibody) = self.multibody else {
            return;
        };
        let Some(multibody) = self.world.multibody_joints.get_multibody_mut(multibody) else {
            return;
        };
        multibody.set_self_contacts_enabled(false);
        // Turns the root's six freedoms of a fresh multibody into none.
        multibody.forward_kinematics(&self.world.bodies, true);
        multibody.apply_displacements(&positions);
        for (index, dof) in self.dofs.iter().enumerate() {
            multibody.damping_mut()[index] = dof.damping;
            let link_id = self.bodies[dof.body].link_id;
            if let Some(link) = multibody.link_mut(link_id) {
                link.joint.set_spring(dof.axis(), dof.stiffness, dof.rest);
            }
        }
        for coupling in couplings(&self.dofs, &self.bodies) {
            multibody.add_dof_coupling(coupling);
        }
        multibody.forward_kinematics(&self.world.bodies, false);
        multibody.update_rigid_bodies(&mut self.world.bodies, true);
    }

    /// Gives the listed links their collision shapes.
    pub fn add_contacts(
        &mut self,
        file: &Path,
        robot: &Robot,
        assembly: &Assembly,
        contact: &ContactSpec,
    ) -> Result<(), MechanismError> {
        set_contact_parameters(&mut self.world, contact);
        for name in &contact.links {
            let error = |problem: &str, remedy: String| MechanismError::spec("contact", name, problem, remedy);
            let Some(link) = robot.links.iter().position(|l| &l.name == name) else {
                let known = known_names(robot.links.iter().map(|l| l.name.as_str()));
                return Err(error("the URDF has no such link", known));
            };
            if robot.links[link].collision.is_empty() {
                return Err(error("this link has no <collision>", "add one to the URDF".into()));
            }
            for collision in &robot.links[link].collision {
                let (own, shape) = placed_shape(file, name, &collision.origin, &collision.geometry)?;
                let (body, link_pose) = assembly.placement[link];
                let Some(builder) = collider(&shape) else {
                    return Err(error("its mesh has no volume", "use a closed mesh".into()));
                };
                let builder =
                    builder.position(link_pose * own * engine_frame(&shape)).friction(contact.friction_coefficient);
                self.attach(builder, link, self.bodies[body].handle);
            }
        }
        Ok(())
    }

    /// Attaches a massless collider that reports contacts as those of `owner`.
    pub fn attach(&mut self, builder: ColliderBuilder, owner: usize, body: RigidBodyHandle) {
        let builder = builder.density(0.0).user_data(owner as u128);
        self.world.insert_collider(builder, Some(body));
    }
}

fn moving_body(model: &BodyModel) -> RigidBodyBuilder {
    let (moments, axes) = model.inertial.principal();
    let mass = MassProperties::with_principal_inertia_frame(
        engine_vector(&model.inertial.com_m),
        model.inertial.mass_kg,
        engine_vector(&moments),
        axes,
    );
    RigidBodyBuilder::dynamic().additional_mass_properties(mass).gravity_scale(0.0).can_sleep(false)
}

fn engine_joint(joint: &JointModel, frame: &Pose) -> GenericJoint {
    let to_axis = Rotation::from_rotation_arc(Vector::X, Vector::from_array(joint.axis));
    let turned = Pose::from_rotation(to_axis);
    let locked = match joint.kind {
        CoordinateKind::Angle => JointAxesMask::LOCKED_REVOLUTE_AXES,
        CoordinateKind::Length => JointAxesMask::LOCKED_PRISMATIC_AXES,
    };
    GenericJointBuilder::new(locked).contacts_enabled(false).local_frame1(*frame * turned).local_frame2(turned).build()
}

fn dof(body: usize, joint: &JointModel, share: Share) -> Dof {
    Dof { body, kind: joint.kind, share, stiffness: joint.stiffness, damping: joint.damping, rest: joint.rest }
}

/// One coupling per follower, to the dof that is the coordinate itself.
fn couplings(dofs: &[Dof], bodies: &[Body]) -> Vec<MultibodyDofCoupling> {
    let mut found = Vec::new();
    for (index, dof) in dofs.iter().enumerate() {
        let leader = leader_of(dofs, dof.share.coordinate);
        let Some(leader) = leader.filter(|l| *l != index).map(|l| dofs[l]) else {
            continue;
        };
        found.push(MultibodyDofCoupling {
            link1: bodies[leader.body].link_id,
            dof1: 0,
            axis1: leader.axis(),
            link2: bodies[dof.body].link_id,
            dof2: 0,
            axis2: dof.axis(),
            coeff: dof.share.multiplier,
            offset: dof.share.offset,
        });
    }
    found
}

/// Index of the dof that measures a coordinate: that of its own joint.
pub(super) fn leader_of(dofs: &[Dof], coordinate: usize) -> Option<usize> {
    dofs.iter().position(|d| d.share.coordinate == coordinate && d.share.leads)
}

fn set_contact_parameters(world: &mut PhysicsWorld, contact: &ContactSpec) {
    let p = &mut world.integration_parameters;
    p.num_internal_pgs_iterations = contact.pgs_iterations.max(1);
    p.length_unit = contact.length_unit_m;
    p.contact_recycling = false;
    // Impulses are then found on the manifolds themselves.
    p.contact_clustering = false;
    // Otherwise a held object creeps.
    p.friction_in_bias_pass = true;
    p.normalized_max_corrective_velocity = f64::MAX;
    let softness = SpringCoefficients::new(contact.natural_frequency_hz, contact.damping_ratio);
    p.contact_softness = softness;
    p.static_contact_softness = softness;
}

/// The engine's world, which can be copied: without its workspaces, which hold nothing between steps.
pub(super) struct World(pub PhysicsWorld);

impl Clone for World {
    fn clone(&self) -> Self {
        let Self(world) = self;
        Self(PhysicsWorld {
            gravity: world.gravity,
            integration_parameters: world.integration_parameters,
            islands: world.islands.clone(),
            broad_phase: world.broad_phase.clone(),
            narrow_phase: world.narrow_phase.clone(),
            bodies: world.bodies.clone(),
            colliders: world.colliders.clone(),
            impulse_joints: world.impulse_joints.clone(),
            multibody_joints: world.multibody_joints.clone(),
            soft_bodies: world.soft_bodies.clone(),
            ..PhysicsWorld::default()
        })
    }
}
