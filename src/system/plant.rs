//! The coupled system of a scene as equations: hydraulics, muscles, cables and the mechanism's coordinates.
//!
//! Coordinates `y` are the mechanism's reduced joint coordinates followed by the free ends of those muscles that pull
//! through a cable. Every muscle's elongation and every cable's stretch is linear in `y` over one step, so all of them
//! act as `-J^T F`. The mechanism enters as `M, D, K` and one-sided stops ([`Coordinates`]): taken from rapier and
//! renewed every step in a full scene, constant in a reduced one. Nothing here knows rapier.

use crate::hydraulics::{Chain, ChainState, Port};
use crate::muscle::{Friction, Stop};
use crate::scalar::Scalar;

use super::elastic::Elastic;
use super::extras::{CableFriction, MechanismExtras, MuscleExtras};

/// The mechanism as the plant sees it over one step: `M y'' + D y' + K (y - rest) = ...`.
#[derive(Clone, Debug)]
pub struct Coordinates<D> {
    /// Inertia matrix, row by row, kg or kg m²; symmetric, positive definite.
    pub inertia: Vec<D>,
    /// Viscous damping of each coordinate, N s/m or N m s/rad.
    pub damping: Vec<D>,
    /// Spring of each coordinate, N/m or N m/rad, and where it rests.
    pub stiffness: Vec<D>,
    pub rest: Vec<f64>,
    /// Constant generalised force over the step: weights, loads, contact reactions.
    pub force: Vec<D>,
    pub stops: Vec<CoordinateStop>,
    /// What the mechanism touched at the end of the last engine step.
    pub contact: Option<ContactSpring>,
}

/// A contact as the plant foresees it over one engine step: a stiff spring where it was touched last.
///
/// The engine owns contacts; without this the plant would, for one step, drive a gripping jaw through what it holds
/// and take its tension away. Reaction `n max(0, f + k (offset - n . y) - c n . y')`, `f` that of the last step.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSpring {
    /// Direction of the reaction in the coordinates, of unit length.
    pub direction: Vec<f64>,
    pub preload: f64,
    pub offset: f64,
    pub stiffness: f64,
    pub damping: f64,
}

impl ContactSpring {
    /// Push along the direction, never negative.
    pub(super) fn push<D: Scalar>(&self, y: &[D], w: &[D]) -> D {
        let depth = -dot(&self.direction, y) + self.offset;
        let push = depth * self.stiffness - dot(&self.direction, w) * self.damping + self.preload;
        if push.value() > 0.0 { push } else { D::constant(0.0) }
    }
}

/// A one-sided spring on a coordinate: a closed jaw, a closed notch, a coil on its turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoordinateStop {
    pub coordinate: usize,
    pub position: f64,
    /// +1: acts below `position`; -1: acts above it.
    pub side: f64,
    pub stiffness: f64,
    pub damping: f64,
}

impl CoordinateStop {
    /// Depth into the stop, and the force it answers with along the coordinate.
    pub(super) fn force<D: Scalar>(&self, y: D, w: D) -> (D, D) {
        let depth = (-y + self.position) * self.side;
        if depth.value() <= 0.0 {
            return (depth, D::constant(0.0));
        }
        let push = depth * self.stiffness - w * (self.side * self.damping);
        if push.value() <= 0.0 { (depth, D::constant(0.0)) } else { (depth, push * self.side) }
    }
}

/// What sets the pressure in a muscle.
#[derive(Clone, Debug)]
pub enum Drive<D> {
    /// A syringe and a line; `plunger` is the index of its input, in m.
    Hydraulic { chain: Chain<D>, syringe_area_m2: f64, plunger: usize },
    /// A recorded pressure; `pressure` is the index of its input, in Pa.
    Pressure { pressure: usize },
}

/// One muscle with whatever drives it.
#[derive(Clone, Debug)]
pub struct MusclePlant<D> {
    pub drive: Drive<D>,
    pub elastic: Elastic<D>,
    pub friction: Option<Friction<D>>,
    /// Axial damping, N s/m.
    pub damping_n_s_m: D,
    pub stop: Option<Stop<D>>,
    /// `d elongation / d y`; elongation is `elongation_0 + jacobian . y`.
    pub jacobian: Vec<f64>,
    pub elongation_0_m: f64,
    /// What effects add, and where its slow states begin in [`PlantState::slow`].
    pub extras: MuscleExtras<D>,
    pub slow_at: usize,
}

