//! What a recording shows and the simulation lacks: locate, name, model, prove, and say what to record next.
//!
//! [`diagnose`] goes through the steps one by one, each a module of its own: `preflight`, `baseline`, detection in
//! `noise`, `locate`, `search`, `verdict`, `prove`. It works on the fast model of the scene
//! ([`crate::system::Twin`]); what it finds is written as a scene.

mod answer;
mod baseline;
mod candidates;
mod case;
mod corrected;
mod descent;
mod error;
mod fit;
mod full;
mod locate;
mod model;
mod noise;
mod normal;
mod preflight;
mod prove;
mod search;
mod thin;
mod verdict;

use std::collections::BTreeMap;

pub use answer::{ChannelProof, Detection, Diagnosis, Estimate, Location, NamedEffect, NextExperiment, Proof, Verdict};
pub use case::{Case, CaseChannel, CaseParameter, CaseRun, Sealed};
pub use error::DiagnoseError;
pub use fit::Fit;
pub use model::{Model, Placed};
pub use noise::Noise;
pub use search::title;

use baseline::Baseline;
use candidates::Variant;
use fit::Problem;
use search::{Found, Screened};

use crate::effects::Effect;
use verdict::Excess;

/// What a diagnosis is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Of the bootstrap's draws.
    pub seed: u64,
}

/// A diagnosis with what its report and its scene are made of.
pub struct Outcome {
    pub diagnosis: Diagnosis,
    pub case: Case,
    /// The calibration alone and with the effects, both fitted to the open runs.
    pub baseline: Option<Fit>,
    pub corrected: Option<Fit>,
    /// The corrected fit renewed on all runs: what the scene gets.
    pub complete: Option<Fit>,
    /// Measured minus simulated of all runs: baseline, corrected.
    pub residuals: Option<[Vec<Vec<Vec<f64>>>; 2]>,
    pub noise: Vec<Noise>,
    /// Models that were refitted and lost, with their chi².
    pub rivals: Vec<(String, f64)>,
    /// Every effect at the size from which these recordings would show it.
    pub just_visible: Vec<Effect<f64>>,
}

impl Outcome {
    /// The corrected scene as text.
    ///
    /// # Errors
    /// A fitted number that the scene's own checks refuse.
    pub fn scene_text(&self) -> Option<Result<String, crate::scene::SceneError>> {
        let fit = self.complete.as_ref()?;
        Some(corrected::corrected_scene(&self.case, fit, &self.diagnosis.summary))
    }
}

/// Diagnoses a case; `say` hears of progress.
///
/// # Errors
/// When the scene cannot be simulated at all. Recordings that cannot carry a diagnosis are an answer, not an error.
pub fn diagnose(mut case: Case, options: Options, say: &dyn Fn(String)) -> Result<Outcome, DiagnoseError> {
    let preflight = {
        let noise: Vec<Noise> = case.channels.iter().map(|_| Noise { sd: 1.0, inflation: 1.0 }).collect();
        preflight::preflight(&case, &Problem { case: &case, runs: case.subset(Sealed::Both), noise: &noise })
    };
    if !preflight.unusable.is_empty() {
        return Ok(unusable(case, preflight));
    }
    say("baseline".to_owned());
    let diverges = || DiagnoseError::Simulation("it diverges".to_owned());
    let base = baseline::baseline(&mut case)?;
    let variants = candidates::variants(&case);
    let (found, noise) = search_and_weigh(&mut case, &base, &variants, say).ok_or_else(diverges)?;
    let mut warnings = [preflight.warnings, base.warnings, case.notes.clone()].concat();
    let sealed = Problem { case: &case, runs: case.subset(Sealed::Sealed), noise: &noise };
    say("sealed runs".to_owned());
    let proof = prove::prove(&sealed, &found.baseline, &found.best, options.seed).ok_or_else(diverges)?;
    let (found, mut proof, confirmed) = confirm(found, proof, &mut warnings);
    say("full scene".to_owned());
    check_on_full_scene(&sealed, &found, &mut proof, options.seed, &mut warnings)?;
    let whole = Problem { case: &case, runs: case.subset(Sealed::Both), noise: &noise };
    let complete = whole.fit(&found.best.model, &found.best.x).ok_or_else(diverges)?;
    let before = whole.residuals(&found.baseline.model, &found.baseline.x).ok_or_else(diverges)?;
    let after = whole.residuals(&found.best.model, &found.best.x).ok_or_else(diverges)?;
    let (baseline_excess, error) = noise::structured_excess(&before, &noise);
    let (best_excess, _) = noise::structured_excess(&after, &noise);
    let excess = Excess { baseline: baseline_excess, best: best_excess, error };
    let effects = verdict::named(&found, &complete);
    let verdict = match confirmed {
        Confirmed::Yes => verdict::verdict(&found, &effects, excess),
        Confirmed::InPart => Verdict::UnknownPhysics,
    };
    let location = location(&case, &found, &effects, &whole, &before, verdict);
    let just_visible = found.screened.iter().filter_map(Screened::just_visible).collect();
    let rivals = found.rivals.iter().flatten().map(|f| (title(&f.model), f.cost)).collect();
    let mut diagnosis = Diagnosis {
        format: 1,
        scene: case.scene_name.clone(),
        recordings: case.folders.clone(),
        verdict,
        summary: String::new(),
        detection: detection(&case, &noise, &found, excess),
        location,
        effects,
        calibration: calibration(&case, &complete),
        fit: proof,
        next_experiment: NextExperiment::none(),
        warnings,
    };
    diagnosis.summary = summary(&diagnosis);
    Ok(Outcome {
        diagnosis,
        baseline: Some(found.baseline),
        corrected: Some(found.best),
        complete: Some(complete),
        residuals: Some([before, after]),
        noise,
        rivals,
        just_visible,
        case,
    })
}

