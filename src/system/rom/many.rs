//! Several settings of the reduced-order model in a SIMD batch.
//!
//! The settings are the lanes of [`Lanes`]. Between samples the model depends only on its state, so an interval in
//! which the lanes would take different branches is repeated for each setting alone: results equal those of
//! [`Rom::simulate`] to the last bit.

use rayon::prelude::*;

use crate::effects::{Effect, ElementKind};
use crate::parallel;
use crate::scalar::{Lanes, take_disagreement};
use crate::system::PlantState;
use crate::system::laws::Acts;
use crate::system::plant::Plant;

use super::course::Course;
use super::output::Sensors;
use super::{Rom, RomParameter, RomRun, RomSetting};

/// Settings taken together, at most.
const TOGETHER: usize = 8;
/// And where there are no more than these.
const FEW: usize = TOGETHER / 2;

/// After lanes have disagreed, they are simulated separately for up to this many intervals, because they often disagree
/// again.
const LONGEST_APART: u32 = 16;

type Outputs = Option<Vec<Vec<f64>>>;

impl Rom {
    /// Simulates every setting as [`Rom::simulate`] would: settings that differ only in sensors once, those that differ
    /// only in values in batches, groups on all threads.
    pub fn simulate_many(&self, run: &RomRun, settings: &[RomSetting<f64>]) -> Vec<Outputs> {
        if self.standalone.is_some() {
            return parallel::map(settings, |setting| self.simulate(run, setting));
        }
        let mut bodies: Vec<RomSetting<f64>> = Vec::with_capacity(settings.len());
        let mut body_of = Vec::with_capacity(settings.len());
        for setting in settings {
            let body = without_sensors(setting);
            let known = bodies.iter().position(|b| *b == body);
            body_of.push(known.unwrap_or(bodies.len()));
            if known.is_none() {
                bodies.push(body);
            }
        }
        let series = self.bodies(run, &bodies);
        let shown = |(setting, body): (&RomSetting<f64>, &usize)| {
            let shown = self.through_sensors(run, setting, series[*body].as_ref()?);
            super::output::are_shown(&self.outputs, setting, &shown).then_some(shown)
        };
        settings.iter().zip(&body_of).map(shown).collect()
    }

    /// What sensors without error would show.
    fn bodies(&self, run: &RomRun, bodies: &[RomSetting<f64>]) -> Vec<Outputs> {
        let found = groups(bodies).into_par_iter().map(|group| {
            let settings: Vec<&RomSetting<f64>> = group.iter().map(|&i| &bodies[i]).collect();
            (self.group(run, &settings), group)
        });
        let mut series = vec![None; bodies.len()];
        for (outputs, group) in found.collect::<Vec<_>>() {
            group.into_iter().zip(outputs).for_each(|(i, outputs)| series[i] = outputs);
        }
        series
    }

    fn group(&self, run: &RomRun, group: &[&RomSetting<f64>]) -> Vec<Outputs> {
        // Levers that follow the pose are the lanes' own at once.
        let together = match group.len() {
            _ if self.plant.posed.is_some() => None,
            0 | 1 => None,
            2..=FEW => self.together::<FEW>(run, group),
            _ => self.together::<TOGETHER>(run, group),
        };
        together.unwrap_or_else(|| group.iter().map(|setting| self.simulate(run, setting)).collect())
    }

    /// None where the settings cannot go side by side.
    fn together<const L: usize>(&self, run: &RomRun, group: &[&RomSetting<f64>]) -> Option<Vec<Outputs>> {
        let shown = self.bundle::<L>(run, group)?.follow(self);
        Some(shown.into_iter().take(group.len()).collect())
    }

    /// The settings as one.
    fn bundle<'a, const L: usize>(&self, run: &'a RomRun, group: &[&RomSetting<f64>]) -> Option<Bundle<'a, L>> {
        // A group that is not full is filled up with its last.
        let filled: [&RomSetting<f64>; L] = std::array::from_fn(|i| group[i.min(group.len() - 1)]);
        let setting = side_by_side(filled);
        take_disagreement();
        let (mut plant, state) = self.prepare(&setting);
        if take_disagreement() {
            return None;
        }
        let course = Course::new(&mut plant, state, run);
        let apart = filled.map(|setting| {
            let (mut plant, state) = self.prepare(setting);
            let course = Course::new(&mut plant, state, run);
            Single { plant, course, has_diverged: false }
        });
        Some(Bundle {
            run,
            plant,
            before: course.state.clone(),
            course,
            room: None,
            apart,
            phase: Phase::Together,
            patience: 0,
        })
    }

    fn through_sensors(&self, run: &RomRun, setting: &RomSetting<f64>, series: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut sensors = Sensors::new(&self.outputs, setting);
        let channels = self.outputs.iter().zip(series);
        let mut show = |(output, values): (_, &Vec<f64>)| {
            run.times_s.iter().zip(values).map(|(&time_s, &value)| sensors.show(output, time_s, value)).collect()
        };
        channels.map(&mut show).collect()
    }
}

pub(super) fn without_sensors(setting: &RomSetting<f64>) -> RomSetting<f64> {
    let mut body = setting.clone();
    body.effects.retain(|effect| effect.element.kind != ElementKind::Sensor);
    body.parameters.retain(|(parameter, _)| !matches!(parameter, RomParameter::SensorLaw(..)));
    body
}

