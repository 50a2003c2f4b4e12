//! One greedy path: effect by effect, or several at once.

use super::exchange::{Converged, Exchange, Stage, is_same};
use super::refits::{
    Absorbed, adds_branch, afresh, candidates, cross_validates, first_that_cross_validates, pick, refit,
};
use super::screening::{Screening, least_gain, screen};
use crate::diagnose::case::Optional;
use crate::diagnose::fit::{Fit, Problem};

/// Maximum number of effects in one answer.
pub(in crate::diagnose) const MOST_EFFECTS: usize = 4;
/// An effect below this share of the explained misfit may only absorb the model discrepancy of others.
const LEAST_OF_ALL: f64 = 1e-3;

/// An effect must explain this share of the explained misfit, or that share of the remaining one: model discrepancy of
/// the other laws can be imitated in part.
const FAIR_OF_ALL: f64 = 0.03;
const FAIR_OF_LEFT: f64 = 0.75;

/// Share of the misfit that counts as much.
const MUCH: f64 = 0.05;

/// Whether a fit leaves much of the baseline's misfit.
pub(in crate::diagnose) fn leaves_much(problem: &Problem, baseline: &Fit, best: &Fit) -> bool {
    let noise = problem.noise_cost();
    best.cost - noise > MUCH * (baseline.cost - noise) && best.cost - noise > least_gain(problem.samples())
}

/// An unlisted law that the search competes with.
#[derive(Clone, Copy, Default)]
pub(in crate::diagnose) struct Bound<'a> {
    pub law: Option<&'a Fit>,
    /// Whether it leaves next to nothing.
    pub is_enough: bool,
}

impl Bound<'_> {
    /// Whether the law leaves less than listed effects: next to nothing where they leave much, little with fewer parts, or anything with far fewer.
    /// One that leaves as little as a single effect proves nothing: a free shape always fits better. Two laws, or one beside an effect, outdo
    /// three effects at least: names are to be tried before they count as missing.
    pub fn outdoes(&self, problem: &Problem, baseline: &Fit, listed: &Fit) -> bool {
        self.law.is_some_and(|law| {
            let [parts, own] = [listed, law].map(|fit| fit.model.effects.len());
            let is_lower = law.cost < listed.cost - least_gain(problem.samples());
            let is_little = || parts > own && !leaves_much(problem, baseline, law);
            let is_enough = || self.is_enough && leaves_much(problem, baseline, listed) && (own == 1 || parts > own);
            is_lower && (parts > own + 1 || is_little() || is_enough())
        })
    }
}

/// One greedy path.
#[derive(Clone)]
pub(super) struct Way {
    pub best: Fit,
    pub rivals: Vec<Vec<Fit>>,
    /// Refits with one effect, cheapest first, if the path started from none.
    pub first: Vec<Fit>,
    /// Screening at `best`, if known.
    pub screening: Option<Screening>,
    /// Refits with one effect more, if none was accepted by itself.
    pub none_alone: Option<Vec<Fit>>,
    /// Whether no addition helps.
    pub is_at_end: bool,
}

impl Way {
    pub fn at(best: Fit, rivals: Vec<Vec<Fit>>) -> Self {
        Self { best, rivals, first: Vec::new(), screening: None, none_alone: None, is_at_end: false }
    }
}

/// Models visited by the paths of one search: another path that reaches one continues as the first did.
#[derive(Clone, Default)]
pub(super) struct Seen(Vec<Fit>);

impl Seen {
    pub fn contains(&self, fit: &Fit) -> bool {
        self.0.iter().any(|other| is_same(other, fit))
    }

    /// Whether another path has reached a lower cost with as many effects.
    pub fn is_behind(&self, fit: &Fit) -> bool {
        let is_as_simple = |other: &&Fit| other.model.effects.len() <= fit.model.effects.len();
        self.0.iter().filter(is_as_simple).any(|other| other.cost < fit.cost)
    }

    /// Whether this model is new; records it.
    pub fn is_new(&mut self, fit: &Fit) -> bool {
        let is_new = !self.contains(fit);
        if is_new {
            self.0.push(fit.clone());
        }
        is_new
    }
}

/// Starts a path with several effects at once if no single one helped; unchanged if that does not help either.
pub(super) fn several_to_begin(exchange: &mut Exchange, mut way: Way, say: &dyn Fn(String)) -> Way {
    let least = least_gain(exchange.problem.samples());
    if let Some(next) = together(exchange, &way.best, &way.first, least, say) {
        (way.best, way.rivals, way.is_at_end) = (next.best, next.rivals, false);
    }
    way
}

