//! Where laws of the plunger put the pistons.
//!
//! The piston is at `x + f(t, x, p, s)`. Its speed `df/dt` is part of the rates where `f` is smooth; where it jumps (a condition
//! that is met, a play that is taken up, a corner of the plunger's speed) there is no rate, and the way is made up for over the step in
//! which it is seen. What has been made so far is kept in the state, so that no volume is ever lost.

use crate::laws::{Port, SLOPES};
use crate::scalar::Scalar;
use crate::system::plant::{Drive, InputSpan, Instant, Plant};
use crate::system::state::PlantState;

use super::{Acts, Instance, PlantLaws};

/// Places in [`SLOPES`].
const PRESSURE: usize = 2;
const PLUNGER: usize = 6;
const TIME: usize = 7;

/// How `f` moves at one instant.
struct Moves<D> {
    /// With time and plunger, and with the states, m/s.
    by_input_m_s: D,
    by_states_m_s: D,
    by_pressure_m_pa: D,
}

impl<D: Scalar> PlantLaws<D> {
    fn on_pistons(&self) -> impl Iterator<Item = &Instance> {
        self.instances.iter().filter(|i| i.port == Port::Plunger)
    }

    /// Whether some law moves a piston.
    #[inline]
    pub(in crate::system) fn moves_pistons(&self) -> bool {
        self.on_plungers
    }

    /// Adds what a law does to the piston's speed, and its yielding to the syringe's compliance: the part of `f` that follows the
    /// pressure acts as a compliance `-A df/dp`.
    pub(super) fn move_piston<const N: usize>(
        &self,
        instance: &Instance,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
    ) {
        let Drive::Hydraulic { syringe_area_m2, .. } = &plant.muscles[instance.at].drive else { return };
        let moves = self.moves(instance, plant, now, acts);
        acts.piston_m_s[instance.at] += moves.by_input_m_s + moves.by_states_m_s;
        acts.muscles[instance.at].at_mut(Port::Plunger).add -= moves.by_pressure_m_pa * *syringe_area_m2;
    }

    fn moves<const N: usize>(
        &self,
        instance: &Instance,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
    ) -> Moves<D> {
        let programs = &self.laws[instance.law].programs;
        let plunger_m_s = match &plant.muscles[instance.at].drive {
            Drive::Hydraulic { plunger, .. } => now.inputs[*plunger].slope,
            Drive::Pressure { .. } => 0.0,
        };
        self.value(instance, plant, now, acts);
        let slopes = Self::slopes(instance, &mut acts.registers);
        let mut moves = Moves {
            by_input_m_s: slopes.to(TIME) + slopes.to(PLUNGER) * plunger_m_s,
            by_states_m_s: D::constant(0.0),
            by_pressure_m_pa: slopes.to(PRESSURE),
        };
        let states = self.laws[instance.law].states.len();
        if states > 0 {
            let by_state: Vec<D> = (0..states).map(|i| slopes.to(SLOPES.len() + i)).collect();
            self.run(&programs.rates, instance, plant, now, acts);
            let rate = |i: usize| programs.rates.output(i, &acts.scratch);
            moves.by_states_m_s = by_state.into_iter().enumerate().map(|(i, slope)| slope * rate(i)).sum();
        }
        moves
    }

    /// `f` of one law at an instant, m.
    fn ahead_m(&self, instance: &Instance, plant: &Plant<D>, now: &Instant<D>, acts: &mut Acts<D>) -> D {
        self.value(instance, plant, now, acts)
    }

    /// Where each law of a plunger puts its piston: index of the law, of the muscle, m.
    pub(in crate::system) fn pistons(&self, plant: &Plant<D>, now: &Instant<D>) -> Vec<(usize, usize, D)> {
        let mut acts = self.room(plant);
        let at = |i: &Instance| (i.law, i.at, self.ahead_m(i, plant, now, &mut acts));
        self.on_pistons().map(at).collect()
    }

    /// Takes the pistons as the laws have them now.
    pub(super) fn place_pistons(&self, plant: &Plant<D>, state: &mut PlantState<D>, inputs: &[InputSpan]) {
        let pistons = self.pistons(plant, &Instant::of(state, inputs, 0.0));
        state.piston_law_m.fill(D::constant(0.0));
        pistons.into_iter().for_each(|(_, muscle, ahead)| state.piston_law_m[muscle] += ahead);
    }

    /// Adds to the pistons' speeds over a step what no rate tells, and notes in `leads_m` how far that goes.
    #[cold]
    #[inline(never)]
    pub(in crate::system) fn lead_pistons(
        &self,
        plant: &Plant<D>,
        (state, inputs, h): (&PlantState<D>, &[InputSpan], f64),
        acts: &mut Acts<D>,
        (speeds_m_s, leads_m): (&mut [D], &mut [D]),
    ) {
        let now: Instant<D> = Instant::of(state, inputs, 0.0);
        let mut row = state.row.clone();
        let moved = self.followed(plant, &Instant { elapsed_s: h, ..now }, acts, |port| port == Port::Plunger);
        let first = row.len() - moved.len();
        row[first..].copy_from_slice(&moved);
        let then: Instant<D> = Instant { at: state.layout.parts(&row), elapsed_s: h, ..now };
        leads_m.iter_mut().zip(&state.piston_law_m).for_each(|(lead, at)| *lead = -*at);
        for instance in self.on_pistons() {
            let ahead = self.ahead_m(instance, plant, &then, acts);
            let rates = self.moves(instance, plant, &now, acts).by_input_m_s
                + self.moves(instance, plant, &then, acts).by_input_m_s;
            leads_m[instance.at] += ahead - rates * (0.5 * h);
        }
        speeds_m_s.iter_mut().zip(&*leads_m).for_each(|(speed, &lead)| *speed += lead / h);
    }

    /// Notes where the pistons have got to in a step that began at the row `from`; the state is at its end, its clock not yet.
    #[cold]
    #[inline(never)]
    pub(in crate::system) fn note_pistons(
        &self,
        plant: &Plant<D>,
        from: &[D],
        (state, inputs, h): (&mut PlantState<D>, &[InputSpan], f64),
        (acts, leads_m): (&mut Acts<D>, &[D]),
    ) {
        let mut gone: Vec<D> = leads_m.to_vec();
        let after: Instant<D> = Instant::of(state, inputs, h);
        let before: Instant<D> = Instant { at: state.layout.parts(from), elapsed_s: 0.0, ..after };
        for instance in self.on_pistons() {
            let [b, a] = [&before, &after].map(|now| self.moves(instance, plant, now, acts));
            let speed = b.by_input_m_s + a.by_input_m_s + b.by_states_m_s + a.by_states_m_s;
            let pressed = after.at.line(instance.at)[0] - before.at.line(instance.at)[0];
            gone[instance.at] += (speed * h + (b.by_pressure_m_pa + a.by_pressure_m_pa) * pressed) * 0.5;
        }
        state.piston_law_m.iter_mut().zip(gone).for_each(|(at, gone)| *at += gone);
    }
}
