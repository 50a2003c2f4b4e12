//! The right-hand side of a plant's equations.

use crate::hydraulics::Chain;
use crate::laws::Port;
use crate::scalar::Scalar;

use super::coordinates::CoordinateStop;
use super::laws::{Acts, MuscleActs, line_drop};
use super::plant::{Drive, Instant, MuscleForces, Plant, add_scaled, dot};
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
    /// What laws do, and the lines with what laws do to them; none without laws.
    pub acts: Option<Box<Acts<D>>>,
    pub chains: Vec<Option<Chain<D>>>,
}

impl<D: Scalar> Seen<D> {
    /// Nothing yet.
    pub fn new(plant: &Plant<D>) -> Self {
        let none = MuscleForces::none();
        let lines = plant.muscles.iter().filter(|_| plant.laws.is_some()).map(|m| match &m.drive {
            Drive::Hydraulic { chain, .. } => Some(chain.clone()),
            Drive::Pressure { .. } => None,
        });
        Self {
            forces: vec![none; plant.muscles.len()],
            tension_n: vec![D::constant(0.0); plant.cables.len()],
            acts: plant.laws.as_ref().map(|laws| Box::new(laws.room(plant))),
            chains: lines.collect(),
        }
    }
}

/// The rates at an instant; for those of the speeds the *force* is given, not the acceleration.
#[inline]
pub(super) fn rates<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    piston_m_s: &[D],
    seen: &mut Seen<D>,
    out: PartsMut<D, N>,
) -> Switches {
    if plant.laws.is_some() {
        return rates_under_laws(plant, now, piston_m_s, seen, out);
    }
    rates_of::<D, N, false>(plant, now, piston_m_s, seen, out)
}

/// Kept apart: what a stock scene goes through knows no laws.
#[inline(never)]
fn rates_under_laws<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    piston_m_s: &[D],
    seen: &mut Seen<D>,
    out: PartsMut<D, N>,
) -> Switches {
    rates_of::<D, N, true>(plant, now, piston_m_s, seen, out)
}

#[inline(always)]
fn rates_of<D: Scalar, const N: usize, const LAWS: bool>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    piston_m_s: &[D],
    seen: &mut Seen<D>,
    mut out: PartsMut<D, N>,
) -> Switches {
    let mut switches = Switches::default();
    if LAWS {
        evaluate_laws(plant, now, seen);
    }
    coordinate_rates(plant, now, &mut out, &mut switches);
    if LAWS {
        cables_under_laws(plant, now, seen, &mut out);
    }
    cable_rates::<D, N, LAWS>(plant, now, &mut seen.tension_n, &mut out, &mut switches);
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let forces = if LAWS { plant.forces_seen(i, now, seen.acts.as_deref()) } else { plant.stock_forces(i, now) };
        switches.note(forces.stop_n.is_above(0.0));
        add_scaled::<_, N>(out.w(), &muscle.jacobian, -forces.pull_n());
        if let Some(friction) = &muscle.friction {
            *out.z(i) = friction.rate(now.at.z(i), forces.speed_m_s);
        }
        if let Drive::Hydraulic { chain, syringe_area_m2, .. } = &muscle.drive {
            let boils = now.state.boiling_of::<N>(i);
            let inflow = piston_m_s[i] * *syringe_area_m2;
            let line = out.line(i);
            if LAWS {
                line_under_laws(chain, *syringe_area_m2, now, (i, inflow, &forces.port), seen, line);
            } else {
                chain.rates(now.at.line(i), boils, inflow, &forces.port, line);
            }
            boils.iter().for_each(|b| switches.note(*b));
        }
        if !out.slow().is_empty() {
            let slow = muscle.slow_at..muscle.slow_at + muscle.extras.slow_states();
            muscle.extras.slow_rates(forces.elongation_m, muscle.slow(&now.at), &mut out.slow()[slow]);
        }
        seen.forces[i] = forces;
    }
    mechanism_rates(plant, now, &mut out, &mut switches);
    if LAWS {
        push_laws(plant, now, seen, &mut out);
    }
    switches
}

/// What laws do at the instant.
fn evaluate_laws<D: Scalar, const N: usize>(plant: &Plant<D>, now: &Instant<D, N>, seen: &mut Seen<D>) {
    if let (Some(laws), Some(acts)) = (&plant.laws, &mut seen.acts) {
        laws.act(plant, now, acts);
    }
}

/// Torques on joints, and rates of the laws' states.
fn push_laws<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    seen: &mut Seen<D>,
    out: &mut PartsMut<D, N>,
) {
    if let (Some(laws), Some(acts)) = (&plant.laws, &mut seen.acts) {
        if laws.joint_sites().next().is_some() {
            laws.push_joints(plant, now, acts, out);
        }
        if laws.remembers() {
            laws.state_rates(plant, now, acts, out.law_states());
        }
    }
}

