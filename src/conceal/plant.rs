//! The concealing plant: the stock rigs as ordinary differential equations in the order of `physics.md`, with places for
//! whatever may be hidden in them. Nothing here is shared with the simulation that diagnoses.

use super::acting::{Acting, Acts, LAW_SCALE, LAW_STATES, Seen};
use super::drawn::Place;
use super::hidden::{MechanismSecrets, MuscleSecrets};
use super::laws::{boiling, far_pressure_pa, far_volume_m3, preload, softening};
use super::stock::{
    AXIAL_DAMPING_N_S_M, BOILING_PA, CABLE_N_M, CABLE_N_S_M, CLOSED_COIL_N_M, CLOSED_COIL_N_S_M, COIL_AREA_M2,
    COIL_STIFFNESS_N_M, Calibration, END_MASS_KG, Rig, STRING_LOAD_N, SYRINGE_AREA_M2, line_inertance, line_resistance,
};
use super::tube::pull_and_energy;

/// States of one muscle with its line.
pub const MUSCLE_STATES: usize = 12;
/// Volume pressed into the compliance at the syringe, line flow, volume at the muscle, elongation, speed, friction state;
/// then what hidden physics remembers: piston, two branches, set, greatest energy of the wall, volume taken by the barrel.
/// Volumes and not pressures: fluid is then conserved whatever the solver's error, boiling or not.
const V_S: usize = 0;
const Q: usize = 1;
const V_M: usize = 2;
const E: usize = 3;
const V: usize = 4;
const Z: usize = 5;
const PISTON: usize = 6;
const BRANCH: usize = 7;
const BRANCH_2: usize = 8;
const SET: usize = 9;
const GREATEST: usize = 10;
const BARREL: usize = 11;
/// What one unit of the scaled states stands for.
const MUSCLE_SCALE: [f64; MUSCLE_STATES] = [1e-8, 1e-8, 1e-8, 1e-2, 1e-2, 1.0, 1e-3, 1e-2, 1e-2, 1e-3, 1e-2, 1e-9];
/// Angle, speed, friction state.
const JOINT_STATES: usize = 3;
const JOINT_SCALE: [f64; JOINT_STATES] = [1.0, 10.0, 1.0];

/// Time constants of what is a jump in the ideal law, s.
const PISTON_S: f64 = 5e-4;
/// Share of the play over which the plunger gets hold of the piston.
const ENGAGES: f64 = 0.05;
const GREATEST_S: f64 = 5e-3;

/// A plunger at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Plunger {
    pub position_m: f64,
    pub speed_m_s: f64,
}

/// One joint: `J w' = torque - d w - k (angle - rest)`, and a closed stop.
#[derive(Clone, Copy, Debug)]
struct Joint {
    inertia: f64,
    damping: f64,
    stiffness: f64,
    rest_rad: f64,
    closed_n_m_rad: f64,
}

/// A rig with its own numbers and its secrets.
#[derive(Clone, Debug)]
pub struct Plant {
    pub rig: Rig,
    pub calibration: Calibration,
    pub muscles: Vec<MuscleSecrets>,
    pub mechanism: MechanismSecrets,
    pub laws: Vec<Acting>,
    /// Time since the first run began, s: some things age.
    pub begun_s: f64,
}

const HINGES: f64 = 8.0;

impl Plant {
    pub fn new(rig: Rig, calibration: Calibration) -> Self {
        let muscles = vec![MuscleSecrets::default(); rig.muscles()];
        Self { rig, calibration, muscles, mechanism: MechanismSecrets::default(), laws: Vec::new(), begun_s: 0.0 }
    }

