//! The model that is compared with recordings: calibrated parameters and a set of effects.

use std::sync::Arc;

use crate::effects::{Effect, Element, Entry, EntryId};
use crate::system::RomSetting;

use crate::diagnose::case::{Case, CaseRun};

/// An effect on its element, without parameters.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Placed {
    pub entry: EntryId,
    pub element: Element,
    pub channel: Option<String>,
}

impl Placed {
    /// The catalogue's entry.
    pub fn spec(&self) -> &'static Entry {
        self.entry.entry()
    }

    /// What a reader is told: `trapped_air in line_2`, `sensor_gain on angle_deg`.
    pub fn title(&self) -> String {
        match &self.channel {
            Some(channel) => format!("{} on {channel}", self.spec().name),
            None => format!("{} in {}", self.spec().name, self.element),
        }
    }

    /// Whether another answer would be given in the same words.
    pub(crate) fn says_the_same(&self, other: &Self) -> bool {
        self.spec().name == other.spec().name && self.element == other.element && self.channel == other.channel
    }

    /// With parameters.
    pub fn with(&self, values: &[f64]) -> Effect<f64> {
        Effect { entry: self.entry, element: self.element, channel: self.channel.clone(), values: values.to_vec() }
    }
}

/// An effect with parameters to start from; the size is the first of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Variant {
    pub placed: Placed,
    pub values: Vec<f64>,
}

/// Maximum number of relaxation times of one muscle, or of terms of one hypothesis.
const MOST_BRANCHES: usize = 3;

/// The numbers of an effect of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    /// All its parameters; those that are fitted are replaced.
    pub values: Vec<f64>,
    /// Which of them are fitted.
    pub fitted: Vec<usize>,
    /// The run that alone has the effect, by its file. Effects of one place, one for every run, are one effect whose numbers differ from
    /// run to run.
    pub only_in: Option<Arc<str>>,
}

impl Numbers {
    /// Those of an effect of all runs.
    fn of(placed: &Placed, values: &[f64]) -> Self {
        let parameters = &placed.spec().parameters;
        let fitted = (0..parameters.len()).filter(|&i| parameters[i].is_fitted).collect();
        Self { values: values.to_vec(), fitted, only_in: None }
    }
}

/// A set of effects beside the calibration.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Model {
    pub effects: Vec<Placed>,
    /// Those of each effect.
    pub numbers: Vec<Numbers>,
}

impl Model {
    /// The calibration alone.
    pub fn baseline() -> Self {
        Self::default()
    }

    /// Its effects in words.
    pub fn title(&self) -> String {
        if self.effects.is_empty() {
            return "calibration alone".to_owned();
        }
        let one = |i: usize| match self.numbers[i].only_in {
            None => self.effects[i].title(),
            Some(_) => format!("{}, different in each run", self.effects[i].title()),
        };
        let named = (0..self.effects.len()).filter(|i| self.stands_for_itself(*i));
        named.map(one).collect::<Vec<_>>().join(" + ")
    }

    /// One effect more, its parameters starting at `values`.
    pub fn plus(&self, placed: &Placed, values: &[f64]) -> Self {
        self.and(placed.clone(), Numbers::of(placed, values))
    }

    /// One effect more, of which only the size is fitted.
    pub(in crate::diagnose) fn plus_size(&self, placed: &Placed, values: &[f64]) -> Self {
        self.and(placed.clone(), Numbers { fitted: vec![0], ..Numbers::of(placed, values) })
    }

    fn and(&self, placed: Placed, numbers: Numbers) -> Self {
        let mut model = self.clone();
        model.effects.push(placed);
        model.numbers.push(numbers);
        model
    }

    /// One effect more, with numbers of its own in each of these runs.
    pub(in crate::diagnose) fn plus_in_each(&self, placed: &Placed, values: &[f64], files: &[Arc<str>]) -> Self {
        let numbers = |file| Numbers { only_in: Some(Arc::clone(file)), ..Numbers::of(placed, values) };
        files.iter().fold(self.clone(), |model, file| model.and(placed.clone(), numbers(file)))
    }

