//! Injects small signals at the ports of a fitted model: how much of the misfit could a law at each port explain,
//! whatever its shape?

use nalgebra::{DMatrix, DVector};

use super::linear_range::{basis, linear_rows, where_linear};
use super::span::explained;
use crate::diagnose::case::CaseRun;
use crate::diagnose::fit::{Fit, FitParameter, Problem, Rows, orthogonal};
use crate::diagnose::grammar::{Shape, Slot, is_size, pieces};
use crate::effects::Effect;
use crate::laws::{Address, Port};
use crate::parallel;
use crate::recording::parse_column;
use crate::system::{Change, Signals};

/// A slot, and how much a curve over its variable could explain.
#[derive(Clone, Debug)]
pub(in crate::diagnose) struct Located {
    pub slot: Slot,
    /// Predicted reduction of chi².
    pub gain: f64,
    /// The part of the misfit that it would explain.
    part: DVector<f64>,
}

impl Located {
    /// Whether another slot would explain the same part of the misfit, but for this share.
    pub fn is_like(&self, other: &Self, share: f64) -> bool {
        (&self.part - &other.part).norm_squared() < share * self.gain.max(other.gain)
    }
}

/// A requested signature: slot, shape, and scale of the variable.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted<'a> {
    pub slot: &'a Slot,
    pub shape: &'a Shape,
    pub scale: f64,
}

impl PartialEq for Wanted<'_> {
    fn eq(&self, other: &Self) -> bool {
        (self.slot, self.shape.text, self.scale) == (other.slot, other.shape.text, other.scale)
    }
}

/// An additional shape with its scale, beside those of a slot's basis.
pub(super) type More = Option<(&'static Shape, f64)>;

/// Numbers, among the fitted ones, of the sizes of an effect; a sum of shapes has one for each, and so has a curve of pieces.
fn sizes_of(fit: &Fit, effect: usize, calibration: usize) -> Vec<usize> {
    let spec = fit.model.effects[effect].spec();
    let places = fit.model.places().into_iter().enumerate();
    places.filter(|(_, (own, i))| *own == effect && is_size(spec, *i)).map(|(k, _)| calibration + k).collect()
}

/// Signatures that make up the curve of a slot.
pub(super) fn of_curve(slot: &Slot, more: More) -> Vec<Wanted<'_>> {
    let more = more.filter(|_| !slot.is_constant()).map(|(shape, scale)| Wanted { slot, shape, scale });
    slot.basis().map(|shape| Wanted { slot, shape, scale: slot.scale }).chain(more).collect()
}

/// Signatures of the terms of its curve of pieces.
pub(super) fn of_pieces(slot: &Slot) -> Vec<Wanted<'_>> {
    pieces(slot).iter().map(|piece| Wanted { slot, shape: piece.shape, scale: piece.scale }).collect()
}

/// The misfit to be explained along the runs of a fitted model.
pub(super) struct Shown<'a> {
    pub(super) problem: &'a Problem<'a>,
    /// The same on longer steps, for signatures and rough refits.
    pub(super) coarse: Problem<'a>,
    /// The model along whose runs signals are injected.
    along: &'a Fit,
    /// The model that laws are added to.
    pub(super) from: Fit,
    /// Jacobian of `from`.
    pub(super) jacobian: DMatrix<f64>,
    /// Rows in the linear range; basis of what calibration and free zeros can imitate there.
    linear: Vec<bool>,
    basis: DMatrix<f64>,
    /// Misfit in the linear range, without what these can imitate.
    pub(super) left: DVector<f64>,
}

impl<'a> Shown<'a> {
    /// The residual of a fit whose rows are `known`.
    pub fn misfit(problem: &'a Problem<'a>, fit: &'a Fit, known: Rows) -> Self {
        Self::along(problem, fit, fit.clone(), known.jacobian, known.residual)
    }

    /// The response of the last effect of a fit. `None` if the model cannot be simulated, or the effect's size is not
    /// fitted.
    pub fn last_effect(problem: &'a Problem<'a>, fit: &'a Fit) -> Option<Self> {
        Self::without_last(problem, fit, |response, _| response)
    }

    /// The response of the last effect together with what the fit leaves: what another law has to explain in its place.
    pub fn in_place_of_last(problem: &'a Problem<'a>, fit: &'a Fit) -> Option<Self> {
        Self::without_last(problem, fit, |response, residual| response + residual)
    }