/// A cable that pulls when stretched: `stretch = stretch_0 + jacobian . y + drive(t)`.
#[derive(Clone, Debug)]
pub struct CablePlant<D> {
    pub stiffness_n_m: D,
    pub damping_n_s_m: D,
    pub stretch_0_m: D,
    pub jacobian: Vec<f64>,
    /// An input that pulls at the cable's near end, and how much stretch one unit of it makes, m per input unit.
    pub drive: Option<(usize, f64)>,
    pub friction: Option<CableFriction<D>>,
}

/// The whole system.
#[derive(Clone, Debug)]
pub struct Plant<D> {
    pub coordinates: Coordinates<D>,
    pub muscles: Vec<MusclePlant<D>>,
    pub cables: Vec<CablePlant<D>>,
    pub mechanism: MechanismExtras<D>,
}

/// State of a [`Plant`].
#[derive(Clone, Debug, PartialEq)]
pub struct PlantState<D> {
    /// Coordinates and their rates.
    pub y: Vec<D>,
    pub w: Vec<D>,
    /// Hydraulics of each muscle; of zero segments where the pressure is recorded.
    pub chains: Vec<ChainState<D>>,
    /// Friction state of each muscle, -1..=1 for the stock law.
    pub z: Vec<D>,
    /// Frictions of the mechanism, then the sliding state of each cable.
    pub joint_z: Vec<D>,
    /// Slow states of all muscles' effects, m.
    pub slow: Vec<D>,
    /// Of each muscle: the greatest energy of its wall so far, J, and how far its piston is ahead of the plunger, m.
    pub greatest_j: Vec<D>,
    pub piston_ahead_m: Vec<D>,
}

/// Inputs over one fine step: their value at its start and the (constant) slope, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InputSpan {
    pub value: f64,
    pub slope: f64,
}

/// Forces and slopes of one muscle at one state.
#[derive(Clone, Copy, Debug)]
pub struct MuscleForces<D> {
    pub elongation_m: D,
    pub speed_m_s: D,
    pub pressure_pa: D,
    /// Pull of wall, coil and pressure, `dU/dL - p A`, N.
    pub elastic_n: D,
    pub friction_n: D,
    pub damping_n: D,
    /// Push of the closed coil, N, >= 0.
    pub stop_n: D,
    /// `d pull / d e` of the elastic part and the stop, N/m.
    pub stiffness_n_m: D,
    /// `-d pull / d p`, m².
    pub area_m2: D,
    /// Effective area for the volume, `dV/de`, m².
    pub port: Port<D>,
}

impl<D: Scalar> MuscleForces<D> {
    /// Everything the muscle pulls with, N; > 0 pulls the end towards the muscle.
    pub fn pull_n(&self) -> D {
        self.elastic_n + self.friction_n + self.damping_n - self.stop_n
    }
}

impl<D: Scalar> MusclePlant<D> {
    /// The forces at elongation, speed, pressure and friction state.
    ///
    /// `slow` are the muscle's slow states, `greatest_j` the greatest energy of its wall so far.
    pub fn forces(
        &self,
        elongation_m: D,
        speed_m_s: D,
        pressure_pa: D,
        z: D,
        slow: &[D],
        greatest_j: D,
    ) -> MuscleForces<D> {
        let zero = D::constant(0.0);
        let (law, (extra_n, extra_k)) = if self.has_extras() {
            let seen = elongation_m - self.extras.set_m(slow);
            let law = self.elastic.softened(seen, pressure_pa, self.extras.mullins.as_ref(), greatest_j);
            (law, self.extras.pull_and_stiffness(elongation_m, pressure_pa, slow))
        } else {
            (self.elastic.at(elongation_m, pressure_pa), (zero, zero))
        };
        let friction_n = self.friction.as_ref().map_or(zero, |f| f.force_n(z, pressure_pa));
        let stop = self.stop.as_ref().map(|s| s.push(elongation_m, speed_m_s));
        let (stop_n, stop_k) = stop.map_or((zero, zero), |s| (s.push_n, -s.dpush_de));
        MuscleForces {
            elongation_m,
            speed_m_s,
            pressure_pa,
            elastic_n: law.pull_n + extra_n,
            friction_n,
            damping_n: self.damping_n_s_m * speed_m_s,
            stop_n,
            stiffness_n_m: law.stiffness_n_m + stop_k + extra_k,
            area_m2: law.area_m2,
            port: self.port(&law, speed_m_s, pressure_pa),
        }
    }

    fn has_extras(&self) -> bool {
        let x = &self.extras;
        !x.branches.is_empty()
            || x.mullins.is_some()
            || x.preload.is_some()
            || x.plastic.is_some()
            || !x.forces.is_empty()
    }

