//! What acts on the terms of muscles, cables and joints.

use crate::laws::Port;
use crate::muscle::Friction;
use crate::scalar::Scalar;
use crate::system::elastic::{Elastic, ElasticPoint};
use crate::system::plant::{CablePlant, Drive, Instant, MuscleForces, MusclePlant, Plant, dot};
use crate::system::state::PartsMut;

use super::{Act, Acts, CableActs, MuscleActs, PlantLaws};

/// The parts of a muscle's pull that have a port each, at one state: wall, coil, friction, damper, and the pressure's part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Terms<D> {
    pub wall_n: D,
    pub coil_n: D,
    pub friction_level_n: D,
    pub damping_n: D,
    pub area_m2: D,
    /// Slopes of wall and coil to the elongation.
    pub wall_n_m: D,
    pub coil_n_m: D,
}

impl<D: Scalar> Terms<D> {
    /// Without the elastic ones, which no law acts on.
    pub fn without_elastic(muscle: &MusclePlant<D>, speed_m_s: D, pressure_pa: D) -> Self {
        let zero = D::constant(0.0);
        Self {
            wall_n: zero,
            coil_n: zero,
            friction_level_n: muscle.friction.as_ref().map_or(zero, |f: &Friction<D>| f.level_n(pressure_pa)),
            damping_n: muscle.damping_n_s_m * speed_m_s,
            area_m2: zero,
            wall_n_m: zero,
            coil_n_m: zero,
        }
    }

    pub fn new(muscle: &MusclePlant<D>, law: &ElasticPoint<D>, seen_m: D, speed_m_s: D, pressure_pa: D) -> Self {
        let zero = D::constant(0.0);
        let (coil_n, coil_n_m) = match &muscle.elastic {
            Elastic::Tube { coil, .. } => (coil.pull_n(seen_m), coil.stiffness_n_m),
            Elastic::Linear { .. } => (zero, zero),
        };
        Self {
            wall_n: law.pull_n + pressure_pa * law.area_m2 - coil_n,
            coil_n,
            area_m2: law.area_m2,
            wall_n_m: law.stiffness_n_m - coil_n_m,
            coil_n_m,
            ..Self::without_elastic(muscle, speed_m_s, pressure_pa)
        }
    }
}

impl<D: Scalar> MusclePlant<D> {
    /// The elastic law at the elongation that wall and coil see, with what laws add to their rest length.
    pub(super) fn seen(&self, at_m: D, pressure_pa: D, slow: &[D], greatest_j: D) -> ElasticPoint<D> {
        if self.extras.acts {
            self.elastic.softened(at_m - self.extras.set_m(slow), pressure_pa, self.extras.mullins.as_ref(), greatest_j)
        } else {
            self.elastic.at(at_m, pressure_pa)
        }
    }

    /// Does to each term of the stock forces, of the elastic law beside them, what laws do to it.
    #[inline(always)]
    pub(in crate::system) fn put_under(
        &self,
        (forces, elastic): (&mut MuscleForces<D>, &ElasticPoint<D>),
        acts: &MuscleActs<D>,
        z: D,
        slow: &[D],
        greatest_j: D,
    ) {
        if acts.stand_at(ELASTIC) {
            self.elastic_under((forces, elastic), acts, slow, greatest_j);
        }
        if acts.stand_at(DRY) {
            let level = self.friction.as_ref().map_or(D::constant(0.0), |f| f.level_n(forces.pressure_pa));
            forces.friction_n = acts.at(Port::Friction).on(level) * z;
            forces.damping_n = acts.at(Port::Damping).on(forces.damping_n);
        }
        if acts.stand_at(&[Port::Pull]) {
            let whole = acts.at(Port::Pull);
            let sum = forces.elastic_n + forces.friction_n + forces.damping_n;
            forces.elastic_n += whole.on(sum) - sum;
            // The stop's stiffness stays.
            let stop_n_m = self
                .stop
                .as_ref()
                .map_or(D::constant(0.0), |s| -s.push(forces.elongation_m, forces.speed_m_s).dpush_de);
            forces.stiffness_n_m = (forces.stiffness_n_m - stop_n_m) * whole.scale + stop_n_m;
        }
        if acts.stand_at(&[Port::Outflow, Port::LineCompliance]) {
            forces.port.outflow_m3_s += acts.at(Port::Outflow).add;
            if let Drive::Hydraulic { chain, .. } = &self.drive {
                let last = chain.compliance_m3_pa[chain.segments()] - chain.end_share_m3_pa;
                forces.port.compliance_m3_pa += acts.at(Port::LineCompliance).on(last) - last;
            }
        }
    }

