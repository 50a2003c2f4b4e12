//! Where in time and state the baseline's misfit is.

use std::borrow::Cow;
use std::collections::BTreeMap;

use crate::diagnose::case::{Case, CaseRun, Direction, Noise, RunSet};
use crate::diagnose::diagnosis::{Balance, Location, NamedEffect, Verdict};
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::latent::{Latent, latents};
use crate::diagnose::search::Found;
use crate::laws::Address;

/// Length of time windows, s.
const PIECE_S: f64 = 1.0;
/// A window counts if its mean square is this many standard errors above noise.
const SIGMA: f64 = 6.0;

/// Element, time and state of the baseline's misfit.
pub fn location(
    case: &Case,
    found: &Found,
    effects: &[NamedEffect],
    whole: &Problem,
    before: &[Vec<Vec<f64>>],
    (verdict, leaves_a_part): (Verdict, bool),
) -> Location {
    if verdict == Verdict::Adequate {
        return Location::default();
    }
    let open = Problem { case, runs: case.subset(RunSet::Open), noise: whole.noise };
    let is_law = effects.iter().any(|e| e.hypothetical);
    // Effects of the catalogue that explain everything give the place; those that explain a part stand where they happen to.
    let is_asked = is_law || effects.is_empty() || leaves_a_part;
    let latents = if is_asked { of_baseline(&open, &found.baseline) } else { Vec::new() };
    let by_place = by_place(found, &latents);
    let ranked = if by_place.is_empty() { by_probability(found, effects) } else { by_place };
    // A law that the held-out runs refuse is no witness.
    let law = effects.iter().rfind(|e| e.hypothetical && found.withheld.is_none()).map(|e| e.element.clone());
    Location {
        element: law.or_else(|| ranked.first().map(|(e, _)| e.clone())),
        ranked,
        time_windows_s: time_windows(&whole.runs, before, whole.noise),
        state_region: state_region(case, &whole.runs, before, whole.noise),
        indistinguishable: if is_law { alike_forms(effects) } else { indistinguishable(found) },
        balances: latents.iter().map(|latent| balance(latent, &latents[0], &open)).collect(),
    }
}

/// Balances of the calibrated scene's misfit.
fn of_baseline(open: &Problem, baseline: &Fit) -> Vec<Latent> {
    let known = open.rows_of(baseline);
    known.map_or_else(Vec::new, |known| latents(open, baseline, &known))
}

/// Balance of one place, relative to the most likely one.
fn balance(latent: &Latent, likeliest: &Latent, open: &Problem) -> Balance {
    let files = open.runs.iter().map(|run| run.file.clone());
    Balance {
        port: latent.address.clone(),
        element: latent.element.clone(),
        behind: likeliest.log_odds - latent.log_odds,
        left_sigma: files.zip(latent.left_sigma.iter().copied()).collect(),
        closes: latent.closes(),
    }
}

/// Elements by the share of the misfit that an unknown signal on them could explain.
fn by_place(found: &Found, latents: &[Latent]) -> Vec<(String, f64)> {
    let all = found.baseline.cost.max(f64::MIN_POSITIVE);
    let mut ranked: Vec<(String, f64)> = Vec::new();
    for latent in latents {
        if !ranked.iter().any(|(element, _)| *element == latent.element) {
            ranked.push((latent.element.clone(), (latent.log_odds / all).clamp(0.0, 1.0)));
        }
    }
    ranked
}

/// Elements by the probabilities of their effects; if none is named, by screening.
fn by_probability(found: &Found, effects: &[NamedEffect]) -> Vec<(String, f64)> {
    let mut shares: BTreeMap<String, f64> = BTreeMap::new();
    // Hypotheses say where only when nothing known does.
    let only_hypotheses = effects.iter().all(|e| e.hypothetical);
    for e in effects.iter().filter(|e| only_hypotheses || !e.hypothetical) {
        *shares.entry(e.element.clone()).or_default() += e.probability;
    }
    if shares.is_empty() {
        for s in &found.screened {
            let share = shares.entry(s.variant.placed.element.to_string()).or_default();
            *share = share.max(s.gain);
        }
    }
    let sum: f64 = shares.values().sum();
    let mut ranked: Vec<(String, f64)> = shares.into_iter().map(|(e, s)| (e, s / sum.max(f64::MIN_POSITIVE))).collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    ranked
}

/// For each law: its element and those of equally good forms.
fn alike_forms(effects: &[NamedEffect]) -> Vec<Vec<String>> {
    let set = |e: &NamedEffect| {
        let mut set = vec![e.element.clone()];
        let elements = e.forms.iter().filter_map(|f| Address::parse(&f.port).ok()).map(|a| a.element());
        for element in elements {
            if !set.contains(&element) {
                set.push(element);
            }
        }
        set
    };
    effects.iter().map(set).filter(|set| set.len() > 1).collect()
}

