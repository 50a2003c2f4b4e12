//! One fine step of a [`Plant`]: a two-stage Rosenbrock method.
//!
//! ```text
//! (1 - g A) k1 = F(u_n)                          g = gamma h, gamma = 1 - 1/sqrt(2)
//! (1 - g A) k2 = F(u_n + h k1) - 2 k1
//! u_(n+1) = u_n + h (3 k1 + k2)/2
//! ```
//! (Verwer's ROS2.) L-stable, and of second order whatever matrix stands in for the Jacobian `A`: tangents may be
//! taken where they are cheap, only stability needs them near. One factorisation and two solves a step, no iteration,
//! so a step costs the same wherever the state is, and derivatives pass through it exactly.
//!
//! The tangents are therefore kept as long as the same cables pull and the same stops, contacts and vapour are met,
//! at most [`KEEP`] steps; this halves the work.
//!
//! The unknowns are eliminated down to the coordinates' accelerations: the line is tridiagonal ([`ChainSolver`]), the
//! friction states are local, so what remains is a symmetric matrix of the size of the mechanism.

use crate::hydraulics::{ChainRates, ChainSolver, ChainState};
use crate::muscle::Friction;
use crate::scalar::Scalar;

use super::extras::CableFriction;
use super::ldl::Ldl;
use super::plant::{CoordinateStop, Drive, InputSpan, Plant, PlantState, dot};

/// `1 - 1/sqrt(2)`: the smaller of the two values that make the method L-stable.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// Steps after which the tangents are taken anew even if nothing was switched.
const KEEP: u32 = 16;
/// And the time after which they are, s: the friction states have moved on.
const KEEP_S: f64 = 3.2e-3;

/// A stage: the rates of everything in a [`PlantState`].
#[derive(Clone, Debug)]
struct Rates<D> {
    y: Vec<D>,
    w: Vec<D>,
    chains: Vec<ChainRates<D>>,
    z: Vec<D>,
    joint_z: Vec<D>,
    slow: Vec<D>,
}

/// Tangent of one dry friction of the mechanism or along a cable.
#[derive(Clone, Copy, Debug)]
struct FrictionTangent<D> {
    force_per_z: D,
    rate_per_z: D,
    rate_per_v: D,
}

/// Tangent of one muscle, frozen for both stages.
#[derive(Clone, Copy, Debug)]
struct MuscleTangent<D> {
    stiffness: D,
    damping: D,
    /// `dF/dp` with its sign: the pull falls by this much per Pa.
    pull_per_pressure: D,
    /// `dV/de`: flow taken per speed.
    area: D,
    /// Response of the muscle's pressure to its outflow.
    sigma: D,
    /// `dF/dz`, and the friction state's tangents.
    pull_per_z: D,
    rate_per_z: D,
    rate_per_v: D,
}

/// Buffers of the integrator; make one per plant and keep it.
#[derive(Clone, Debug)]
pub struct Stepper<D> {
    middle: PlantState<D>,
    saved: PlantState<D>,
    r: Rates<D>,
    k1: Rates<D>,
    k2: Rates<D>,
    solvers: Vec<ChainSolver<D>>,
    tangents: Vec<MuscleTangent<D>>,
    frictions: Vec<FrictionTangent<D>>,
    /// Speed of each piston over the step, m/s: that of the plunger unless there is play.
    piston_m_s: Vec<D>,
    /// Which cables pull, and which stops are met, where the tangents were taken.
    taut: Vec<bool>,
    met: Vec<bool>,
    touching: bool,
    /// Everything one-sided at that point, and how many steps ago and for which step that was.
    switches: Switches,
    age: u32,
    tangent_step_s: f64,
    rho: Vec<D>,
    matrix: Vec<D>,
    ldl: Ldl<D>,
    right: Vec<D>,
}

