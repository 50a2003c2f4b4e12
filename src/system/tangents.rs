//! Slopes of a plant's rates, in the form in which the stages of a step need them.

use crate::hydraulics::ChainSolver;
use crate::laws::Port;
use crate::muscle::Friction;
use crate::scalar::Scalar;

use super::extras::CableFriction;
use super::laws::{Acts, LawTangents, MuscleSlopes, PlantLaws};
use super::ldl::Ldl;
use super::plant::{Drive, Instant, MuscleForces, Plant, dot};
use super::rates::Seen;
use super::state::{sized, sized_mut};

/// Tangent of one dry friction: the stage of its state is `(r + speed_gain * acceleration) * damper`.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrictionTangent<D> {
    /// `1/(1 - g d rate/d z)`.
    pub damper: D,
    /// `g d rate/d v`.
    speed_gain: D,
    /// Force along the direction per right-hand side of the friction state, N s.
    pub force_per_r: D,
}

/// Tangent of one muscle, frozen for both stages.
#[derive(Clone, Copy, Debug)]
pub(super) struct MuscleTangent<D> {
    /// The pull falls by this much per stage of the pressure, N s/Pa.
    pub pull_per_rho: D,
    /// `dV/de`: flow taken per speed.
    pub area: D,
    pub friction: FrictionTangent<D>,
}

/// Tangent of the dashpot of a relaxing branch: the stage of its state is `(r + gain * elongation) * damper`.
#[derive(Clone, Copy, Debug)]
pub(super) struct DashpotTangent<D> {
    /// `g/theta`, of a step's part and the relaxation time.
    pub gain: D,
    /// `1/(1 + g/theta)`.
    pub damper: D,
}

/// All tangents of a plant, and the factorised matrix of the accelerations.
#[derive(Clone, Debug)]
pub(super) struct Tangents<D> {
    pub lines: Vec<ChainSolver<D>>,
    pub muscles: Vec<MuscleTangent<D>>,
    /// Dry frictions of the mechanism, then of the cables.
    pub frictions: Vec<FrictionTangent<D>>,
    /// Of every slow state.
    pub dashpots: Vec<DashpotTangent<D>>,
    /// Of laws, where there are any.
    pub laws: Option<Box<LawTangents<D>>>,
    /// `g K`, row by row: every spring that acts, seen from the coordinates.
    pub springs: Vec<D>,
    matrix: Vec<D>,
    pub ldl: Ldl<D>,
}

impl<D: Scalar> FrictionTangent<D> {
    /// No friction.
    fn none() -> Self {
        Self { damper: D::constant(1.0), speed_gain: D::constant(0.0), force_per_r: D::constant(0.0) }
    }

    fn new(force_per_z: D, rate_per_z: D, rate_per_v: D, g: f64) -> Self {
        let damper = (-(rate_per_z * g) + 1.0).recip();
        Self { damper, speed_gain: rate_per_v * g, force_per_r: force_per_z * damper * g }
    }

    /// What it adds to the matrix along its direction.
    fn inertia(&self) -> D {
        self.force_per_r * self.speed_gain
    }

    /// Stage of the friction state.
    #[inline]
    pub fn stage(&self, r: D, acceleration: D) -> D {
        (r + self.speed_gain * acceleration) * self.damper
    }
}

impl<D: Scalar> DashpotTangent<D> {
    /// Of a state that is none of a dashpot.
    fn none() -> Self {
        Self { gain: D::constant(0.0), damper: D::constant(1.0) }
    }
}

impl<D: Scalar> Tangents<D> {
    /// Room for those of a plant whose lines have so many segments.
    pub fn new(plant: &Plant<D>, segments: usize, frictions: usize, slow_states: usize) -> Self {
        let (n, zero) = (plant.dim(), D::constant(0.0));
        let muscle = MuscleTangent { pull_per_rho: zero, area: zero, friction: FrictionTangent::none() };
        Self {
            lines: plant.muscles.iter().map(|_| ChainSolver::new(segments)).collect(),
            muscles: vec![muscle; plant.muscles.len()],
            frictions: vec![FrictionTangent::none(); frictions],
            dashpots: vec![DashpotTangent::none(); slow_states],
            laws: plant.laws.as_ref().map(|laws| Box::new(LawTangents::new(laws, plant))),
            springs: vec![zero; n * n],
            matrix: vec![zero; n * n],
            ldl: Ldl::new(n),
        }
    }