    /// Wall, coil and pressure under their laws. What relaxation, preload and the like add has no port of its own and stays.
    #[inline(never)]
    fn elastic_under(
        &self,
        (forces, before): (&mut MuscleForces<D>, &ElasticPoint<D>),
        acts: &MuscleActs<D>,
        slow: &[D],
        greatest_j: D,
    ) {
        let (e, v, p) = (forces.elongation_m, forces.speed_m_s, forces.pressure_pa);
        let longer = acts.at(Port::RestLength).add;
        let law = if acts.stand_at(&[Port::RestLength]) { self.seen(e - longer, p, slow, greatest_j) } else { *before };
        let terms = Terms::new(self, &law, e - longer - self.extras.set_m(slow), v, p);
        let area = acts.at(Port::Area).on(terms.area_m2);
        let (wall, coil) = (acts.at(Port::Wall), acts.at(Port::Coil));
        forces.elastic_n += wall.on(terms.wall_n) + coil.on(terms.coil_n) - p * area - before.pull_n;
        forces.stiffness_n_m += terms.wall_n_m * wall.scale + terms.coil_n_m * coil.scale - before.stiffness_n_m;
        forces.area_m2 = area;
        forces.port.outflow_m3_s += (area - before.area_m2) * v;
        forces.port.compliance_m3_pa += law.compliance_m3_pa - before.compliance_m3_pa;
    }
}

/// Ports whose laws change the elastic pull, and those whose laws change what takes energy.
pub(super) const ELASTIC: &[Port] = &[Port::Wall, Port::Coil, Port::Area, Port::RestLength];
const DRY: &[Port] = &[Port::Friction, Port::Damping];

/// A cable under its laws.
#[derive(Clone, Copy, Debug)]
pub(in crate::system) struct CablePull<D> {
    pub stretch_m: D,
    pub rate_m_s: D,
    /// At the near end, and at the joints.
    pub tension_n: D,
    pub far_n: D,
}

impl<D: Scalar> CablePlant<D> {
    /// Lever on a coordinate with what laws do to it; ends of muscles keep theirs.
    #[inline]
    pub(in crate::system) fn lever_under(&self, act: &Act<D>, coordinate: usize, joints: usize) -> D {
        let own = self.jacobian[coordinate];
        if coordinate >= joints || own == 0.0 {
            return D::constant(own);
        }
        act.scale * own + act.add * own.signum()
    }

    fn pull_under<const N: usize>(
        &self,
        now: &Instant<D, N>,
        acts: &CableActs<D>,
        travel_m: D,
        joints: usize,
    ) -> CablePull<D> {
        let zero = D::constant(0.0);
        let (mut stretch, mut rate) = self.stretch_and_rate(now);
        stretch += acts.at(Port::Stretch).add + travel_m;
        let lever = acts.at(Port::Lever);
        if *lever != Act::neutral() {
            for (i, &w) in now.at.w().iter().enumerate().take(joints) {
                rate += (self.lever_under(lever, i, joints) - self.jacobian[i]) * w;
            }
        }
        let taut = || {
            let elastic = acts.at(Port::CableStiffness).on(self.stiffness_n_m * stretch);
            let pull = acts.at(Port::Tension).on(elastic + self.damping_n_s_m * rate);
            pull.select_above(zero, pull, zero)
        };
        let tension = stretch.select_above(zero, taut(), zero);
        let far = acts.at(Port::Transmission).on(D::constant(1.0)) * tension;
        CablePull { stretch_m: stretch, rate_m_s: rate, tension_n: tension, far_n: far }
    }
}