    /// What is to be explained follows from the response of the last effect and the residual.
    fn without_last(
        problem: &'a Problem<'a>,
        fit: &'a Fit,
        left: impl FnOnce(DVector<f64>, DVector<f64>) -> DVector<f64>,
    ) -> Option<Self> {
        let last = fit.model.effects.len().checked_sub(1)?;
        let (model, x) = (fit.model.without(last), problem.start_without(fit, last));
        let cost = problem.cost_at(&model, &x).unwrap_or(f64::INFINITY);
        let without = Fit { model, x, cost, ..fit.clone() };
        let sizes = sizes_of(fit, last, problem.case.parameters.len());
        let known = problem.rows_of(fit)?;
        let parameters = problem.parameters(&fit.model);
        let response = |&size: &usize| known.jacobian.column(size) * (fit.x[size] / parameters[size].scale);
        let does = sizes.iter().map(response).reduce(|sum, own| sum + own)?;
        let own = fit.x.len() - without.x.len();
        let jacobian = known.jacobian.remove_columns(fit.x.len() - own, own);
        Some(Self::along(problem, fit, without, jacobian, left(does, known.residual)))
    }

    /// The misfit `left` along the runs of a fit, with the Jacobian of the model that laws are added to.
    fn along(problem: &'a Problem<'a>, along: &'a Fit, from: Fit, jacobian: DMatrix<f64>, left: DVector<f64>) -> Self {
        let coarse = problem.coarse(along);
        let linear = linear_rows(&coarse, along);
        let free = jacobian.column_iter().map(|column| column.into_owned()).chain(problem.free_zeros());
        let basis = basis(free, &linear, left.len());
        let left = orthogonal(&basis, &where_linear(left, &linear));
        Self { problem, coarse, along, from, jacobian, linear, basis, left }
    }

    /// Keeps the part of the misfit that curves over a slot's variable can explain. Finite effects contain more than
    /// linear signals do: different bounces where cables go slack, and what a law does between samples.
    pub fn keep(&mut self, all: &[Slot], own: &Slot, more: More) {
        let signatures: Option<Vec<DVector<f64>>> = self.signatures(all, &of_curve(own, more)).into_iter().collect();
        let Some(signatures) = signatures else { return };
        self.left = explained(&signatures, &self.left);
    }

    /// Sum of squares of the misfit.
    pub fn whole(&self) -> f64 {
        self.left.norm_squared()
    }

    /// How much a curve over the variable of each slot could explain; with one additional shape if given. Best first.
    pub fn locate(&self, all: &[Slot], some: &[Slot], more: More) -> Vec<Located> {
        let wanted: Vec<Vec<Wanted>> = some.iter().map(|slot| of_curve(slot, more)).collect();
        let signatures = self.signatures(all, &wanted.concat());
        let mut signatures = signatures.iter();
        let gains = some.iter().zip(&wanted).map(|(slot, own)| {
            let own: Vec<&Option<DVector<f64>>> = signatures.by_ref().take(own.len()).collect();
            let own: Vec<DVector<f64>> = own.into_iter().flatten().cloned().collect();
            let part = explained(&own, &self.left);
            Located { slot: slot.clone(), gain: part.norm_squared(), part }
        });
        let mut located: Vec<Located> = gains.collect();
        located.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        located
    }

    /// Derivatives of all measured channels with respect to the size of each law at zero, without what the calibration
    /// imitates. For a law on several equal elements, the sum over the elements.
    pub(super) fn signatures(&self, all: &[Slot], wanted: &[Wanted]) -> Vec<Option<DVector<f64>>> {
        let mut single: Vec<Wanted> = Vec::new();
        let members: Vec<Vec<usize>> = wanted
            .iter()
            .map(|w| {
                let own = parts(all, w.slot).map(|slot| Wanted { slot, ..*w });
                own.map(|part| {
                    let known = single.iter().position(|s| *s == part);
                    known.unwrap_or_else(|| {
                        single.push(part);
                        single.len() - 1
                    })
                })
                .collect()
            })
            .collect();
        let of_runs: Vec<Vec<Option<Vec<f64>>>> =
            parallel::map_indices(self.coarse.runs.len(), |r| self.in_run(r, &self.coarse.runs[r], &single));
        let whole = |i: usize| -> Option<DVector<f64>> {
            let mut entries = Vec::with_capacity(self.left.len());
            for run in &of_runs {
                entries.extend_from_slice(run[i].as_ref()?);
            }
            Some(DVector::from_vec(entries))
        };
        let signatures: Vec<Option<DVector<f64>>> = parallel::map_indices(single.len(), whole);
        let sum = |parts: &Vec<usize>| -> Option<DVector<f64>> {
            let mut sum = DVector::zeros(self.left.len());
            for &i in parts {
                sum += signatures[i].as_ref()?;
            }
            Some(orthogonal(&self.basis, &where_linear(sum, &self.linear)))
        };
        parallel::map(&members, sum)
    }

