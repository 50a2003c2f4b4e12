//! What is compared with the recordings: calibrated parameters and a set of effects.

use num_dual::DualSVec64;

use crate::effects::{Effect, EffectSpec, Element, Kind};
use crate::scalar::Scalar;
use crate::system::TwinSetting;

use super::case::{Case, CaseRun};

/// Derivatives that one simulation carries.
pub(super) const LANES: usize = 8;
type Dual = DualSVec64<LANES>;

/// An effect on its element, without numbers.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Placed {
    pub kind: Kind,
    pub element: Element,
    pub channel: Option<String>,
}

impl Placed {
    /// The catalogue's entry.
    pub fn spec(&self) -> &'static EffectSpec {
        crate::effects::find(self.kind)
    }

    /// What a reader is told: `trapped_air in line_2`, `sensor_gain on angle_deg`.
    pub fn title(&self) -> String {
        match &self.channel {
            Some(channel) => format!("{} on {channel}", self.spec().name),
            None => format!("{} in {}", self.spec().name, self.element),
        }
    }

    /// Whether another answer would be given in the same words.
    pub fn says_the_same(&self, other: &Self) -> bool {
        self.spec().name == other.spec().name && self.element == other.element && self.channel == other.channel
    }

    /// With numbers.
    pub fn with(&self, values: &[f64]) -> Effect<f64> {
        Effect { kind: self.kind, element: self.element, channel: self.channel.clone(), values: values.to_vec() }
    }
}

/// A set of effects beside the calibration, and the numbers that are not fitted.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Model {
    pub effects: Vec<Placed>,
    /// All numbers of each effect; those that are fitted are replaced.
    pub values: Vec<Vec<f64>>,
    /// Of each effect: which of its numbers are fitted.
    pub fitted: Vec<Vec<usize>>,
}

impl Model {
    /// The calibration alone.
    pub fn baseline() -> Self {
        Self::default()
    }

    /// One effect more, its numbers starting at `values`.
    pub fn plus(&self, placed: &Placed, values: &[f64]) -> Self {
        let mut model = self.clone();
        let spec = placed.spec();
        model.effects.push(placed.clone());
        model.values.push(values.to_vec());
        model.fitted.push((0..spec.parameters.len()).filter(|&i| spec.parameters[i].is_fitted).collect());
        model
    }

    /// One effect less.
    pub fn without(&self, index: usize) -> Self {
        let mut model = self.clone();
        model.effects.remove(index);
        model.values.remove(index);
        model.fitted.remove(index);
        model
    }

    /// Number of fitted numbers of the effects.
    pub fn effect_numbers(&self) -> usize {
        self.fitted.iter().map(Vec::len).sum()
    }

    /// Where each fitted number of the effects stands: effect and index.
    pub fn places(&self) -> Vec<(usize, usize)> {
        self.fitted.iter().enumerate().flat_map(|(e, list)| list.iter().map(move |&i| (e, i))).collect()
    }

    /// The effects with the fitted numbers at `x`, which follows the calibration in the vector of a fit.
    pub fn effects_at(&self, x: &[f64]) -> Vec<Effect<f64>> {
        self.setting_effects(x, |v, _| v)
    }

    fn setting_effects<D: Scalar>(&self, x: &[f64], lift: impl Fn(f64, usize) -> D) -> Vec<Effect<D>> {
        let mut effects: Vec<Effect<D>> = self
            .effects
            .iter()
            .zip(&self.values)
            .map(|(placed, values)| Effect {
                kind: placed.kind,
                element: placed.element,
                channel: placed.channel.clone(),
                values: values.iter().map(|&v| D::constant(v)).collect(),
            })
            .collect();
        for (k, (effect, index)) in self.places().into_iter().enumerate() {
            effects[effect].values[index] = lift(x[k], k);
        }
        effects
    }
}

/// Simulated channels of one run, and their derivatives to the numbers asked for.
pub(super) struct Response {
    /// By channel, then time.
    pub values: Vec<Vec<f64>>,
    /// By number, then channel, then time.
    pub slopes: Vec<Vec<Vec<f64>>>,
}

/// Simulates a run; `x` holds the calibration, then the fitted numbers of the effects.
pub(super) fn simulate(case: &Case, run: &CaseRun, model: &Model, x: &[f64]) -> Option<Vec<Vec<f64>>> {
    let n = case.parameters.len();
    let setting = TwinSetting {
        parameters: case.parameters.iter().zip(x).map(|(p, &v)| (p.parameter.clone(), v)).collect(),
        effects: model.effects_at(&x[n..]),
    };
    Some(pick(case, run, run.twin.simulate(&run.drive, &setting)?, |v| v))
}

/// Simulates with derivatives to the numbers `wanted` of `x`.
pub(super) fn respond(case: &Case, run: &CaseRun, model: &Model, x: &[f64], wanted: &[usize]) -> Option<Response> {
    let n = case.parameters.len();
    let mut response = Response { values: Vec::new(), slopes: Vec::new() };
    for lanes in wanted.chunks(LANES) {
        let lift = |value: f64, number: usize| match lanes.iter().position(|&l| l == number) {
            Some(lane) => Dual::from_re(value).derivative(lane),
            None => Dual::from_re(value),
        };
        let parameters =
            case.parameters.iter().enumerate().map(|(i, p)| (p.parameter.clone(), lift(x[i], i))).collect();
        let effects = model.setting_effects(&x[n..], |v, k| lift(v, n + k));
        let series = run.twin.simulate(&run.drive, &TwinSetting { parameters, effects })?;
        let series = pick(case, run, series, |v| v);
        for lane in 0..lanes.len() {
            let slope = |d: &Dual| d.eps.unwrap_generic(nalgebra::Const::<LANES>, nalgebra::Const::<1>)[lane];
            response.slopes.push(series.iter().map(|s| s.iter().map(slope).collect()).collect());
        }
        response.values = series.iter().map(|s| s.iter().map(|d| d.re).collect()).collect();
    }
    if wanted.is_empty() {
        response.values = simulate(case, run, model, x)?;
    }
    Some(response)
}

/// The recorded channels at the recorded instants.
fn pick<D: Copy>(case: &Case, run: &CaseRun, series: Vec<Vec<D>>, read: impl Fn(D) -> D) -> Vec<Vec<D>> {
    let picked = case.channels.iter().map(|c| series[c.output][run.lead_in..].iter().map(|&v| read(v)).collect());
    picked.collect()
}