impl<D: Scalar> Stepper<D> {
    /// Buffers for `plant` and states shaped like `state`.
    pub fn new(plant: &Plant<D>, state: &PlantState<D>) -> Self {
        let zero = D::constant(0.0);
        let n = plant.dim();
        let rates = Rates {
            y: vec![zero; n],
            w: vec![zero; n],
            chains: state.chains.iter().map(ChainState::zero_rates).collect(),
            z: vec![zero; state.z.len()],
            joint_z: vec![zero; state.joint_z.len()],
            slow: vec![zero; state.slow.len()],
        };
        let friction = FrictionTangent { force_per_z: zero, rate_per_z: zero, rate_per_v: zero };
        let tangent = MuscleTangent {
            stiffness: zero,
            damping: zero,
            pull_per_pressure: zero,
            area: zero,
            sigma: zero,
            pull_per_z: zero,
            rate_per_z: zero,
            rate_per_v: zero,
        };
        Self {
            middle: state.clone(),
            saved: state.clone(),
            r: rates.clone(),
            k1: rates.clone(),
            k2: rates,
            solvers: state.chains.iter().map(|c| ChainSolver::new(c.flow_m3_s.len())).collect(),
            tangents: vec![tangent; plant.muscles.len()],
            frictions: vec![friction; state.joint_z.len()],
            piston_m_s: vec![zero; plant.muscles.len()],
            taut: vec![false; plant.cables.len()],
            met: vec![false; plant.coordinates.stops.len()],
            touching: false,
            switches: Switches::default(),
            age: KEEP,
            tangent_step_s: 0.0,
            rho: vec![zero; plant.muscles.len()],
            matrix: vec![zero; n * n],
            ldl: Ldl::new(n),
            right: vec![zero; n],
        }
    }

    /// Forgets the tangents: inertia, levers or weights of the plant have changed.
    pub fn plant_changed(&mut self) {
        self.age = KEEP;
    }

    /// Keeps a state, to try again from it.
    pub fn save(&mut self, state: &PlantState<D>) {
        copy(&mut self.saved, state);
    }

    /// Goes back to the kept state.
    pub fn restore(&mut self, state: &mut PlantState<D>) {
        copy(state, &self.saved);
    }

    /// Advances `state` by `h` seconds; `inputs` start at the step's beginning. Whether everything one-sided acted alike
    /// at both stages: where it did not, the step is too long to be trusted.
    pub fn step(&mut self, plant: &Plant<D>, state: &mut PlantState<D>, inputs: &[InputSpan], h: f64) -> bool {
        let g = GAMMA * h;
        self.move_pistons(plant, state, inputs, h);
        let switches = rates(plant, state, inputs, &self.piston_m_s, 0.0, &mut self.r);
        if switches != self.switches
            || self.age >= KEEP
            || f64::from(self.age) * h >= KEEP_S
            || h != self.tangent_step_s
        {
            self.linearise(plant, state, inputs, g);
            (self.switches, self.age, self.tangent_step_s) = (switches, 0, h);
        }
        self.age += 1;
        self.solve(plant, state, g, Stage::First);
        move_to(&mut self.middle, state, &self.k1, h);
        let ahead = rates(plant, &self.middle, inputs, &self.piston_m_s, h, &mut self.r);
        self.subtract_first_stage(plant);
        self.solve(plant, state, g, Stage::Second);
        advance(state, &self.k1, 1.5 * h);
        advance(state, &self.k2, 0.5 * h);
        for (muscle, chain_state) in plant.muscles.iter().zip(&mut state.chains) {
            if let Drive::Hydraulic { chain, .. } = &muscle.drive {
                chain.settle_vapour(chain_state);
            }
        }
        remember_greatest(plant, state);
        ahead == switches
    }

    /// Where the pistons are at the end of the step, and how fast they go there.
    fn move_pistons(&mut self, plant: &Plant<D>, state: &mut PlantState<D>, inputs: &[InputSpan], h: f64) {
        for (i, muscle) in plant.muscles.iter().enumerate() {
            let Drive::Hydraulic { plunger, .. } = &muscle.drive else { continue };
            let span = inputs[*plunger];
            let Some(play) = &muscle.extras.backlash else {
                self.piston_m_s[i] = D::constant(span.slope);
                continue;
            };
            let before = state.piston_ahead_m[i];
            let after = play.follow(before, h * span.slope);
            self.piston_m_s[i] = (after - before) / h + span.slope;
            state.piston_ahead_m[i] = after;
        }
    }