    /// Takes them at an instant whose forces have been `seen`, and factorises `M + g D + g² K`.
    ///
    /// Cables, muscles and the like enter as rank-one terms.
    pub fn take<const N: usize>(&mut self, plant: &Plant<D>, now: &Instant<D, N>, seen: &mut Seen<D>, g: f64) {
        let n = plant.dim();
        self.matrix.copy_from_slice(&plant.coordinates.inertia);
        self.springs.fill(D::constant(0.0));
        self.take_coordinates(plant, now, g);
        if let (Some(laws), Some(acts)) = (&plant.laws, &mut seen.acts) {
            self.take_laws(laws, plant, now, acts, g);
        } else {
            for (cable, tension) in plant.cables.iter().zip(&seen.tension_n) {
                if tension.is_above(0.0) {
                    self.add_spring::<N>(&cable.jacobian, cable.stiffness_n_m * g, cable.damping_n_s_m * g);
                }
            }
        }
        for i in 0..plant.muscles.len() {
            self.take_muscle(plant, i, now, seen, g);
        }
        self.take_frictions(plant, now, seen, g);
        for i in 0..n * n {
            self.matrix[i] += self.springs[i] * g;
        }
        self.ldl.factorise::<N>(&self.matrix);
    }

    /// Cables under laws, joints with laws on them, and laws' states that are on no muscle.
    fn take_laws<const N: usize>(
        &mut self,
        laws: &PlantLaws<D>,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
        g: f64,
    ) {
        let Some(own) = &mut self.laws else { return };
        own.levers_at(laws, plant, acts);
        laws.other_states(plant, now, acts, (g, &mut own.states));
        for i in 0..plant.cables.len() {
            if !acts.tension_n[i].is_above(0.0) {
                continue;
            }
            let (stiffness, damping) = laws.cable_slopes(i, plant, now, acts);
            add_outer_of(&mut self.springs, &own.levers[i], stiffness * g);
            add_outer_of(&mut self.matrix, &own.levers[i], damping * g);
        }
        for site in laws.joint_sites() {
            let slopes = laws.joint_slopes(site, plant, now, acts);
            let direction = laws.direction(site);
            let own = &acts.joints[site];
            let whole = own.at(Port::Torque).scale;
            let [spring, damper] =
                [Port::JointStiffness, Port::JointDamping].map(|port| own.at(port).scale * whole - 1.0);
            // Springs and dampers are each joint's own; what depends on the angle depends on that of all.
            let (n, c) = (plant.dim(), &plant.coordinates);
            for i in (0..n).filter(|i| direction[*i] != 0.0) {
                self.springs[i * (n + 1)] += c.stiffness[i] * spring * g;
                self.matrix[i * (n + 1)] += c.damping[i] * damper * g;
            }
            add_outer::<_, N>(&mut self.springs, direction, -slopes.by_position * g);
            let (zero, resisting) = (D::constant(0.0), -slopes.by_speed);
            add_outer::<_, N>(&mut self.matrix, direction, resisting.select_above(zero, resisting, zero) * g);
        }
    }

    /// Slopes that laws give a muscle's pull; those of its states are kept.
    fn slopes_of_laws<const N: usize>(
        &mut self,
        plant: &Plant<D>,
        i: usize,
        now: &Instant<D, N>,
        seen: &mut Seen<D>,
        g: f64,
    ) -> Option<MuscleSlopes<D>> {
        let (laws, acts, own) = (plant.laws.as_ref()?, seen.acts.as_mut()?, self.laws.as_mut()?);
        let slopes = laws.muscle_slopes(i, plant, now, (&seen.forces[i], acts), (g, &mut own.states));
        self.lines[i].set_conductance(slopes.conductance_m3_s_pa);
        // A slope that would make the line pump is left to the rates alone.
        let zero = D::constant(0.0);
        if let Some(Some(under)) = seen.chains.get_mut(i) {
            let resistance = under.resistance_pa_s_m3 + slopes.drop_pa_s_m3 / under.segments() as f64;
            under.resistance_pa_s_m3 = resistance.select_above(zero, resistance, zero);
        }
        Some(slopes)
    }

