//! The right-hand side of a plant's equations.

use crate::scalar::Scalar;

use super::plant::{CoordinateStop, Drive, Instant, MuscleForces, Plant, add_scaled, dot};
use super::state::{PartsMut, sized};

/// Which of the plant's one-sided elements act, as one number (a collision only delays new tangents).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Switches(u64);

impl Switches {
    #[inline]
    fn note(&mut self, acts: bool) {
        self.0 = self.0.rotate_left(1) ^ u64::from(acts);
    }
}

/// What was evaluated on the way, for the tangents at the same instant.
#[derive(Clone, Debug)]
pub(super) struct Seen<D> {
    pub forces: Vec<MuscleForces<D>>,
    pub tension_n: Vec<D>,
}

impl<D: Scalar> Seen<D> {
    /// Nothing yet.
    pub fn new(plant: &Plant<D>) -> Self {
        let none = MuscleForces::none();
        Self { forces: vec![none; plant.muscles.len()], tension_n: vec![D::constant(0.0); plant.cables.len()] }
    }
}

/// The rates at an instant; for those of the speeds the *force* is given, not the acceleration.
pub(super) fn rates<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    piston_m_s: &[D],
    seen: &mut Seen<D>,
    mut out: PartsMut<D, N>,
) -> Switches {
    let mut switches = Switches::default();
    coordinate_rates(plant, now, &mut out, &mut switches);
    cable_rates(plant, now, &mut seen.tension_n, &mut out, &mut switches);
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let forces = plant.forces(i, now);
        switches.note(forces.stop_n.is_above(0.0));
        add_scaled::<_, N>(out.w(), &muscle.jacobian, -forces.pull_n());
        if let Some(friction) = &muscle.friction {
            *out.z(i) = friction.rate(now.at.z(i), forces.speed_m_s);
        }
        if let Drive::Hydraulic { chain, syringe_area_m2, .. } = &muscle.drive {
            let boils = now.state.boiling_of::<N>(i);
            chain.rates(now.at.line(i), boils, piston_m_s[i] * *syringe_area_m2, &forces.port, out.line(i));
            boils.iter().for_each(|b| switches.note(*b));
        }
        if !out.slow().is_empty() {
            let slow = muscle.slow_at..muscle.slow_at + muscle.extras.slow_states();
            muscle.extras.slow_rates(forces.elongation_m, muscle.slow(&now.at), &mut out.slow()[slow]);
        }
        seen.forces[i] = forces;
    }
    mechanism_rates(plant, now, &mut out, &mut switches);
    switches
}

/// Springs, dampers, stops and contacts of the coordinates: the first to write their forces.
#[inline]
fn coordinate_rates<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    out: &mut PartsMut<D, N>,
    switches: &mut Switches,
) {
    let (c, y, w) = (&plant.coordinates, now.at.y(), now.at.w());
    let (force, damping) = (sized::<N, _>(&c.force), sized::<N, _>(&c.damping));
    let (stiffness, rest) = (sized::<N, _>(&c.stiffness), sized::<N, _>(&c.rest));
    let (out_y, out_w) = out.y_and_w();
    for i in 0..y.len() {
        out_y[i] = w[i];
        out_w[i] = force[i] - damping[i] * w[i] - stiffness[i] * (y[i] - rest[i]);
    }
    for stop in &c.stops {
        let force = CoordinateStop::force(stop, y[stop.coordinate], w[stop.coordinate]).1;
        switches.note(!force.is_at(0.0));
        out.w()[stop.coordinate] += force;
    }
    if let Some(contact) = &c.contact {
        let push = contact.push(y, w);
        switches.note(push.is_above(0.0));
        add_scaled::<_, N>(out.w(), &contact.direction, push);
    }
}

#[inline]
fn cable_rates<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    tension_n: &mut [D],
    out: &mut PartsMut<D, N>,
    switches: &mut Switches,
) {
    for (i, cable) in plant.cables.iter().enumerate() {
        let (_, _, tension) = cable.pull(now);
        tension_n[i] = tension;
        switches.note(tension.is_above(0.0));
        add_scaled::<_, N>(out.w(), &cable.jacobian, -tension);
        if let Some(friction) = &cable.friction {
            let at = plant.mechanism.frictions.len() + i;
            let sliding = now.at.joint_z()[at];
            // What has been taken along the whole cable above, corrected to what arrives.
            friction.shares(now.at.y(), sliding, |j, share| out.w()[j] -= tension * (share - 1.0) * friction.far[j]);
            out.joint_z()[at] = friction.law.rate_1_s(sliding, friction.sliding_m_s(now.at.w()));
        }
        for coupling in plant.mechanism.couplings.iter().filter(|c| c.cable == i) {
            add_scaled::<_, N>(out.w(), &coupling.direction, coupling.lever_m * tension);
        }
    }
}

/// Dry frictions, walls and loads of the mechanism.
#[inline]
fn mechanism_rates<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    out: &mut PartsMut<D, N>,
    switches: &mut Switches,
) {
    let (extras, at) = (&plant.mechanism, &now.at);
    for (i, friction) in extras.frictions.iter().enumerate() {
        let zero = D::constant(0.0);
        add_scaled::<_, N>(out.w(), &friction.direction, -friction.law.force_n(at.joint_z()[i], zero));
        out.joint_z()[i] = friction.law.rate(at.joint_z()[i], dot::<_, N>(&friction.direction, at.w()));
    }
    for w in &extras.walls {
        let angle = dot::<_, N>(&w.direction, at.y());
        switches.note(w.wall.is_met(angle) && !w.wall.stiffness_n_m_rad.is_at(0.0));
        add_scaled::<_, N>(out.w(), &w.direction, w.wall.torque_n_m(angle));
    }
    for load in &extras.loads {
        add_scaled::<_, N>(out.w(), &load.direction, load.force);
    }
}
