//! One engine step towards a given velocity.

use nalgebra::{DMatrix, DVector};
use rapier3d_f64::math::Vector;

use super::convert::engine_vector;
use super::coordinate::CoordinateKind;
use super::model::Mechanism;

impl Mechanism {
    /// Advances by one engine step of `dt_s`, on to `target_velocity` unless contacts object.
    ///
    /// Whoever calls integrates muscles, cables, springs, dampers, stops and weight on the coordinates, and arrives
    /// at v*; the engine then gets the generalised force that carries it there, and adds what only it knows:
    /// contacts, Coriolis forces. The engine's own step is A (v⁺ − v) / h = τ − D v − K (q − r) − h K v + R with
    /// A = M + h D + h² K and R the reactions, so
    ///
    /// τ = A (P v* − v)/h + D v + K (q − r) + h K v − f_c, all over the full dofs.
    ///
    /// `known_force` f_c (N m or N) is the estimate of R that v* already contains; it is spread over followers so that
    /// their coupling carries nothing. On return it is A (v⁺ − v*)/h + f_c, which is R: zero in free motion, the
    /// contact's force on the coordinate once a contact lasts. Start with zeros and hand it on from call to call.
    ///
    /// `dt_s` may change from call to call; one that is not > 0 does nothing. Slices are in coordinate order.
    pub fn advance(&mut self, dt_s: f64, target_velocity: &[f64], known_force: &mut [f64]) {
        let fits = target_velocity.len() == self.coordinates.len() && known_force.len() == target_velocity.len();
        debug_assert!(fits, "one target velocity and one known force per coordinate");
        if !(fits && dt_s > 0.0 && dt_s.is_finite()) {
            return;
        }
        let augmented = self.augmented_mass(dt_s);
        let reduced = self.projection.tr_mul(&(&augmented * &self.projection));
        let target = DVector::from_column_slice(target_velocity);
        let known = DVector::from_column_slice(known_force);
        let force = self.carrying_force(dt_s, &augmented, &reduced, &target, &known);
        self.apply(&force);
        self.world.0.integration_parameters.dt = dt_s;
        self.world.0.step();
        self.last_step_s = dt_s;
        self.refresh_mass();
        let mut arrived = DVector::zeros(target.len());
        self.velocities(arrived.as_mut_slice());
        let reaction = reduced * (arrived - target) / dt_s + known;
        known_force.copy_from_slice(reaction.as_slice());
    }

    /// A = M + h D + h² K over all dofs.
    fn augmented_mass(&self, dt_s: f64) -> DMatrix<f64> {
        let mut augmented = self.full_mass.clone();
        for (i, dof) in self.dofs.iter().enumerate() {
            augmented[(i, i)] += dt_s * dof.damping + dt_s * dt_s * dof.stiffness;
        }
        augmented
    }

    /// τ of [`Mechanism::advance`].
    fn carrying_force(
        &self,
        dt_s: f64,
        augmented: &DMatrix<f64>,
        reduced: &DMatrix<f64>,
        target: &DVector<f64>,
        known: &DVector<f64>,
    ) -> DVector<f64> {
        let Some(multibody) = self.multibody() else {
            return DVector::zeros(0);
        };
        let velocity = multibody.generalized_velocity();
        let mut gain = (&self.projection * target - velocity) / dt_s;
        // A P A_r⁻¹ f_c accelerates the dofs along P alone.
        if known.iter().any(|f| *f != 0.0)
            && let Some(acceleration) = reduced.clone().lu().solve(known)
        {
            gain -= &self.projection * acceleration;
        }
        let mut force = augmented * gain;
        for (i, dof) in self.dofs.iter().enumerate() {
            let stretch = self.dof_position(i) + dt_s * velocity[i] - dof.rest;
            force[i] += dof.damping * velocity[i] + dof.stiffness * stretch;
        }
        force
    }

    /// Puts each dof's force on its body, and the opposite on the body that carries it.
    fn apply(&mut self, force: &DVector<f64>) {
        for body in self.bodies.iter().skip(1) {
            if let Some(engine_body) = self.world.0.bodies.get_mut(body.handle) {
                engine_body.reset_forces(false);
                engine_body.reset_torques(false);
            }
        }
        for i in 0..self.dofs.len() {
            let dof = self.dofs[i];
            let along = self.world_axis(i) * force[i];
            let (linear, angular) = match dof.kind {
                CoordinateKind::Angle => (Vector::ZERO, along),
                CoordinateKind::Length => (along, Vector::ZERO),
            };
            let parent = self.bodies[dof.body].parent;
            let arm = self.body_com(dof.body) - self.body_com(parent);
            self.push(dof.body, linear, angular);
            // Both forces of a slide act along one line, so they make no couple.
            self.push(parent, -linear, -angular - arm.cross(linear));
        }
    }

    fn push(&mut self, body: usize, force: Vector, torque: Vector) {
        if let Some(engine_body) = self.world.0.bodies.get_mut(self.bodies[body].handle) {
            engine_body.add_force(force, false);
            engine_body.add_torque(torque, false);
        }
    }

    fn body_com(&self, body: usize) -> Vector {
        self.body_pose(body) * engine_vector(&self.bodies[body].com_m)
    }

    /// A dof's axis in the world: x of its joint's frame in the child.
    fn world_axis(&self, dof: usize) -> Vector {
        let body = self.dofs[dof].body;
        let link = self.multibody().and_then(|m| m.link(self.bodies[body].link_id));
        link.map_or(Vector::X, |l| l.local_to_world().rotation * l.joint().data.local_frame2.rotation * Vector::X)
    }
}
