//! Memory of laws: where it starts, its rates, and what follows an expression from step to step.

use crate::laws::{Memory, Port};
use crate::scalar::Scalar;
use crate::system::plant::{InputSpan, Instant, Plant};
use crate::system::state::PlantState;

use super::{Acts, PlantLaws};

/// Puts every state where its law starts it.
pub(super) fn start<D: Scalar>(laws: &PlantLaws<D>, plant: &Plant<D>, state: &mut PlantState<D>, inputs: &[InputSpan]) {
    let mut starts = vec![D::constant(0.0); laws.states];
    let now: Instant<D> = Instant::of(state, inputs, 0.0);
    let mut acts = laws.afresh(plant, &now);
    for instance in &laws.instances {
        let law = &laws.laws[instance.law];
        for (s, own) in law.states.iter().enumerate() {
            let program = if own.follows_start { &law.programs.follows } else { &law.programs.starts };
            starts[instance.state_at + s] = laws.evaluate(program, instance, plant, &now, &mut acts, s);
        }
    }
    state.law_states_mut().copy_from_slice(&starts);
}

impl<D: Scalar> PlantLaws<D> {
    /// Rates of all states at an instant whose acts have been evaluated.
    pub(in crate::system) fn state_rates<const N: usize>(
        &self,
        plant: &Plant<D>,
        now: &Instant<D, N>,
        acts: &mut Acts<D>,
        out: &mut [D],
    ) {
        for instance in &self.instances {
            let law = &self.laws[instance.law];
            if law.states.is_empty() {
                continue;
            }
            self.run(&law.programs.rates, instance, plant, now, acts);
            for s in 0..law.states.len() {
                out[instance.state_at + s] = law.programs.rates.output(s, &acts.scratch);
            }
        }
        self.travel_rates(plant, now, acts, out);
    }

    /// Lets states that follow an expression go with it to the end of a step.
    #[cold]
    #[inline(never)]
    pub(in crate::system) fn follow(&self, plant: &Plant<D>, state: &mut PlantState<D>, inputs: &[InputSpan], h: f64) {
        let follows = |m: &Memory| *m != Memory::Rate;
        if !self.laws.iter().any(|law| law.states.iter().any(|s| follows(&s.memory))) {
            return;
        }
        let now: Instant<D> = Instant::of(state, inputs, h);
        let mut acts = self.afresh(plant, &now);
        let moved = self.followed(plant, &now, &mut acts, |_| true);
        state.law_states_mut().copy_from_slice(&moved);
    }

    /// All states, those that follow an expression (at the `wanted` ports) gone with it to an instant.
    pub(super) fn followed(
        &self,
        plant: &Plant<D>,
        now: &Instant<D>,
        acts: &mut Acts<D>,
        wanted: impl Fn(Port) -> bool,
    ) -> Vec<D> {
        let mut moved = now.at.law_states().to_vec();
        for instance in self.instances.iter().filter(|i| wanted(i.port)) {
            let law = &self.laws[instance.law];
            for (s, own) in law.states.iter().enumerate().filter(|(_, s)| s.memory != Memory::Rate) {
                let before = moved[instance.state_at + s];
                let at = self.evaluate(&law.programs.follows, instance, plant, now, acts, s);
                let half = self.evaluate(&law.programs.widths, instance, plant, now, acts, s) * 0.5;
                moved[instance.state_at + s] = match own.memory {
                    Memory::Greatest => at.select_above(before, at, before),
                    _ => super::play(before, at, half),
                };
            }
        }
        moved
    }

    /// Takes over what the engine changed of the joints: cables go as much further or less.
    pub(in crate::system) fn joints_moved(
        &self,
        plant: &Plant<D>,
        state: &mut PlantState<D>,
        inputs: &[InputSpan],
        by: &[D],
    ) {
        let Some(at) = self.travel_at else { return };
        let now: Instant<D> = Instant::of(state, inputs, 0.0);
        let acts = self.afresh(plant, &now);
        let further: Vec<D> = (0..plant.cables.len())
            .map(|i| {
                let (cable, lever) = (&plant.cables[i], acts.cables[i].at(crate::laws::Port::Lever));
                let step = |(j, &by): (usize, &D)| (cable.lever_under(lever, j, self.joints) - cable.jacobian[j]) * by;
                by.iter().enumerate().take(self.joints).map(step).sum()
            })
            .collect();
        for (state, further) in state.law_states_mut()[at..].iter_mut().zip(further) {
            *state += further;
        }
    }
}
