//! Which effects explain the recordings: ways up from the calibration, effect by effect.

use super::exchange::Exchange;
use super::screening::{Screened, least_gain, screen};
use super::way::{Bound, MOST_EFFECTS, Seen, Up, Way, climb, leaves_much, several_to_begin};
use crate::diagnose::fit::{Fit, Placed, Problem, Variant};

/// A model with the rivals that were refitted beside it.
#[derive(Clone, Debug)]
pub struct Found {
    pub baseline: Fit,
    pub best: Fit,
    /// For each effect of the best: the other effects tried in its place, refitted jointly; cheapest first.
    pub rivals: Vec<Vec<Fit>>,
    /// Chi² that the rivals' compares with: the best's beside which they were fitted, before it was given hypothetical terms.
    pub rivals_against: f64,
    /// What the baseline's residual promised of every effect.
    pub screened: Vec<Screened>,
    /// For each effect of the best: laws of other shapes or at other places that explain as much in its place, the last effect of each.
    pub forms: Vec<Vec<Fit>>,
    /// What predicts held-out runs worse than the calibration, or cannot be played: known, and not put into the scene.
    pub withheld: Option<Box<Found>>,
}

impl Found {
    /// Those of one effect.
    pub fn forms_of(&self, effect: usize) -> &[Fit] {
        self.forms.get(effect).map_or(&[], Vec::as_slice)
    }

    /// The same with these for the last effect, and none for the others.
    pub fn with_last_forms(self, forms: Vec<Fit>) -> Self {
        let others = self.best.model.effects.len().saturating_sub(1);
        Self { forms: std::iter::repeat_n(Vec::new(), others).chain([forms]).collect(), ..self }
    }

    /// Effects that were worth fitting.
    pub(super) fn known(&self) -> Vec<Placed> {
        let rivals = self.rivals.iter().flatten().filter_map(|f| f.model.effects.last());
        self.best.model.effects.iter().chain(rivals).cloned().collect()
    }
}

/// A search that has begun: where its way up stands, and what it has come by.
#[derive(Clone)]
pub(in crate::diagnose) struct Begun {
    baseline: Fit,
    way: Way,
    seen: Seen,
    /// Effects that one knows to be worth something somewhere.
    known: Vec<Placed>,
    screened: Vec<Screened>,
    is_new: bool,
}

impl Begun {
    /// The best single effect beside the calibration.
    pub fn with_one(problem: &Problem, baseline: Fit, variants: &[Variant], say: &dyn Fn(String)) -> Self {
        let screening = screen(problem, &baseline, variants);
        let screened = screening.as_ref().map_or_else(Vec::new, |s| s.screened.clone());
        let way = Way { screening, ..Way::at(baseline.clone(), Vec::new()) };
        let (mut exchange, mut seen) = (Exchange::new(problem, variants, Vec::new()), Seen::default());
        let way = climb(&mut exchange, &baseline, way, &mut seen, (Up::to(1), Bound(None)), say);
        Self { baseline, way, seen, known: exchange.known, screened, is_new: true }
    }

    /// From what a former search has found and known.
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

    /// Goes on to so many effects one by one, and no further.
    pub fn up_to(mut self, problem: &Problem, variants: &[Variant], most: usize, say: &dyn Fn(String)) -> Self {
        let mut exchange = Exchange::new(problem, variants, std::mem::take(&mut self.known));
        let singly = Up { most, is_singly: true };
        self.way = climb(&mut exchange, &self.baseline, self.way, &mut self.seen, (singly, Bound(None)), say);
        self.known = exchange.known;
        self
    }

    /// What stands as far as it went.
    pub fn found(&self) -> Found {
        Found {
            baseline: self.baseline.clone(),
            rivals_against: self.way.best.cost,
            best: self.way.best.clone(),
            rivals: self.way.rivals.clone(),
            screened: self.screened.clone(),
            forms: Vec::new(),
            withheld: None,
        }
    }

    /// Goes on to the end.
    ///
    /// The way up is greedy. Where it ends with much left over it may have begun with the wrong effect: then the next best
    /// beginnings are tried as well. Where a law outdoes two effects the way ends there.
    pub fn finish(mut self, problem: &Problem, variants: &[Variant], law: Bound, say: &dyn Fn(String)) -> Found {
        let mut exchange = Exchange::new(problem, variants, std::mem::take(&mut self.known));
        let baseline = self.baseline.clone();
        if self.is_new && self.way.best.model.effects.is_empty() {
            self.way = several_to_begin(&mut exchange, self.way, say);
        }
        self.way = climb(&mut exchange, &baseline, self.way, &mut self.seen, (Up::to(MOST_EFFECTS), law), say);
        let best = &self.way.best;
        let is_done = law.outdoes(problem, &baseline, best) || !leaves_much(problem, &baseline, best);
        if !self.is_new || best.model.effects.len() < 2 || is_done {
            return self.found();
        }
        for other in other_beginnings(&baseline, &self.way.first, &self.seen) {
            if !leaves_much(problem, &baseline, &self.way.best) {
                break;
            }
            if !self.seen.is_new(&other) {
                continue;
            }
            say(format!("once more, beginning with {}", other.model.title()));
            let mut way = Way::at(other, Vec::new());
            for most in 2..=MOST_EFFECTS {
                way = climb(&mut exchange, &baseline, way, &mut self.seen, (Up::to(most), law), say);
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

/// Beginnings other than the best that are tried, and the share of its gain that makes one worth it.
const BEGINNINGS: usize = 2;
const BEGINNING_WORTH: f64 = 0.3;

/// The best fits with one effect that no way has come by, each effect once.
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

/// What was found with another best model, and the rivals of that.
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
