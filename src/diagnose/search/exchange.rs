//! Deletions and exchanges: what stands in a model must be needed, and better than anything else in its place.

use super::refits::{Absorbed, BRANCH_TIE, pick, refit};
use super::screening::screen;
use crate::diagnose::fit::{Fit, Model, Placed, Problem, Variant};

/// Exchanges in one search, and what they have come to.
pub(super) struct Exchange<'a> {
    pub problem: &'a Problem<'a>,
    pub variants: &'a [Variant],
    /// Effects that have been worth something somewhere: they are tried again even where the calibration takes them in.
    pub known: Vec<Placed>,
    /// Ends of former exchanges: those that come there again end with them.
    ends: Vec<Converged>,
}

/// A model in which nothing is needless and nothing else is better, with the others tried in place of each of its effects.
#[derive(Clone, Debug)]
pub(super) struct Converged {
    pub best: Fit,
    pub rivals: Vec<Vec<Fit>>,
}

/// The stage that added a model's last effect: the fit without it, and all that were tried, cheapest first.
pub(super) struct Stage<'a> {
    pub before: &'a Fit,
    pub refits: &'a [Fit],
}

impl<'a> Exchange<'a> {
    pub fn new(problem: &'a Problem<'a>, variants: &'a [Variant], known: Vec<Placed>) -> Self {
        Self { problem, variants, known, ends: Vec::new() }
    }

    /// Leaves out effects that others have made needless and puts better ones in their place, until neither helps. `last`:
    /// how the start's last effect was added, if that is known; it is not done again.
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

    /// A model without one of its effects, and others in its place. `None` where it cannot be simulated without.
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

    /// Remembers which effects were worth something.
    pub fn keep_in_mind(&mut self, before: &Fit, refits: &[Fit], least: f64) {
        for placed in refits.iter().filter(|f| before.cost - f.cost > least).filter_map(|f| f.model.effects.last()) {
            if !self.known.contains(placed) {
                self.known.push(placed.clone());
            }
        }
    }
}

/// Costs of one model that differ by a smaller share are those of one fit: ways come to it from different sides.
const SAME_COST: f64 = 2e-4;

/// Whether two fits are one: the same effects, in whatever order, at the same cost.
pub(super) fn is_same(a: &Fit, b: &Fit) -> bool {
    let sorted = |fit: &Fit| {
        let mut effects = fit.model.effects.clone();
        effects.sort();
        effects
    };
    (a.cost - b.cost).abs() < SAME_COST * a.cost && sorted(a) == sorted(b)
}

/// What was tried beside the effect that a model ends with.
fn others(refits: &[Fit], model: &Model) -> Vec<Fit> {
    refits.iter().filter(|f| f.model.effects.last() != model.effects.last()).cloned().collect()
}

/// Whether an effect stands there with more than one branch.
fn has_branches(model: &Model) -> bool {
    model.effects.iter().enumerate().any(|(i, e)| model.effects[..i].contains(e))
}