/// Settings of the same shape, by their places in the list, at most [`TOGETHER`] in a group.
fn groups(settings: &[RomSetting<f64>]) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, setting) in settings.iter().enumerate() {
        let has_room = |group: &&mut Vec<usize>| group.len() < TOGETHER && is_like(&settings[group[0]], setting);
        match groups.iter_mut().find(has_room) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    groups
}

/// Whether settings differ in their numbers alone.
fn is_like(one: &RomSetting<f64>, other: &RomSetting<f64>) -> bool {
    let parameters = one.parameters.iter().map(|p| &p.0).eq(other.parameters.iter().map(|p| &p.0));
    let effects = one.effects.iter().zip(&other.effects).all(|(a, b)| {
        (a.entry, a.element, &a.channel, a.values.len()) == (b.entry, b.element, &b.channel, b.values.len())
    });
    parameters && effects && one.effects.len() == other.effects.len()
}

/// Settings that are alike, as one of lanes.
fn side_by_side<const L: usize>(settings: [&RomSetting<f64>; L]) -> RomSetting<Lanes<L>> {
    let first = settings[0];
    let lanes = |number: &dyn Fn(&RomSetting<f64>) -> f64| Lanes(settings.map(number));
    let parameters = first.parameters.iter().enumerate();
    let effects = first.effects.iter().enumerate();
    RomSetting {
        parameters: parameters.map(|(i, (which, _))| (which.clone(), lanes(&|s| s.parameters[i].1))).collect(),
        effects: effects
            .map(|(i, effect)| Effect {
                entry: effect.entry,
                element: effect.element,
                channel: effect.channel.clone(),
                values: (0..effect.values.len()).map(|j| lanes(&|s| s.effects[i].values[j])).collect(),
            })
            .collect(),
    }
}

/// One setting by itself.
struct Single {
    plant: Plant<f64>,
    course: Course<f64>,
    has_diverged: bool,
}

/// Where the state of a [`Bundle`] stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// In the lanes.
    Together,
    /// In the settings by themselves, for so many intervals more.
    Apart(u32),
}

/// Settings on their way through a run.
struct Bundle<'a, const L: usize> {
    run: &'a RomRun,
    plant: Plant<Lanes<L>>,
    course: Course<Lanes<L>>,
    /// For what laws do where outputs are read.
    room: Option<Acts<Lanes<L>>>,
    /// The lanes' state where the interval began.
    before: PlantState<Lanes<L>>,
    apart: [Single; L],
    phase: Phase,
    /// How many intervals they stay apart the next time.
    patience: u32,
}

impl<const L: usize> Bundle<'_, L> {
    /// Goes through the run; what sensors without error would show of each setting, none where it diverges.
    fn follow(mut self, rom: &Rom) -> [Outputs; L] {
        let rows = vec![Vec::with_capacity(self.run.times_s.len()); rom.outputs.len()];
        let mut series: [Vec<Vec<f64>>; L] = std::array::from_fn(|_| rows.clone());
        for k in 0..self.run.times_s.len() {
            if k > 0 {
                self.advance(rom, k);
            }
            for output in 0..rom.outputs.len() {
                let read = self.read(rom, output);
                series.iter_mut().zip(read).for_each(|(series, read)| series[output].push(read));
            }
        }
        let mut singles = self.apart.iter();
        series.map(|series| singles.next().is_some_and(|single| !single.has_diverged).then_some(series))
    }

    /// Over the interval that ends at sample `k`.
    fn advance(&mut self, rom: &Rom, k: usize) {
        let steps = rom.steps_in(self.run, k);
        if self.phase == Phase::Together {
            self.before.clone_from(&self.course.state);
            self.course.advance(&mut self.plant, self.run, k, steps);
            let is_finite = self.course.is_sound(&self.plant);
            if !take_disagreement() && is_finite {
                self.patience /= 2;
                return;
            }
            self.part();
        }
        for single in self.apart.iter_mut().filter(|single| !single.has_diverged) {
            single.course.advance(&mut single.plant, self.run, k, steps);
            single.has_diverged = !single.course.is_sound(&single.plant);
        }
        self.reunite();
    }

    /// Back to where the interval began, each setting by itself.
    fn part(&mut self) {
        for (lane, single) in self.apart.iter_mut().enumerate() {
            self.before.part(lane, &mut single.course.state);
        }
        self.patience = (2 * self.patience).clamp(1, LONGEST_APART);
        self.phase = Phase::Apart(self.patience);
    }

    /// Together again if their time is up and they can be.
    fn reunite(&mut self) {
        let Phase::Apart(left) = self.phase else { return };
        self.phase = Phase::Apart(left.saturating_sub(1));
        if left > 1 || self.apart.iter().any(|single| single.has_diverged) {
            return;
        }
        let states = self.apart.each_ref().map(|single| &single.course.state);
        if self.course.state.join(states) {
            self.course.spans.clone_from(&self.apart[0].course.spans);
            self.phase = Phase::Together;
        }
    }

    /// What an output shows of each setting.
    fn read(&mut self, rom: &Rom, output: usize) -> [f64; L] {
        let output = &rom.outputs[output];
        if self.phase == Phase::Together {
            let Lanes(read) = output.read(&self.plant, &self.course.state, &self.course.spans, &mut self.room);
            if !take_disagreement() {
                return read;
            }
            for (lane, single) in self.apart.iter_mut().enumerate() {
                self.course.state.part(lane, &mut single.course.state);
                single.course.spans.clone_from(&self.course.spans);
            }
        }
        let read = |s: &Single| output.read(&s.plant, &s.course.state, &s.course.spans, &mut None);
        self.apart.each_ref().map(read)
    }
}
