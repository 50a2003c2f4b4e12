//! Several settings of the fast model over one run, side by side.
//!
//! What differs between the settings stands in [`Lanes`]; an instruction then works for several of them. From one sample to
//! the next the model needs nothing but the state, so an interval in which the settings would not all take the same
//! branch is taken back and done for each by itself: results are those of [`Twin::simulate`] to the last bit.

use crate::effects::Effect;
use crate::scalar::{Lanes, take_disagreement};
use crate::system::PlantState;
use crate::system::plant::Plant;

use super::course::Course;
use super::output::Sensors;
use super::{Twin, TwinRun, TwinSetting};

/// Settings taken together, at most.
pub const TOGETHER: usize = 8;
/// And where there are no more than these.
const FEW: usize = TOGETHER / 2;

/// After lanes have disagreed they are kept apart for a while, at most so many intervals: they often do so again at once.
const LONGEST_APART: u32 = 16;

type Outputs = Option<Vec<Vec<f64>>>;

impl Twin {
    /// Simulates every setting as [`Twin::simulate`] would, several at a time. The settings should differ in their
    /// numbers alone; others are simulated one by one.
    pub fn simulate_many(&self, run: &TwinRun, settings: &[TwinSetting<f64>]) -> Vec<Outputs> {
        let mut shown = Vec::with_capacity(settings.len());
        for group in settings.chunks(TOGETHER) {
            let together = match group.len() {
                0 | 1 => None,
                2..=FEW => self.together::<FEW>(run, group),
                _ => self.together::<TOGETHER>(run, group),
            };
            match together {
                Some(together) => shown.extend(together),
                None => shown.extend(group.iter().map(|setting| self.simulate(run, setting))),
            }
        }
        shown
    }

    /// None where the settings cannot go side by side.
    fn together<const L: usize>(&self, run: &TwinRun, group: &[TwinSetting<f64>]) -> Option<Vec<Outputs>> {
        let shown = self.bundle::<L>(run, group)?.follow(self, group);
        Some(shown.into_iter().take(group.len()).collect())
    }

    /// The settings as one; none where that does not go.
    fn bundle<'a, const L: usize>(&self, run: &'a TwinRun, group: &[TwinSetting<f64>]) -> Option<Bundle<'a, L>> {
        if self.axis.is_some() {
            return None;
        }
        // A group that is not full is filled up with its last.
        let filled: [&TwinSetting<f64>; L] = std::array::from_fn(|i| &group[i.min(group.len() - 1)]);
        let setting = side_by_side(filled)?;
        take_disagreement();
        let (plant, state) = self.prepare(&setting);
        if take_disagreement() {
            return None;
        }
        let course = Course::new(&plant, state, run);
        let apart = filled.map(|setting| {
            let (plant, state) = self.prepare(setting);
            let course = Course::new(&plant, state, run);
            Single { plant, course, has_diverged: false }
        });
        Some(Bundle { run, plant, before: course.state.clone(), course, apart, phase: Phase::Together, patience: 0 })
    }
}

/// Settings that differ in their numbers alone, as one setting of lanes.
fn side_by_side<const L: usize>(settings: [&TwinSetting<f64>; L]) -> Option<TwinSetting<Lanes<L>>> {
    let first = settings.first()?;
    let is_like = |other: &TwinSetting<f64>| {
        let parameters = first.parameters.iter().map(|p| &p.0).eq(other.parameters.iter().map(|p| &p.0));
        let effects = first.effects.iter().zip(&other.effects).all(|(a, b)| {
            (a.kind, a.element, &a.channel, a.values.len()) == (b.kind, b.element, &b.channel, b.values.len())
        });
        parameters && effects && first.effects.len() == other.effects.len()
    };
    if !settings.iter().all(|setting| is_like(setting)) {
        return None;
    }
    let lanes = |number: &dyn Fn(&TwinSetting<f64>) -> f64| Lanes(settings.map(number));
    let parameters = first.parameters.iter().enumerate();
    let effects = first.effects.iter().enumerate();
    Some(TwinSetting {
        parameters: parameters.map(|(i, (which, _))| (which.clone(), lanes(&|s| s.parameters[i].1))).collect(),
        effects: effects
            .map(|(i, effect)| Effect {
                kind: effect.kind,
                element: effect.element,
                channel: effect.channel.clone(),
                values: (0..effect.values.len()).map(|j| lanes(&|s| s.effects[i].values[j])).collect(),
            })
            .collect(),
    })
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
    run: &'a TwinRun,
    plant: Plant<Lanes<L>>,
    course: Course<Lanes<L>>,
    /// The lanes' state where the interval began.
    before: PlantState<Lanes<L>>,
    apart: [Single; L],
    phase: Phase,
    /// How many intervals they stay apart the next time.
    patience: u32,
}

impl<const L: usize> Bundle<'_, L> {
    /// Goes through the run; the outputs of each setting, none where it diverges.
    fn follow(mut self, twin: &Twin, group: &[TwinSetting<f64>]) -> [Outputs; L] {
        let last = group.len() - 1;
        let mut sensors: [Sensors<f64>; L] =
            std::array::from_fn(|i| Sensors::new(&twin.outputs, &group[i.min(last)].effects));
        let rows = vec![Vec::with_capacity(self.run.times_s.len()); twin.outputs.len()];
        let mut series: [Vec<Vec<f64>>; L] = std::array::from_fn(|_| rows.clone());
        for k in 0..self.run.times_s.len() {
            if k > 0 {
                self.advance(twin, k);
            }
            for (o, output) in twin.outputs.iter().enumerate() {
                let read = self.read(twin, o);
                for lane in 0..L {
                    series[lane][o].push(sensors[lane].show(output, self.run.times_s[k], read[lane]));
                }
            }
        }
        let mut singles = self.apart.iter();
        series.map(|series| singles.next().is_some_and(|single| !single.has_diverged).then_some(series))
    }

    /// Over the interval that ends at sample `k`.
    fn advance(&mut self, twin: &Twin, k: usize) {
        let steps = self.run.plan.as_ref().map_or_else(|| twin.steps_by_rule(self.run, k), |plan| plan[k - 1]);
        if self.phase == Phase::Together {
            self.before.clone_from(&self.course.state);
            self.course.advance(&self.plant, self.run, k, steps);
            let is_finite = self.course.is_finite();
            if !take_disagreement() && is_finite {
                self.patience /= 2;
                return;
            }
            self.part();
        }
        for single in self.apart.iter_mut().filter(|single| !single.has_diverged) {
            single.course.advance(&single.plant, self.run, k, steps);
            single.has_diverged = !single.course.is_finite();
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
    fn read(&mut self, twin: &Twin, output: usize) -> [f64; L] {
        let output = &twin.outputs[output];
        if self.phase == Phase::Together {
            let Lanes(read) = output.read(&self.plant, &self.course.state, &self.course.spans);
            if !take_disagreement() {
                return read;
            }
            for (lane, single) in self.apart.iter_mut().enumerate() {
                self.course.state.part(lane, &mut single.course.state);
                single.course.spans.clone_from(&self.course.spans);
            }
        }
        self.apart.each_ref().map(|single| output.read(&single.plant, &single.course.state, &single.course.spans))
    }
}
