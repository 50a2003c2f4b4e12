//! Signals injected at a port of the fast model, several at a time.

use rayon::prelude::*;

use crate::effects::Effect;
use crate::scalar::{Lanes, Scalar, take_disagreement};

use super::course::Course;
use super::{Twin, TwinRun, TwinSetting};

/// Signals taken together; the first place stays without a signal.
const TOGETHER: usize = 8;

impl Twin {
    /// What each signal changes of every output, in the unit of its column, by signal, output and sample; none where the model
    /// diverges. A signal holds one value for each sample of the run.
    ///
    /// `at` is a law whose only number is the signal, as an effect. Branches are those of the run without a signal: what comes out
    /// is the response along them, right for small signals.
    pub fn injected(
        &self,
        run: &TwinRun,
        setting: &TwinSetting<f64>,
        at: &Effect<f64>,
        signals: &[Vec<f64>],
    ) -> Vec<Option<Vec<Vec<f64>>>> {
        let groups: Vec<_> =
            signals.par_chunks(TOGETHER - 1).map(|group| self.inject(run, setting, at, group)).collect();
        groups.into_iter().flatten().collect()
    }

    fn inject(
        &self,
        run: &TwinRun,
        setting: &TwinSetting<f64>,
        at: &Effect<f64>,
        signals: &[Vec<f64>],
    ) -> Vec<Option<Vec<Vec<f64>>>> {
        type D = Lanes<TOGETHER>;
        let constant = |effect: &Effect<f64>| Effect {
            entry: effect.entry,
            element: effect.element,
            channel: effect.channel.clone(),
            values: effect.values.iter().map(|&x| D::constant(x)).collect(),
        };
        let setting = TwinSetting {
            parameters: setting.parameters.iter().map(|(p, x)| (p.clone(), D::constant(*x))).collect(),
            effects: setting.effects.iter().chain([at]).map(constant).collect(),
        };
        let (mut plant, state) = self.prepare(&setting);
        let mut course = Course::new(&mut plant, state, run);
        let mut room = None;
        let mut changes = vec![vec![Vec::with_capacity(run.times_s.len()); self.outputs.len()]; signals.len()];
        for k in 0..run.times_s.len() {
            if k > 0 {
                let mean = |lane: usize| match lane.checked_sub(1).and_then(|i| signals.get(i)) {
                    Some(signal) => 0.5 * (signal[k - 1] + signal[k]),
                    None => 0.0,
                };
                if let Some(laws) = &mut plant.laws {
                    laws.set_last(Lanes(std::array::from_fn(mean)));
                }
                let steps = run.plan.as_ref().map_or_else(|| self.steps_by_rule(run, k), |plan| plan[k - 1]);
                course.advance(&mut plant, run, k, steps);
            }
            for (o, output) in self.outputs.iter().enumerate() {
                let Lanes(shown) = output.read(&plant, &course.state, &course.spans, &mut room);
                for (change, value) in changes.iter_mut().zip(&shown[1..]) {
                    change[o].push(value - shown[0]);
                }
            }
        }
        // The first lane has decided; that others would have gone another way is the point.
        take_disagreement();
        let is_finite = |change: &Vec<Vec<f64>>| change.iter().flatten().all(|x| x.is_finite());
        changes.into_iter().map(|change| is_finite(&change).then_some(change)).collect()
    }
}