    /// Tangents at the start of the step, and the factorised matrix of the accelerations.
    fn linearise(&mut self, plant: &Plant<D>, state: &PlantState<D>, inputs: &[InputSpan], g: f64) {
        for (flag, stop) in self.met.iter_mut().zip(&plant.coordinates.stops) {
            *flag = stop.force(state.y[stop.coordinate], state.w[stop.coordinate]).1.value() != 0.0;
        }
        let contact = plant.coordinates.contact.as_ref();
        self.touching = contact.is_some_and(|c| c.push(&state.y, &state.w).value() > 0.0);
        for (i, flag) in self.taut.iter_mut().enumerate() {
            *flag = plant.cable(i, state, inputs, 0.0).2.value() > 0.0;
        }
        for i in 0..plant.muscles.len() {
            self.tangents[i] = tangent(plant, i, state, inputs, &mut self.solvers[i], g);
        }
        for (i, friction) in plant.mechanism.frictions.iter().enumerate() {
            let speed = dot(&friction.direction, &state.w);
            self.frictions[i] = friction_tangent(&friction.law, state.joint_z[i], speed);
        }
        let first = plant.mechanism.frictions.len();
        for (i, cable) in plant.cables.iter().enumerate() {
            if let Some(friction) = &cable.friction {
                let tension = plant.cable(i, state, inputs, 0.0).2;
                self.frictions[first + i] = sliding_tangent(friction, state, state.joint_z[first + i], tension);
            }
        }
        self.assemble(plant, state, g);
        self.ldl.factorise(&self.matrix);
    }

    /// `M + g D + g² K`, with cables and muscles as rank-one terms.
    fn assemble(&mut self, plant: &Plant<D>, state: &PlantState<D>, g: f64) {
        let c = &plant.coordinates;
        let n = plant.dim();
        self.matrix.copy_from_slice(&c.inertia);
        for i in 0..n {
            self.matrix[i * n + i] += c.damping[i] * g + c.stiffness[i] * (g * g);
        }
        for (stop, _) in c.stops.iter().zip(&self.met).filter(|(_, met)| **met) {
            self.matrix[stop.coordinate * (n + 1)] += D::constant(g * stop.damping + g * g * stop.stiffness);
        }
        if let (Some(contact), true) = (&c.contact, self.touching) {
            add_outer(
                &mut self.matrix,
                &contact.direction,
                D::constant(g * contact.damping + g * g * contact.stiffness),
            );
        }
        for (cable, _) in plant.cables.iter().zip(&self.taut).filter(|(_, taut)| **taut) {
            add_outer(&mut self.matrix, &cable.jacobian, cable.damping_n_s_m * g + cable.stiffness_n_m * (g * g));
        }
        for (muscle, t) in plant.muscles.iter().zip(&self.tangents) {
            let pressure = t.pull_per_pressure * t.sigma * t.area * g;
            let friction = t.pull_per_z * t.rate_per_v * (g * g) / (-(t.rate_per_z * g) + 1.0);
            add_outer(&mut self.matrix, &muscle.jacobian, t.damping * g + t.stiffness * (g * g) + pressure + friction);
        }
        for w in &plant.mechanism.walls {
            if w.wall.is_met(dot(&w.direction, &state.y)) {
                add_outer(&mut self.matrix, &w.direction, w.wall.stiffness_n_m_rad * (g * g));
            }
        }
        for (direction, t) in dry_frictions(plant).zip(&self.frictions) {
            let scale = t.force_per_z * t.rate_per_v * (g * g) / (-(t.rate_per_z * g) + 1.0);
            add_outer(&mut self.matrix, direction, scale);
        }
    }

