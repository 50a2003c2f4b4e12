//! Do no harm: what predicts worse than the calibrated scene does not leave the program.

use super::answer::Proof;
use super::case::{Case, CaseRun, Sealed};
use super::fit::{Fit, Problem};
use super::model::simulate;
use super::noise::Noise;
use super::prove;
use super::search::Found;

/// What was found, or of the other fits that explain the open runs as well the first that does no harm; where all do, nothing: the
/// answer is then located, not modelled. `proof` becomes that of what is left.
pub(super) fn without(
    case: &Case,
    noise: &[Noise],
    mut found: Found,
    proof: &mut Proof,
    seed: u64,
    warnings: &mut Vec<String>,
) -> Found {
    if found.best.model.effects.is_empty() || !is_harmful(case, noise, &found.baseline, &found.best, proof) {
        return found;
    }
    warnings.push(format!(
        "{} predicts the held-out runs worse than the calibrated scene: it is not put into scene.toml",
        found.best.model.title()
    ));
    let sealed = Problem { case, runs: case.subset(Sealed::Sealed), noise };
    for (other, own) in as_good(&found) {
        let Some(renewed) = prove::prove(&sealed, &found.baseline, &own, seed) else { continue };
        if !is_harmful(case, noise, &found.baseline, &own, &renewed) {
            *proof = renewed;
            exchange(&mut found, other, own);
            return found;
        }
    }
    found.withheld = Some(std::mem::replace(&mut found.best, found.baseline.clone()));
    found.rivals.clear();
    found.forms.clear();
    proof.channels.values_mut().for_each(|c| c.rmse_corrected = c.rmse_baseline);
    (proof.gap_closed, proof.gain_ci95) = (0.0, [0.0, 0.0]);
    found
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
    let of_channel = |((samples, values), noise): ((&Vec<(usize, f64)>, &Vec<f64>), &Noise)| -> f64 {
        samples.iter().map(|(i, measured)| ((measured - values[*i]) / noise.scale()).powi(2)).sum()
    };
    Some(run.unheld.iter().zip(&simulated).zip(noise).map(of_channel).sum())
}
