//! Elements that stand alone, over a run: what they show, what the variables of laws go through, and what small signals at their
//! ports change.

use crate::laws::{Law, Symbol};
use crate::recording::PiecewiseLinear;
use crate::scalar::Scalar;
use crate::system::standalone::{Answering, Standalone};

use super::directions::{D, TOGETHER};
use super::inject::{Change, Signals, is_finite};
use super::output::Sensors;
use super::{Rom, RomParameter, RomRun, RomSetting};

/// An element on its way through a run.
struct Played<'a, D> {
    run: &'a RomRun,
    lines: Vec<Option<PiecewiseLinear>>,
    span_s: Option<(f64, f64)>,
    answering: Answering<D>,
}

impl<'a, D: Scalar> Played<'a, D> {
    fn new(element: &Standalone, run: &'a RomRun, setting: &RomSetting<D>) -> Self {
        let numbers = setting.parameters.iter().filter_map(|(parameter, value)| match parameter {
            RomParameter::Standalone(which) => Some((*which, *value)),
            _ => None,
        });
        let lines = run.inputs.iter().map(|x| PiecewiseLinear::new(&run.times_s, x)).collect();
        let span_s = run.times_s.first().copied().zip(run.times_s.last().copied());
        Self { run, lines, span_s, answering: element.begin(numbers, &setting.effects) }
    }

    /// What it shows at a sample, SI; samples must come in order.
    fn show(&mut self, k: usize) -> D {
        let Self { run, lines, span_s, answering } = self;
        answering.show(|i, t| value(lines, i, t), *span_s, run.times_s[k])
    }

    /// What the variables of its laws are there, time last.
    fn reads(&self, k: usize) -> Vec<D> {
        self.answering.reads(|i, t| value(&self.lines, i, t), self.span_s, self.run.times_s[k])
    }
}

fn value(lines: &[Option<PiecewiseLinear>], input: usize, time_s: f64) -> f64 {
    lines[input].as_ref().map_or(0.0, |line| line.value(time_s))
}

impl Rom {
    /// What an element shows over a run, by output; `None` where a law on it comes to what is no number. `before` is called before
    /// every sample.
    pub(super) fn alone<D: Scalar>(
        &self,
        element: &Standalone,
        run: &RomRun,
        setting: &RomSetting<D>,
        mut before: impl FnMut(usize, &mut Answering<D>),
    ) -> Option<Vec<Vec<D>>> {
        let mut played = Played::new(element, run, setting);
        let mut sensors = Sensors::new(&self.outputs, setting);
        let mut series = vec![Vec::with_capacity(run.times_s.len()); self.outputs.len()];
        for (k, &time_s) in run.times_s.iter().enumerate() {
            before(k, &mut played.answering);
            let value = played.show(k);
            if !value.is_finite() && !played.answering.laws().is_empty() {
                return None;
            }
            for (output, series) in self.outputs.iter().zip(&mut series) {
                series.push(sensors.show(output, time_s, output.of_element(value)));
            }
        }
        super::output::are_shown(&self.outputs, setting, &series).then_some(series)
    }

    /// Series of the first variable of each law on the element; empty for others.
    pub(super) fn visited_alone(
        &self,
        element: &Standalone,
        run: &RomRun,
        setting: &RomSetting<f64>,
        laws: &[Law],
    ) -> Vec<Vec<f64>> {
        let mut played = Played::new(element, run, setting);
        let mut series = vec![Vec::new(); laws.len()];
        let variables: Vec<Option<usize>> = laws.iter().map(|law| variable(element, law)).collect();
        for k in 0..run.times_s.len() {
            played.show(k);
            let reads = played.reads(k);
            for (series, variable) in series.iter_mut().zip(&variables) {
                series.extend(variable.and_then(|at| reads.get(at)));
            }
        }
        series
    }

    /// Response to each signal per unit at the ports of an element, by port and signal: by derivatives, some signals in a run.
    pub(super) fn injected_alone(
        &self,
        element: &Standalone,
        run: &RomRun,
        setting: &RomSetting<f64>,
        ports: &[Signals],
    ) -> Vec<Vec<Option<Change>>> {
        let of_some = |port: &Signals, some: &[Vec<f64>]| -> Vec<Option<Change>> {
            let setting = setting.with(std::iter::once(port.at.lift(D::constant)));
            let shown = self.alone(element, run, &setting, |k, answering| {
                let mut size = D::constant(0.0);
                some.iter().enumerate().for_each(|(i, signal)| size.slopes[i] = signal[k]);
                answering.laws_mut().set_last(size);
            });
            let along = |i: usize| -> Option<Change> {
                let of = |channel: &Vec<D>| channel.iter().map(|x| x.slopes[i]).collect();
                Some(shown.as_ref()?.iter().map(of).collect()).filter(is_finite)
            };
            (0..some.len()).map(along).collect()
        };
        let of_port = |port: &Signals| port.values.chunks(TOGETHER).flat_map(|some| of_some(port, some)).collect();
        ports.iter().map(of_port).collect()
    }
}

/// Place of a law's first variable among those of its port, if the port is one of the element.
fn variable(element: &Standalone, law: &Law) -> Option<usize> {
    let own = law.symbols.iter().find_map(|symbol| match symbol {
        Symbol::Variable(variable) => Some(variable.quantity),
        _ => None,
    })?;
    let variables = element.has(law.address.port).then(|| law.address.port.spec().variables())?;
    variables.iter().position(|quantity| *quantity == own)
}
