//! Which effects are named, with what probability, and when none is.

use std::collections::BTreeMap;

use super::misfit::Excess;
use super::parameters::{add_branch, over_runs, parameters, size_in_each};
use super::written;
use crate::diagnose::diagnosis::{NamedEffect, Verdict};
use crate::diagnose::fit::{Fit, Placed};
use crate::diagnose::search::Found;

/// Alternatives with less probability are not listed.
const LEAST_PROBABILITY: f64 = 0.05;
/// An effect with at least this probability is the only answer.
const SURE: f64 = 0.9;
/// A complete answer may leave this share of the baseline's misfit: model discrepancy.
const LEFT_SHARE: f64 = 0.1;
/// Limit of the probability in an answer that leaves part of the misfit: what the effect explains may belong to what is
/// missing.
const MOST_IN_PART: f64 = 2.0 / 3.0;
/// What a law may leave per sample, in noise variances, before another one is looked for.
pub const LITTLE_OF_NOISE: f64 = 0.3;
/// Misfit per sample, in noise variances, below which nothing is called unknown.
const LEFT_LEAST: f64 = 0.015;

/// What the held-out runs say about the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confirmed {
    /// Confirmed, or nothing to confirm.
    Yes,
    /// It explains the open runs but not the held-out ones, or a run contradicts it.
    InPart,
}

impl Confirmed {
    /// Confirmed only if both are.
    pub fn and(self, other: Self) -> Self {
        if other == Self::InPart { other } else { self }
    }
}

/// Whether a misfit per sample is more than noise.
pub fn is_loud(excess: f64, error: f64) -> bool {
    excess > 5.0 * error && excess > LEFT_LEAST
}

/// Whether more is left than the catalogue can explain.
pub fn is_unknown(found: &Found, excess: Excess) -> bool {
    found.best.model.effects.iter().any(|e| e.entry.hypothetical) || leaves_a_part(found, excess)
}

/// Whether the answer leaves more than model discrepancy accounts for.
pub fn leaves_a_part(found: &Found, excess: Excess) -> bool {
    let left = if found.best.model.effects.is_empty() { 0.0 } else { LEFT_SHARE * excess.baseline };
    is_loud(excess.best, excess.error) && excess.best > left
}

/// Whether a law leaves so much beyond noise that it is not quite the one sought, however small a share of the misfit that is: one at
/// another place, or of another form, might leave none.
pub fn is_approximate(found: &Found, excess: Excess) -> bool {
    let is_law = found.best.model.effects.iter().any(|e| e.entry.hypothetical);
    is_law && is_loud(excess.best, excess.error) && excess.best > LITTLE_OF_NOISE
}

/// Limits the probabilities in an answer that leaves part of the misfit.
pub fn doubt(effects: &mut [NamedEffect]) {
    effects.iter_mut().for_each(|effect| effect.probability = effect.probability.min(MOST_IN_PART));
}

/// The verdict of the search and the remaining misfit. In a closed set nothing is unknown.
pub fn verdict(found: &Found, effects: &[NamedEffect], excess: Excess, is_open_set: bool) -> Verdict {
    if is_open_set && is_unknown(found, excess) {
        return Verdict::UnknownPhysics;
    }
    if found.best.model.effects.is_empty() {
        return Verdict::Adequate;
    }
    let ambiguous = found
        .best
        .model
        .effects
        .iter()
        .any(|placed| effects.iter().find(|e| is_said(e, placed)).is_some_and(|e| e.probability < SURE));
    if ambiguous { Verdict::Ambiguous } else { Verdict::MissingPhysics }
}

