//! Consequences: withdraws what fails on held-out runs, and compares with the full scene.

use super::{consistency, prove};
use crate::diagnose::case::Step;
use crate::diagnose::diagnosis::Proof;
use crate::diagnose::error::DiagnoseError;
use crate::diagnose::fit::{Fit, Problem, Variant};
use crate::diagnose::full::{FullRun, agreement, play_full};
use crate::diagnose::search::{self, Found, cross_validates};
use crate::diagnose::verdict::{self, Confirmed, misfit};
use crate::parallel;

/// What the held-out runs say about the answer. They choose nothing: if they show no gain, the answer stays, as
/// incomplete.
pub(in crate::diagnose) fn confirm(
    held_out: &Problem,
    found: &Found,
    proof: &Proof,
    warnings: &mut Vec<String>,
) -> Confirmed {
    let gains_nothing = proof.gap_closed <= 0.0 && proof.gain_ci95[1] < 0.5;
    let is_asked = !found.best.model.effects.is_empty() && !held_out.case.is_without(Step::CrossValidation);
    if !is_asked || !gains_nothing {
        return Confirmed::Yes;
    }
    let title = found.best.model.title();
    if let Some(sensor) = missing_sensor(held_out, found) {
        warnings
            .push(format!("the held-out runs lack {sensor}, which shows what {title} changes: it is unproven there"));
        return Confirmed::Yes;
    }
    warnings.push(format!("{title} explains open runs, but not the held-out ones"));
    Confirmed::InPart
}

/// Distance of baseline and best on the held-out runs, in standard errors, below which these decide nothing.
const SHOWN: f64 = 5.0;

/// A channel that the held-out runs lack, if the others show no difference.
fn missing_sensor<'a>(held_out: &Problem<'a>, found: &Found) -> Option<&'a str> {
    let case = held_out.case;
    let has = |is_held_out: bool, c: usize| {
        let runs = case.runs.iter().filter(|r| r.is_held_out == is_held_out);
        runs.flat_map(|r| &r.measured[c]).any(|v| v.is_finite())
    };
    let lacking = (0..case.channels.len()).find(|c| has(false, *c) && !has(true, *c))?;
    let residual = |fit: &Fit| held_out.weighted_residual(&fit.model, &fit.x);
    let apart = (residual(&found.baseline)? - residual(&found.best)?).norm();
    (apart < SHOWN).then_some(case.channels[lacking].column.as_str())
}

/// Withdraws what the reduced-order model cannot simulate on every run.
pub(in crate::diagnose) fn take_back_unplayable(
    whole: &Problem,
    mut found: Found,
    warnings: &mut Vec<String>,
) -> Found {
    let has_effects = !found.best.model.effects.is_empty();
    if has_effects && whole.cost_at(&found.best.model, &found.best.x).is_none() {
        let title = found.best.model.title();
        warnings.push(format!("{title} fitted the open runs but cannot be simulated on all, and was dropped"));
        found.best = found.baseline.clone();
        found.rivals.clear();
    }
    found
}

