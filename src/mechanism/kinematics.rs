//! Mass matrix, weight and point Jacobians, from the engine's body Jacobians at the current pose.

use nalgebra::{DMatrix, DVector, Vector3, Vector6};

use super::convert::{engine_vector, na_vector, rotation_matrix};
use super::model::Mechanism;

impl Mechanism {
    /// Bare mass matrix M(q) of the coordinates at the current pose, without damping or springs; kg m², kg m or kg.
    ///
    /// M = Pᵀ (Σ Jᵢᵀ diag(mᵢ, Iᵢ) Jᵢ) P, P the projection of followers on their leaders.
    pub fn mass_matrix(&self, out: &mut DMatrix<f64>) {
        *out = self.projection.tr_mul(&(&self.full_mass * &self.projection));
    }

    /// Generalised force of gravity on what has weight, N m or N: Σ Jᵀ m g.
    pub fn weight(&self, out: &mut [f64]) {
        let gravity = na_vector(self.world.0.gravity);
        let mut full = DVector::zeros(self.dofs.len());
        for weight in &self.weights {
            let point = self.body_pose(weight.body) * engine_vector(&weight.point_m);
            self.add_point_force(weight.body, &na_vector(point), &(gravity * weight.mass_kg), &mut full);
        }
        self.write_reduced(&full, out);
    }

    /// Recomputes the bare mass matrix over all dofs; to be called whenever the pose has changed.
    pub(super) fn refresh_mass(&mut self) {
        let n = self.dofs.len();
        let mut mass = std::mem::replace(&mut self.full_mass, DMatrix::zeros(0, 0));
        mass.resize_mut(n, n, 0.0);
        mass.fill(0.0);
        for body in 1..self.bodies.len() {
            self.add_body_mass(body, &mut mass);
        }
        mass.fill_upper_triangle_with_lower_triangle();
        self.full_mass = mass;
    }

    /// Adds the lower triangle of Jᵀ diag(m, I) J, over the dofs that move the body at all.
    fn add_body_mass(&self, index: usize, mass: &mut DMatrix<f64>) {
        let Some(multibody) = self.multibody() else {
            return;
        };
        let body = &self.bodies[index];
        let turn = rotation_matrix(&self.body_pose(index).rotation);
        let inertia = turn * body.inertia_kg_m2 * turn.transpose();
        let jacobian = multibody.body_jacobian(body.link_id);
        for (k, &column) in body.moved_by.iter().enumerate() {
            let velocity = jacobian.fixed_view::<3, 1>(0, column) * body.mass_kg;
            let turning = inertia * jacobian.fixed_view::<3, 1>(3, column);
            for &row in &body.moved_by[k..] {
                mass[(row, column)] += velocity.dot(&jacobian.fixed_view::<3, 1>(0, row))
                    + turning.dot(&jacobian.fixed_view::<3, 1>(3, row));
            }
        }
    }

    /// Adds Jᵀ f for a force (world frame) at a world point of a body.
    pub(super) fn add_point_force(
        &self,
        body: usize,
        point: &Vector3<f64>,
        force: &Vector3<f64>,
        full: &mut DVector<f64>,
    ) {
        let Some(multibody) = self.multibody() else {
            return;
        };
        let com = self.body_pose(body) * engine_vector(&self.bodies[body].com_m);
        let moment = (point - na_vector(com)).cross(force);
        let wrench = Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
        let jacobian = multibody.body_jacobian(self.bodies[body].link_id);
        full.gemv_tr(1.0, jacobian, &wrench, 1.0);
    }

    /// Pᵀ f.
    pub(super) fn write_reduced(&self, full: &DVector<f64>, out: &mut [f64]) {
        let reduced = self.projection.tr_mul(full);
        for (value, reduced) in out.iter_mut().zip(reduced.iter()) {
            *value = *reduced;
        }
    }
}