    /// Springs, dampers, stops, contacts and walls.
    fn take_coordinates<const N: usize>(&mut self, plant: &Plant<D>, now: &Instant<D, N>, g: f64) {
        let (c, n, y, w) = (&plant.coordinates, plant.dim(), now.at.y(), now.at.w());
        for i in 0..n {
            self.springs[i * (n + 1)] += c.stiffness[i] * g;
            self.matrix[i * (n + 1)] += c.damping[i] * g;
        }
        for stop in &c.stops {
            let i = stop.coordinate;
            if !stop.force(y[i], w[i]).1.is_at(0.0) {
                self.springs[i * (n + 1)] += D::constant(g * stop.stiffness);
                self.matrix[i * (n + 1)] += D::constant(g * stop.damping);
            }
        }
        if let Some(contact) = c.contact.as_ref().filter(|c| c.push(y, w).is_above(0.0)) {
            let c = D::constant;
            self.add_spring::<N>(&contact.direction, c(g * contact.stiffness), c(g * contact.damping));
        }
        for w in &plant.mechanism.walls {
            if w.wall.is_met(dot::<_, N>(&w.direction, y)) {
                self.add_spring::<N>(&w.direction, w.wall.stiffness_n_m_rad * g, D::constant(0.0));
            }
        }
    }

    fn take_muscle<const N: usize>(
        &mut self,
        plant: &Plant<D>,
        i: usize,
        now: &Instant<D, N>,
        seen: &mut Seen<D>,
        g: f64,
    ) {
        let slopes = self.slopes_of_laws(plant, i, now, seen, g);
        let acts = seen.acts.as_ref().map(|acts| &acts.muscles[i]);
        let (muscle, forces): (_, &MuscleForces<D>) = (&plant.muscles[i], &seen.forces[i]);
        let z = now.at.z(i);
        let mut damping = muscle.damping_n_s_m;
        if let Some(acts) = acts {
            damping *= acts.at(Port::Damping).scale * acts.at(Port::Pull).scale;
        }
        if let (Some(stop), true) = (&muscle.stop, forces.stop_n.is_above(0.0)) {
            damping += stop.damping_n_s_m;
        }
        let mut tangent =
            MuscleTangent { pull_per_rho: D::constant(0.0), area: forces.area_m2, friction: FrictionTangent::none() };
        let mut pull_per_pressure = forces.area_m2;
        if let Some(acts) = acts {
            pull_per_pressure *= acts.at(Port::Pull).scale;
        }
        if let Some(friction) = &muscle.friction {
            let slopes = friction.rate_jacobian(z, forces.speed_m_s);
            let mut level = friction.level_n(forces.pressure_pa);
            let mut per_pressure = friction.force_per_pressure(z, forces.pressure_pa);
            if let Some(acts) = acts {
                let kept = acts.at(Port::Pull).scale;
                level = acts.at(Port::Friction).on(level) * kept;
                per_pressure *= acts.at(Port::Friction).scale * kept;
            }
            pull_per_pressure -= per_pressure;
            tangent.friction = FrictionTangent::new(level, slopes.drate_dz, slopes.drate_dv, g);
        }
        if let Some(slopes) = &slopes {
            // What falls with speed would make the matrix indefinite: it acts through the forces, which are evaluated in full.
            let zero = D::constant(0.0);
            damping += slopes.pull_n_s_m.select_above(zero, slopes.pull_n_s_m, zero);
            pull_per_pressure -= slopes.pull_n_pa;
        }
        let mut along = damping * g + tangent.friction.inertia();
        if let Drive::Hydraulic { chain, .. } = &muscle.drive {
            let chain = seen.chains.get(i).and_then(Option::as_ref).unwrap_or(chain);
            let sigma = self.lines[i].factorise(chain, now.at.line(i), now.state.boiling_of::<N>(i), &forces.port, g);
            tangent.pull_per_rho = pull_per_pressure * g;
            along += tangent.pull_per_rho * sigma * tangent.area;
        }
        self.muscles[i] = tangent;
        let mut given_way = self.take_dashpots(plant, i, g);
        if let (Some(slopes), Some(own)) = (&slopes, &self.laws) {
            given_way -= slopes.pull_n_m + own.stiffness_through(i);
            along += own.damping_through(i) * g;
        }
        self.add_spring::<N>(&muscle.jacobian, (forces.stiffness_n_m - given_way) * g, along);
    }

