//! Linearisation of the reduced-order model between two samples: derivatives with respect to its state and to signals
//! at ports.

use std::ops::Range;

use crate::effects::Effect;
use crate::scalar::{Jet, Scalar, blended_at_rest};
use crate::system::laws::Acts;
use crate::system::plant::Plant;

use super::course::Course;
use super::{Rom, RomRun, RomSetting};

/// Directions per run, and the number type that carries the derivatives.
pub(super) const TOGETHER: usize = 8;
pub(super) type D = Jet<TOGETHER>;

/// Direction of the derivative, set at the beginning of every interval.
#[derive(Clone, Debug)]
enum Along {
    /// Numbers of the state, by their places.
    State(Vec<usize>),
    /// Signals at this many ports, constant over the interval.
    Ports(usize),
}

/// A run that carries derivatives along a few directions, restarted with every interval.
pub(super) struct Directions<'a> {
    rom: &'a Rom,
    run: &'a RomRun,
    along: Along,
    /// Places of the states that are looked at.
    states: Vec<usize>,
    plant: Plant<D>,
    course: Course<D>,
    room: Option<Acts<D>>,
    pub is_sound: bool,
}

/// Derivatives over some intervals: by interval and direction, the states at its end, then the outputs.
pub(super) struct Columns {
    values: Vec<f64>,
    directions: usize,
    length: usize,
}

impl Columns {
    /// Those of an interval, one after the other.
    pub fn of(&self, interval: usize) -> &[f64] {
        let all = self.directions * self.length;
        &self.values[interval * all..][..all]
    }

    /// That of one direction.
    pub fn column(&self, interval: usize, direction: usize) -> &[f64] {
        &self.of(interval)[direction * self.length..][..self.length]
    }
}

impl<'a> Directions<'a> {
    /// Runs along every one of `states`, several at a time. `memory`: laws that add states.
    pub fn of_state(
        rom: &'a Rom,
        run: &'a RomRun,
        setting: &RomSetting<f64>,
        memory: &[&Effect<f64>],
        states: &[usize],
    ) -> Vec<Self> {
        let along = |some: &[usize]| Along::State(some.to_vec());
        let new = |some: &[usize]| Self::new(rom, run, setting, (memory, &[]), states, along(some));
        states.chunks(TOGETHER).map(new).collect()
    }

    /// Runs along signals at ports, several at a time.
    pub fn of_ports(
        rom: &'a Rom,
        run: &'a RomRun,
        setting: &RomSetting<f64>,
        (memory, ports): (&[&Effect<f64>], &[&Effect<f64>]),
        states: &[usize],
    ) -> Vec<Self> {
        let along = |some: &[&Effect<f64>]| Along::Ports(some.len());
        let new = |some: &[&Effect<f64>]| Self::new(rom, run, setting, (memory, some), states, along(some));
        ports.chunks(TOGETHER).map(new).collect()
    }

    fn new(
        rom: &'a Rom,
        run: &'a RomRun,
        setting: &RomSetting<f64>,
        (memory, ports): (&[&Effect<f64>], &[&Effect<f64>]),
        states: &[usize],
        along: Along,
    ) -> Self {
        let acting = |(i, port): (usize, &&Effect<f64>)| port.lift(|_| D::along(0.0, i));
        let at_rest = memory.iter().map(|law| law.lift(|_| D::from(0.0)));
        let known = setting.effects.iter().map(|effect| effect.lift(D::from)).chain(at_rest);
        let setting = RomSetting {
            parameters: setting.parameters.iter().map(|(p, x)| (p.clone(), D::from(*x))).collect(),
            effects: known.chain(ports.iter().enumerate().map(acting)).collect(),
        };
        let (mut plant, state) = rom.prepare(&setting);
        let course = Course::new(&mut plant, state, run);
        Self { rom, run, along, states: states.to_vec(), plant, course, room: None, is_sound: true }
    }

    fn count(&self) -> usize {
        match &self.along {
            Along::State(states) => states.len(),
            Along::Ports(count) => *count,
        }
    }

    /// Over the intervals that end at these samples.
    pub fn follow(&mut self, samples: Range<usize>) -> Columns {
        let mut values = Vec::with_capacity(samples.len() * self.count() * self.length());
        blended_at_rest(|| {
            for k in samples {
                self.begin();
                let steps = self.rom.steps_in(self.run, k);
                self.course.advance(&mut self.plant, self.run, k, steps);
                self.is_sound &= self.course.is_sound(&self.plant);
                self.read(&mut values);
            }
        });
        Columns { values, directions: self.count(), length: self.length() }
    }

    /// The same at the run's first sample, before any interval.
    pub fn start(&mut self) -> Columns {
        let mut values = Vec::new();
        self.read(&mut values);
        Columns { values, directions: self.count(), length: self.length() }
    }

    fn length(&self) -> usize {
        self.states.len() + self.rom.outputs.len()
    }

    /// Adds the derivatives of state and outputs as they are.
    fn read(&mut self, values: &mut Vec<f64>) {
        let state: Vec<D> = self.course.state.numbers().copied().collect();
        let shown = self.states.iter().map(|&i| state[i]);
        let outputs = self.rom.outputs.iter();
        let read = outputs.map(|o| o.read(&self.plant, &self.course.state, &self.course.spans, &mut self.room));
        let here: Vec<D> = shown.chain(read).collect();
        (0..self.count()).for_each(|d| values.extend(here.iter().map(|x| x.slopes[d])));
    }

    /// Resets the directions for the next interval.
    fn begin(&mut self) {
        for number in self.course.state.numbers_mut() {
            *number = D::constant(number.value());
        }
        let Along::State(own) = &self.along else { return };
        for (i, number) in self.course.state.numbers_mut().enumerate() {
            if let Some(direction) = own.iter().position(|&n| n == i) {
                *number = D::along(number.value, direction);
            }
        }
    }
}