/// Ports whose laws change the line's own equations.
const FLUID: &[Port] =
    &[Port::Plunger, Port::SyringeFlow, Port::SyringeCompliance, Port::PressureDrop, Port::Resistance, Port::Inertance];

/// Rates of a muscle's line under laws.
fn line_under_laws<D: Scalar, const N: usize>(
    chain: &Chain<D>,
    syringe_area_m2: f64,
    now: &Instant<D, N>,
    (i, inflow, port): (usize, D, &crate::hydraulics::Port<D>),
    seen: &mut Seen<D>,
    out: &mut [D],
) {
    let (Some(acts), Some(Some(under))) = (&seen.acts, seen.chains.get_mut(i)) else { return };
    let (own, at) = (&acts.muscles[i], now.at.line(i));
    if !own.stand_at(FLUID) {
        return chain.rates(at, now.state.boiling_of::<N>(i), inflow, port, out);
    }
    chain_under(chain, own, under);
    let inflow = inflow + acts.piston_m_s[i] * syringe_area_m2 - own.at(Port::SyringeFlow).add;
    under.rates(at, now.state.boiling_of::<N>(i), inflow, port, out);
    drop_under(chain, own, under, at, out);
}

/// Tensions of the cables under their laws, which pull at the coordinates.
fn cables_under_laws<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    seen: &mut Seen<D>,
    out: &mut PartsMut<D, N>,
) {
    let (Some(laws), Some(acts)) = (&plant.laws, &seen.acts) else { return };
    for (i, tension) in seen.tension_n.iter_mut().enumerate() {
        laws.push_cable(i, plant, now, acts, out);
        *tension = acts.tension_n[i];
    }
}

/// Rate of each muscle's pressure with all that acts, Pa/s.
pub(super) fn pressure_rates(plant: &Plant<f64>, now: &Instant<f64>) -> Vec<f64> {
    let row = all_rates(plant, now);
    let at = now.state.layout.parts::<f64, 0>(&row);
    (0..plant.muscles.len()).map(|i| at.line(i)[now.state.segments()]).collect()
}

/// The row of all rates, plungers going as their inputs do.
pub(super) fn all_rates(plant: &Plant<f64>, now: &Instant<f64>) -> Vec<f64> {
    let mut row = vec![0.0; now.state.row.len()];
    let speed = |drive: &Drive<f64>| match drive {
        Drive::Hydraulic { plunger, .. } => now.inputs[*plunger].slope,
        Drive::Pressure { pressure } => now.inputs[*pressure].slope,
    };
    let pistons: Vec<f64> = plant.muscles.iter().map(|m| speed(&m.drive)).collect();
    rates(plant, now, &pistons, &mut Seen::new(plant), now.state.layout.parts_mut(&mut row));
    row
}

/// The line with what laws make of its compliances and its inertia; its resistance is that of the last call of [`drop_under`].
fn chain_under<D: Scalar>(chain: &Chain<D>, acts: &MuscleActs<D>, under: &mut Chain<D>) {
    let share = chain.end_share_m3_pa;
    let upstream = acts.at(Port::SyringeCompliance).on(chain.compliance_m3_pa[0] - share);
    under.compliance_m3_pa[0] = upstream + share + acts.at(Port::Plunger).add;
    let n = chain.segments() as f64;
    under.inertance_pa_s2_m3 = acts.at(Port::Inertance).on(chain.inertance_pa_s2_m3 * n) / n;
}

/// Exchanges the line's own pressure drop for that under laws, and keeps its slope for the tangents.
fn drop_under<D: Scalar>(chain: &Chain<D>, acts: &MuscleActs<D>, under: &mut Chain<D>, line: &[D], out: &mut [D]) {
    let n = chain.segments();
    for j in n + 1..=2 * n {
        let flow = line[j];
        let own = |r: D| r + chain.quadratic_pa_s2_m6 * flow.abs();
        let drop = line_drop(acts, chain.resistance_pa_s_m3, own(chain.resistance_pa_s_m3), flow, n);
        let taken = own(under.resistance_pa_s_m3) * flow;
        out[j] += (taken - drop) / under.inertance_pa_s2_m3;
    }
    let count = n as f64;
    let resistance = acts.at(Port::Resistance).on(chain.resistance_pa_s_m3 * count) / count;
    under.resistance_pa_s_m3 = resistance * acts.at(Port::PressureDrop).scale;
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
fn cable_rates<D: Scalar, const N: usize, const LAWS: bool>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    tension_n: &mut [D],
    out: &mut PartsMut<D, N>,
    switches: &mut Switches,
) {
    for (i, cable) in plant.cables.iter().enumerate() {
        // Under laws it has been found already, and pulls.
        let tension = if LAWS { tension_n[i] } else { cable.pull(now).2 };
        tension_n[i] = tension;
        switches.note(tension.is_above(0.0));
        if !LAWS {
            add_scaled::<_, N>(out.w(), &cable.jacobian, -tension);
        }
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