/// What the sealed runs say to what the open ones have found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Confirmed {
    /// It holds, or there is nothing to hold.
    Yes,
    /// It explains the open runs for the most part, and not the sealed ones: not the whole truth.
    InPart,
}

/// Takes back what does not hold on the sealed runs; what explains most of the open ones is kept as the nearest known.
fn confirm(mut found: Found, mut proof: Proof, warnings: &mut Vec<String>) -> (Found, Proof, Confirmed) {
    let gains_nothing = proof.gap_closed <= 0.0 && proof.gain_ci95[1] < 0.5;
    if found.best.model.effects.is_empty() || !gains_nothing {
        return (found, proof, Confirmed::Yes);
    }
    let title = title(&found.best.model);
    if found.baseline.cost - found.best.cost > 0.5 * found.baseline.cost {
        warnings.push(format!("{title} explains the open runs for the most part, but not the sealed ones"));
        return (found, proof, Confirmed::InPart);
    }
    warnings.push(format!("{title} fitted the open runs but not the sealed ones, and was dropped"));
    found.best = found.baseline.clone();
    found.rivals.clear();
    proof.channels.values_mut().for_each(|c| c.rmse_corrected = c.rmse_baseline);
    (proof.gap_closed, proof.gain_ci95) = (0.0, [0.0, 0.0]);
    (found, proof, Confirmed::Yes)
}

/// Plays what was found on the full scene. Where the fast model is not near it, the full scene's figures are the proof.
fn check_on_full_scene(
    sealed: &Problem,
    found: &Found,
    proof: &mut Proof,
    seed: u64,
    warnings: &mut Vec<String>,
) -> Result<(), DiagnoseError> {
    let case = sealed.case;
    let corrected = full::play_full(case, &found.best, sealed.noise)?;
    let agreement = full::agreement(case, &corrected);
    if !agreement.agrees {
        let residuals = |runs: &[full::FullRun]| -> Vec<Vec<Vec<f64>>> {
            let played = runs.iter().filter(|r| r.is_sealed);
            sealed.runs.iter().zip(played).map(|(run, full)| sealed.subtract(run, &full.values)).collect()
        };
        let baseline = full::play_full(case, &found.baseline, sealed.noise)?;
        let renewed = prove::compare(sealed, &residuals(&baseline), &residuals(&corrected), seed);
        *proof = Proof { placebo_gap_closed: std::mem::take(&mut proof.placebo_gap_closed), ..renewed };
        let differ: Vec<String> =
            agreement.rms_difference_over_noise.iter().map(|(c, d)| format!("{c} by {d:.2} of the noise")).collect();
        warnings.push(format!(
            "the fast model differs from the full scene ({}): the figures of the sealed runs are those of the full scene",
            differ.join(", ")
        ));
    }
    proof.full_scene = agreement;
    Ok(())
}

/// Searches, and again where what was found asks for other weights or other steps.
fn search_and_weigh(
    case: &mut Case,
    base: &Baseline,
    variants: &[Variant],
    say: &dyn Fn(String),
) -> Option<(Found, Vec<Noise>)> {
    let mut noise = base.noise.clone();
    let mut found = search::search(&open_runs(case, &noise), base.fit.clone(), base.fit.clone(), variants, say);
    for _ in 0..2 {
        if found.best.model.effects.is_empty() {
            break;
        }
        let residuals = open_runs(case, &noise).residuals(&found.best.model, &found.best.x)?;
        let renewed = noise::estimate(case, &residuals);
        let weights_hold = renewed.iter().zip(&noise).all(|(new, old)| new.is_near(old));
        noise = renewed;
        let setting = found.best.model.setting(case, &found.best.x);
        case.plan_steps(&setting, &noise)?;
        case.leave_out_unheld(&setting)?;
        let problem = open_runs(case, &noise);
        let start = problem.fit(&found.best.model, &found.best.x)?;
        if weights_hold && (start.cost - found.best.cost).abs() < SAME_COST * search::least_gain(problem.samples()) {
            break;
        }
        let baseline = problem.fit(&found.baseline.model, &found.baseline.x)?;
        found = search::search(&problem, baseline, start, variants, say);
    }
    Some((found, noise))
}

/// Steps hold when new ones change chi² by less than this share of the least gain.
const SAME_COST: f64 = 0.3;

fn open_runs<'a>(case: &'a Case, noise: &'a [Noise]) -> Problem<'a> {
    Problem { case, runs: case.subset(Sealed::Open), noise }
}

