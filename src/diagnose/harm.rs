//! Do no harm: what predicts worse than the calibrated scene does not leave the program.

use super::answer::Proof;
use super::case::{Case, CaseRun, Sealed};
use super::fit::{Fit, Problem};
use super::grammar::Reach;
use super::hypothesis::equally_good;
use super::model::simulate;
use super::noise::Noise;
use super::prove;
use super::search::Found;
use super::unlisted::propose;
use super::without::Step;

/// What was found, or of the other fits that explain the open runs as well, laws that nobody listed included, the first that does no
/// harm; where all do, nothing: the answer is then located, not modelled. `proof` becomes that of what is left.
pub(super) fn without(
    case: &Case,
    noise: &[Noise],
    mut found: Found,
    proof: &mut Proof,
    seed: u64,
    (warnings, say): (&mut Vec<String>, &dyn Fn(String)),
) -> Found {
    if found.best.model.effects.is_empty() || !is_harmful(case, noise, &found.baseline, &found.best, proof) {
        return found;
    }
    warnings.push(format!(
        "{} predicts the held-out runs worse than the calibrated scene: it is not put into scene.toml",
        found.best.model.title()
    ));
    let sealed = Problem { case, runs: case.subset(Sealed::Sealed), noise };
    let harmless = |fit: &Fit| {
        let renewed = prove::prove(&sealed, &found.baseline, fit, seed)?;
        (!is_harmful(case, noise, &found.baseline, fit, &renewed)).then_some(renewed)
    };
    let other = as_good(&found).into_iter().find_map(|(other, fit)| Some((other, harmless(&fit)?, fit)));
    if let Some((other, renewed, fit)) = other {
        *proof = renewed;
        exchange(&mut found, other, fit);
        return found;
    }
    let mut fits = laws(case, noise, &found, say);
    fits.retain(|fit| harmless(fit).is_some());
    let open = Problem { case, runs: case.subset(Sealed::Open), noise };
    if let Some((best, forms)) = equally_good(&open, &fits, found.baseline.cost) {
        *proof = harmless(&best).unwrap_or_default();
        return Found { rivals_against: best.cost, best, rivals: vec![Vec::new()], forms, ..found };
    }
    found.withheld = Some(std::mem::replace(&mut found.best, found.baseline.clone()));
    found.rivals.clear();
    found.forms.clear();
    proof.channels.values_mut().for_each(|c| c.rmse_corrected = c.rmse_baseline);
    (proof.gap_closed, proof.gain_ci95) = (0.0, [0.0, 0.0]);
    found
}

/// Laws that explain the open runs as well as what was found, where that is a single effect; cheapest first.
fn laws(case: &Case, noise: &[Noise], found: &Found, say: &dyn Fn(String)) -> Vec<Fit> {
    if case.is_without(Step::OpenSet) || found.best.model.effects.len() > 1 {
        return Vec::new();
    }
    let open = Problem { case, runs: case.subset(Sealed::Open), noise };
    let mut fits = propose(&open, &found.baseline, Reach::Plain, say).map_or_else(Vec::new, |p| p.fits);
    fits.retain(|fit| fit.cost <= found.best.cost + AS_GOOD);
    fits
}

/// Where another fit stands beside the answer.
#[derive(Clone, Copy)]
enum Place {
    Form(usize),
    /// Of the last effect.
    Rival(usize),
}

/// Chi² within which another fit explains the open runs as well: odds of one to twenty.
const AS_GOOD: f64 = 6.0;

fn as_good(found: &Found) -> Vec<(Place, Fit)> {
    let near = found.best.cost + AS_GOOD;
    let forms = found.forms.iter().enumerate().map(|(i, fit)| (Place::Form(i), fit));
    let rivals = found.rivals.last().into_iter().flatten().enumerate().map(|(i, fit)| (Place::Rival(i), fit));
    forms.chain(rivals).filter(|(_, fit)| fit.cost <= near).map(|(place, fit)| (place, fit.clone())).collect()
}

/// Puts another fit in the place of the best, and the best in its place.
fn exchange(found: &mut Found, other: Place, own: Fit) {
    let was = std::mem::replace(&mut found.best, own);
    match other {
        Place::Form(i) => found.forms[i] = was,
        Place::Rival(i) => {
            found.rivals_against = found.best.cost;
            if let Some(rivals) = found.rivals.last_mut() {
                rivals[i] = was;
            }
        }
    }
}

/// Whether a fit predicts held-out runs worse than the calibrated scene, beyond chance; or gains less there than it loses where samples
/// are left out of the fit: there next to nothing holds a joint, and a small wrong force drives it anywhere.
fn is_harmful(case: &Case, noise: &[Noise], baseline: &Fit, fit: &Fit, proof: &Proof) -> bool {
    if proof.gap_closed < 0.0 && proof.gain_ci95[1] < 0.0 {
        return true;
    }
    if !case.goes_slack() {
        return false;
    }
    let Some([gained, lost]) = gain_and_loss(case, noise, baseline, fit) else { return true };
    lost > 0.0 && lost > gained
}

/// Chi² that a fit gains on the held-out runs, and that it loses where samples of any run are left out; `None` where it cannot be
/// simulated.
fn gain_and_loss(case: &Case, noise: &[Noise], baseline: &Fit, fit: &Fit) -> Option<[f64; 2]> {
    let sealed = Problem { case, runs: case.subset(Sealed::Sealed), noise };
    let cost = |fit: &Fit| sealed.cost_at(&fit.model, &fit.x);
    let left_out = |fit: &Fit| -> Option<f64> {
        let each = case.runs.iter().map(|run| at_left_out(case, run, noise, fit));
        each.collect::<Option<Vec<f64>>>().map(|all| all.iter().sum())
    };
    Some([cost(baseline)? - cost(fit)?, left_out(fit)? - left_out(baseline)?])
}

/// Sum of squares of what a fit leaves at the samples of a run that are left out, in the units of [`Fit::cost`].
fn at_left_out(case: &Case, run: &CaseRun, noise: &[Noise], fit: &Fit) -> Option<f64> {
    if run.unheld.iter().all(Vec::is_empty) {
        return Some(0.0);
    }
    let simulated = simulate(case, run, &fit.model, &fit.x)?;
    let channels = run.unheld.iter().zip(&simulated).zip(noise);
    let of_channel = channels.map(|((samples, values), noise)| -> f64 {
        samples.iter().map(|(i, measured)| ((measured - values[*i]) / noise.scale()).powi(2)).sum()
    });
    Some(of_channel.sum())
}
