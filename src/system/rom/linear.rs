//! The reduced-order model linearised along a run.
//!
//! From sample to sample:
//!
//! ```text
//! dx[k] = A[k] dx[k-1] + b[k] u[k]        dy[k] = C[k] dx[k-1] + d[k] u[k]
//! ```
//! where `A` and `C` are the same for all that acts, and `b` and `d` for all that acts at one port. Runs that carry exact derivatives
//! yield them ([`Directions`]). Branches are those of the run: what sticks there goes on sticking.

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::effects::Effect;
use crate::laws::Port;

use super::directions::{Columns, Directions, TOGETHER};
use super::{Rom, RomRun, RomSetting};

/// Intervals per batch.
const BLOCK: usize = 256;

/// The linear model of a run in progress, with signals at some ports.
pub struct Linear<'a> {
    rom: &'a Rom,
    /// Places of the states that may change.
    pub states: Vec<usize>,
    of_state: Vec<Directions<'a>>,
    of_ports: Vec<Directions<'a>>,
    start: Vec<Columns>,
    /// The sample at which the next interval ends, and how many there are.
    next: usize,
    samples: usize,
}

/// Some intervals of a linear model.
pub struct Block {
    /// The sample at which the first of them ends.
    pub first: usize,
    /// `[A; C]` of each, outputs in the units of their columns.
    pub matrices: Vec<DMatrix<f64>>,
    columns: Vec<Columns>,
}

impl Block {
    /// `[b; d]` of an interval, for one of the model's ports.
    pub fn column(&self, interval: usize, port: usize) -> &[f64] {
        column(&self.columns, interval, port)
    }
}

impl Rom {
    /// The linear model along a run, for constant laws at ports. `None` for models that are not integrated.
    pub fn linear<'a>(
        &'a self,
        run: &'a RomRun,
        setting: &RomSetting<f64>,
        ports: &[&Effect<f64>],
    ) -> Option<Linear<'a>> {
        if self.standalone.is_some() {
            return None;
        }
        let of_kind = |kind: Port| ports.iter().copied().find(|at| port(at) == Some(kind));
        let memory: Vec<&Effect<f64>> = REMEMBERED.into_iter().filter_map(of_kind).collect();
        let states = self.states_at(setting, &memory);
        let of_state = Directions::of_state(self, run, setting, &memory, &states);
        let mut of_ports = Directions::of_ports(self, run, setting, (&memory, ports), &states);
        let start = of_ports.iter_mut().map(Directions::start).collect();
        Some(Linear { rom: self, states, of_state, of_ports, start, next: 1, samples: run.times_s.len() })
    }

    /// Places of all states.
    fn states_at(&self, setting: &RomSetting<f64>, memory: &[&Effect<f64>]) -> Vec<usize> {
        let mut setting = setting.clone();
        setting.effects.extend(memory.iter().copied().cloned());
        let (plant, state) = self.prepare(&setting);
        state.states_in_use(&plant)
    }
}

impl Linear<'_> {
    /// Initial response to a signal at one of its ports: of the states, then of the outputs.
    pub fn start(&self, port: usize) -> &[f64] {
        column(&self.start, 0, port)
    }

    /// Number of outputs that a response has.
    pub fn outputs(&self) -> usize {
        self.rom.outputs.len()
    }

    /// The next intervals; none at the end of the run.
    pub(crate) fn next_block(&mut self) -> Option<Block> {
        let first = self.next;
        self.next = self.samples.min(first + BLOCK);
        let samples = first..self.next;
        if samples.is_empty() {
            return None;
        }
        let follow = |some: &mut Directions| some.follow(samples.clone());
        let mut state: Vec<Columns> = self.of_state.par_iter_mut().chain(&mut self.of_ports).map(follow).collect();
        let columns = state.split_off(self.of_state.len());
        let matrices = (0..samples.len()).map(|k| self.matrix(&state, k)).collect();
        Some(Block { first, matrices, columns })
    }

    /// Whether everything so far was finite and all laws were in their domain.
    pub fn is_sound(&self) -> bool {
        self.of_state.iter().chain(&self.of_ports).all(|some| some.is_sound)
    }

    fn matrix(&self, state: &[Columns], interval: usize) -> DMatrix<f64> {
        let all = state.iter().flat_map(|c| c.of(interval)).copied();
        let states = self.states.len();
        DMatrix::from_iterator(states + self.outputs(), states, all)
    }
}

/// Ports whose laws give it states of their own: what moved a piston, what a cable travelled besides.
const REMEMBERED: [Port; 2] = [Port::Plunger, Port::Lever];

fn port(at: &Effect<f64>) -> Option<Port> {
    Some(at.entry.unlisted()?.law.address.port)
}

/// Response at the end of an interval to a signal at a port.
fn column(ports: &[Columns], interval: usize, port: usize) -> &[f64] {
    ports[port / TOGETHER].column(interval, port % TOGETHER)
}
