//! Stepwise search from the calibration upwards, one effect at a time.

use super::discrepancy::Described;
use super::exchange::Exchange;
use super::screening::{Screened, least_gain, screen};
use super::way::{Bound, MOST_EFFECTS, Seen, Up, Way, climb, leaves_much, several_to_begin};
use crate::diagnose::case::Optional;
use crate::diagnose::fit::{Fit, Placed, Problem, Variant};

/// A model with the alternatives refitted beside it.
#[derive(Clone, Debug)]
pub struct Found {
    pub baseline: Fit,
    pub best: Fit,
    /// For each effect of the best: the alternatives refitted in its place; cheapest first.
    pub rivals: Vec<Vec<Fit>>,
    /// Chi² to compare the alternatives with: of the best model as they were fitted, before hypothetical terms.
    pub rivals_against: f64,
    /// Screening at the baseline.
    pub screened: Vec<Screened>,
    /// For each effect of the best: other forms (shapes, places) that explain as much; the law is the last effect of
    /// each.
    pub forms: Vec<Vec<Fit>>,
    /// The answer that was withheld because it predicts held-out runs worse than the calibration, or cannot be
    /// simulated.
    pub withheld: Option<Box<Found>>,
    /// The best with further effects behind its own that describe what it leaves.
    pub described: Option<Described>,
}

impl Found {
    /// What predicts: the best, with what describes its discrepancy.
    pub fn corrected(&self) -> &Fit {
        self.described.as_ref().map_or(&self.best, |described| &described.fit)
    }

    /// Forms of one effect.
    pub fn forms_of(&self, effect: usize) -> &[Fit] {
        self.forms.get(effect).map_or(&[], Vec::as_slice)
    }

    /// The same with these forms for the last effect, and none for the others.
    pub fn with_last_forms(self, forms: Vec<Fit>) -> Self {
        let others = self.best.model.effects.len().saturating_sub(1);
        Self { forms: std::iter::repeat_n(Vec::new(), others).chain([forms]).collect(), ..self }
    }

    /// Effects that were worth a fit.
    pub(super) fn known(&self) -> Vec<Placed> {
        let rivals = self.rivals.iter().flatten().filter_map(|f| f.model.effects.last());
        self.best.model.effects.iter().chain(rivals).cloned().collect()
    }
}

/// A search under way.
#[derive(Clone)]
pub(in crate::diagnose) struct Begun {
    baseline: Fit,
    way: Way,
    seen: Seen,
    /// Effects that were useful somewhere.
    known: Vec<Placed>,
    screened: Vec<Screened>,
    is_new: bool,
}

impl Begun {
    /// Finds the best single effect.
    pub fn with_one(problem: &Problem, baseline: Fit, variants: &[Variant], say: &dyn Fn(String)) -> Self {
        let screening = screen(problem, &baseline, variants);
        let screened = screening.as_ref().map_or_else(Vec::new, |s| s.screened.clone());
        let way = Way { screening, ..Way::at(baseline.clone(), Vec::new()) };
        let (mut exchange, mut seen) = (Exchange::new(problem, variants, Vec::new()), Seen::default());
        let way = climb(&mut exchange, &baseline, way, &mut seen, (Up::to(1), Bound::default()), say);
        Self { baseline, way, seen, known: exchange.known, screened, is_new: true }
    }

    /// Continues from the result of an earlier search.
    pub fn again(
        problem: &Problem,
        (baseline, start): (Fit, Fit),
        variants: &[Variant],
        known: Vec<Placed>,
        say: &dyn Fn(String),
    ) -> Self {
        if start.model.effects.is_empty() {
            return Self { known, ..Self::with_one(problem, baseline, variants, say) };
        }
        let screened = screen(problem, &baseline, variants).map_or_else(Vec::new, |s| s.screened);
        let mut exchange = Exchange::new(problem, variants, known);
        let converged = exchange.converge(start, least_gain(problem.samples()), None, say);
        let way = Way::at(converged.best, converged.rivals);
        Self { baseline, way, seen: Seen::default(), known: exchange.known, screened, is_new: false }
    }