impl<D: Scalar> PlantLaws<D> {
    /// The cable under its laws, which have been evaluated.
    pub(in crate::system) fn cable<const N: usize>(
        &self,
        cable: usize,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &Acts<D>,
    ) -> CablePull<D> {
        plant.cables[cable].pull_under(now, &acts.cables[cable], acts.travel_m[cable], self.joints)
    }

    /// Tensions under the laws of cables.
    pub(super) fn pull_cables<const N: usize>(&self, plant: &Plant<D>, now: &Instant<D, N>, acts: &mut Acts<D>) {
        for i in 0..plant.cables.len() {
            if let Some(at) = self.travel_at {
                acts.travel_m[i] = now.at.law_states()[at + i];
            }
            acts.tension_n[i] = self.cable(i, plant, now, acts).tension_n;
        }
    }

    /// Adds the force of a cable under its laws to the coordinates'.
    pub(in crate::system) fn push_cable<const N: usize>(
        &self,
        cable: usize,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &Acts<D>,
        out: &mut PartsMut<D, N>,
    ) {
        let pull = self.cable(cable, plant, now, acts);
        let lever = acts.cables[cable].at(Port::Lever);
        for (i, force) in out.w().iter_mut().enumerate() {
            let tension = if i < self.joints { pull.far_n } else { pull.tension_n };
            *force -= plant.cables[cable].lever_under(lever, i, self.joints) * tension;
        }
    }

    /// Speed at which the cables go further than their levers say, m/s, as rates of their states.
    pub(super) fn travel_rates<const N: usize>(
        &self,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &Acts<D>,
        out: &mut [D],
    ) {
        let Some(at) = self.travel_at else { return };
        for (i, cable) in plant.cables.iter().enumerate() {
            let lever = acts.cables[i].at(Port::Lever);
            let further = |(j, &w): (usize, &D)| (cable.lever_under(lever, j, self.joints) - cable.jacobian[j]) * w;
            out[at + i] = now.at.w().iter().enumerate().take(self.joints).map(further).sum();
        }
    }

    /// Adds what acts on the joints to the coordinates' forces.
    pub(in crate::system) fn push_joints<const N: usize>(
        &self,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &Acts<D>,
        out: &mut PartsMut<D, N>,
    ) {
        for site in self.joint_sites() {
            let direction = &self.rig.directions[site].direction;
            for (i, share) in direction.iter().enumerate().filter(|(_, d)| **d != 0.0) {
                out.w()[i] += joint_force(plant, now, &acts.joints[site], i) * *share;
            }
        }
    }

    /// Directions on which laws act, each once.
    pub(in crate::system) fn joint_sites(&self) -> impl Iterator<Item = usize> + '_ {
        self.joint_sites.iter().copied()
    }
}

/// Generalised force of what acts on one coordinate of a site: torque, and what is done to its spring and damper.
pub(super) fn joint_force<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    now: &Instant<D, N>,
    acts: &super::JointActs<D>,
    i: usize,
) -> D {
    let c = &plant.coordinates;
    let spring = c.stiffness[i] * (now.at.y()[i] - c.rest[i]);
    let damper = c.damping[i] * now.at.w()[i];
    let own = -(spring + damper);
    let torque = -(acts.at(Port::JointStiffness).on(spring) + acts.at(Port::JointDamping).on(damper));
    acts.at(Port::Torque).on(torque) - own
}

/// Position along a direction.
pub(super) fn along<D: Scalar>(direction: &[f64], y: &[D]) -> D {
    dot::<_, 0>(direction, y)
}
