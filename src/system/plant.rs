//! The coupled system of a scene as equations: hydraulics, muscles, cables and the mechanism's coordinates.
//!
//! Coordinates `y` are the mechanism's reduced joint coordinates followed by the free ends of those muscles that pull
//! through a cable. Every muscle's elongation and every cable's stretch is linear in `y` over one step, so all of them
//! act as `-J^T F`. The mechanism enters as `M, D, K` and one-sided stops ([`Coordinates`]): taken from rapier and
//! renewed every step in a full scene, constant in a reduced one. Nothing here knows rapier.

use crate::hydraulics::{Chain, Port};
use crate::muscle::{Friction, Stop};
use crate::scalar::Scalar;

use super::coordinates::Coordinates;
use super::elastic::{Elastic, ElasticPoint};
use super::extras::{CableFriction, MechanismExtras, MuscleExtras};
use super::laws::{Acts, PlantLaws};
use super::posed::{Lean, Posed};
use super::state::{Parts, PlantState, sized, sized_mut};

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
    /// What effects add, and where its slow states begin in [`PlantState`].
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
    /// What derivatives and lanes change of a lever that follows the pose; none of plain numbers.
    pub lean: Option<Box<Lean<D>>>,
}

/// The whole system.
#[derive(Clone, Debug)]
pub struct Plant<D> {
    pub coordinates: Coordinates<D>,
    pub muscles: Vec<MusclePlant<D>>,
    pub cables: Vec<CablePlant<D>>,
    pub mechanism: MechanismExtras<D>,
    /// Laws that the scene has written down; none costs nothing.
    pub laws: Option<Box<PlantLaws<D>>>,
    /// What follows the pose in a plant that no engine renews; none where nothing does.
    pub posed: Option<Box<Posed<D>>>,
}

/// Inputs over one fine step: their value at its start and the (constant) slope, SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct InputSpan {
    pub value: f64,
    pub slope: f64,
}

/// An instant of a run: a state, or another row of numbers in its place, and the inputs `elapsed_s` into their spans.
#[derive(Clone, Copy, Debug)]
pub(super) struct Instant<'a, D, const N: usize = 0> {
    /// What does not move within a step.
    pub state: &'a PlantState<D>,
    pub at: Parts<'a, D, N>,
    pub inputs: &'a [InputSpan],
    pub elapsed_s: f64,
}

impl<'a, D: Scalar, const N: usize> Instant<'a, D, N> {
    /// That of a state.
    #[inline]
    pub fn of(state: &'a PlantState<D>, inputs: &'a [InputSpan], elapsed_s: f64) -> Self {
        Self { state, at: state.layout.parts(&state.row), inputs, elapsed_s }
    }

    /// Time of the run's clock, s.
    #[inline]
    pub fn time_s(&self) -> f64 {
        self.state.time_s + self.elapsed_s
    }

    /// Value of an input.
    #[inline]
    pub fn input(&self, index: usize) -> f64 {
        self.inputs[index].value + self.elapsed_s * self.inputs[index].slope
    }
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
    /// A muscle that does nothing.
    pub(super) fn none() -> Self {
        let zero = D::constant(0.0);
        Self {
            elongation_m: zero,
            speed_m_s: zero,
            pressure_pa: zero,
            elastic_n: zero,
            friction_n: zero,
            damping_n: zero,
            stop_n: zero,
            stiffness_n_m: zero,
            area_m2: zero,
            port: Port { outflow_m3_s: zero, compliance_m3_pa: zero },
        }
    }

    /// Everything the muscle pulls with, N; > 0 pulls the end towards the muscle.
    pub fn pull_n(&self) -> D {
        self.elastic_n + self.friction_n + self.damping_n - self.stop_n
    }
}

impl<D: Scalar> MusclePlant<D> {
    /// The forces at elongation, speed, pressure and friction state.
    ///
    /// `slow` are the muscle's slow states, `greatest_j` the greatest energy of its wall so far.
    #[inline]
    pub fn forces(
        &self,
        elongation_m: D,
        speed_m_s: D,
        pressure_pa: D,
        z: D,
        slow: &[D],
        greatest_j: D,
    ) -> MuscleForces<D> {
        self.forces_and_elastic(elongation_m, speed_m_s, pressure_pa, z, slow, greatest_j).0
    }

    /// The same, with the elastic law that they rest on.
    #[inline(always)]
    fn forces_and_elastic(
        &self,
        elongation_m: D,
        speed_m_s: D,
        pressure_pa: D,
        z: D,
        slow: &[D],
        greatest_j: D,
    ) -> (MuscleForces<D>, ElasticPoint<D>) {
        let zero = D::constant(0.0);
        let (law, (extra_n, extra_k)) = if self.extras.acts {
            let seen = elongation_m - self.extras.set_m(slow);
            let law = self.elastic.softened(seen, pressure_pa, self.extras.mullins.as_ref(), greatest_j);
            (law, self.extras.pull_and_stiffness(elongation_m, slow))
        } else {
            (self.elastic.at(elongation_m, pressure_pa), (zero, zero))
        };
        let friction_n = self.friction.as_ref().map_or(zero, |f| f.force_n(z, pressure_pa));
        let stop = self.stop.as_ref().map(|s| s.push(elongation_m, speed_m_s));
        let (stop_n, stop_k) = stop.map_or((zero, zero), |s| (s.push_n, -s.dpush_de));
        let forces = MuscleForces {
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
        };
        (forces, law)
    }

