//! The law that nobody listed.
//!
//! Every slot of the grammar (a port and a variable) is screened first: small signals of several shapes are injected at its port,
//! and what a curve made up of them could explain says how well the slot does, whatever the law's shape. Around the best slots all
//! shapes are screened, the best are refitted jointly with the calibration.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::case::CaseRun;
use super::fit::{Fit, Problem};
use super::grammar::{Reach, Shape, Slot, slots, variant};
use super::model::{Model, Sides};
use super::normal::Number;
use super::screening::orthogonal;

/// Slots of which the best shape is refitted, at most so many at ports of one kind; slots around which all shapes are.
const SLOTS: usize = 12;
const SLOTS_OF_PORT: usize = 3;
const WIDENED: usize = 4;
/// Mere numbers that are refitted beside them.
const NUMBERS: usize = 4;
/// Shapes of one slot that are refitted there, and refits that are fitted to the end.
const SHAPES_OF_SLOT: usize = 6;
const FINISHED: usize = 6;
/// Scales of a shape that are tried, in those of the slot.
const SCALES: [f64; 3] = [1.0, 0.4, 2.0];
/// Share of a slot's typical size that is injected.
const INJECTED: f64 = 2e-2;

/// A slot with the share of the misfit that a curve over its variable could explain.
#[derive(Clone, Debug)]
pub(super) struct Located {
    pub slot: Slot,
    /// Fall of chi² that the best curve promises.
    pub gain: f64,
}

/// What the grammar makes of a fit's misfit.
pub(super) struct Proposals {
    /// All slots, the best first.
    pub located: Vec<Located>,
    /// Refits with one law more, cheapest first; the last effect of each is the law.
    pub fits: Vec<Fit>,
}

impl Proposals {
    /// The best of them fitted again to a problem with other weights or steps.
    pub fn again(self, problem: &Problem) -> Self {
        let best = &self.fits[..self.fits.len().min(FINISHED)];
        let again = best.par_iter().filter_map(|f| problem.fit(&f.model, &f.x));
        let mut fits: Vec<Fit> = again.collect();
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        Self { fits, ..self }
    }
}

/// A signature that is wanted: slot, shape and scale of the variable.
#[derive(Clone, Copy, Debug)]
struct Wanted<'a> {
    slot: &'a Slot,
    shape: &'a Shape,
    scale: f64,
}

impl PartialEq for Wanted<'_> {
    fn eq(&self, other: &Self) -> bool {
        (self.slot, self.shape.text, self.scale) == (other.slot, other.shape.text, other.scale)
    }
}

/// Screens all slots at a fit and refits the best laws beside it. `None` where the fit cannot be simulated.
pub(super) fn propose(problem: &Problem, from: &Fit, reach: Reach, say: &dyn Fn(String)) -> Option<Proposals> {
    let all = slots(problem.case, from, reach);
    if all.is_empty() {
        return None;
    }
    let known = problem.rows(&from.model, &from.x, 0..from.x.len(), Sides::Both)?;
    let basis = known.slopes.clone().qr().q();
    let left = orthogonal(&basis, &known.residual);
    let shown = Shown { problem, from, basis: &basis, left: &left };
    let located = shown.locate(&all);
    say(format!("{} slots screened, the best {} on {}", located.len(), address(&located), variable(&located)));
    let best = several_ports(&located);
    let refits = |candidates: Vec<Candidate>| -> Vec<Fit> {
        let fits = candidates.par_iter().filter_map(|c| refit(problem, from, &known.slopes, c));
        let mut fits: Vec<Fit> = fits.collect();
        fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        fits
    };
    let mut fits = refits(shown.shapes(&all, &best, 1));
    let mut wide: Vec<&Slot> = Vec::new();
    for fit in &fits {
        let own =
            best.iter().find(|slot| is_law_of(fit, slot)).filter(|slot| !slot.is_constant() && !wide.contains(*slot));
        wide.extend(own.filter(|_| wide.len() < WIDENED));
    }
    say(format!(
        "shapes of {} at {}",
        wide.first().map_or("", |s| &s.variable),
        wide.first().map_or("", |s| &s.address)
    ));
    fits.extend(refits(shown.shapes(&all, &wide, SHAPES_OF_SLOT)));
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    fits.dedup_by(|a, b| a.model.effects == b.model.effects);
    let count = fits.len().min(FINISHED);
    let finished: Vec<Option<Fit>> = fits[..count].par_iter().map(|f| problem.fit(&f.model, &f.x)).collect();
    for (fit, finished) in fits.iter_mut().zip(finished) {
        if let Some(finished) = finished.filter(|f| f.cost < fit.cost) {
            *fit = finished;
        }
    }
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    Some(Proposals { located, fits })
}

