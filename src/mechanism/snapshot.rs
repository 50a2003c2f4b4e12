//! Saving a mechanism's state, to go on later bit for bit.

use rapier3d_f64::pipeline::PhysicsWorld;
use serde::{Deserialize, Serialize};

use super::model::Mechanism;

/// Everything that changes while a mechanism moves. Only fit for a mechanism loaded from the same spec.
#[derive(Clone, Serialize, Deserialize)]
pub struct Snapshot {
    world: World,
    last_step_s: f64,
}

/// The engine's world, which can be copied: without its workspaces, which hold nothing between steps.
#[derive(Serialize, Deserialize)]
pub(super) struct World(pub PhysicsWorld);

impl Mechanism {
    /// The present state.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { world: self.world.clone(), last_step_s: self.last_step_s }
    }

    /// Returns to a state saved from a mechanism of the same spec.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.world = snapshot.world.clone();
        self.last_step_s = snapshot.last_step_s;
        self.refresh_mass();
    }
}

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
