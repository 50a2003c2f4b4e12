//! Slopes of laws, in the form in which the implicit step needs them.
//!
//! They decide over stability alone: the method is of second order whatever stands in for the Jacobian. A law's dependence on
//! the element's own elongation, speed, pressure, angle and state is kept, that on its neighbours is left out.

use crate::laws::{Acts as Sense, Carrier, Memory, Port, Program, SLOPES};
use crate::scalar::Scalar;
use crate::system::plant::{Drive, Instant, MuscleForces, Plant};

use super::apply::{ELASTIC, Terms};
use super::{Act, Acts, Instance, PlantLaws};

/// Places in [`SLOPES`].
const ELONGATION: usize = 0;
const SPEED: usize = 1;
const PRESSURE: usize = 2;
const ANGLE: usize = 3;
const ANGULAR_SPEED: usize = 4;
const POSITION: usize = 5;
const FLOW: usize = 8;
const STRETCH: usize = 9;

/// How a muscle's pull and the flows out of its line change with the muscle's own quantities because of laws alone.
#[derive(Clone, Copy, Debug)]
pub(in crate::system) struct MuscleSlopes<D> {
    pub pull_n_m: D,
    pub pull_n_s_m: D,
    pub pull_n_pa: D,
    /// Flow lost per pressure before and after the line, m³/(s Pa).
    pub conductance_m3_s_pa: [D; 2],
    /// Pressure drop per flow that the line's laws add by changing with the flow, Pa s/m³.
    pub drop_pa_s_m3: D,
}

/// How the torque on a site changes with its position and its speed because of laws.
#[derive(Clone, Copy, Debug)]
pub(in crate::system) struct JointSlopes<D> {
    pub by_position: D,
    pub by_speed: D,
}

/// Tangent of a law's state: its stage is `(r + by_elongation k_e + by_speed k_v) damper`.
#[derive(Clone, Copy, Debug)]
pub(in crate::system) struct StateTangent<D> {
    pub damper: D,
    pub by_elongation: D,
    pub by_speed: D,
    /// What the muscle's pull gains per state, and which muscle's.
    pub pull: D,
    pub muscle: Option<usize>,
}

impl<D: Scalar> StateTangent<D> {
    pub fn none() -> Self {
        let zero = D::constant(0.0);
        Self { damper: D::constant(1.0), by_elongation: zero, by_speed: zero, pull: zero, muscle: None }
    }
}

/// Pressure drop per flow through the change of what acts at a port with the flow, Pa s/m³.
fn line_slope<D: Scalar, const N: usize>(
    port: Port,
    acts: &super::MuscleActs<D>,
    plant: &Plant<D>,
    i: usize,
    now: &Instant<D, N>,
    change: &Act<D>,
) -> D {
    let Drive::Hydraulic { chain, .. } = &plant.muscles[i].drive else { return D::constant(0.0) };
    let n = chain.segments();
    let flow = now.at.line(i)[n + 1];
    let resistance = chain.resistance_pa_s_m3 * n as f64;
    if port == Port::Resistance {
        return (resistance * change.scale + change.add) * flow * acts.at(Port::PressureDrop).scale;
    }
    acts.at(Port::Resistance).on(resistance) * flow * change.scale + change.add
}

/// What a muscle's pull depends on at one instant.
struct Muscle<D> {
    /// What laws scale the whole pull, the wall and the coil by.
    whole: D,
    wall: D,
    coil: D,
    terms: Terms<D>,
    z: D,
    pressure_pa: D,
    /// All that the port of the whole pull scales.
    sum_n: D,
}

impl<D: Scalar> Muscle<D> {
    /// Change of the pull with a change of what acts at a port.
    fn pull_per(&self, port: Port, change: &Act<D>) -> D {
        let on = |term: D| term * change.scale + change.add;
        let (whole, wall, coil) = (self.whole, self.wall, self.coil);
        match port {
            Port::Wall => on(self.terms.wall_n) * whole,
            Port::Coil => on(self.terms.coil_n) * whole,
            Port::Friction => on(self.terms.friction_level_n) * self.z * whole,
            Port::Damping => on(self.terms.damping_n) * whole,
            Port::Area => -(on(self.terms.area_m2) * self.pressure_pa * whole),
            Port::RestLength => -((self.terms.wall_n_m * wall + self.terms.coil_n_m * coil) * change.add * whole),
            Port::Pull => on(self.sum_n),
            _ => D::constant(0.0),
        }
    }
}

/// Slopes of a law's value at an instant.
pub(super) struct Slopes<'a, D> {
    pub program: &'a Program,
    pub registers: &'a [D],
}

impl<D: Scalar> Slopes<'_, D> {
    /// To a quantity or a state, in the order of [`SLOPES`]. One without bound, of a root at zero, would hold the rig where it is:
    /// a step is better off without it.
    #[inline]
    pub fn to(&self, index: usize) -> D {
        let slope = self.program.output(1 + index, self.registers);
        if slope.is_finite() { slope } else { D::constant(0.0) }
    }

    /// Whether there is one.
    #[inline]
    fn depends_on(&self, index: usize) -> bool {
        !self.program.is_nothing(1 + index)
    }
}

