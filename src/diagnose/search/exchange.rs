//! Stepwise deletions and exchanges: every effect of a model must be needed, and better than any alternative.

use super::refits::{Absorbed, BRANCH_TIE, pick, refit};
use super::screening::screen;
use crate::diagnose::fit::{Fit, Model, Placed, Problem, Variant};

/// Exchanges of one search, with their results.
pub(super) struct Exchange<'a> {
    pub problem: &'a Problem<'a>,
    pub variants: &'a [Variant],
    /// Effects that were useful somewhere: they are retried even if the calibration absorbs them.
    pub known: Vec<Placed>,
    /// Results of earlier exchanges; a search that reaches one of them again ends there.
    ends: Vec<Converged>,
}

/// A model in which every effect is needed and none has a better alternative; with the alternatives tried for each
/// effect.
#[derive(Clone, Debug)]
pub(super) struct Converged {
    pub best: Fit,
    pub rivals: Vec<Vec<Fit>>,
}

/// The step that added a model's last effect: the fit before it, and all candidates, cheapest first.
pub(super) struct Stage<'a> {
    pub before: &'a Fit,
    pub refits: &'a [Fit],
}

impl<'a> Exchange<'a> {
    pub fn new(problem: &'a Problem<'a>, variants: &'a [Variant], known: Vec<Placed>) -> Self {
        Self { problem, variants, known, ends: Vec::new() }
    }

    /// Deletes redundant effects and replaces others by better ones until neither helps. `last`: how the start's last
    /// effect was added, if known; that step is not repeated.
    pub fn converge(&mut self, start: Fit, least: f64, mut last: Option<Stage>, say: &dyn Fn(String)) -> Converged {
        let mut best = start;
        let mut rivals: Vec<Vec<Fit>> = Vec::new();
        while rivals.len() < best.model.effects.len() {
            if let Some(end) = self.ends.iter().find(|end| is_same(&end.best, &best)) {
                return end.clone();
            }
            let index = rivals.len();
            let is_last = index + 1 == best.model.effects.len();
            let tried = match last.as_ref().filter(|_| is_last) {
                Some(stage) => Some((stage.before.clone(), others(stage.refits, &best.model))),
                None => self.in_place_of(&best, index, least),
            };
            let Some((fewer, refits)) = tried else {
                rivals.push(Vec::new());
                continue;
            };
            let tie = if has_branches(&best.model) { BRANCH_TIE * (fewer.cost - best.cost).max(0.0) } else { 0.0 };
            let better = match refits.first().filter(|f| f.cost < best.cost - 1.0 - tie) {
                _ if fewer.cost - best.cost < least => fewer,
                Some(other) => other.clone(),
                None => {
                    rivals.push(refits);
                    continue;
                }
            };
            say(format!("rather {}: chi2 {:.0} -> {:.0}", better.model.title(), best.cost, better.cost));
            best = better;
            rivals.clear();
            last = None;
        }
        let end = Converged { best, rivals };
        self.ends.push(end.clone());
        end
    }

    /// Fits without one effect, and with each alternative in its place. `None` if the model cannot be simulated without
    /// it.
    fn in_place_of(&mut self, best: &Fit, index: usize, least: f64) -> Option<(Fit, Vec<Fit>)> {
        let start = self.problem.start_without(best, index);
        let fewer = self.problem.fit(&best.model.without(index), &start)?;
        let refits = screen(self.problem, &fewer, self.variants).map_or_else(Vec::new, |screening| {
            let mut others = pick(&screening.screened, least, Absorbed::Among(&self.known));
            // What stands there already would only be found again.
            others.retain(|s| s.variant.placed != best.model.effects[index]);
            refit(self.problem, &screening, &others)
        });
        self.keep_in_mind(&fewer, &refits, least);
        Some((fewer, refits))
    }

    /// Records which effects were useful.
    pub fn keep_in_mind(&mut self, before: &Fit, refits: &[Fit], least: f64) {
        for placed in refits.iter().filter(|f| before.cost - f.cost > least).filter_map(|f| f.model.effects.last()) {
            if !self.known.contains(placed) {
                self.known.push(placed.clone());
            }
        }
    }
}

/// Costs of one model that differ by less than this share belong to the same fit, reached from different sides.
const SAME_COST: f64 = 2e-4;

/// Whether two fits are the same: equal effects in any order, at the same cost.
pub(super) fn is_same(a: &Fit, b: &Fit) -> bool {
    let sorted = |fit: &Fit| {
        let mut effects = fit.model.effects.clone();
        effects.sort();
        effects
    };
    (a.cost - b.cost).abs() < SAME_COST * a.cost && sorted(a) == sorted(b)
}

/// Candidates tried with the effect that a model ends with.
fn others(refits: &[Fit], model: &Model) -> Vec<Fit> {
    refits.iter().filter(|f| f.model.effects.last() != model.effects.last()).cloned().collect()
}

/// Whether an effect has several branches.
fn has_branches(model: &Model) -> bool {
    model.effects.iter().enumerate().any(|(i, e)| model.effects[..i].contains(e))
}