/// The effects of the best model with the alternatives that the data cannot rule out. `left`: chi² of the best above
/// noise.
pub fn named(found: &Found, final_fit: &Fit, left: f64) -> Vec<NamedEffect> {
    let mut effects = Vec::new();
    for (index, placed) in found.best.model.effects.iter().enumerate() {
        if !found.best.model.stands_for_itself(index) {
            continue;
        }
        let standing = standing(found, index, placed, left);
        let rivals = |own: &Placed| {
            standing.iter().filter(|(p, _, _)| !p.says_the_same(own)).map(|(p, _, _)| p.title()).collect::<Vec<_>>()
        };
        for (rival, probability, fit) in &standing {
            let is_best = rival.says_the_same(placed);
            let (source, at) = if is_best { (final_fit, index) } else { (*fit, fit.model.effects.len() - 1) };
            if let Some(known) = effects.iter_mut().find(|e: &&mut NamedEffect| is_said(e, rival)) {
                if is_best {
                    add_branch(known, parameters(source, at));
                    written::add_law(known, placed, source, at);
                }
                continue;
            }
            let mut named = NamedEffect {
                name: rival.spec().name.clone(),
                element: rival.element.to_string(),
                channel: rival.channel.clone(),
                probability: *probability,
                rivals: rivals(rival),
                parameters: parameters(source, at),
                size_by_run: BTreeMap::new(),
                law: rival.spec().equation.clone(),
                hypothetical: rival.entry.hypothetical,
                ..NamedEffect::default()
            };
            written::describe(&mut named, rival, source, at);
            let of_each = source.model.of_each_run(at);
            if !of_each.is_empty() {
                named.differs_by_run = true;
                named.parameters = over_runs(source, &of_each);
                named.size_by_run = size_in_each(source, &of_each);
            }
            if is_best {
                named.forms = written::forms(found.forms_of(index), found.best.cost, unit_of(found, left));
            }
            effects.push(named);
        }
    }
    effects
}

/// Prior odds of an unlisted law at another port against an effect of the catalogue.
const UNLISTED: f64 = 0.02;

/// Limit of the log odds: a lower chi² of any size has a finite weight.
const CERTAIN: f64 = 50.0;

/// The best form at every other port, with its weight relative to the effect. Beside one of several effects of the
/// catalogue, a law that fits better counts as one that fits equally well, because a free shape absorbs the model
/// discrepancy of the others.
fn elsewhere(found: &Found, index: usize, left: f64) -> Vec<(f64, &Fit)> {
    let own = &found.best.model.effects[index];
    let (unit, is_law) = (unit_of(found, left), own.entry.hypothetical);
    let prior = if is_law { 1.0 } else { UNLISTED };
    let most = if is_law || found.best.model.effects.len() == 1 { CERTAIN } else { 0.0 };
    let mut ports = vec![written::port(own)];
    let mut forms = Vec::new();
    for fit in found.forms_of(index) {
        let Some(port) = fit.model.effects.last().map(written::port).filter(|port| !ports.contains(port)) else {
            continue;
        };
        ports.push(port);
        let odds = ((found.best.cost - fit.cost) / (2.0 * unit)).min(most).exp();
        forms.push((prior * odds, fit));
    }
    forms
}

/// Alternatives that keep an answer ambiguous.
#[derive(Clone, Debug)]
pub struct Open<'a> {
    /// Alternatives to effects that are not certain.
    pub rivals: Vec<&'a Fit>,
    /// Dispersion: difference in chi² that counts as one, above 1 if the best model leaves a misfit.
    pub unit: f64,
}

/// The open alternatives; `left` as for [`named`].
pub fn open(found: &Found, left: f64) -> Open<'_> {
    let mut rivals = Vec::new();
    for (index, placed) in found.best.model.effects.iter().enumerate() {
        if !found.best.model.stands_for_itself(index) {
            continue;
        }
        let standing = standing(found, index, placed, left);
        let own =
            standing.iter().find(|(p, _, _)| p.says_the_same(placed)).map_or(1.0, |(_, probability, _)| *probability);
        if own >= SURE {
            continue;
        }
        rivals.extend(standing.iter().filter(|(p, _, _)| !p.says_the_same(placed)).map(|(_, _, fit)| *fit));
        let forms = elsewhere(found, index, left).into_iter();
        rivals.extend(forms.filter(|(weight, _)| weight * own >= LEAST_PROBABILITY).map(|(_, fit)| fit));
    }
    Open { rivals, unit: unit_of(found, left) }
}