/// Signatures more similar than this are not distinguished.
const ALIKE: f64 = 0.9;

/// For each effect: its element and those where another effect has the same signature.
fn indistinguishable(found: &Found) -> Vec<Vec<String>> {
    let mut sets = Vec::new();
    for placed in &found.best.model.effects {
        let own: Vec<_> = found.screened.iter().filter(|s| s.variant.placed == *placed).collect();
        let mut set = vec![placed.element.to_string()];
        for other in &found.screened {
            let element = other.variant.placed.element.to_string();
            if !set.contains(&element) && own.iter().any(|s| s.likeness(other) > ALIKE) {
                set.push(element);
            }
        }
        if set.len() > 1 && !sets.contains(&set) {
            sets.push(set);
        }
    }
    sets
}

/// Windows (file, from, to) in which the residual exceeds noise.
pub fn time_windows(
    runs: &[Cow<'_, CaseRun>],
    residuals: &[Vec<Vec<f64>>],
    noise: &[Noise],
) -> Vec<(String, f64, f64)> {
    let mut windows = Vec::new();
    for (run, residuals) in runs.iter().zip(residuals) {
        let times = run.times_s();
        let mut open: Option<(f64, f64)> = None;
        let mut from = 0;
        while from < times.len() {
            let to = times.partition_point(|t| *t < times[from] + PIECE_S).max(from + 1);
            if is_loud(residuals, noise, from..to) {
                let end = times[to - 1];
                open = Some(open.map_or((times[from], end), |(start, _)| (start, end)));
            } else if let Some((start, end)) = open.take() {
                windows.push((run.file.clone(), start, end));
            }
            from = to;
        }
        windows.extend(open.map(|(start, end)| (run.file.clone(), start, end)));
    }
    windows
}

fn is_loud(residuals: &[Vec<f64>], noise: &[Noise], piece: std::ops::Range<usize>) -> bool {
    let (mut sum, mut expected, mut count) = (0.0, 0.0, 0.0);
    for (channel, noise) in residuals.iter().zip(noise) {
        for r in channel[piece.clone()].iter().filter(|r| r.is_finite()) {
            sum += (r / noise.scale()).powi(2);
            expected += 1.0 / noise.inflation();
            count += 1.0;
        }
    }
    count > 10.0 && sum > expected + SIGMA * f64::sqrt(2.0 * count)
}

/// Number of levels that each state is cut into.
const LEVELS: usize = 4;

/// The part of state space where the misfit is greatest: a level of one recorded channel, and the direction of the first
/// input. In words, `pressure_kpa 1200 .. 2100 while unloading`.
pub fn state_region(case: &Case, runs: &[Cow<'_, CaseRun>], residuals: &[Vec<Vec<f64>>], noise: &[Noise]) -> String {
    let mut best: Option<(f64, String)> = None;
    for (c, channel) in case.channels.iter().enumerate() {
        let Some((low, high)) = range(runs, c) else { continue };
        let width = (high - low) / LEVELS as f64;
        let mut sums = [[(0.0, 0.0); 2]; LEVELS];
        for (run, residuals) in runs.iter().zip(residuals) {
            for (i, &value) in run.measured[c].iter().enumerate().filter(|(_, v)| v.is_finite()) {
                let level = (((value - low) / width) as usize).min(LEVELS - 1);
                let direction = match run.direction(i) {
                    Direction::Falling => 0,
                    Direction::Rising => 1,
                    Direction::Resting => continue,
                };
                let excess: f64 = residuals
                    .iter()
                    .zip(noise)
                    .filter(|(r, _)| r[i].is_finite())
                    .map(|(r, n)| (r[i] / n.sd).powi(2) - 1.0)
                    .sum();
                sums[level][direction].0 += excess;
                sums[level][direction].1 += 1.0;
            }
        }
        for (level, by_direction) in sums.iter().enumerate() {
            for (direction, (sum, count)) in by_direction.iter().enumerate().filter(|(_, s)| s.1 > 50.0) {
                let mean = sum / count;
                if best.as_ref().is_none_or(|(b, _)| mean > *b) {
                    let from = low + width * level as f64;
                    let way = ["while unloading", "while loading"][direction];
                    best = Some((mean, format!("{} {:.4} .. {:.4} {way}", channel.column, from, from + width)));
                }
            }
        }
    }
    best.map_or_else(String::new, |(_, words)| words)
}

fn range(runs: &[Cow<'_, CaseRun>], channel: usize) -> Option<(f64, f64)> {
    let finite = runs.iter().flat_map(|r| r.measured[channel].iter().copied()).filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
    (high > low).then_some((low, high))
}
