//! One way up from a fit: effect by effect, or several at once.

use super::exchange::{Converged, Exchange, Stage, is_same};
use super::refits::{
    Absorbed, adds_branch, afresh, candidates, cross_validates, first_that_cross_validates, pick, refit,
};
use super::screening::{Screening, least_gain, screen};
use crate::diagnose::fit::{Fit, Problem};

/// At most this many effects in one answer.
pub(in crate::diagnose) const MOST_EFFECTS: usize = 4;
/// Share of all that is explained below which one more effect may be no more than the others' laws being idealised.
const LEAST_OF_ALL: f64 = 1e-3;

/// One more effect explains this share of all that is explained, or that share of what was left over: laws that are
/// idealised leave something that others imitate in part.
const FAIR_OF_ALL: f64 = 0.03;
const FAIR_OF_LEFT: f64 = 0.75;

/// Share of the misfit that is much.
const MUCH: f64 = 0.05;

/// Whether a fit leaves much of what the baseline leaves.
pub(in crate::diagnose) fn leaves_much(problem: &Problem, baseline: &Fit, best: &Fit) -> bool {
    let noise = problem.noise_cost();
    best.cost - noise > MUCH * (baseline.cost - noise) && best.cost - noise > least_gain(problem.samples())
}

/// A law that nobody listed against which the search for several effects is held: where it leaves little, they must leave less.
#[derive(Clone, Copy)]
pub(in crate::diagnose) struct Bound<'a>(pub Option<&'a Fit>);

impl Bound<'_> {
    /// Whether the law leaves less than several effects do, and not much. A single law is not compared with a single effect: it bends.
    pub fn outdoes(&self, problem: &Problem, baseline: &Fit, several: &Fit) -> bool {
        self.0.is_some_and(|law| {
            let is_simpler = [several, law].iter().any(|fit| fit.model.effects.len() > 1);
            let is_lower = law.cost < several.cost - least_gain(problem.samples());
            is_simpler && is_lower && !leaves_much(problem, baseline, law)
        })
    }
}

/// One greedy way up.
#[derive(Clone)]
pub(super) struct Way {
    pub best: Fit,
    pub rivals: Vec<Vec<Fit>>,
    /// The refits with one effect, cheapest first, if it began with none.
    pub first: Vec<Fit>,
    /// What the effects promise at `best`, where that is known.
    pub screening: Option<Screening>,
    /// The refits with one effect more, where that has been tried and none does its share by itself.
    pub none_alone: Option<Vec<Fit>>,
    /// Whether nothing that can be added helps.
    pub is_at_end: bool,
}

impl Way {
    pub fn at(best: Fit, rivals: Vec<Vec<Fit>>) -> Self {
        Self { best, rivals, first: Vec::new(), screening: None, none_alone: None, is_at_end: false }
    }
}

/// Where the ways of one search have been: another that comes there goes on as they did.
#[derive(Clone, Default)]
pub(super) struct Seen(Vec<Fit>);

impl Seen {
    pub fn contains(&self, fit: &Fit) -> bool {
        self.0.iter().any(|other| is_same(other, fit))
    }

    /// Whether a way has come further with as many effects.
    pub fn is_behind(&self, fit: &Fit) -> bool {
        let is_as_simple = |other: &&Fit| other.model.effects.len() <= fit.model.effects.len();
        self.0.iter().filter(is_as_simple).any(|other| other.cost < fit.cost)
    }

    /// Whether no way has been here before; from now on one has.
    pub fn is_new(&mut self, fit: &Fit) -> bool {
        let is_new = !self.contains(fit);
        if is_new {
            self.0.push(fit.clone());
        }
        is_new
    }
}

/// A way on which no single effect helped, begun with several at once; as it was where those do not help either.
pub(super) fn several_to_begin(exchange: &mut Exchange, mut way: Way, say: &dyn Fn(String)) -> Way {
    let least = least_gain(exchange.problem.samples());
    if let Some(next) = together(exchange, &way.best, &way.first, least, say) {
        (way.best, way.rivals, way.is_at_end) = (next.best, next.rivals, false);
    }
    way
}

/// [`several_at_once`], and says so.
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

/// How far up a way goes.
#[derive(Clone, Copy)]
pub(super) struct Up {
    pub most: usize,
    /// Whether several effects at once, where none helps by itself, are left for later: they are the dearest step of all.
    pub is_singly: bool,
}

impl Up {
    pub fn to(most: usize) -> Self {
        Self { most, is_singly: false }
    }
}

/// Adds effect by effect, and settles after each, until nothing helps, a law outdoes them or another way has been there.
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

/// What comes of one effect more.
enum Tried {
    Better(Converged),
    /// None does its share by itself; with the refits of all that were tried, of which several together may.
    NoneAlone(Vec<Fit>),
}

/// Fall of chi² that is worth an effect beside a fit.
fn least_of(problem: &Problem, baseline: &Fit, best: &Fit) -> f64 {
    least_gain(problem.samples()).max(LEAST_OF_ALL * (baseline.cost - best.cost).max(0.0))
}

/// The best with one effect more, converged. `first` gets the refits where there was none before.
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
    let refits = refit(problem, screening, &pick(&screening.screened, least, Absorbed::Any));
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

/// Share of what is left over that several effects together must explain where none does its share by itself: nearly all of it, which
/// effects that only imitate another's idealised law do not.
const TOGETHER: f64 = 0.9;
/// Misfit per sample, in units of the noise's variance, from which it is worth looking for several at once.
const MUCH_PER_SAMPLE: f64 = 0.3;

/// Two effects or more that explain together what is left over, where none of them does its share by itself: the first that was found
/// may stand for another, and then each of the others alone changes little. `None` if they do not, or not on runs left out.
fn several_at_once(exchange: &mut Exchange, before: &Fit, refits: &[Fit], least: f64) -> Option<Converged> {
    let problem = exchange.problem;
    let left = before.cost - problem.noise_cost();
    if left < MUCH_PER_SAMPLE * problem.samples() as f64 {
        return None;
    }
    let mut best = refits.first().filter(|f| before.cost - f.cost > least)?.clone();
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

/// Whether what one more effect explains is more than what another's idealised law may leave over.
fn explains_its_share(problem: &Problem, baseline_cost: f64, before: &Fit, after: &Fit) -> bool {
    let (gain, all) = (before.cost - after.cost, baseline_cost - after.cost);
    let left = before.cost - problem.noise_cost();
    adds_branch(before, after) || gain > FAIR_OF_ALL * all || gain > FAIR_OF_LEFT * left
}
