//! Effects that stand where nothing is missing.
//!
//! Left out of an answer, an effect leaves a misfit. Where something unknown at another place makes that far likelier than anything at the
//! effect's own, and likelier than the effect makes it, the effect only stands in for it.

use super::forms::{Criterion, equally_good};
use super::hypothesis::{CLEARLY, Lawful, without_idle};
use super::unlisted::propose;
use crate::diagnose::case::{Case, Noise, RunSet, Step};
use crate::diagnose::fit::{Fit, Problem, Sides};
use crate::diagnose::grammar::Reach;
use crate::diagnose::latent::{Latent, is_behind, latents};
use crate::diagnose::search::Found;
use crate::diagnose::verdict;

/// What was found with a law at a likelier place instead of one of its effects, where that is clearly better.
pub(in crate::diagnose) fn exchanged(
    case: &Case,
    noise: &[Noise],
    found: &Found,
    say: &dyn Fn(String),
) -> Option<Found> {
    if case.is_without(Step::OpenSet) || found.withheld.is_some() {
        return None;
    }
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let effects = found.best.model.effects.iter().enumerate();
    let listed = effects.filter(|(_, effect)| !effect.entry.hypothetical);
    listed.map(|(index, _)| index).find_map(|index| elsewhere(&open, found, index, say))
}

/// The same for one of them.
fn elsewhere(open: &Problem, found: &Found, index: usize, say: &dyn Fn(String)) -> Option<Found> {
    let own = &found.best.model.effects[index];
    let others = found.best.model.effects.len() - 1;
    let bare = match others {
        0 => found.baseline.clone(),
        _ => open.fit(&found.best.model.without(index), &open.start_without(&found.best, index))?,
    };
    let known = open.rows(&bare.model, &bare.x, 0..bare.x.len(), Sides::Both)?;
    let latents = latents(open, &bare, &known);
    if !is_behind(&latents, &verdict::port(own)) || !is_likelier(open, &latents, &bare, &found.best) {
        return None;
    }
    say(format!("{} is not where something is missing", own.title()));
    let proposals = propose(open, &bare, Reach::Plain, say)?;
    let (best, forms) = equally_good(open, &proposals.fits, bare.cost)?;
    let (best, forms) = without_idle(open, best, forms);
    let criterion = Criterion::of(open, [&best, &found.best]);
    let is_better = criterion.at(&best) < criterion.at(&found.best) - CLEARLY;
    is_better.then(|| Lawful { best, forms }.beside(found))
}

/// Whether something unknown at the likeliest place makes what an effect leaves out likelier than the effect does.
fn is_likelier(open: &Problem, latents: &[Latent], bare: &Fit, with: &Fit) -> bool {
    let numbers = with.model.effect_numbers() - bare.model.effect_numbers();
    let explained = bare.cost - with.cost - numbers as f64 * (open.samples() as f64).ln();
    latents.first().is_some_and(|likeliest| likeliest.log_odds > explained + CLEARLY)
}
