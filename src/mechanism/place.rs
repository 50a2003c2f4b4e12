//! Putting a mechanism into a given pose, to look at it.

use nalgebra::DVector;

use super::model::Mechanism;

impl Mechanism {
    /// Puts the coordinates (rad or m, in their order) where they are told; followers go with them, velocities stay.
    ///
    /// For looking at poses: whatever runs in time is carried by [`Mechanism::advance`].
    pub fn place(&mut self, positions: &[f64]) {
        let wanted = &self.projection * DVector::from_column_slice(positions);
        let moved: Vec<f64> = (0..self.dofs.len())
            .map(|dof| wanted[dof] + self.dofs[dof].share.offset - self.dof_position(dof))
            .collect();
        let Some(multibody) = self.multibody.and_then(|m| self.world.0.multibody_joints.get_multibody_mut(m)) else {
            return;
        };
        multibody.apply_displacements(&moved);
        multibody.forward_kinematics(&self.world.0.bodies, false);
        multibody.update_rigid_bodies(&mut self.world.0.bodies, true);
        self.refresh_mass();
    }
}