/// How what acts at a port changes with what one of its laws depends on.
struct Change<'a, D> {
    sense: Sense,
    /// What the other laws there scale by.
    others: Option<D>,
    slopes: Slopes<'a, D>,
}

impl<D: Scalar> Change<'_, D> {
    fn with(&self, index: usize) -> Act<D> {
        let (slope, zero) = (self.slopes.to(index), D::constant(0.0));
        match self.sense {
            Sense::Adds => Act { add: slope, scale: zero },
            Sense::Scales => Act { add: zero, scale: self.others.map_or(slope, |others| slope * others) },
        }
    }
}

impl<D: Scalar> PlantLaws<D> {
    /// Of an instance whose law was evaluated last at the same instant; `total` is what all laws at its port scale by.
    fn change<'a>(instance: &'a Instance, total: D, registers: &'a mut [D]) -> Change<'a, D> {
        let slopes = Self::slopes(instance, registers);
        let value = slopes.program.output(0, slopes.registers);
        let others = (!instance.is_alone && !value.is_at(0.0)).then(|| total / value);
        Change { sense: instance.sense, others, slopes }
    }

    fn at<'a>(&'a self, wanted: Carrier, at: usize) -> impl Iterator<Item = &'a Instance> + 'a {
        self.instances.iter().filter(move |i| i.at == at && i.carrier == wanted)
    }

    fn muscle(
        &self,
        i: usize,
        plant: &Plant<D>,
        forces: &MuscleForces<D>,
        now_z: D,
        acts: &super::MuscleActs<D>,
        (slow, greatest_j): (&[D], D),
    ) -> Muscle<D> {
        let muscle = &plant.muscles[i];
        let (v, p) = (forces.speed_m_s, forces.pressure_pa);
        let terms = if acts.stand_at(ELASTIC) {
            let seen = forces.elongation_m - acts.at(Port::RestLength).add;
            let law = muscle.seen(seen, p, slow, greatest_j);
            Terms::new(muscle, &law, seen - muscle.extras.set_m(slow), v, p)
        } else {
            Terms::without_elastic(muscle, v, p)
        };
        let whole = acts.at(Port::Pull);
        let sum = forces.elastic_n + forces.friction_n + forces.damping_n - whole.add;
        let sum_n = if whole.scale.is_at(0.0) { sum } else { sum / whole.scale };
        let (wall, coil) = (acts.at(Port::Wall).scale, acts.at(Port::Coil).scale);
        Muscle { whole: whole.scale, wall, coil, terms, z: now_z, pressure_pa: forces.pressure_pa, sum_n }
    }

    /// Slopes of a muscle's laws, and tangents of their states for steps of `g`.
    pub(in crate::system) fn muscle_slopes<const N: usize>(
        &self,
        i: usize,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        (forces, acts): (&MuscleForces<D>, &mut Acts<D>),
        (g, states): (f64, &mut [StateTangent<D>]),
    ) -> MuscleSlopes<D> {
        let zero = D::constant(0.0);
        let mut slopes = MuscleSlopes {
            pull_n_m: zero,
            pull_n_s_m: zero,
            pull_n_pa: zero,
            conductance_m3_s_pa: [zero; 2],
            drop_pa_s_m3: zero,
        };
        if acts.muscles[i].is_free() {
            return slopes;
        }
        let memory = (plant.muscles[i].slow(&now.at), now.state.greatest_j[i]);
        let muscle = self.muscle(i, plant, forces, now.at.z(i), &acts.muscles[i], memory);
        for instance in self.at(Carrier::Muscle, i).filter(|x| x.port != Port::Plunger) {
            let (port, law) = (instance.port, &self.laws[instance.law]);
            let change = Self::change(instance, acts.muscles[i].at(port).scale, &mut acts.registers);
            let pull_per = |output: usize| muscle.pull_per(port, &change.with(output));
            for (slope, output) in
                [(&mut slopes.pull_n_m, ELONGATION), (&mut slopes.pull_n_s_m, SPEED), (&mut slopes.pull_n_pa, PRESSURE)]
            {
                if change.slopes.depends_on(output) {
                    *slope += pull_per(output);
                }
            }
            match port {
                Port::SyringeFlow => slopes.conductance_m3_s_pa[0] += change.with(PRESSURE).add,
                Port::Outflow => slopes.conductance_m3_s_pa[1] += change.with(PRESSURE).add,
                Port::Resistance | Port::PressureDrop => {
                    let by_flow = change.with(FLOW);
                    slopes.drop_pa_s_m3 += line_slope(port, &acts.muscles[i], plant, i, now, &by_flow);
                }
                _ => {}
            }
            if !law.states.is_empty() {
                let pulls: Vec<D> = (0..law.states.len()).map(|s| pull_per(SLOPES.len() + s)).collect();
                self.state_tangents(instance, plant, now, acts, (g, states, &pulls));
            }
        }
        slopes
    }

    fn state_tangents<const N: usize>(
        &self,
        instance: &Instance,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
        (g, states, pulls): (f64, &mut [StateTangent<D>], &[D]),
    ) {
        let law = &self.laws[instance.law];
        self.run(&law.programs.rate_slopes, instance, plant, now, acts);
        for (s, _) in law.states.iter().enumerate().filter(|(_, s)| s.memory == Memory::Rate) {
            let slope = |k: usize| law.programs.rate_slopes.output(3 * s + k, &acts.scratch) * g;
            let is_muscle = instance.carrier == Carrier::Muscle;
            states[instance.state_at + s] = StateTangent {
                damper: (-slope(0) + 1.0).recip(),
                by_elongation: if is_muscle { slope(1) } else { D::constant(0.0) },
                by_speed: if is_muscle { slope(2) } else { D::constant(0.0) },
                pull: pulls.get(s).copied().unwrap_or(D::constant(0.0)),
                muscle: is_muscle.then_some(instance.at),
            };
        }
    }

    /// Tangents of the states of laws that are on no muscle, for steps of `g`.
    pub(in crate::system) fn other_states<const N: usize>(
        &self,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
        (g, states): (f64, &mut [StateTangent<D>]),
    ) {
        for instance in &self.instances {
            let has_memory = !self.laws[instance.law].states.is_empty();
            if has_memory && (instance.carrier != Carrier::Muscle || instance.port == Port::Plunger) {
                self.state_tangents(instance, plant, now, acts, (g, states, &[]));
            }
        }
        // What goes through the plunger acts on its speed alone.
        for instance in self.instances.iter().filter(|i| i.port == Port::Plunger) {
            for tangent in &mut states[instance.state_at..][..self.laws[instance.law].states.len()] {
                tangent.muscle = None;
            }
        }
    }

    /// Stiffness (N/m) and damping (N s/m) of a taut cable under its laws, at its near end.
    pub(in crate::system) fn cable_slopes<const N: usize>(
        &self,
        i: usize,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
    ) -> (D, D) {
        let (cable, own) = (&plant.cables[i], acts.cables[i]);
        let (elastic, whole) = (own.at(Port::CableStiffness), own.at(Port::Tension));
        let mut stiffness = cable.stiffness_n_m * elastic.scale * whole.scale;
        if own.stand_at(&[Port::CableStiffness, Port::Tension]) {
            let pull = self.cable(i, plant, now, acts);
            let stretched = cable.stiffness_n_m * pull.stretch_m;
            let sum = elastic.on(stretched) + cable.damping_n_s_m * pull.rate_m_s;
            for instance in self.at(Carrier::Cable, i) {
                let port = instance.port;
                let change = Self::change(instance, own.at(port).scale, &mut acts.registers).with(STRETCH);
                stiffness += match port {
                    Port::CableStiffness => (stretched * change.scale + change.add) * whole.scale,
                    Port::Tension => sum * change.scale + change.add,
                    _ => D::constant(0.0),
                };
            }
        }
        (stiffness, cable.damping_n_s_m * whole.scale)
    }

    /// Slopes of the laws on a site.
    pub(in crate::system) fn joint_slopes<const N: usize>(
        &self,
        site: usize,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
    ) -> JointSlopes<D> {
        let direction = &self.rig.directions[site];
        let (position, speed) = if direction.slides { (POSITION, SPEED) } else { (ANGLE, ANGULAR_SPEED) };
        let Some(i) = direction.direction.iter().position(|d| *d != 0.0) else {
            return JointSlopes { by_position: D::constant(0.0), by_speed: D::constant(0.0) };
        };
        let (c, own) = (&plant.coordinates, acts.joints[site]);
        let spring = c.stiffness[i] * (now.at.y()[i] - c.rest[i]);
        let damper = c.damping[i] * now.at.w()[i];
        let mut slopes = JointSlopes { by_position: D::constant(0.0), by_speed: D::constant(0.0) };
        let whole = own.at(Port::Torque).scale;
        for instance in self.at(Carrier::Joint, site) {
            let port = instance.port;
            let change = Self::change(instance, own.at(port).scale, &mut acts.registers);
            let torque = |act: Act<D>| match port {
                Port::JointStiffness => -((spring * act.scale + act.add) * whole),
                Port::JointDamping => -((damper * act.scale + act.add) * whole),
                _ => {
                    let sum = own.at(Port::JointStiffness).on(spring) + own.at(Port::JointDamping).on(damper);
                    -(sum * act.scale) + act.add
                }
            };
            slopes.by_position += torque(change.with(position));
            slopes.by_speed += torque(change.with(speed));
        }
        slopes
    }
}