    fn solve(&mut self, plant: &Plant<D>, state: &PlantState<D>, g: f64, stage: Stage) {
        let k = match stage {
            Stage::First => &mut self.k1,
            Stage::Second => &mut self.k2,
        };
        let r = &self.r;
        self.right.copy_from_slice(&r.w);
        for (i, right) in self.right.iter_mut().enumerate() {
            *right -= plant.coordinates.stiffness[i] * r.y[i] * g;
        }
        for (stop, _) in plant.coordinates.stops.iter().zip(&self.met).filter(|(_, met)| **met) {
            self.right[stop.coordinate] -= r.y[stop.coordinate] * (g * stop.stiffness);
        }
        if let (Some(contact), true) = (&plant.coordinates.contact, self.touching) {
            let along = dot(&contact.direction, &r.y) * (contact.stiffness * g);
            add_scaled(&mut self.right, &contact.direction, -along);
        }
        for (cable, _) in plant.cables.iter().zip(&self.taut).filter(|(_, taut)| **taut) {
            let along = dot(&cable.jacobian, &r.y) * cable.stiffness_n_m * g;
            add_scaled(&mut self.right, &cable.jacobian, -along);
        }
        for (i, muscle) in plant.muscles.iter().enumerate() {
            let t = &self.tangents[i];
            self.rho[i] = self.solvers[i].eliminate(&r.chains[i]);
            let spring = t.stiffness * dot(&muscle.jacobian, &r.y);
            let friction = t.pull_per_z * r.z[i] / (-(t.rate_per_z * g) + 1.0);
            let along = (t.pull_per_pressure * self.rho[i] - spring - friction) * g;
            add_scaled(&mut self.right, &muscle.jacobian, along);
        }
        for w in &plant.mechanism.walls {
            if w.wall.is_met(dot(&w.direction, &state.y)) {
                let along = dot(&w.direction, &r.y) * w.wall.stiffness_n_m_rad * g;
                add_scaled(&mut self.right, &w.direction, -along);
            }
        }
        for (i, (direction, t)) in dry_frictions(plant).zip(&self.frictions).enumerate() {
            let along = t.force_per_z * r.joint_z[i] / (-(t.rate_per_z * g) + 1.0) * g;
            add_scaled(&mut self.right, direction, -along);
        }
        k.w.copy_from_slice(&self.right);
        self.ldl.solve(&mut k.w);
        for i in 0..plant.dim() {
            k.y[i] = r.y[i] + k.w[i] * g;
        }
        for (i, muscle) in plant.muscles.iter().enumerate() {
            let t = &self.tangents[i];
            let acceleration = dot(&muscle.jacobian, &k.w);
            k.z[i] = (r.z[i] + t.rate_per_v * acceleration * g) / (-(t.rate_per_z * g) + 1.0);
            self.solvers[i].back_substitute(
                t.area * acceleration,
                &r.chains[i],
                &state.chains[i].boiling,
                &mut k.chains[i],
            );
        }
        for (i, (direction, t)) in dry_frictions(plant).zip(&self.frictions).enumerate() {
            let acceleration = dot(direction, &k.w);
            k.joint_z[i] = (r.joint_z[i] + t.rate_per_v * acceleration * g) / (-(t.rate_per_z * g) + 1.0);
        }
        // Slow states act back only through the forces, which are evaluated in full: no tangent needed.
        k.slow.copy_from_slice(&r.slow);
    }

    /// Turns `F(u + h k1)` into the right-hand side of the second stage.
    fn subtract_first_stage(&mut self, plant: &Plant<D>) {
        let n = plant.dim();
        for i in 0..n {
            self.r.y[i] -= self.k1.y[i] * 2.0;
            let row = &plant.coordinates.inertia[i * n..(i + 1) * n];
            let inertial: D = row.iter().zip(&self.k1.w).map(|(&m, &a)| m * a).sum();
            self.r.w[i] -= inertial * 2.0;
        }
        for (r, k) in self.r.chains.iter_mut().zip(&self.k1.chains) {
            r.subtract_twice(k);
        }
        for (r, &k) in self.r.z.iter_mut().zip(&self.k1.z) {
            *r -= k * 2.0;
        }
        for (r, &k) in self.r.joint_z.iter_mut().zip(&self.k1.joint_z) {
            *r -= k * 2.0;
        }
        for (r, &k) in self.r.slow.iter_mut().zip(&self.k1.slow) {
            *r -= k * 2.0;
        }
    }
}

#[derive(Clone, Copy)]
enum Stage {
    First,
    Second,
}

fn tangent<D: Scalar>(
    plant: &Plant<D>,
    i: usize,
    state: &PlantState<D>,
    inputs: &[InputSpan],
    solver: &mut ChainSolver<D>,
    g: f64,
) -> MuscleTangent<D> {
    let muscle = &plant.muscles[i];
    let forces = plant.muscle_forces(i, state, inputs, 0.0);
    let zero = D::constant(0.0);
    let (sigma, driven) = match &muscle.drive {
        Drive::Hydraulic { chain, .. } => (solver.factorise(chain, &state.chains[i], &forces.port, g), 1.0),
        Drive::Pressure { .. } => (zero, 0.0),
    };
    let mut t = MuscleTangent {
        stiffness: forces.stiffness_n_m,
        damping: muscle.damping_n_s_m,
        pull_per_pressure: forces.area_m2 * driven,
        area: forces.area_m2,
        sigma,
        pull_per_z: zero,
        rate_per_z: zero,
        rate_per_v: zero,
    };
    if let (Some(stop), true) = (&muscle.stop, forces.stop_n.value() > 0.0) {
        t.damping += stop.damping_n_s_m;
    }
    if let Some(friction) = &muscle.friction {
        let slopes = friction.rate_jacobian(state.z[i], forces.speed_m_s);
        t.pull_per_pressure -= friction.force_per_pressure(state.z[i], forces.pressure_pa) * driven;
        t.pull_per_z = friction.level_n(forces.pressure_pa);
        t.rate_per_z = slopes.drate_dz;
        t.rate_per_v = slopes.drate_dv;
    }
    t
}