    /// Whether an effect is of all runs, or the first of those that are one but for their run.
    pub(in crate::diagnose) fn stands_for_itself(&self, effect: usize) -> bool {
        self.of_each_run(effect).first().is_none_or(|first| *first == effect)
    }

    /// The effects that are one with this one but for their run, if it belongs to a run; in the order of the runs.
    pub(in crate::diagnose) fn of_each_run(&self, effect: usize) -> Vec<usize> {
        let is_of_one = |i: usize| self.numbers[i].only_in.is_some();
        if !is_of_one(effect) {
            return Vec::new();
        }
        let is_one = |i: &usize| is_of_one(*i) && self.effects[*i] == self.effects[effect];
        (0..self.effects.len()).filter(is_one).collect()
    }

    /// Whether an effect may be added: once per element, except relaxation, which has a spectrum.
    pub fn takes(&self, placed: &Placed) -> bool {
        let standing = self.effects.iter().filter(|e| *e == placed).count();
        standing < if placed.entry.may_repeat { MOST_BRANCHES } else { 1 }
    }

    /// One effect less.
    pub fn without(&self, index: usize) -> Self {
        let mut model = self.clone();
        model.effects.remove(index);
        model.numbers.remove(index);
        model
    }

    /// The same with one effect moved to the end.
    pub(crate) fn with_last(&self, index: usize) -> Self {
        self.without(index).and(self.effects[index].clone(), self.numbers[index].clone())
    }

    /// Number of fitted parameters of the effects.
    pub(crate) fn effect_parameters(&self) -> usize {
        self.numbers.iter().map(|own| own.fitted.len()).sum()
    }

    /// Where each fitted number of the effects stands: effect and index.
    pub fn places(&self) -> Vec<(usize, usize)> {
        self.numbers.iter().enumerate().flat_map(|(e, own)| own.fitted.iter().map(move |&i| (e, i))).collect()
    }

    /// The effects with the fitted parameters at `x`, which follows the calibration in the vector of a fit.
    pub(crate) fn effects_at(&self, x: &[f64]) -> Vec<Effect<f64>> {
        let all = self.effects.iter().zip(&self.numbers);
        let mut effects: Vec<Effect<f64>> = all.map(|(placed, own)| placed.with(&own.values)).collect();
        for ((effect, index), value) in self.places().into_iter().zip(x) {
            effects[effect].values[index] = *value;
        }
        effects
    }

    /// The same as a run has them; of what differs from run to run, its own, or the mean in a run that nobody recorded.
    pub(crate) fn effects_in(&self, file: Option<&str>, x: &[f64]) -> Vec<Effect<f64>> {
        let all = self.effects_at(x);
        let as_it_is_there = |i: usize| {
            let of_each = self.of_each_run(i);
            match of_each.iter().find(|own| self.numbers[**own].only_in.as_deref() == file) {
                Some(own) => all[*own].clone(),
                None => mean(i, &of_each, &all),
            }
        };
        (0..all.len()).filter(|i| self.stands_for_itself(*i)).map(as_it_is_there).collect()
    }

    /// All numbers of one effect; of one that differs from run to run, their means.
    pub(in crate::diagnose) fn values_of(&self, effect: usize, x: &[f64]) -> Vec<f64> {
        mean(effect, &self.of_each_run(effect), &self.effects_at(x)).values
    }
}

/// An effect with the means of the numbers that each run has, if they differ.
fn mean(effect: usize, of_each: &[usize], all: &[Effect<f64>]) -> Effect<f64> {
    let mut mean = all[effect].clone();
    for (n, value) in mean.values.iter_mut().enumerate().filter(|_| !of_each.is_empty()) {
        *value = of_each.iter().map(|i| all[*i].values[n]).sum::<f64>() / of_each.len() as f64;
    }
    mean
}

impl Model {
    /// Setting of the reduced-order model for a run; `x` holds the calibration, then the fitted parameters of the
    /// effects.
    pub(in crate::diagnose) fn setting(&self, case: &Case, run: &CaseRun, x: &[f64]) -> RomSetting<f64> {
        let parameters = case.rom_parameters(run, x);
        let mut effects = case.known_effects.clone();
        effects.extend(self.effects_in(Some(&run.file), &x[case.parameters.len()..]));
        RomSetting { parameters, effects }
    }

