//! Removes surrogates: effects placed where nothing is missing.
//!
//! Leaving an effect out of the answer leaves a misfit. The effect is a surrogate if an unknown signal at another place
//! makes that misfit far more likely than a signal at the effect's own place, and more likely than the effect does.

use super::forms::{CLEARLY, Criterion, equally_good};
use super::hypothesis::without_idle;
use super::tried::Lawful;
use super::unlisted::propose;
use crate::diagnose::case::{Case, Noise, RunSet, Step};
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::grammar::Reach;
use crate::diagnose::latent::{Latent, is_behind, latents};
use crate::diagnose::search::Found;
use crate::diagnose::verdict;

/// Replaces one effect of the answer by a law at a more likely place, if that is clearly better.
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

/// The same for one effect.
fn elsewhere(open: &Problem, found: &Found, index: usize, say: &dyn Fn(String)) -> Option<Found> {
    let own = &found.best.model.effects[index];
    let others = found.best.model.effects.len() - 1;
    let bare = match others {
        0 => found.baseline.clone(),
        _ => open.fit(&found.best.model.without(index), &open.start_without(&found.best, index))?,
    };
    let known = open.rows_of(&bare)?;
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

/// Whether an unknown signal at the most likely place explains what an effect leaves out better than the effect does.
fn is_likelier(open: &Problem, latents: &[Latent], bare: &Fit, with: &Fit) -> bool {
    let parameters = with.model.effect_parameters() - bare.model.effect_parameters();
    let explained = bare.cost - with.cost - parameters as f64 * (open.samples() as f64).ln();
    latents.first().is_some_and(|likeliest| likeliest.log_odds > explained + CLEARLY)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::fit::{Model, Placed, made::Bench};
    use crate::effects::{Element, ElementKind, find};
    use crate::scene::Override;

    /// What replaces a gain error of the pressure gauge; `None` if it stays.
    fn instead_of_a_gain(bench: &Bench) -> Option<String> {
        let entry = find("sensor_gain").expect("of the catalogue");
        let element = Element::of(ElementKind::Sensor, 0, 1);
        let gain = Placed { entry, element, channel: Some(Bench::CHANNELS[1].to_owned()) };
        let (baseline, best) = (bench.baseline(), bench.fit(&Model::baseline().plus(&gain, &entry.typical())));
        let rivals_against = best.cost;
        let (rivals, screened, forms) = (vec![Vec::new()], Vec::new(), Vec::new());
        let found = Found { baseline, best, rivals, rivals_against, screened, forms, withheld: None, described: None };
        let other = exchanged(&bench.case, &bench.noise, &found, &|_| {})?;
        let last = other.best.model.effects.last().expect("a law");
        Some(format!("{} over {:?}", verdict::port(last), last.spec().variables))
    }

    /// With a growing bore the pressure lags: a gain of the gauge explains part of it and is replaced. A real gain
    /// error stays.
    #[test]
    fn an_effect_gives_way_to_a_law_where_something_is_missing() {
        let grows = Override::parse("muscles.tube.area_growth_1_m=4.0").expect("a key");
        let instead = instead_of_a_gain(&Bench::with(&[grows])).expect("a law");
        assert!(instead.starts_with("muscle."), "{instead}");
        let mut off = Bench::with(&[]);
        off.case.runs.iter_mut().for_each(|run| run.measured[1].iter_mut().for_each(|p| *p *= 1.05));
        assert_eq!(instead_of_a_gain(&off), None);
    }
}