/// `F(u)`; for the rates of the coordinates the *force* is given, not the acceleration.
fn rates<D: Scalar>(
    plant: &Plant<D>,
    state: &PlantState<D>,
    inputs: &[InputSpan],
    piston_m_s: &[D],
    elapsed_s: f64,
    out: &mut Rates<D>,
) -> Switches {
    let mut switches = Switches::default();
    let c = &plant.coordinates;
    out.y.copy_from_slice(&state.w);
    for i in 0..plant.dim() {
        out.w[i] = c.force[i] - c.damping[i] * state.w[i] - c.stiffness[i] * (state.y[i] - c.rest[i]);
    }
    for stop in &c.stops {
        let force = CoordinateStop::force(stop, state.y[stop.coordinate], state.w[stop.coordinate]).1;
        switches.note(force.value() != 0.0);
        out.w[stop.coordinate] += force;
    }
    if let Some(contact) = &c.contact {
        let push = contact.push(&state.y, &state.w);
        switches.note(push.value() > 0.0);
        add_scaled(&mut out.w, &contact.direction, push);
    }
    for (i, cable) in plant.cables.iter().enumerate() {
        let (_, _, tension) = plant.cable(i, state, inputs, elapsed_s);
        switches.note(tension.value() > 0.0);
        add_scaled(&mut out.w, &cable.jacobian, -tension);
        if let Some(friction) = &cable.friction {
            let at = plant.mechanism.frictions.len() + i;
            let sliding = state.joint_z[at];
            // What has been taken along the whole cable above, corrected to what arrives.
            friction.shares(&state.y, sliding, |j, share| out.w[j] -= tension * (share - 1.0) * friction.far[j]);
            out.joint_z[at] = friction.law.rate_1_s(sliding, friction.sliding_m_s(&state.w));
        }
        for coupling in plant.mechanism.couplings.iter().filter(|c| c.cable == i) {
            add_scaled(&mut out.w, &coupling.direction, coupling.lever_m * tension);
        }
    }
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let forces = plant.muscle_forces(i, state, inputs, elapsed_s);
        switches.note(forces.stop_n.value() > 0.0);
        add_scaled(&mut out.w, &muscle.jacobian, -forces.pull_n());
        if let Some(friction) = &muscle.friction {
            out.z[i] = friction.rate(state.z[i], forces.speed_m_s);
        }
        if let Drive::Hydraulic { chain, syringe_area_m2, .. } = &muscle.drive {
            let inflow = piston_m_s[i] * *syringe_area_m2;
            chain.rates(&state.chains[i], inflow, forces.port, &mut out.chains[i]);
            state.chains[i].boiling.iter().for_each(|b| switches.note(*b));
        }
        let slow = muscle.slow_at..muscle.slow_at + muscle.extras.slow_states();
        if !slow.is_empty() {
            muscle.extras.slow_rates(forces.elongation_m, &state.slow[slow.clone()], &mut out.slow[slow]);
        }
    }
    mechanism_rates(plant, state, out, &mut switches);
    switches
}

/// Dry frictions, walls and loads of the mechanism.
fn mechanism_rates<D: Scalar>(plant: &Plant<D>, state: &PlantState<D>, out: &mut Rates<D>, switches: &mut Switches) {
    let extras = &plant.mechanism;
    for (i, friction) in extras.frictions.iter().enumerate() {
        let zero = D::constant(0.0);
        add_scaled(&mut out.w, &friction.direction, -friction.law.force_n(state.joint_z[i], zero));
        out.joint_z[i] = friction.law.rate(state.joint_z[i], dot(&friction.direction, &state.w));
    }
    for w in &extras.walls {
        let angle = dot(&w.direction, &state.y);
        switches.note(w.wall.is_met(angle) && w.wall.stiffness_n_m_rad.value() != 0.0);
        add_scaled(&mut out.w, &w.direction, w.wall.torque_n_m(angle));
    }
    for load in &extras.loads {
        add_scaled(&mut out.w, &load.direction, load.force);
    }
}