    fn joints(&self) -> &'static [Joint] {
        const PULLEY: Joint =
            Joint { inertia: 2.5e-7, damping: 2e-6, stiffness: 0.0, rest_rad: 0.0, closed_n_m_rad: 0.0 };
        const BEND: Joint =
            Joint { inertia: 0.7e-8, damping: 2e-5, stiffness: 1.05e-3, rest_rad: 0.0, closed_n_m_rad: 0.0 };
        const JAW: Joint =
            Joint { inertia: 2e-9, damping: 2e-6, stiffness: 0.9e-3, rest_rad: 0.7, closed_n_m_rad: 0.05 };
        match self.rig {
            Rig::MuscleBench => &[],
            Rig::AntagonisticPulley => &[PULLEY],
            Rig::BendingCatheter => &[BEND, JAW],
        }
    }

    fn first_joint(&self) -> usize {
        self.muscles.len() * MUSCLE_STATES
    }

    fn first_law(&self) -> usize {
        self.first_joint() + self.joints().len() * JOINT_STATES
    }

    pub fn states(&self) -> usize {
        self.first_law() + self.laws.len() * LAW_STATES
    }

    /// What one unit of each scaled state stands for, SI.
    pub fn scales(&self) -> Vec<f64> {
        let mut scales = MUSCLE_SCALE.repeat(self.muscles.len());
        scales.extend(JOINT_SCALE.repeat(self.joints().len()));
        scales.extend(LAW_SCALE.repeat(self.laws.len()));
        scales
    }

    /// The state at rest before the first sample, SI.
    pub fn start(&self) -> Vec<f64> {
        let mut x = vec![0.0; self.states()];
        let e = self.rig.start_elongation_m();
        for muscle in 0..self.muscles.len() {
            let m = &mut x[muscle * MUSCLE_STATES..];
            let (wall, energy) = pull_and_energy(self.calibration.tube_c1_pa, e);
            let pressure = if e > 0.0 { (wall + COIL_STIFFNESS_N_M * e) / COIL_AREA_M2 } else { 0.0 };
            m[V_S] = self.calibration.upstream_compliance_m3_pa * pressure;
            m[V_M] = far_volume_m3(&self.muscles[muscle], pressure);
            m[E] = e;
            (m[BRANCH], m[BRANCH_2], m[GREATEST]) = (e, e, energy);
            m[BARREL] = self.muscles[muscle].barrel_m3_pa * pressure;
        }
        for (i, joint) in self.joints().iter().enumerate() {
            x[self.first_joint() + i * JOINT_STATES] = joint.rest_rad;
        }
        for (i, own) in self.laws.iter().enumerate() {
            let at = self.first_law() + i * LAW_STATES;
            let start = own.start(&self.seen(own.muscle, 0.0, &x));
            x[at..at + LAW_STATES].copy_from_slice(&start);
        }
        x
    }

    /// `dx/dt`, SI, with the plungers at these positions and speeds.
    pub fn rates(&self, t: f64, x: &[f64], plungers: &[Plunger], dx: &mut [f64]) {
        let acts = self.acts(t, x);
        let tensions = self.tensions(x, &acts);
        for (i, plunger) in plungers.iter().enumerate() {
            let own = i * MUSCLE_STATES..(i + 1) * MUSCLE_STATES;
            self.muscle_rates((i, &acts[i]), t, &x[own.clone()], *plunger, tensions[i], &mut dx[own]);
        }
        for i in 0..self.joints().len() {
            self.joint_rates(i, x, tensions, &acts, dx);
        }
        for (i, own) in self.laws.iter().enumerate() {
            let at = self.first_law() + i * LAW_STATES;
            let further: f64 = (0..self.joints().len())
                .map(|j| {
                    let lever = self.lever_m(own.muscle, j);
                    lever * (acts[own.muscle].scale(Place::Lever) - 1.0) * x[self.first_joint() + j * JOINT_STATES + 1]
                })
                .sum();
            let seen = self.seen(own.muscle, t, x);
            own.rates(&seen, &x[at..at + LAW_STATES], further, &mut dx[at..at + LAW_STATES]);
        }
    }

    /// What laws can read around a muscle; the tension is that without laws.
    fn seen(&self, muscle: usize, t: f64, x: &[f64]) -> Seen {
        let m = &x[muscle * MUSCLE_STATES..];
        let joint = |state: usize| if self.joints().is_empty() { 0.0 } else { x[self.first_joint() + state] };
        Seen {
            elongation_m: m[E],
            speed_m_s: m[V],
            near_pa: self.near_pressure_pa(m[V_S]),
            far_pa: far_pressure_pa(&self.muscles[muscle], m[V_M]),
            flow_m3_s: m[Q],
            tension_n: self.tensions(x, &[Acts::NEUTRAL; 2])[muscle],
            angle_rad: joint(0),
            angular_speed_rad_s: joint(1),
            time_s: t,
        }
    }

    /// What the drawn laws do to the terms of each muscle.
    fn acts(&self, t: f64, x: &[f64]) -> [Acts; 2] {
        let mut acts = [Acts::NEUTRAL; 2];
        for (i, own) in self.laws.iter().enumerate() {
            let at = self.first_law() + i * LAW_STATES;
            let seen = self.seen(own.muscle, t, x);
            let whose = if own.law.place.is_of_joint() { 0 } else { own.muscle };
            own.join(&seen, &x[at..at + LAW_STATES], &mut acts[whose]);
        }
        acts
    }

    /// Outputs of the rig in its columns' units, before any sensor's error.
    pub fn outputs(&self, x: &[f64]) -> Vec<f64> {
        let pressure = |muscle: usize| 1e-3 * self.near_pressure_pa(x[muscle * MUSCLE_STATES + V_S]);
        let degrees = |joint: usize| x[self.first_joint() + joint * JOINT_STATES].to_degrees();
        match self.rig {
            Rig::MuscleBench => vec![1e3 * x[E], pressure(0)],
            Rig::AntagonisticPulley => vec![degrees(0), pressure(0), pressure(1)],
            Rig::BendingCatheter => vec![degrees(0), degrees(1), pressure(0), pressure(1)],
        }
    }

    /// What the sensors of [`Rig::more_sensors`] show, in their columns' units: the pull of a muscle, cables' tensions.
    pub fn more_outputs(&self, t: f64, x: &[f64]) -> Vec<f64> {
        match self.rig {
            Rig::MuscleBench => {
                let (s, m) = (&self.muscles[0], &x[..MUSCLE_STATES]);
                vec![self.pull((s, &self.acts(t, x)[0]), t, m, far_pressure_pa(s, m[V_M]))]
            }
            Rig::AntagonisticPulley => self.tensions(x, &self.acts(t, x)).to_vec(),
            Rig::BendingCatheter => Vec::new(),
        }
    }

    /// How far each joint lets the cable of a muscle in, m per rad.
    fn lever_m(&self, muscle: usize, joint: usize) -> f64 {
        match (self.rig, muscle, joint) {
            (Rig::AntagonisticPulley, 0, 0) => 8e-3,
            (Rig::AntagonisticPulley, 1, 0) => -8e-3,
            (Rig::BendingCatheter, 0, 0) => 2.62e-3,
            (Rig::BendingCatheter, 1, 1) => -1.5e-3,
            _ => 0.0,
        }
    }

    /// Tension of each muscle's cable; on the bench the string's load.
    fn tensions(&self, x: &[f64], acts: &[Acts; 2]) -> [f64; 2] {
        if self.rig == Rig::MuscleBench {
            return [STRING_LOAD_N, 0.0];
        }
        let mut tensions = [0.0; 2];
        for (i, tension) in tensions.iter_mut().enumerate() {
            let muscle = &x[i * MUSCLE_STATES..];
            let (lever, stiffness) = (acts[i].scale(Place::Lever), acts[i].scale(Place::CableStiffness));
            let mut stretch = self.rig.start_elongation_m() - muscle[E] - self.mechanism.slack_m[i] - acts[i].travel_m;
            let mut rate = -muscle[V];
            for (j, joint) in self.joints().iter().enumerate() {
                let at = self.first_joint() + j * JOINT_STATES;
                stretch -= self.lever_m(i, j) * (x[at] - joint.rest_rad);
                rate -= self.lever_m(i, j) * lever * x[at + 1];
            }
            if stretch > 0.0 {
                *tension = (CABLE_N_M * stiffness * stretch + CABLE_N_S_M * rate).max(0.0);
            }
        }
        tensions
    }

    fn muscle_rates(
        &self,
        (i, acts): (usize, &Acts),
        t: f64,
        x: &[f64],
        plunger: Plunger,
        tension: f64,
        dx: &mut [f64],
    ) {
        let (s, c) = (&self.muscles[i], &self.calibration);
        let ripple = s.ripple_m * std::f64::consts::TAU * s.ripple_hz * (std::f64::consts::TAU * s.ripple_hz * t).cos();
        let piston_m_s = piston_speed(s, x, plunger, dx) + ripple;
        let (near_pa, far_pa) = (self.near_pressure_pa(x[V_S]), far_pressure_pa(s, x[V_M]));
        dx[BARREL] = if s.barrel_s > 0.0 { (s.barrel_m3_pa * near_pa - x[BARREL]) / s.barrel_s } else { 0.0 };
        // The volumes stand for pressures: a compliance that a law scales fills as much more slowly.
        let kept = SYRINGE_AREA_M2 * piston_m_s - dx[BARREL] - x[Q] - acts.add(Place::SyringeFlow);
        dx[V_S] = kept / acts.scale(Place::SyringeCompliance);
        let returning = if x[Q] < 0.0 { s.return_restriction } else { 0.0 };
        let resistance =
            line_resistance() * (1.0 + (s.restriction + returning) * (1.0 + s.restriction_growth_s_m3 * x[Q].abs()));
        let dropped = resistance * acts.scale(Place::Resistance) * x[Q] + acts.add(Place::PressureDrop);
        dx[Q] = (near_pa - far_pa - dropped) / line_inertance();
        let taken = COIL_AREA_M2 * (1.0 + 2.0 * s.area_growth_1_m * x[E]) * acts.scale(Place::Area) * x[V];
        let kept = x[Q] - taken - self.lost_flow(s, t, far_pa) - acts.add(Place::Outflow);
        dx[V_M] = kept / acts.scale(Place::LineCompliance);
        dx[E] = x[V];
        dx[V] = (tension + s.load_n - self.pull((s, acts), t, x, far_pa)) / END_MASS_KG;
        dx[Z] = (x[V] - x[V].abs() * x[Z]) / c.presliding_length_m;
        memories(s, c, x, dx);
    }

    /// Leak minus growth of the fluid, m³/s.
    fn lost_flow(&self, s: &MuscleSecrets, t: f64, pressure_pa: f64) -> f64 {
        let fading = if s.growth_fades_s > 0.0 { (-(self.begun_s + t) / s.growth_fades_s).exp() } else { 1.0 };
        s.leak * pressure_pa * (1.0 + s.leak_growth_1_pa * pressure_pa) - s.growth_m3_s * fading
    }

    /// Gauge pressure at the syringe.
    fn near_pressure_pa(&self, volume_m3: f64) -> f64 {
        boiling(volume_m3, self.calibration.upstream_compliance_m3_pa * BOILING_PA)
            .unwrap_or(volume_m3 / self.calibration.upstream_compliance_m3_pa)
    }

    /// Pull of a muscle on its end, N.
    fn pull(&self, (s, acts): (&MuscleSecrets, &Acts), t: f64, x: &[f64], pressure_pa: f64) -> f64 {
        let c = &self.calibration;
        let age_s = self.begun_s + t;
        let e = x[E] - x[SET] - acts.add(Place::RestLength);
        let (wall, energy) = pull_and_energy(c.tube_c1_pa, e);
        let wound = COIL_STIFFNESS_N_M * (1.0 - s.coil_loss_1_s * age_s) * acts.scale(Place::Coil);
        let coil = wound * e + preload(s, x[E]);
        let fibre = if age_s < s.fibre_breaks_s { s.fibre_n_m * e } else { 0.0 };
        let branch = |(k, _): (f64, f64), dashpot: f64| {
            let stretch = x[E] - dashpot;
            k * stretch * (1.0 + s.branch_hardening_1_m2 * stretch * stretch)
        };
        let branches = branch(s.branches[0], x[BRANCH]) + branch(s.branches[1], x[BRANCH_2]);
        let level = (c.friction_m0_n + c.friction_m1_n_pa * pressure_pa.max(0.0)) * acts.scale(Place::Friction);
        let friction = level * x[Z];
        let rate = s.rate_force_n * (x[V] / 2e-4).asinh();
        let closed = if x[E] < 0.0 { (-CLOSED_COIL_N_M * x[E] - CLOSED_COIL_N_S_M * x[V]).max(0.0) } else { 0.0 };
        let pushed = pressure_pa * COIL_AREA_M2 * (1.0 + 2.0 * s.area_growth_1_m * x[E]) * acts.scale(Place::Area);
        let wall = wall * softening(s, x[GREATEST] - energy) * acts.scale(Place::Wall);
        wall + coil + fibre + branches + s.cubic_n_m3 * e.powi(3) + friction + rate - pushed
            + AXIAL_DAMPING_N_S_M * acts.scale(Place::Damping) * x[V]
            - closed
            + acts.add(Place::Pull)
    }

    fn joint_rates(&self, i: usize, x: &[f64], tensions: [f64; 2], acts: &[Acts; 2], dx: &mut [f64]) {
        let joint = self.joints()[i];
        let at = self.first_joint() + i * JOINT_STATES;
        let (angle, speed, sliding) = (x[at], x[at + 1], x[at + 2]);
        let m = &self.mechanism;
        // Laws of the joint are those of the first.
        let own = if i == 0 { acts[0] } else { Acts::NEUTRAL };
        let mut torque = own.add(Place::Torque)
            - joint.damping * own.scale(Place::JointDamping) * speed
            - joint.stiffness * own.scale(Place::JointStiffness) * (angle - joint.rest_rad);
        if angle < 0.0 {
            torque -= joint.closed_n_m_rad * angle;
        }
        for (muscle, tension) in tensions.iter().enumerate().take(self.muscles.len()) {
            let passed = acts[muscle].scale(Place::Lever) * acts[muscle].scale(Place::Transmission);
            torque += self.lever_m(muscle, i) * passed * tension * self.capstan_share(i, angle, speed, sliding);
        }
        if i == 0 {
            torque += self.hidden_torque(angle, speed, sliding, tensions);
        }
        let presliding = if m.capstan > 0.0 { 1e-4 / 2.62e-3 } else { m.bearing_rad.max(1e-3) };
        dx[at] = speed;
        dx[at + 1] = torque / joint.inertia;
        dx[at + 2] = (speed - speed.abs() * sliding) / presliding;
    }

    /// Tension left at the hinges over that at the muscle: each hinge sees the wrap before it.
    fn capstan_share(&self, joint: usize, angle: f64, speed: f64, sliding: f64) -> f64 {
        let m = &self.mechanism;
        if m.capstan == 0.0 || joint > 0 || self.rig != Rig::BendingCatheter {
            return 1.0;
        }
        let way = if m.capstan_by_speed { (speed / 0.02).tanh() } else { sliding };
        let at = |hinge: i32| (-m.capstan * way * angle.abs() * f64::from(hinge) / HINGES).exp();
        (1..=HINGES as i32).map(at).sum::<f64>() / HINGES
    }

    fn hidden_torque(&self, angle: f64, speed: f64, sliding: f64, tensions: [f64; 2]) -> f64 {
        let m = &self.mechanism;
        let way = if m.bearing_by_speed { (speed / 0.02).tanh() } else { sliding };
        let beyond = (angle - m.wall_rad).max(0.0);
        let wall = m.wall_n_m_rad * if m.wall_power > 1.0 { beyond.powf(m.wall_power) } else { beyond };
        let closed = (angle / HINGES - m.notch_rad).max(0.0) * m.notch_n_m_rad;
        m.load_n_m + m.coupling_m * tensions[1] - m.bearing_n_m * way - wall - closed
    }
}

