//! States of several parameter sets as one.

use crate::scalar::Lanes;

use super::PlantState;

impl<const L: usize> PlantState<Lanes<L>> {
    /// Takes over the states of `L` plants; `false` where their lines boil at different nodes, which cannot be one state.
    pub(in crate::system) fn join(&mut self, states: [&PlantState<f64>; L]) -> bool {
        let Some((first, rest)) = states.split_first() else { return false };
        if rest.iter().any(|state| state.boiling != first.boiling) {
            return false;
        }
        self.boiling.clone_from(&first.boiling);
        self.time_s = first.time_s;
        for (lane, state) in states.iter().enumerate() {
            put(&mut self.row, &state.row, lane);
            put(&mut self.greatest_j, &state.greatest_j, lane);
            put(&mut self.piston_ahead_m, &state.piston_ahead_m, lane);
            put(&mut self.piston_law_m, &state.piston_law_m, lane);
        }
        true
    }

    /// Gives the state of one plant back.
    pub(in crate::system) fn part(&self, lane: usize, state: &mut PlantState<f64>) {
        state.boiling.clone_from(&self.boiling);
        state.time_s = self.time_s;
        take(&self.row, &mut state.row, lane);
        take(&self.greatest_j, &mut state.greatest_j, lane);
        take(&self.piston_ahead_m, &mut state.piston_ahead_m, lane);
        take(&self.piston_law_m, &mut state.piston_law_m, lane);
    }
}

fn put<const L: usize>(to: &mut [Lanes<L>], from: &[f64], lane: usize) {
    to.iter_mut().zip(from).for_each(|(Lanes(to), &from)| to[lane] = from);
}

fn take<const L: usize>(from: &[Lanes<L>], to: &mut [f64], lane: usize) {
    from.iter().zip(to).for_each(|(Lanes(from), to)| *to = from[lane]);
}