/// All other models fitted in place of the best, with their chi², cheapest first: one row per set of effects. A model
/// that reads like the answer has another form, and the row says which parameter it differs in.
pub fn lost(found: &Found) -> Vec<(String, f64)> {
    let words = |fit: &Fit| {
        let mut effects: Vec<String> = fit.model.effects.iter().map(Placed::title).collect();
        effects.sort();
        effects
    };
    let answer = words(&found.best);
    let mut fits: Vec<&Fit> = found.rivals.iter().flatten().collect();
    fits.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    let mut rows: Vec<(String, f64)> = Vec::new();
    for fit in fits {
        let effects = words(fit);
        let own_key = fit.model.effects.last().map_or("", |e| &e.spec().parameters[0].key);
        let title = effects.join(" + ");
        let title = if effects == answer { format!("{title} (with {own_key})") } else { title };
        if rows.iter().all(|(known, _)| *known != title) {
            rows.push((title, fit.cost));
        }
    }
    rows
}

/// Whether an answer names this effect.
pub fn is_said(effect: &NamedEffect, placed: &Placed) -> bool {
    effect.name == placed.spec().name
        && (placed.entry.hypothetical || effect.element == placed.element.to_string())
        && effect.channel == placed.channel
}

/// Probabilities of an effect and its alternatives, best first; the same description is counted once.
fn standing<'a>(found: &'a Found, index: usize, placed: &Placed, left: f64) -> Vec<(Placed, f64, &'a Fit)> {
    let best = &found.best;
    // A hypothesis has no rivals by name: what the catalogue offers instead has lost already.
    let is_hypothesis = placed.entry.hypothetical;
    let rivals = found.rivals.get(index).filter(|_| !is_hypothesis).map_or(&[][..], Vec::as_slice);
    let unit = unit_of(found, left);
    let mut all: Vec<(Placed, f64, &Fit)> = vec![(placed.clone(), 1.0, best)];
    for rival in rivals {
        let Some(own) = rival.model.effects.last() else { continue };
        if all.iter().any(|(p, _, _)| p.says_the_same(own)) {
            continue;
        }
        all.push((own.clone(), (-(rival.cost - found.rivals_against).max(0.0) / (2.0 * unit)).exp(), rival));
    }
    // The same at another port is another answer, if not another line.
    let others: f64 = elsewhere(found, index, left).iter().map(|(w, _)| w).sum();
    let sum: f64 = all.iter().map(|(_, w, _)| w).sum::<f64>() + others;
    all.iter_mut().for_each(|(_, w, _)| *w /= sum);
    all.retain(|(p, w, _)| *w >= LEAST_PROBABILITY || p == placed);
    all
}

/// Dispersion as a share of what the best model leaves, or explains. With all of the remaining misfit it was too
/// conservative: of 38 ambiguous answers 33 named the truth first (calibration: docs/proof.md).
const UNIT_OF_LEFT: f64 = 1.0 / 3.0;
const UNIT_OF_EXPLAINED: f64 = 0.005 / 3.0;

/// Dispersion of a model that explains and leaves this much chi². Differences count relative to the model discrepancy,
/// at most relative to what is explained, not to the number of samples.
pub fn unit(explained: f64, left: f64) -> f64 {
    (UNIT_OF_EXPLAINED * explained).min(UNIT_OF_LEFT * left).max(1.0)
}