    fn port(&self, law: &super::ElasticPoint<D>, speed_m_s: D, pressure_pa: D) -> Port<D> {
        let (mut outflow_m3_s, mut compliance_m3_pa) = (law.area_m2 * speed_m_s, law.compliance_m3_pa);
        let x = &self.extras;
        if x.air.is_some() || x.leak_m3_s_pa.is_some() || x.growth_m3_s.is_some() || !x.flows.is_empty() {
            let (compliance, flow) = x.line_load(pressure_pa);
            compliance_m3_pa += compliance;
            outflow_m3_s += flow;
        }
        Port { outflow_m3_s, compliance_m3_pa }
    }

    /// The muscle's part of [`PlantState::slow`].
    pub(super) fn slow<'a>(&self, state: &'a PlantState<D>) -> &'a [D] {
        &state.slow[self.slow_at..self.slow_at + self.extras.slow_states()]
    }
}

impl<D: Scalar> Plant<D> {
    /// Number of coordinates.
    pub fn dim(&self) -> usize {
        self.coordinates.damping.len()
    }

    /// Pressure at the muscle, gauge, Pa.
    pub fn muscle_pressure(&self, muscle: usize, state: &PlantState<D>, inputs: &[InputSpan], elapsed_s: f64) -> D {
        match &self.muscles[muscle].drive {
            Drive::Hydraulic { chain, .. } => state.chains[muscle].pressure_pa[chain.segments()],
            Drive::Pressure { pressure } => D::constant(inputs[*pressure].value + elapsed_s * inputs[*pressure].slope),
        }
    }

    /// Forces of one muscle at a state, `elapsed_s` into the span of the inputs.
    pub fn muscle_forces(
        &self,
        muscle: usize,
        state: &PlantState<D>,
        inputs: &[InputSpan],
        elapsed_s: f64,
    ) -> MuscleForces<D> {
        let m = &self.muscles[muscle];
        let pressure = self.muscle_pressure(muscle, state, inputs, elapsed_s);
        let elongation = dot(&m.jacobian, &state.y) + m.elongation_0_m;
        let speed = dot(&m.jacobian, &state.w);
        m.forces(elongation, speed, pressure, state.z[muscle], m.slow(state), state.greatest_j[muscle])
    }

    /// Whether anything rubs dry, or could with an effect.
    pub(super) fn may_rub(&self) -> bool {
        self.muscles.iter().any(|m| m.friction.is_some()) || !self.cables.is_empty()
    }

    /// Which cables pull and which stops of the mechanism and the coils are met, one bit each.
    pub(super) fn pulling(&self, state: &PlantState<D>, inputs: &[InputSpan], elapsed_s: f64) -> u64 {
        let cables = (0..self.cables.len()).map(|i| self.cable(i, state, inputs, elapsed_s).2.value() > 0.0);
        let stops = &self.coordinates.stops;
        let stops = stops.iter().map(|s| s.force(state.y[s.coordinate], state.w[s.coordinate]).0.value() > 0.0);
        let coils = self.muscles.iter().filter(|m| m.stop.is_some()).map(|m| {
            let elongation = dot(&m.jacobian, &state.y) + m.elongation_0_m;
            elongation.value() < 0.0
        });
        // A wall without stiffness is none.
        let walls = self.mechanism.walls.iter();
        let walls =
            walls.map(|w| w.wall.stiffness_n_m_rad.value() != 0.0 && w.wall.is_met(dot(&w.direction, &state.y)));
        cables.chain(stops).chain(coils).chain(walls).fold(0, |bits, acts| bits << 1 | u64::from(acts))
    }

    /// Stretch, stretching rate and tension of a cable; the tension is never negative and zero when slack.
    pub fn cable(&self, cable: usize, state: &PlantState<D>, inputs: &[InputSpan], elapsed_s: f64) -> (D, D, D) {
        let c = &self.cables[cable];
        let mut stretch = c.stretch_0_m + dot(&c.jacobian, &state.y);
        let mut rate = dot(&c.jacobian, &state.w);
        if let Some((input, gain)) = c.drive {
            stretch += gain * (inputs[input].value + elapsed_s * inputs[input].slope);
            rate += gain * inputs[input].slope;
        }
        if stretch.value() < 0.0 {
            return (stretch, rate, D::constant(0.0));
        }
        let tension = c.stiffness_n_m * stretch + c.damping_n_s_m * rate;
        (stretch, rate, if tension.value() > 0.0 { tension } else { D::constant(0.0) })
    }
}

/// `sum a_i x_i`; `a` holds few entries that are not zero.
pub(super) fn dot<D: Scalar>(a: &[f64], x: &[D]) -> D {
    a.iter().zip(x).filter(|(a, _)| **a != 0.0).map(|(&a, &x)| x * a).sum()
}