/// [`several_at_once`], with a progress message.
fn together(
    exchange: &mut Exchange,
    before: &Fit,
    refits: &[Fit],
    least: f64,
    say: &dyn Fn(String),
) -> Option<Converged> {
    let next = several_at_once(exchange, before, refits, least)?;
    say(format!("together {}: chi2 {:.0} -> {:.0}", next.best.model.title(), before.cost, next.best.cost));
    Some(next)
}

/// Limits of a path.
#[derive(Clone, Copy)]
pub(super) struct Up {
    pub most: usize,
    /// Whether to postpone adding several effects at once, the most expensive step.
    pub is_singly: bool,
}

impl Up {
    pub fn to(most: usize) -> Self {
        Self { most, is_singly: false }
    }
}

/// Adds effects one by one and converges after each, until nothing helps, a law outdoes them, or the model was visited
/// before.
pub(super) fn climb(
    exchange: &mut Exchange,
    baseline: &Fit,
    mut way: Way,
    seen: &mut Seen,
    (up, law): (Up, Bound),
    say: &dyn Fn(String),
) -> Way {
    let problem = exchange.problem;
    while !way.is_at_end && way.best.model.effects.len() < up.most && !law.outdoes(problem, baseline, &way.best) {
        let best = &way.best;
        let tried = way.none_alone.take().map(Tried::NoneAlone).or_else(|| {
            let screening = way.screening.take().or_else(|| screen(problem, best, exchange.variants))?;
            Some(step_up(exchange, baseline, best, &screening, &mut way.first, say))
        });
        let next = match tried {
            Some(Tried::Better(next)) => Some(next),
            // [`several_to_begin`] goes on from there.
            Some(Tried::NoneAlone(_)) if best.model.effects.is_empty() => None,
            Some(Tried::NoneAlone(refits)) if up.is_singly => {
                way.none_alone = Some(refits);
                break;
            }
            Some(Tried::NoneAlone(refits)) => together(exchange, best, &refits, least_of(problem, baseline, best), say),
            None => None,
        };
        match next {
            Some(next) => {
                (way.best, way.rivals) = (next.best, next.rivals);
                way.is_at_end = !seen.is_new(&way.best);
            }
            None => way.is_at_end = true,
        }
    }
    way
}

/// Result of trying one effect more.
enum Tried {
    Better(Converged),
    /// None is accepted by itself; with the refits, of which several together may be.
    NoneAlone(Vec<Fit>),
}

/// Reduction of chi² that justifies one effect more.
fn least_of(problem: &Problem, baseline: &Fit, best: &Fit) -> f64 {
    least_gain(problem.samples()).max(LEAST_OF_ALL * (baseline.cost - best.cost).max(0.0))
}

/// The best model with one effect more, converged. `first` receives the refits if the model had none before.
fn step_up(
    exchange: &mut Exchange,
    baseline: &Fit,
    best: &Fit,
    screening: &Screening,
    first: &mut Vec<Fit>,
    say: &dyn Fn(String),
) -> Tried {
    let problem = exchange.problem;
    let least = least_of(problem, baseline, best);
    let picked = pick(&screening.screened, least, Absorbed::Any);
    say(format!("{} listed effects beside {}", picked.len(), best.model.title()));
    let refits = refit(problem, screening, &picked);
    let refits = afresh(problem, refits);
    if best.model.effects.is_empty() {
        first.clone_from(&refits);
    }
    let worthy = candidates(&refits, best, baseline.cost)
        .into_iter()
        .filter(|f| best.cost - f.cost > least && explains_its_share(problem, baseline.cost, best, f));
    exchange.keep_in_mind(best, &refits, least);
    let Some(winner) = first_that_cross_validates(problem, best, worthy, say).cloned() else {
        return Tried::NoneAlone(refits);
    };
    say(format!("{}: chi2 {:.0} -> {:.0}", winner.model.title(), best.cost, winner.cost));
    if winner.model.effects.len() > 1 {
        return Tried::Better(exchange.converge(winner, least, Some(Stage { before: best, refits: &refits }), say));
    }
    let rivals = refits.into_iter().filter(|f| f.model != winner.model).collect();
    Tried::Better(Converged { best: winner, rivals: vec![rivals] })
}