    fn port(&self, law: &ElasticPoint<D>, speed_m_s: D, pressure_pa: D) -> Port<D> {
        let (mut outflow_m3_s, mut compliance_m3_pa) = (law.area_m2 * speed_m_s, law.compliance_m3_pa);
        let x = &self.extras;
        if x.acts {
            let (compliance, flow) = x.line_load(pressure_pa);
            compliance_m3_pa += compliance;
            outflow_m3_s += flow;
        }
        Port { outflow_m3_s, compliance_m3_pa }
    }

    /// The muscle's part of the slow states.
    #[inline]
    pub(super) fn slow<'a, const N: usize>(&self, at: &Parts<'a, D, N>) -> &'a [D] {
        if self.extras.acts { &at.slow()[self.slow_at..self.slow_at + self.extras.slow_states()] } else { &[] }
    }

    /// Elongation at the coordinates `y`, m.
    #[inline]
    pub(super) fn elongation_m<const N: usize>(&self, y: &[D]) -> D {
        dot::<_, N>(&self.jacobian, y) + self.elongation_0_m
    }
}

impl<D: Scalar> CablePlant<D> {
    /// Stretch and stretching rate.
    #[inline]
    pub(super) fn stretch_and_rate<const N: usize>(&self, now: &Instant<D, N>) -> (D, D) {
        let mut stretch = self.stretch_0_m + dot::<_, N>(&self.jacobian, now.at.y());
        let mut rate = dot::<_, N>(&self.jacobian, now.at.w());
        if let Some((input, gain)) = self.drive {
            stretch += gain * now.input(input);
            rate += gain * now.inputs[input].slope;
        }
        if let Some(lean) = &self.lean {
            let more = lean.stretch_and_rate(now.at.y(), now.at.w());
            (stretch, rate) = (stretch + more.0, rate + more.1);
        }
        (stretch, rate)
    }

    /// Stretch, stretching rate and tension; the tension is never negative and zero when slack.
    #[inline]
    pub(super) fn pull<const N: usize>(&self, now: &Instant<D, N>) -> (D, D, D) {
        let (stretch, rate) = self.stretch_and_rate(now);
        if stretch.is_below(0.0) {
            return (stretch, rate, D::constant(0.0));
        }
        let tension = self.stiffness_n_m * stretch + self.damping_n_s_m * rate;
        (stretch, rate, if tension.is_above(0.0) { tension } else { D::constant(0.0) })
    }
}

impl<D: Scalar> Plant<D> {
    /// Number of coordinates.
    pub(crate) fn dim(&self) -> usize {
        self.coordinates.damping.len()
    }

    /// Pressure at the muscle, gauge, Pa.
    pub fn muscle_pressure(&self, muscle: usize, state: &PlantState<D>, inputs: &[InputSpan], elapsed_s: f64) -> D {
        self.pressure::<0>(muscle, &Instant::of(state, inputs, elapsed_s))
    }

    #[inline]
    pub(super) fn pressure<const N: usize>(&self, muscle: usize, now: &Instant<D, N>) -> D {
        match &self.muscles[muscle].drive {
            Drive::Hydraulic { chain, .. } => now.at.line(muscle)[chain.segments()],
            Drive::Pressure { pressure } => D::constant(now.input(*pressure)),
        }
    }

    /// Forces of one muscle at a state, `elapsed_s` into the span of the inputs.
    pub(crate) fn muscle_forces(
        &self,
        muscle: usize,
        state: &PlantState<D>,
        inputs: &[InputSpan],
        elapsed_s: f64,
    ) -> MuscleForces<D> {
        self.forces::<0>(muscle, &Instant::of(state, inputs, elapsed_s))
    }

    /// Forces of one muscle at an instant.
    pub(super) fn forces<const N: usize>(&self, muscle: usize, now: &Instant<D, N>) -> MuscleForces<D> {
        self.forces_in(muscle, now, &mut None)
    }

    /// The same with room for what laws do, kept from one instant to the next.
    pub(super) fn forces_in<const N: usize>(
        &self,
        muscle: usize,
        now: &Instant<D, N>,
        room: &mut Option<Acts<D>>,
    ) -> MuscleForces<D> {
        let Some(laws) = &self.laws else { return self.stock_forces(muscle, now) };
        self.forces_seen(muscle, now, Some(laws.acting(self, now, room)))
    }