    /// The same for every run of a case.
    pub(in crate::diagnose) fn settings(&self, case: &Case, x: &[f64]) -> Vec<RomSetting<f64>> {
        case.runs.iter().map(|run| self.setting(case, run, x)).collect()
    }
}

/// Simulated channels of one run, and their derivatives to the parameters asked for.
pub(in crate::diagnose) struct Response {
    /// By channel, then time.
    pub values: Vec<Vec<f64>>,
    /// By number, then channel, then time.
    pub sensitivities: Vec<Vec<Vec<f64>>>,
}

/// Simulates a run; `x` holds the calibration, then the fitted parameters of the effects.
pub(in crate::diagnose) fn simulate(case: &Case, run: &CaseRun, model: &Model, x: &[f64]) -> Option<Vec<Vec<f64>>> {
    simulate_many(case, run, &[model.setting(case, run, x)]).pop()?
}

/// Simulates a run at several settings; the compared channels of each.
pub(in crate::diagnose) fn simulate_many(
    case: &Case,
    run: &CaseRun,
    settings: &[RomSetting<f64>],
) -> Vec<Option<Vec<Vec<f64>>>> {
    let compared =
        |series: Vec<Vec<f64>>| case.channels.iter().map(|c| series[c.output][run.lead_in..].to_vec()).collect();
    case.effort.add(settings.len() as u64 * run.rom.steps(&run.drive));
    let many = run.rom.simulate_many(&run.drive, settings);
    many.into_iter().map(|series| series.map(compared)).collect()
}

/// A parameter and the step of its difference quotient, one-sided or central.
#[derive(Clone, Copy, Debug)]
pub(in crate::diagnose) struct Probe {
    pub number: usize,
    pub step: f64,
    pub sides: Sides,
}

impl Probe {
    /// Sensitivity of every channel from its values with and without the probe's step.
    pub fn sensitivity(&self, ahead: &[Vec<f64>], behind: &[Vec<f64>]) -> Vec<Vec<f64>> {
        sensitivity(ahead, behind, self.step)
    }
}

fn sensitivity(ahead: &[Vec<f64>], behind: &[Vec<f64>], way: f64) -> Vec<Vec<f64>> {
    let channels = ahead.iter().zip(behind);
    channels.map(|(a, b)| a.iter().zip(b).map(|(a, b)| (a - b) / way).collect()).collect()
}

/// One-sided differences cost half; central ones are accurate enough for narrow valleys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::diagnose) enum Sides {
    One,
    Both,
}

/// Simulates with sensitivities, as difference quotients over the probes' steps.
///
/// The exact derivatives of the reduced-order model would cost the same. But where a cable switches between taut and
/// slack they follow the branch taken at every step and grow without bound; a finite step does not.
pub(in crate::diagnose) fn respond(
    case: &Case,
    run: &CaseRun,
    model: &Model,
    x: &[f64],
    probes: &[Probe],
) -> Option<Response> {
    let mut jobs = vec![x.to_vec()];
    let mut ends = Vec::new();
    for probe in probes {
        let mut end = |step: f64| {
            let mut moved = x.to_vec();
            moved[probe.number] += step;
            jobs.push(moved);
            jobs.len() - 1
        };
        let ahead = end(probe.step);
        ends.push(match probe.sides {
            Sides::One => (ahead, 0, probe.step),
            Sides::Both => (ahead, end(-probe.step), 2.0 * probe.step),
        });
    }
    let settings: Vec<_> = jobs.iter().map(|x| model.setting(case, run, x)).collect();
    let series = simulate_many(case, run, &settings).into_iter().collect::<Option<Vec<_>>>()?;
    let sensitivities =
        ends.into_iter().map(|(ahead, behind, way)| sensitivity(&series[ahead], &series[behind], way)).collect();
    Some(Response { values: series[0].clone(), sensitivities })
}