    /// Tangents of a muscle's dashpots; the stiffness that its branches lose to them within the step, N/m.
    fn take_dashpots(&mut self, plant: &Plant<D>, i: usize, g: f64) -> D {
        let muscle = &plant.muscles[i];
        let mut given_way = D::constant(0.0);
        for (k, branch) in muscle.extras.branches.iter().enumerate() {
            let gain = branch.relaxation_time_s.recip() * g;
            let damper = (gain + 1.0).recip();
            self.dashpots[muscle.slow_at + k] = DashpotTangent { gain, damper };
            given_way += branch.stiffness_n_m * gain * damper;
        }
        given_way
    }

    fn take_frictions<const N: usize>(&mut self, plant: &Plant<D>, now: &Instant<D, N>, seen: &Seen<D>, g: f64) {
        for (i, friction) in plant.mechanism.frictions.iter().enumerate() {
            let speed = dot::<_, N>(&friction.direction, now.at.w());
            self.frictions[i] = joint_tangent(&friction.law, now.at.joint_z()[i], speed, g);
            add_outer::<_, N>(&mut self.matrix, &friction.direction, self.frictions[i].inertia());
        }
        for (i, cable) in plant.cables.iter().enumerate() {
            let Some(friction) = &cable.friction else { continue };
            let at = plant.mechanism.frictions.len() + i;
            self.frictions[at] = sliding_tangent(friction, now, now.at.joint_z()[at], seen.tension_n[i], g);
            add_outer::<_, N>(&mut self.matrix, &friction.far, self.frictions[at].inertia());
        }
    }

    /// A spring (`g K`) along a direction, and what else stands in the matrix there.
    fn add_spring<const N: usize>(&mut self, direction: &[f64], spring: D, rest: D) {
        add_outer::<_, N>(&mut self.springs, direction, spring);
        add_outer::<_, N>(&mut self.matrix, direction, rest);
    }
}

fn joint_tangent<D: Scalar>(law: &Friction<D>, z: D, speed: D, g: f64) -> FrictionTangent<D> {
    let slopes = law.rate_jacobian(z, speed);
    FrictionTangent::new(law.m0_n, slopes.drate_dz, slopes.drate_dv, g)
}

/// The sliding state grows as the far end is drawn in, against the levers' sign: two signs that cancel.
fn sliding_tangent<D: Scalar, const N: usize>(
    friction: &CableFriction<D>,
    now: &Instant<D, N>,
    sliding: D,
    tension: D,
    g: f64,
) -> FrictionTangent<D> {
    let speed = friction.sliding_m_s(now.at.w());
    let pace = speed.abs() / friction.law.presliding_m;
    let along = D::constant(0.0).select_above(speed, sliding + 1.0, -sliding + 1.0);
    let force_per_z = -friction.slope_n(now.at.y(), tension);
    FrictionTangent::new(force_per_z, -pace, -(along / friction.law.presliding_m), g)
}

/// `matrix += scale * j j^T`, of levers that laws change.
fn add_outer_of<D: Scalar>(matrix: &mut [D], j: &[D], scale: D) {
    let n = j.len();
    for (row, &a) in j.iter().enumerate().filter(|(_, a)| !a.is_at(0.0)) {
        for (x, &b) in matrix[row * n..(row + 1) * n].iter_mut().zip(j) {
            *x += scale * a * b;
        }
    }
}

/// `matrix += scale * j j^T`.
fn add_outer<D: Scalar, const N: usize>(matrix: &mut [D], j: &[f64], scale: D) {
    let j = sized::<N, _>(j);
    let n = j.len();
    for (row, &a) in j.iter().enumerate().filter(|(_, a)| **a != 0.0) {
        let along = scale * a;
        for (x, &b) in sized_mut::<N, _>(&mut matrix[row * n..(row + 1) * n]).iter_mut().zip(j) {
            *x += along * b;
        }
    }
}