/// Withdraws, one by one, the effects that cross-validation does not need: they only absorbed the model discrepancy of
/// others.
pub(in crate::diagnose) fn prune(
    open: &Problem,
    mut found: Found,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> Found {
    // Of a single run one half says little of the other: it may have gone on, to where nothing was before.
    if open.case.is_without(Step::CrossValidation) || open.runs.len() < 2 {
        return found;
    }
    while found.best.model.effects.len() > 1 {
        let without = |i: usize| open.fit(&found.best.model.without(i), &open.start_without(&found.best, i));
        let fewer: Vec<Option<Fit>> = parallel::map_indices(found.best.model.effects.len(), without);
        let is_idle = |fewer: &Fit| !cross_validates(open, fewer, &found.best);
        let idle = fewer.into_iter().flatten().filter(is_idle).min_by(|a, b| a.cost.total_cmp(&b.cost));
        let Some(fewer) = idle else { break };
        say(format!("{} predicts runs left out as well", fewer.model.title()));
        found = search::converged(open, found, fewer, variants, say);
    }
    found
}

/// Withdraws the effects that a single run contradicts: they are surrogates. If the rest does not explain the
/// recordings either, all stay as the closest known ones.
pub(in crate::diagnose) fn take_back_contradicted(
    whole: &Problem,
    open: &Problem,
    found: Found,
    variants: &[Variant],
    warnings: &mut Vec<String>,
) -> (Found, Confirmed) {
    let explains = |found: &Found| {
        let is_left = !found.best.model.effects.is_empty();
        is_left && misfit(whole, found).is_some_and(|(_, excess)| !verdict::is_unknown(found, excess))
    };
    if whole.case.is_without(Step::CrossValidation) || !explains(&found) {
        return (found, Confirmed::Yes);
    }
    let mut fewer = found.clone();
    while let Some((effect, how)) = consistency::contradiction(whole.case, &fewer.best, whole.noise) {
        let title = fewer.best.model.effects[effect].title();
        warnings.push(format!("{title} {how}: it stands in for something else"));
        let start = open.start_without(&fewer.best, effect);
        match open.fit(&fewer.best.model.without(effect), &start).filter(|f| !f.model.effects.is_empty()) {
            Some(fit) => fewer = search::converged(open, fewer, fit, variants, &|_| {}),
            None => return (found, Confirmed::InPart),
        }
    }
    let stands = fewer.best.model == found.best.model || explains(&fewer);
    if stands { (fewer, Confirmed::Yes) } else { (found, Confirmed::InPart) }
}

/// Simulates the answer on the full scene. If the reduced-order model differs, the full scene's figures count; if the
/// full scene cannot be simulated, a warning says so and the reduced-order model's figures count.
///
/// Returns whether the full scene can be simulated.
pub fn check_on_full_scene(
    held_out: &Problem,
    found: &Found,
    proof: &mut Proof,
    seed: u64,
    warnings: &mut Vec<String>,
) -> bool {
    let compared = compare_with_full_scene(held_out, found, proof, seed, warnings);
    if let Err(e) = &compared {
        proof.full_scene.agrees = false;
        warnings.push(format!("the full scene could not be played: all figures are the reduced-order model's ({e})"));
    }
    compared.is_ok()
}

fn compare_with_full_scene(
    held_out: &Problem,
    found: &Found,
    proof: &mut Proof,
    seed: u64,
    warnings: &mut Vec<String>,
) -> Result<(), DiagnoseError> {
    let case = held_out.case;
    let corrected = play_full(case, found.corrected(), held_out.noise)?;
    let agreement = agreement(case, &corrected);
    if !agreement.agrees {
        let residuals = |runs: &[FullRun]| -> Vec<Vec<Vec<f64>>> {
            let played = runs.iter().filter(|r| r.is_held_out);
            held_out.runs.iter().zip(played).map(|(run, full)| held_out.subtract(run, &full.values)).collect()
        };
        let baseline = play_full(case, &found.baseline, held_out.noise)?;
        let renewed = prove::compare(held_out, &residuals(&baseline), &residuals(&corrected), seed);
        *proof = Proof { placebo_gap_closed: std::mem::take(&mut proof.placebo_gap_closed), ..renewed };
        let differ: Vec<String> =
            agreement.rms_difference_over_noise.iter().map(|(c, d)| format!("{c} by {d:.2} of the noise")).collect();
        let named = if found.best.model.effects.is_empty() { "that nothing is missing" } else { "what is named" };
        warnings.push(format!(
            "the reduced-order model differs from the full scene ({}): the figures of the held-out runs are those of the full scene, {named} rests on \
             the reduced-order model",
            differ.join(", ")
        ));
    }
    proof.full_scene = agreement;
    Ok(())
}

/// Maximum number of alternatives evaluated for comparison.
const PLACEBOS: usize = 5;

/// What the rejected alternatives would have gained on the held-out runs.
pub fn placebos(held_out: &Problem, found: &Found, seed: u64) -> Vec<(String, f64)> {
    let gained = |rival: &Fit| -> Option<(String, f64)> {
        let proof = prove::prove(held_out, &found.baseline, rival, seed)?;
        Some((rival.model.title(), proof.gap_closed))
    };
    found.rivals.iter().flatten().take(PLACEBOS).filter_map(gained).collect()
}
