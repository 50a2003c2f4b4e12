//! Responses of the reduced-order model to small signals at ports.
//!
//! A signal costs a product of a small matrix and a vector for each sample, whatever the model ([`Linear`]).

use nalgebra::DMatrix;
use rayon::prelude::*;

use crate::effects::Effect;

use super::linear::{Block, Linear};
use super::output::Sensors;
use super::{Rom, RomRun, RomSetting};

/// Signals per product of matrices.
const TOGETHER: usize = 32;

/// Signals at a port: a constant law, and its values at each sample of the run.
#[derive(Clone, Debug)]
pub struct Signals<'a> {
    pub at: &'a Effect<f64>,
    pub values: Vec<Vec<f64>>,
}

/// Response of every output, in the unit of its column, by output and sample.
pub type Change = Vec<Vec<f64>>;

impl Rom {
    /// Response to each signal per unit, by port and signal; `None` if the model diverges.
    ///
    /// Branches are those of the run without signals: the response is linear along that run.
    pub fn injected(&self, run: &RomRun, setting: &RomSetting<f64>, ports: &[Signals]) -> Vec<Vec<Option<Change>>> {
        if let Some(element) = &self.standalone {
            return self.injected_alone(element, run, setting, ports);
        }
        let at: Vec<&Effect<f64>> = ports.iter().map(|port| port.at).collect();
        let linear = self.linear(run, setting, &at);
        let Some(changes) = linear.and_then(|linear| through(linear, ports)) else {
            return ports.iter().map(|port| vec![None; port.values.len()]).collect();
        };
        let shown = self.shown_by_sensors(run, setting);
        let mut changes = changes.into_iter().map(|change| Some(shown(change)).filter(is_finite));
        ports.iter().map(|port| changes.by_ref().take(port.values.len()).collect()).collect()
    }

    /// Whether something acts on what the model shows.
    pub(crate) fn has_sensors(&self, setting: &RomSetting<f64>) -> bool {
        super::many::without_sensors(setting) != *setting || self.outputs.iter().any(|o| !o.laws.is_empty())
    }

    /// Applies the sensors to a response.
    fn shown_by_sensors(&self, run: &RomRun, setting: &RomSetting<f64>) -> impl Fn(Change) -> Change {
        let without = super::many::without_sensors(setting);
        let base =
            if self.has_sensors(setting) { self.without_laws_of_sensors().simulate(run, &without) } else { None };
        move |mut change| {
            let Some(base) = &base else { return change };
            for ((output, change), base) in self.outputs.iter().zip(&mut change).zip(base) {
                let [mut with, mut plain] = [(); 2].map(|()| Sensors::new(&self.outputs, setting));
                for ((&time, change), &base) in run.times_s.iter().zip(change).zip(base) {
                    *change = with.show(output, time, base + *change) - plain.show(output, time, base);
                }
            }
            change
        }
    }
}

pub(super) fn is_finite(change: &Change) -> bool {
    change.iter().flatten().all(|x| x.is_finite())
}

/// Responses to the signals at all ports of a linear model; `None` if it diverges.
fn through(mut linear: Linear, signals: &[Signals]) -> Option<Vec<Change>> {
    let each = signals.iter().enumerate();
    let all: Vec<(usize, &[f64])> =
        each.flat_map(|(port, own)| own.values.iter().map(move |signal| (port, &signal[..]))).collect();
    let mut waves: Vec<Waves> = all.chunks(TOGETHER).map(|some| Waves::new(some, &linear)).collect();
    while let Some(block) = linear.next_block() {
        waves.par_iter_mut().for_each(|waves| waves.go_on(&block));
    }
    linear.is_sound().then(|| waves.into_iter().flat_map(|waves| waves.changes).collect())
}

/// Some signals on their way, each with its port: a column of the matrices each.
struct Waves<'a> {
    signals: &'a [(usize, &'a [f64])],
    /// Of each number of the state what they have changed so far.
    state: DMatrix<f64>,
    next: DMatrix<f64>,
    changes: Vec<Change>,
}