    /// The rows of each signature in one run.
    fn in_run(&self, r: usize, run: &CaseRun, wanted: &[Wanted]) -> Vec<Option<Vec<f64>>> {
        let setting = self.along.model.setting(self.problem.case, run, &self.along.x);
        let mut ports: Vec<(&Slot, Vec<usize>)> = Vec::new();
        let mut found: Vec<Option<Vec<f64>>> = vec![None; wanted.len()];
        let signal = |w: &Wanted| w.slot.signal(r, w.shape, w.scale);
        for (i, w) in wanted.iter().enumerate() {
            if w.slot.port == Port::Sensor {
                found[i] = Some(self.on_channel(run, w.slot, signal(w)));
                continue;
            }
            match ports.iter_mut().find(|(port, _)| port.injected == w.slot.injected) {
                Some((_, own)) => own.push(i),
                None => ports.push((w.slot, vec![i])),
            }
        }
        if ports.is_empty() {
            return found;
        }
        let at: Vec<Effect<f64>> = ports.iter().map(|(port, _)| port.injected.with(&[0.0])).collect();
        let signals = ports
            .iter()
            .zip(&at)
            .map(|((_, own), at)| Signals { at, values: own.iter().map(|&i| signal(&wanted[i])).collect() });
        let changes = run.rom.injected(&run.drive, &setting, &signals.collect::<Vec<_>>());
        for ((port, own), changes) in ports.iter().zip(changes) {
            for (&i, change) in own.iter().zip(changes) {
                found[i] = change.map(|change| self.weighted(run, &change, port.action.typical));
            }
        }
        found
    }

    /// Response to a signal added to a channel: that channel alone.
    fn on_channel(&self, run: &CaseRun, slot: &Slot, signal_si: Vec<f64>) -> Vec<f64> {
        let channels = &self.problem.case.channels;
        let own = channels.iter().find(|c| slot.injected.channel.as_ref() == Some(&c.column));
        let count = channels.iter().map(|c| c.output + 1).max().unwrap_or(0);
        let mut change = vec![vec![0.0; signal_si.len()]; count];
        if let Some((channel, unit)) = own.and_then(|c| Some((c, parse_column(&c.column).ok()?.unit))) {
            change[channel.output] = signal_si.into_iter().map(|x| unit.from_si(x)).collect();
        }
        self.weighted(run, &change, slot.action.typical)
    }

    /// Response to a signal of this size, in units of the noise.
    fn weighted(&self, run: &CaseRun, change: &Change, size: f64) -> Vec<f64> {
        let number = number(size);
        let channels = self.problem.case.channels.iter().enumerate();
        let each = channels.flat_map(|(c, channel)| {
            self.problem
                .weighted_sensitivity(run, c, &change[channel.output][run.lead_in..], &number)
                .collect::<Vec<f64>>()
        });
        each.collect()
    }
}

/// The slots of single elements that make up a slot on several: the slot itself if there is only one.
fn parts<'a>(all: &'a [Slot], slot: &'a Slot) -> impl Iterator<Item = &'a Slot> {
    let is_part = move |other: &&Slot| {
        let is_same =
            (other.port, &other.variable, other.reading.word()) == (slot.port, &slot.variable, slot.reading.word());
        is_same && other.reading.is_like(&slot.reading) && other.address != slot.address
    };
    let is_whole = slot.port.spec().is_numbered() && Address::parse(&slot.address).is_ok_and(|a| a.number.is_none());
    let others: Vec<&Slot> = if is_whole { all.iter().filter(is_part).collect() } else { Vec::new() };
    if others.is_empty() { vec![slot].into_iter() } else { others.into_iter() }
}

fn number(scale: f64) -> FitParameter {
    FitParameter { min: f64::NEG_INFINITY, max: f64::INFINITY, scale, step: 1.0, prior: 0.0, prior_weight: 0.0 }
}
