//! Saving a mechanism's state, to go on later bit for bit.

use rapier3d_f64::pipeline::PhysicsWorld;
use serde::{Deserialize, Serialize};

use super::model::Mechanism;

/// Everything that changes while a mechanism moves. Only fit for a mechanism loaded from the same spec.
#[derive(Serialize, Deserialize)]
pub struct Snapshot {
    world: PhysicsWorld,
    last_step_s: f64,
}

impl Mechanism {
    /// The present state.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { world: copy(&self.world), last_step_s: self.last_step_s }
    }

    /// Returns to a state saved from a mechanism of the same spec.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        self.world = copy(&snapshot.world);
        self.last_step_s = snapshot.last_step_s;
        self.refresh_mass();
    }
}

impl Clone for Snapshot {
    fn clone(&self) -> Self {
        Self { world: copy(&self.world), last_step_s: self.last_step_s }
    }
}

/// A copy without the engine's workspaces, which hold nothing between steps.
fn copy(world: &PhysicsWorld) -> PhysicsWorld {
    PhysicsWorld {
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
    }
}