/// The dispersion for each effect of the answer.
fn unit_of(found: &Found, left: f64) -> f64 {
    unit((found.baseline.cost - found.best.cost) / found.best.model.effects.len() as f64, left)
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::diagnose::fit::Model;
    use crate::effects::{Element, ElementKind, find};

    fn fit(ids: &[&str], cost: f64) -> Fit {
        let model = ids.iter().fold(Model::baseline(), |model, id| {
            let entry = find(id).expect("of the catalogue");
            let placed = Placed { entry, element: Element::of(ElementKind::Muscle, 0, 1), channel: None };
            model.plus(&placed, &entry.typical())
        });
        let n = model.effect_parameters();
        let x = model.places().iter().map(|&(e, i)| model.numbers[e].values[i]).collect();
        Fit { model, x, cost, covariance: DMatrix::zeros(n, n), on_bound: Vec::new() }
    }

    fn found(best: Fit, rivals: Vec<Fit>) -> Found {
        Found {
            baseline: fit(&[], 1000.0),
            rivals_against: best.cost,
            best,
            rivals: vec![rivals],
            screened: Vec::new(),
            forms: Vec::new(),
            withheld: None,
            described: None,
        }
    }

    /// A tenth of the baseline's misfit may be model discrepancy; more is missing physics.
    #[test]
    fn what_leaves_a_part_unexplained_is_not_believed_to_the_end() {
        let [weight, nothing] = [&["gravity_load"][..], &[]].map(|ids| found(fit(ids, 100.0), Vec::new()));
        let excess = |best: f64| Excess { baseline: 1.0, best, error: 1e-3 };
        assert!(!leaves_a_part(&weight, excess(0.09)));
        assert!(leaves_a_part(&weight, excess(0.11)));
        assert!(leaves_a_part(&nothing, excess(0.09)));
        let mut effects = named(&weight, &fit(&["gravity_load"], 100.0), 10.0);
        assert_eq!(effects[0].probability, 1.0);
        doubt(&mut effects);
        assert_eq!(effects[0].probability, MOST_IN_PART);
    }

    /// A law is made for these recordings: what it leaves is not its idealisation. Of a listed effect that may be.
    #[test]
    fn a_law_that_leaves_noises_is_not_certain_of_its_place() {
        let [law, weight] = ["hypothetical_force", "gravity_load"].map(|id| found(fit(&[id], 100.0), Vec::new()));
        let excess = |best: f64| Excess { baseline: 4000.0, best, error: 1e-3 };
        assert!(is_approximate(&law, excess(11.0)) && !is_approximate(&law, excess(0.1)));
        assert!(!is_approximate(&weight, excess(11.0)));
        assert!(!is_approximate(&law, Excess { error: 10.0, ..excess(11.0) }));
    }

    /// A form that fits far better makes a single effect doubtful. Beside another effect it may have absorbed that
    /// one's model discrepancy.
    #[test]
    fn of_several_effects_a_law_elsewhere_counts_as_one_that_fits_as_well() {
        let elsewhere = fit(&["hypothetical_flow"], 40.0);
        let probability = |ids: &[&str]| {
            let forms = vec![vec![elsewhere.clone()]; ids.len()];
            let rivals = vec![Vec::new(); ids.len()];
            let found = Found { forms, rivals, ..found(fit(ids, 100.0), Vec::new()) };
            named(&found, &found.best, 0.0).iter().map(|e| e.probability).fold(1.0, f64::min)
        };
        assert!(probability(&["gravity_load"]) < 1e-6);
        assert!((probability(&["gravity_load", "leak"]) - 1.0 / (1.0 + UNLISTED)).abs() < 1e-12);
    }

    #[test]
    fn terms_of_a_hypothesis_do_not_count_against_the_rivals_of_what_stands_beside_them() {
        let plain = found(fit(&["gravity_load"], 100.0), vec![fit(&["coil_preload"], 101.0)]);
        let grown = Found { best: fit(&["gravity_load", "hypothetical_force"], 40.0), ..plain.clone() };
        let probabilities = |found: &Found| -> Vec<(String, f64)> {
            let effects = named(found, &found.best, 0.0).into_iter();
            effects.filter(|e| !e.hypothetical).map(|e| (e.name, e.probability)).collect()
        };
        assert!((probabilities(&plain)[0].1 - 1.0 / (1.0 + (-0.5f64).exp())).abs() < 1e-12);
        assert_eq!(probabilities(&grown), probabilities(&plain));
    }
}