fn unusable(case: Case, preflight: preflight::Preflight) -> Outcome {
    let diagnosis = Diagnosis {
        format: 1,
        scene: case.scene_name.clone(),
        recordings: case.folders.clone(),
        verdict: Verdict::UnusableData,
        summary: format!("The recordings cannot be diagnosed: {}.", preflight.unusable.join("; ")),
        detection: Detection::default(),
        location: Location::default(),
        effects: Vec::new(),
        calibration: BTreeMap::new(),
        fit: Proof::default(),
        next_experiment: NextExperiment::none(),
        warnings: [preflight.unusable, preflight.warnings, case.notes.clone()].concat(),
    };
    Outcome {
        diagnosis,
        case,
        baseline: None,
        corrected: None,
        complete: None,
        residuals: None,
        noise: Vec::new(),
        rivals: Vec::new(),
        just_visible: Vec::new(),
    }
}

fn detection(case: &Case, noise: &[Noise], found: &Found, excess: Excess) -> Detection {
    let by_channel = |f: fn(&Noise) -> f64| -> BTreeMap<String, f64> {
        case.channels.iter().zip(noise).map(|(c, n)| (c.column.clone(), f(n))).collect()
    };
    let mut smallest = BTreeMap::new();
    for s in &found.screened {
        let size: &mut f64 = smallest.entry(s.variant.placed.title()).or_insert(f64::INFINITY);
        *size = size.min(s.least_size);
    }
    smallest.retain(|_, size| size.is_finite());
    let z = excess.baseline / excess.error;
    let gain = found.baseline.cost - found.best.cost;
    Detection {
        excess_chi2_per_sample: excess.baseline,
        excess_chi2_per_sample_corrected: excess.best,
        p_value: (-0.5 * z.max(0.0).powi(2)).exp().min((-0.5 * gain.max(0.0)).exp()),
        noise_sd: by_channel(|n| n.sd),
        noise_inflation: by_channel(|n| n.inflation),
        smallest_detectable: smallest,
    }
}

fn calibration(case: &Case, fit: &Fit) -> BTreeMap<String, Estimate> {
    let estimate = |i: usize| {
        let (value, half) = (fit.x[i], fit.half_width(i));
        Estimate { value, ci95: [value - half, value + half] }
    };
    case.parameters.iter().enumerate().map(|(i, p)| (p.key.clone(), estimate(i))).collect()
}

fn location(
    case: &Case,
    found: &Found,
    effects: &[NamedEffect],
    whole: &Problem,
    before: &[Vec<Vec<f64>>],
    verdict: Verdict,
) -> Location {
    if verdict == Verdict::Adequate {
        return Location::default();
    }
    let mut shares: BTreeMap<String, f64> = BTreeMap::new();
    for e in effects {
        *shares.entry(e.element.clone()).or_default() += e.probability;
    }
    if shares.is_empty() {
        // Nothing of the catalogue: where the signatures promise most.
        for s in &found.screened {
            let share = shares.entry(s.variant.placed.element.to_string()).or_default();
            *share = share.max(s.gain);
        }
    }
    let sum: f64 = shares.values().sum();
    let mut ranked: Vec<(String, f64)> = shares.into_iter().map(|(e, s)| (e, s / sum.max(f64::MIN_POSITIVE))).collect();
    ranked.sort_by(|a, b| b.1.total_cmp(&a.1));
    Location {
        element: ranked.first().map(|(e, _)| e.clone()),
        ranked,
        time_windows_s: locate::time_windows(&whole.runs, before, whole.noise),
        state_region: locate::state_region(case, &whole.runs, before, whole.noise),
        indistinguishable: Vec::new(),
    }
}

/// The verdict in two sentences.
fn summary(d: &Diagnosis) -> String {
    let effects: Vec<String> = d
        .effects
        .iter()
        .map(|e| match &e.channel {
            Some(channel) => format!("{} on {channel}", e.name),
            None => format!("{} in {}", e.name, e.element),
        })
        .collect();
    let closed = format!(
        "On the sealed runs it closes {:.0} % of the gap between the calibrated scene and the noise.",
        100.0 * d.fit.gap_closed
    );
    match d.verdict {
        Verdict::Adequate => format!(
            "The calibrated scene explains the recordings down to their noise: nothing is missing that they could show. \
             What is left is {:.4} of the noise's variance.",
            d.detection.excess_chi2_per_sample.max(0.0)
        ),
        Verdict::MissingPhysics => format!("The scene lacks {}. {closed}", effects.join(" and ")),
        Verdict::Ambiguous => format!("The scene lacks one of these: {}. {closed}", effects.join(", ")),
        Verdict::UnknownPhysics => format!(
            "Something is missing that is not in the catalogue{}. {}",
            d.location.element.as_ref().map_or(String::new(), |e| format!(", most likely in the {e}")),
            if effects.is_empty() {
                "No known effect explains any of it.".to_owned()
            } else {
                format!("The nearest known effect, {}, leaves a part of it. {closed}", effects.join(" with "))
            }
        ),
        Verdict::UnusableData => d.summary.clone(),
    }
}