fn memories(s: &MuscleSecrets, c: &Calibration, x: &[f64], dx: &mut [f64]) {
    for (state, (_, time_s)) in [BRANCH, BRANCH_2].into_iter().zip(s.branches) {
        dx[state] = if time_s > 0.0 { (x[E] - x[state]) / time_s } else { 0.0 };
    }
    let over = (x[E] - s.set_threshold_m).max(0.0);
    dx[SET] = if s.set_rate_1_s == 0.0 {
        0.0
    } else if s.set_power > 1.0 {
        s.set_rate_1_s * s.set_threshold_m * (over / s.set_threshold_m).powf(s.set_power)
    } else {
        s.set_rate_1_s * over
    };
    dx[GREATEST] = if s.softening == 0.0 {
        0.0
    } else {
        (pull_and_energy(c.tube_c1_pa, x[E] - x[SET]).1 - x[GREATEST]).max(0.0) / GREATEST_S
    };
}

/// Speed of the piston behind its play.
fn piston_speed(s: &MuscleSecrets, x: &[f64], plunger: Plunger, dx: &mut [f64]) -> f64 {
    if s.play_m == 0.0 {
        dx[PISTON] = 0.0;
        return plunger.speed_m_s;
    }
    let ahead = plunger.position_m - x[PISTON];
    let gap = 0.5 * s.play_m;
    // Taken along as soon as the play is used up; a spring alone would add a lag far greater than a small play.
    let used_up = ahead * plunger.speed_m_s.signum() - gap;
    let taken_along = (1.0 + used_up / (ENGAGES * s.play_m)).clamp(0.0, 1.0);
    dx[PISTON] = plunger.speed_m_s * taken_along + (ahead - ahead.clamp(-gap, gap)) / PISTON_S;
    dx[PISTON]
}