/// Several effects together must explain this share of the remaining misfit: nearly all of it, which effects that only
/// imitate a model discrepancy do not.
const TOGETHER: f64 = 0.9;
/// Misfit per sample, in noise variances, from which several at once are tried.
const MUCH_PER_SAMPLE: f64 = 0.3;

/// Adds two or more effects that explain the remaining misfit only together: if the first one found is a surrogate,
/// each single addition changes little. `None` if they do not explain it, or fail on left-out data.
fn several_at_once(exchange: &mut Exchange, before: &Fit, refits: &[Fit], least: f64) -> Option<Converged> {
    let problem = exchange.problem;
    let left = before.cost - problem.noise_cost();
    if left < MUCH_PER_SAMPLE * problem.samples() as f64 {
        return None;
    }
    let mut best = refits.first().filter(|f| before.cost - f.cost > least)?.clone();
    if !problem.case.effort.allows(Optional::SeveralAtOnce) {
        return None;
    }
    loop {
        let converged = exchange.converge(best, least, None, &|_| {});
        if before.cost - converged.best.cost > TOGETHER * left {
            return cross_validates(problem, before, &converged.best).then_some(converged);
        }
        if converged.best.model.effects.len() >= MOST_EFFECTS {
            return None;
        }
        let screening = screen(problem, &converged.best, exchange.variants)?;
        let refits = refit(problem, &screening, &pick(&screening.screened, least, Absorbed::Any));
        best = refits.into_iter().next().filter(|f| converged.best.cost - f.cost > least)?;
    }
}

/// Whether one more effect explains more than model discrepancy could.
fn explains_its_share(problem: &Problem, baseline_cost: f64, before: &Fit, after: &Fit) -> bool {
    let (gain, all) = (before.cost - after.cost, baseline_cost - after.cost);
    let left = before.cost - problem.noise_cost();
    adds_branch(before, after) || gain > FAIR_OF_ALL * all || gain > FAIR_OF_LEFT * left
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::{Model, Placed};
    use crate::effects::{Element, ElementKind, find};

    /// Fits that leave a share of the calibration's misfit, with a number of effects.
    fn fit(problem: &Problem, parts: usize, left: f64) -> Fit {
        let entry = find("leak").expect("of the catalogue");
        let placed = Placed { entry, element: Element::of(ElementKind::Line, 0, 1), channel: None };
        let model = (0..parts).fold(Model::baseline(), |model, _| model.plus(&placed, &entry.typical()));
        let cost = problem.noise_cost() * (1.0 + 10.0 * left);
        Fit { model, x: Vec::new(), cost, covariance: DMatrix::zeros(0, 0), on_bound: Vec::new() }
    }

    #[test]
    fn a_law_outdoes_effects_that_leave_more_and_are_many_or_leave_much() {
        let case = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        let noise = [Noise::white(0.02)];
        let problem = Problem { case: &case, runs: case.subset(RunSet::Open), noise: &noise };
        let fit = |parts: usize, left: f64| fit(&problem, parts, left);
        let outdoes = |left: f64, is_enough: bool, listed: Fit| {
            let law = fit(1, left);
            Bound { law: Some(&law), is_enough }.outdoes(&problem, &fit(0, 1.0), &listed)
        };
        // A law that leaves much: only three effects, and only if they leave more.
        assert!(outdoes(0.4, false, fit(3, 0.5)) && !outdoes(0.4, false, fit(3, 0.3)));
        assert!(!outdoes(0.4, false, fit(2, 0.5)) && !outdoes(0.4, false, fit(1, 0.9)));
        // One that leaves little: two effects; two such, three effects. One that leaves next to nothing: also one that leaves much, or none at all.
        assert!(outdoes(0.04, false, fit(2, 0.5)) && !outdoes(0.04, false, fit(1, 0.5)));
        let two = fit(2, 0.04);
        let by_two = |parts: usize| {
            [false, true]
                .map(|is_enough| Bound { law: Some(&two), is_enough }.outdoes(&problem, &fit(0, 1.0), &fit(parts, 0.5)))
        };
        assert!(by_two(3) == [true; 2] && by_two(2) == [false; 2]);
        assert!(
            outdoes(0.01, true, fit(1, 0.5)) && outdoes(0.01, true, fit(0, 1.0)) && !outdoes(0.01, true, fit(1, 0.04))
        );
        assert!(!Bound::default().outdoes(&problem, &fit(0, 1.0), &fit(3, 0.9)));
    }
}