    /// The same where what laws do at the instant is known.
    #[inline]
    pub(super) fn forces_seen<const N: usize>(
        &self,
        muscle: usize,
        now: &Instant<D, N>,
        acts: Option<&Acts<D>>,
    ) -> MuscleForces<D> {
        let Some(acts) = acts else { return self.stock_forces(muscle, now) };
        let (m, z) = (&self.muscles[muscle], now.at.z(muscle));
        let pressure = self.pressure(muscle, now);
        let (elongation, speed) = (m.elongation_m::<N>(now.at.y()), dot::<_, N>(&m.jacobian, now.at.w()));
        let (slow, greatest) = (m.slow(&now.at), now.state.greatest_j[muscle]);
        let (mut forces, law) = m.forces_and_elastic(elongation, speed, pressure, z, slow, greatest);
        m.put_under((&mut forces, &law), &acts.muscles[muscle], z, slow, greatest);
        forces
    }

    /// Forces of one muscle without laws.
    #[inline]
    pub(super) fn stock_forces<const N: usize>(&self, muscle: usize, now: &Instant<D, N>) -> MuscleForces<D> {
        let m = &self.muscles[muscle];
        let pressure = self.pressure(muscle, now);
        let (elongation, speed) = (m.elongation_m::<N>(now.at.y()), dot::<_, N>(&m.jacobian, now.at.w()));
        m.forces(elongation, speed, pressure, now.at.z(muscle), m.slow(&now.at), now.state.greatest_j[muscle])
    }

    /// Whether anything rubs dry, or could with an effect.
    pub(super) fn may_rub(&self) -> bool {
        self.muscles.iter().any(|m| m.friction.is_some()) || !self.cables.is_empty()
    }

    /// Which cables pull and which stops of the mechanism and the coils are met, one bit each.
    ///
    /// `room` is for what laws do, and may be kept for the next instant.
    pub(super) fn pulling<const N: usize>(&self, now: &Instant<D, N>, room: &mut Option<Acts<D>>) -> u64 {
        let (y, w) = (now.at.y(), now.at.w());
        let mut bits = 0;
        let mut note = |acts: bool| bits = bits << 1 | u64::from(acts);
        match self.laws.as_ref().filter(|laws| laws.on_cables()) {
            None => self.cables.iter().for_each(|c| note(c.pull(now).2.is_above(0.0))),
            Some(laws) => laws.tensions(self, now, room).iter().for_each(|tension| note(tension.is_above(0.0))),
        }
        self.coordinates.stops.iter().for_each(|s| note(s.force(y[s.coordinate], w[s.coordinate]).0.is_above(0.0)));
        for muscle in self.muscles.iter().filter(|m| m.stop.is_some()) {
            note(muscle.elongation_m::<N>(y).is_below(0.0));
        }
        // A wall without stiffness is none.
        for w in &self.mechanism.walls {
            note(!w.wall.stiffness_n_m_rad.is_at(0.0) && w.wall.is_met(dot::<_, N>(&w.direction, y)));
        }
        bits
    }

    /// Stretch, stretching rate and tension of a cable; the tension is never negative and zero when slack.
    pub fn cable(&self, cable: usize, state: &PlantState<D>, inputs: &[InputSpan], elapsed_s: f64) -> (D, D, D) {
        self.cable_in(cable, &Instant::of(state, inputs, elapsed_s), &mut None)
    }

    /// The same with room for what laws do, kept from one instant to the next.
    pub(super) fn cable_in(&self, cable: usize, now: &Instant<D>, room: &mut Option<Acts<D>>) -> (D, D, D) {
        let Some(laws) = &self.laws else { return self.cables[cable].pull(now) };
        let pull = laws.cable(cable, self, now, laws.acting(self, now, room));
        (pull.stretch_m, pull.rate_m_s, pull.tension_n)
    }

    /// How many inputs the plant reads, at least.
    pub(super) fn inputs(&self) -> usize {
        let of_muscles = self.muscles.iter().map(|m| match m.drive {
            Drive::Hydraulic { plunger, .. } => plunger,
            Drive::Pressure { pressure } => pressure,
        });
        let of_cables = self.cables.iter().filter_map(|c| c.drive).map(|(input, _)| input);
        of_muscles.chain(of_cables).max().map_or(0, |last| last + 1)
    }
}

/// `sum a_i x_i`; `N` as for [`sized`].
#[inline]
pub(super) fn dot<D: Scalar, const N: usize>(a: &[f64], x: &[D]) -> D {
    sized::<N, _>(a).iter().zip(sized::<N, _>(x)).fold(D::constant(0.0), |sum, (&a, &x)| sum + x * a)
}

/// `x += scale * j`; `N` as for [`sized`].
#[inline]
pub(super) fn add_scaled<D: Scalar, const N: usize>(x: &mut [D], j: &[f64], scale: D) {
    for (x, &a) in sized_mut::<N, _>(x).iter_mut().zip(sized::<N, _>(j)) {
        *x += scale * a;
    }
}