    /// Continues to at most this many effects, one by one.
    pub fn up_to(mut self, problem: &Problem, variants: &[Variant], most: usize, say: &dyn Fn(String)) -> Self {
        let mut exchange = Exchange::new(problem, variants, std::mem::take(&mut self.known));
        let singly = Up { most, is_singly: true };
        self.way = climb(&mut exchange, &self.baseline, self.way, &mut self.seen, (singly, Bound::default()), say);
        self.known = exchange.known;
        self
    }

    /// The result so far.
    pub fn found(&self) -> Found {
        Found {
            baseline: self.baseline.clone(),
            rivals_against: self.way.best.cost,
            best: self.way.best.clone(),
            rivals: self.way.rivals.clone(),
            screened: self.screened.clone(),
            forms: Vec::new(),
            withheld: None,
            described: None,
        }
    }

    /// Continues to the end.
    ///
    /// The search is greedy. If it ends with much misfit, it may have started with the wrong effect, and the next best
    /// starts are tried. It stops where a law outdoes its effects.
    pub fn finish(mut self, problem: &Problem, variants: &[Variant], law: Bound, say: &dyn Fn(String)) -> Found {
        let mut exchange = Exchange::new(problem, variants, std::mem::take(&mut self.known));
        let baseline = self.baseline.clone();
        let is_outdone = law.outdoes(problem, &baseline, &self.way.best);
        if self.is_new && self.way.best.model.effects.is_empty() && !is_outdone {
            self.way = several_to_begin(&mut exchange, self.way, say);
        }
        self.way = climb(&mut exchange, &baseline, self.way, &mut self.seen, (Up::to(MOST_EFFECTS), law), say);
        let best = &self.way.best;
        let is_done = law.outdoes(problem, &baseline, best) || !leaves_much(problem, &baseline, best);
        if !self.is_new || best.model.effects.len() < 2 || is_done {
            return self.found();
        }
        for other in other_beginnings(&baseline, &self.way.first, &self.seen) {
            if !leaves_much(problem, &baseline, &self.way.best)
                || !problem.case.effort.allows(Optional::OtherBeginnings)
            {
                break;
            }
            if !self.seen.is_new(&other) {
                continue;
            }
            say(format!("once more, beginning with {}", other.model.title()));
            let mut way = Way::at(other, Vec::new());
            for most in 2..=MOST_EFFECTS {
                // Several at once cost more than all else, and were tried on the first way.
                let singly = Up { most, is_singly: true };
                way = climb(&mut exchange, &baseline, way, &mut self.seen, (singly, law), say);
                if self.seen.is_behind(&way.best) {
                    break;
                }
            }
            if way.best.cost < self.way.best.cost - least_gain(problem.samples()) {
                (self.way.best, self.way.rivals) = (way.best, way.rivals);
            }
        }
        self.found()
    }
}

/// Other starts that are tried, and the share of the best gain that they need.
const BEGINNINGS: usize = 2;
const BEGINNING_WORTH: f64 = 0.3;

/// The best fits with one effect that no path has visited, each effect once.
fn other_beginnings(baseline: &Fit, first: &[Fit], seen: &Seen) -> Vec<Fit> {
    let worth = baseline.cost - BEGINNING_WORTH * (baseline.cost - first.first().map_or(0.0, |f| f.cost));
    let mut others: Vec<Fit> = Vec::new();
    for fit in first.iter().filter(|f| f.cost < worth && !seen.contains(f)) {
        if others.iter().all(|other| other.model.title() != fit.model.title()) {
            others.push(fit.clone());
        }
    }
    others.truncate(BEGINNINGS);
    others
}

/// The result with another best model and its alternatives.
pub(in crate::diagnose) fn converged(
    problem: &Problem,
    found: Found,
    best: Fit,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> Found {
    let converged =
        Exchange::new(problem, variants, found.known()).converge(best, least_gain(problem.samples()), None, say);
    Found { rivals_against: converged.best.cost, best: converged.best, rivals: converged.rivals, ..found }
}