/// Directions of the dry frictions, in the order of [`PlantState::joint_z`].
fn dry_frictions<D>(plant: &Plant<D>) -> impl Iterator<Item = &[f64]> {
    let joints = plant.mechanism.frictions.iter().map(|f| f.direction.as_slice());
    joints.chain(plant.cables.iter().map(|c| c.friction.as_ref().map_or(&[][..], |f| f.far.as_slice())))
}

fn friction_tangent<D: Scalar>(law: &Friction<D>, z: D, speed: D) -> FrictionTangent<D> {
    let slopes = law.rate_jacobian(z, speed);
    FrictionTangent { force_per_z: law.m0_n, rate_per_z: slopes.drate_dz, rate_per_v: slopes.drate_dv }
}

/// The sliding state grows as the far end is drawn in, against the levers' sign: two signs that cancel.
fn sliding_tangent<D: Scalar>(
    friction: &CableFriction<D>,
    state: &PlantState<D>,
    sliding: D,
    tension: D,
) -> FrictionTangent<D> {
    let speed = friction.sliding_m_s(&state.w);
    let pace = speed.abs() / friction.law.presliding_m;
    let along = if speed.value() < 0.0 { sliding + 1.0 } else { -sliding + 1.0 };
    FrictionTangent {
        force_per_z: -friction.slope_n(&state.y, tension),
        rate_per_z: -pace,
        rate_per_v: -(along / friction.law.presliding_m),
    }
}

/// Keeps the greatest energy of walls that soften.
fn remember_greatest<D: Scalar>(plant: &Plant<D>, state: &mut PlantState<D>) {
    for (i, muscle) in plant.muscles.iter().enumerate().filter(|(_, m)| m.extras.mullins.is_some()) {
        let elongation = dot(&muscle.jacobian, &state.y) + muscle.elongation_0_m;
        let energy = muscle.elastic.wall_energy_j(elongation - muscle.extras.set_m(muscle.slow(state)));
        if energy.value() > state.greatest_j[i].value() {
            state.greatest_j[i] = energy;
        }
    }
}

/// Which of the plant's one-sided elements act, as one number (a collision only delays new tangents).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Switches(u64);

impl Switches {
    fn note(&mut self, acts: bool) {
        self.0 = self.0.rotate_left(1) ^ u64::from(acts);
    }
}

fn move_to<D: Scalar>(to: &mut PlantState<D>, from: &PlantState<D>, k: &Rates<D>, h: f64) {
    copy(to, from);
    advance(to, k, h);
}

/// Copies without allocating; both states belong to the same plant.
fn copy<D: Scalar>(to: &mut PlantState<D>, from: &PlantState<D>) {
    to.y.copy_from_slice(&from.y);
    to.w.copy_from_slice(&from.w);
    to.z.copy_from_slice(&from.z);
    to.joint_z.copy_from_slice(&from.joint_z);
    to.slow.copy_from_slice(&from.slow);
    to.greatest_j.copy_from_slice(&from.greatest_j);
    for (t, f) in to.chains.iter_mut().zip(&from.chains) {
        t.copy_from(f);
    }
    to.piston_ahead_m.copy_from_slice(&from.piston_ahead_m);
}

fn advance<D: Scalar>(state: &mut PlantState<D>, k: &Rates<D>, h: f64) {
    for (x, &k) in state.y.iter_mut().zip(&k.y) {
        *x += k * h;
    }
    for (x, &k) in state.w.iter_mut().zip(&k.w) {
        *x += k * h;
    }
    for (x, &k) in state.z.iter_mut().zip(&k.z) {
        *x += k * h;
    }
    for (x, &k) in state.joint_z.iter_mut().zip(&k.joint_z) {
        *x += k * h;
    }
    for (x, &k) in state.slow.iter_mut().zip(&k.slow) {
        *x += k * h;
    }
    for (x, k) in state.chains.iter_mut().zip(&k.chains) {
        x.move_by(k, h);
    }
}

/// `matrix += scale * j j^T`.
fn add_outer<D: Scalar>(matrix: &mut [D], j: &[f64], scale: D) {
    let n = j.len();
    for (row, &a) in j.iter().enumerate().filter(|(_, a)| **a != 0.0) {
        for (column, &b) in j.iter().enumerate().filter(|(_, b)| **b != 0.0) {
            matrix[row * n + column] += scale * (a * b);
        }
    }
}

/// `x += scale * j`.
fn add_scaled<D: Scalar>(x: &mut [D], j: &[f64], scale: D) {
    for (x, &a) in x.iter_mut().zip(j).filter(|(_, a)| **a != 0.0) {
        *x += scale * a;
    }
}