/// Share of what an effect explains from which a slot is another place for it, and shapes that are refitted there.
const AS_MUCH: f64 = 0.97;
const SHAPES_OF_PLACE: usize = 2;

/// Laws over the variables of an effect, and mere numbers, in its place, that explain as much of what `from` leaves as `best` does; cheapest
/// first.
pub(super) fn alternatives(problem: &Problem, from: &Fit, best: &Fit, variables: &[&str]) -> Vec<Fit> {
    let mut all = slots(problem.case, from, Reach::Plain);
    all.retain(|slot| slot.is_constant() || variables.contains(&slot.variable.as_str()));
    let Some(known) = problem.rows(&from.model, &from.x, 0..from.x.len(), Sides::Both) else { return Vec::new() };
    let basis = known.slopes.clone().qr().q();
    let left = orthogonal(&basis, &known.residual);
    let shown = Shown { problem, from, basis: &basis, left: &left };
    let located = shown.locate(&all);
    let as_much = located.iter().filter(|l| l.gain > AS_MUCH * (from.cost - best.cost));
    let places: Vec<&Slot> = as_much.take(SLOTS).map(|l| &l.slot).collect();
    let candidates = shown.shapes(&all, &places, SHAPES_OF_PLACE);
    let fits = candidates.par_iter().filter_map(|c| refit(problem, from, &known.slopes, c));
    let mut fits: Vec<Fit> = fits.collect();
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    fits
}

/// The best slots, few of them at ports of one kind, and the best mere numbers.
fn several_ports(located: &[Located]) -> Vec<&Slot> {
    let mut best: Vec<&Slot> = Vec::new();
    for Located { slot, .. } in located.iter().filter(|l| !l.slot.is_constant()) {
        let of_port = best.iter().filter(|b| b.port == slot.port).count();
        if of_port < SLOTS_OF_PORT && best.len() < SLOTS {
            best.push(slot);
        }
    }
    best.extend(located.iter().map(|l| &l.slot).filter(|slot| slot.is_constant()).take(NUMBERS));
    best
}

/// Whether the last effect of a fit is a law of this slot.
fn is_law_of(fit: &Fit, slot: &Slot) -> bool {
    let Some(written) = fit.model.effects.last().and_then(|e| e.spec().unlisted()) else { return false };
    let law = &written.law;
    let variables = law.variables();
    let is_over = match slot.is_constant() {
        true => variables.is_empty(),
        false => variables.iter().any(|v| v.name() == slot.variable),
    };
    law.name == slot.name() && is_over
}

fn address(located: &[Located]) -> &str {
    located.first().map_or("none", |l| &l.slot.address)
}

fn variable(located: &[Located]) -> &str {
    located.first().map_or("nothing", |l| &l.slot.variable)
}

/// A law with numbers to start from.
struct Candidate {
    model: Model,
    x: Vec<f64>,
}

/// What is left at a fit, and what the calibration can imitate.
struct Shown<'a> {
    problem: &'a Problem<'a>,
    from: &'a Fit,
    basis: &'a DMatrix<f64>,
    left: &'a DVector<f64>,
}