impl<'a> Waves<'a> {
    /// At the first sample, where what acts at a port comes to its start.
    fn new(signals: &'a [(usize, &'a [f64])], linear: &Linear) -> Self {
        let (states, count) = (linear.states.len(), signals.len());
        let outputs = linear.outputs();
        let change = |(_, signal): &(usize, &[f64])| vec![Vec::with_capacity(signal.len()); outputs];
        let changes = signals.iter().map(change).collect();
        let [state, next] = [states, states + outputs].map(|rows| DMatrix::zeros(rows, count));
        let mut waves = Self { signals, state, next, changes };
        waves.act(|signal| signal[0], |port| linear.start(port));
        waves.note();
        waves
    }

    /// What acts at the ports, by what it comes to there.
    fn act<'b>(&mut self, acting: impl Fn(&[f64]) -> f64, column: impl Fn(usize) -> &'b [f64]) {
        for (mut next, (port, signal)) in self.next.column_iter_mut().zip(self.signals) {
            let acting = acting(signal);
            next.iter_mut().zip(column(*port)).for_each(|(next, &slope)| *next = acting * slope);
        }
    }

    /// Takes over state and outputs.
    fn note(&mut self) {
        let states = self.state.nrows();
        self.state.copy_from(&self.next.rows(0, states));
        for (change, next) in self.changes.iter_mut().zip(self.next.column_iter()) {
            change.iter_mut().zip(next.iter().skip(states)).for_each(|(series, output)| series.push(*output));
        }
    }

    /// Through some intervals.
    fn go_on(&mut self, block: &Block) {
        for (i, matrix) in block.matrices.iter().enumerate() {
            let k = block.first + i;
            self.act(|signal| 0.5 * (signal[k - 1] + signal[k]), |port| block.column(i, port));
            self.next.gemm(1.0, matrix, &self.state, 1.0);
            self.note();
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::effects::{Element, EntryId, Fitted, Range};
    use crate::laws::{Carrier, LawTable, PORTS, PortSpec, Surroundings};
    use crate::scalar::blended_at_rest;
    use crate::scene::Scene;
    use crate::system::Schedule;
    use crate::system::rom::directions::D;

    const SWING_S: f64 = 1.0;

    /// A law at a port whose size stands before something that swings, or before nothing.
    fn law(spec: &PortSpec, swings: bool) -> Effect<f64> {
        let text = if swings { "a * sin(time_s / scale_s)" } else { "a" }.to_owned();
        let (adds, scales, unit) = match spec.adds.first() {
            Some(unit) => (Some(text), None, unit),
            None => (None, Some(format!("1 + {text}")), &"1"),
        };
        let number = |value: f64, unit: &str| crate::laws::ParameterTable {
            value,
            unit: Some(unit.to_owned()),
            ..crate::laws::ParameterTable::default()
        };
        let all = [("a", number(0.0, unit)), ("scale_s", number(SWING_S, "s"))];
        let parameter: BTreeMap<_, _> =
            all.into_iter().take(1 + usize::from(swings)).map(|(name, n)| (name.to_owned(), n)).collect();
        let port =
            if spec.term.is_empty() { spec.element.to_owned() } else { format!("{}.{}", spec.element, spec.term) };
        let table = LawTable { name: "small".to_owned(), port, adds, scales, parameter, ..LawTable::default() };
        let law = table.law(&Surroundings::default()).expect("a law");
        let range = Range { min: -1.0, max: 1.0 };
        let numbers = law.parameters.iter().map(|p| Fitted { typical: p.value, range, is_fitted: true });
        let entry = EntryId::write(&table, &law, 0, &numbers.collect::<Vec<_>>());
        let values = law.parameters.iter().map(|p| p.value).collect();
        Effect { entry, element: Element::of(entry.element, 0, 1), channel: None, values }
    }

    /// Derivatives to the size of such a law, by output and sample. By numbers whose values are plain arithmetic's, as those of the
    /// matrices: where cables are about to go slack the last bit decides on the branch.
    fn exact(rom: &Rom, run: &RomRun, law: Effect<f64>) -> Vec<Vec<f64>> {
        let Effect { entry, element, channel, values } = law;
        let mut values: Vec<D> = values.into_iter().map(D::from).collect();
        values[0].slopes[0] = 1.0;
        let effects = vec![Effect { entry, element, channel, values }];
        let setting = RomSetting { parameters: Vec::new(), effects };
        let series = blended_at_rest(|| rom.simulate_over(run, &setting)).expect("it does not diverge");
        series.into_iter().map(|channel| channel.into_iter().map(|x| x.slopes[0]).collect()).collect()
    }

    /// Signals sent through the matrices, against derivatives to the size of a law: one that stays is met to rounding; one that
    /// swings is held over each interval, so that what moves at once lags by half of that.
    #[test]
    fn a_small_signal_does_what_a_small_law_does() {
        for name in ["muscle_bench", "antagonistic_pulley", "bending_catheter"] {
            let scene = Scene::load(name, &[]).expect("a stock scene");
            let rom = Rom::new(&scene).expect("a reduced-order model");
            let run = RomRun::of_programs(&scene, &Schedule::even(2.0, 0.002));
            let has = |spec: &&PortSpec| match spec.carrier {
                Carrier::Muscle => true,
                Carrier::Cable | Carrier::Joint => !scene.file.cable.is_empty(),
                Carrier::Alone | Carrier::Sensor => false,
            };
            let ports: Vec<&PortSpec> = PORTS.iter().filter(has).collect();
            let at: Vec<Effect<f64>> = ports.iter().map(|spec| law(spec, false)).collect();
            let swing: Vec<f64> = run.times_s.iter().map(|t| (t / SWING_S).sin()).collect();
            let steady = vec![1.0; swing.len()];
            let values = [vec![steady; TOGETHER], vec![swing]].concat();
            let signals: Vec<Signals> = at.iter().map(|at| Signals { at, values: values.clone() }).collect();
            let found = rom.injected(&run, &RomSetting::default(), &signals);
            let moving = rom.columns().position(|c| ["elongation_mm", "angle_deg", "bend_deg"].contains(&c));
            let moving = moving.expect("what moves");
            for (spec, found) in ports.iter().zip(found) {
                let [steady, other, swinging] = [0, TOGETHER - 1, TOGETHER].map(|i| found[i].as_ref().expect("finite"));
                let port = (name, spec.element, spec.term);
                assert_eq!(steady, other);
                for (change, exact) in steady.iter().zip(exact(&rom, &run, law(spec, false))) {
                    let off = off(change, &exact);
                    assert!(off < 1e-6, "{port:?}: {off}");
                }
                let off = off(&swinging[moving], &exact(&rom, &run, law(spec, true))[moving]);
                assert!(off < 0.05, "{port:?} swings: {off}");
            }
        }
    }

    /// Distance of two series as a share of the second's size; as it is where that is nothing at all.
    fn off(series: &[f64], exact: &[f64]) -> f64 {
        let size = |x: &mut dyn Iterator<Item = f64>| x.map(|x| x * x).sum::<f64>().sqrt();
        let whole = size(&mut exact.iter().copied());
        size(&mut series.iter().zip(exact).map(|(s, x)| s - x)) / if whole > 0.0 { whole } else { 1.0 }
    }
}