impl Shown<'_> {
    /// How much of the misfit a curve over each slot's variable could explain.
    fn locate(&self, all: &[Slot]) -> Vec<Located> {
        let every: Vec<Wanted> = all
            .iter()
            .flat_map(|slot| slot.basis().map(move |shape| Wanted { slot, shape, scale: slot.scale }))
            .collect();
        let signatures = self.signatures(all, &every);
        let mut signatures = signatures.iter();
        let gains = all.iter().map(|slot| {
            let own = signatures.by_ref().take(slot.basis().count());
            let own: Vec<&DVector<f64>> = own.flatten().collect();
            Located { slot: slot.clone(), gain: explained(&own, self.left) }
        });
        let mut located: Vec<Located> = gains.collect();
        located.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        located
    }

    /// The most promising shapes of these slots, at most so many of each, ready to be refitted.
    fn shapes(&self, all: &[Slot], best: &[&Slot], most: usize) -> Vec<Candidate> {
        let scales = |shape: &Shape| if shape.has_scale { &SCALES[..] } else { &SCALES[..1] };
        let wanted: Vec<Wanted> = best
            .iter()
            .flat_map(|&slot| slot.shapes().iter().map(move |shape| (slot, shape)))
            .flat_map(|(slot, shape)| scales(shape).iter().map(move |s| Wanted { slot, shape, scale: s * slot.scale }))
            .collect();
        let signatures = self.signatures(all, &wanted);
        let mut promised: Vec<(f64, f64, Wanted)> = wanted
            .iter()
            .zip(signatures)
            .filter_map(|(w, signature)| {
                let signature = signature?;
                let length = signature.norm().max(f64::MIN_POSITIVE);
                let amplitude = signature.dot(self.left) / length;
                Some((amplitude * amplitude, amplitude / length * w.slot.typical, *w))
            })
            .collect();
        promised.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut taken: Vec<Wanted> = Vec::new();
        let mut candidates = Vec::new();
        for (_, size, w) in promised {
            let is_same = |t: &&Wanted| t.slot == w.slot && t.shape.text == w.shape.text;
            let of_slot = taken.iter().filter(|t| t.slot == w.slot).count();
            if taken.iter().any(|t| is_same(&t)) || of_slot >= most {
                continue;
            }
            taken.push(w);
            candidates.extend(self.candidate(&w, size));
        }
        candidates
    }

    fn candidate(&self, w: &Wanted, size: f64) -> Option<Candidate> {
        let mut own = variant(self.problem.case, w.slot, w.shape, w.scale / w.slot.scale)?;
        let range = own.placed.spec().parameters[0].range;
        own.values[0] = size.clamp(range.min, range.max);
        let model = self.from.model.plus(&own.placed, &own.values);
        let mut x = self.from.x.clone();
        x.extend(model.fitted.last()?.iter().map(|&i| own.values[i]));
        Some(Candidate { model, x })
    }

    /// Derivatives of what is measured to the size of each law at zero, without what the calibration imitates. A law on all of
    /// several equal elements shows what those on each show together.
    fn signatures(&self, all: &[Slot], wanted: &[Wanted]) -> Vec<Option<DVector<f64>>> {
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
            self.problem.runs.par_iter().enumerate().map(|(r, run)| self.in_run(r, run, &single)).collect();
        let whole = |i: usize| -> Option<DVector<f64>> {
            let mut entries = Vec::with_capacity(self.left.len());
            for run in &of_runs {
                entries.extend_from_slice(run[i].as_ref()?);
            }
            Some(DVector::from_vec(entries))
        };
        let signatures: Vec<Option<DVector<f64>>> = (0..single.len()).into_par_iter().map(whole).collect();
        let sum = |parts: &Vec<usize>| -> Option<DVector<f64>> {
            let mut sum = DVector::zeros(self.left.len());
            for &i in parts {
                sum += signatures[i].as_ref()?;
            }
            Some(orthogonal(self.basis, &sum))
        };
        members.par_iter().map(sum).collect()
    }

    /// The part of each signature that stands in one run.
    fn in_run(&self, r: usize, run: &CaseRun, wanted: &[Wanted]) -> Vec<Option<Vec<f64>>> {
        let problem = self.problem;
        let setting = self.from.model.setting(problem.case, run, &self.from.x);
        let mut found: Vec<Option<Vec<f64>>> = vec![None; wanted.len()];
        let mut ports: Vec<&Slot> = Vec::new();
        for w in wanted {
            if ports.iter().all(|p| p.injected != w.slot.injected) {
                ports.push(w.slot);
            }
        }
        let of_ports = ports.into_par_iter().map(|port| {
            let own: Vec<usize> = (0..wanted.len()).filter(|&i| wanted[i].slot.injected == port.injected).collect();
            let step = INJECTED * port.typical;
            let signal = |&i: &usize| -> Vec<f64> {
                let w = &wanted[i];
                w.slot.series[r].iter().map(|x| step * (w.shape.at)(x / w.scale)).collect()
            };
            let signals: Vec<Vec<f64>> = own.iter().map(signal).collect();
            let changes = run.twin.injected(&run.drive, &setting, &port.injected.with(&[0.0]), &signals);
            let number = number(port.typical);
            let weighted = changes.into_iter().map(|change| {
                let change = change?;
                let channels = problem.case.channels.iter().enumerate();
                let each = channels.flat_map(|(c, channel)| {
                    let slope: Vec<f64> = change[channel.output][run.lead_in..].iter().map(|x| x / step).collect();
                    problem.weighted_slope(run, c, &slope, &number).collect::<Vec<f64>>()
                });
                Some(each.collect())
            });
            own.into_iter().zip(weighted.collect::<Vec<_>>()).collect::<Vec<_>>()
        });
        for (i, signature) in of_ports.collect::<Vec<_>>().into_iter().flatten() {
            found[i] = signature;
        }
        found
    }
}

/// The slots of single elements that a slot is made up of: itself, or those of its port on every element.
fn parts<'a>(all: &'a [Slot], slot: &'a Slot) -> impl Iterator<Item = &'a Slot> {
    let is_part = move |other: &&Slot| {
        let is_same =
            (other.port, &other.variable, other.reading.word()) == (slot.port, &slot.variable, slot.reading.word());
        is_same && other.reading.is_like(&slot.reading) && other.address != slot.address
    };
    let is_whole = crate::laws::Address::parse(&slot.address).is_ok_and(|a| a.number.is_none());
    let others: Vec<&Slot> = if is_whole { all.iter().filter(is_part).collect() } else { Vec::new() };
    if others.is_empty() { vec![slot].into_iter() } else { others.into_iter() }
}

fn number(scale: f64) -> Number {
    Number { min: f64::NEG_INFINITY, max: f64::INFINITY, scale, step: INJECTED, prior: 0.0, prior_weight: 0.0 }
}

/// Share of its largest direction below which a curve's signature says nothing.
const FAINT: f64 = 1e-6;

/// Fall of the sum of squares that signatures explain together.
fn explained(signatures: &[&DVector<f64>], left: &DVector<f64>) -> f64 {
    let n = signatures.len();
    if n == 0 {
        return 0.0;
    }
    let lengths: Vec<f64> = signatures.iter().map(|s| s.norm().max(f64::MIN_POSITIVE)).collect();
    let gram = DMatrix::from_fn(n, n, |i, j| signatures[i].dot(signatures[j]) / (lengths[i] * lengths[j]));
    let along = DVector::from_fn(n, |i, _| signatures[i].dot(left) / lengths[i]);
    let eigen = gram.symmetric_eigen();
    let floor = FAINT * eigen.eigenvalues.max();
    let rotated = eigen.eigenvectors.tr_mul(&along);
    rotated.iter().zip(eigen.eigenvalues.iter()).filter(|(_, e)| **e > floor).map(|(x, e)| x * x / e).sum()
}

/// A joint refit with the law added.
fn refit(problem: &Problem, from: &Fit, slopes: &DMatrix<f64>, candidate: &Candidate) -> Option<Fit> {
    let (model, start) = (&candidate.model, &candidate.x);
    let own = problem.rows(model, start, from.x.len()..start.len(), Sides::One)?.slopes;
    let mut all = slopes.clone().resize_horizontally(start.len(), 0.0);
    all.columns_mut(from.x.len(), own.ncols()).copy_from(&own);
    problem.fit_roughly(model, start, all)
}
