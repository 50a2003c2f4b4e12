//! What a recording shows and the simulation lacks: locate, name, model, prove, and say what to record next.
//!
//! [`diagnose`] goes through the steps one by one, each a folder of its own: `case` and `fit` (recordings, noise, calibration), `search`,
//! `verdict`, `latent`, `unknown`, `validation`, `experiment`, `answer`. A step imports those below it, never one above (`tests/architecture.rs`). All work
//! on the reduced-order model of the scene ([`crate::system::Rom`]) but `full`; what is found is written as a scene.
//!
//! Half a minute for a bench:
//!
//! ```no_run
//! use std::path::Path;
//!
//! use smam::diagnose::{Case, Options, Verdict, diagnose, write_answer};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let case = Case::load(&[Path::new("recordings/bench")], None, &[])?;
//! let outcome = diagnose(case, Options { seed: 1 }, &|step| eprintln!("{step}"))?;
//! if outcome.diagnosis.verdict == Verdict::MissingPhysics {
//!     for effect in &outcome.diagnosis.effects {
//!         println!("{} in the {}: {:.2}", effect.name, effect.element, effect.probability);
//!     }
//! }
//! write_answer(&outcome, Path::new("out/bench"))?;
//! # Ok(())
//! # }
//! ```

mod answer;
mod case;
mod diagnosis;
mod error;
mod experiment;
mod explained;
mod fit;
mod full;
mod grammar;
mod latent;
mod search;
mod unknown;
mod validation;
mod verdict;

use std::collections::BTreeMap;

pub use answer::{Outcome, calibrated_scene, write_answer, write_answer_with};
pub use case::{Case, Step};
pub use diagnosis::{
    Balance, ChannelProof, Curve, Detection, Diagnosis, DiscrepancyTerm, Estimate, Form, Freehand, Location,
    NamedEffect, NextExperiment, Proof, Verdict,
};
pub use error::DiagnoseError;

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    answer::side_by_side,
    case::{CaseChannel, CaseParameter, CaseRun, Direction, Noise, RunSet},
    diagnosis::size_key,
    experiment::programme,
    fit::{Calibrated, Fit, Model, Placed, chi2_beyond},
};

use answer::{caveats, figures, location, specimens, summary, warnings};
use experiment::Experiment;
use explained::{Explained, diverges};
use fit::{Problem, intervals};
use full::refine;
use search::{Found, Screened};
use unknown::freehand;
use validation::{consistency, preflight};
use verdict::{Confirmed, misfit};

use crate::recording::RecordingError;

/// What a diagnosis is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Of the bootstrap's draws.
    pub seed: u64,
}

/// Diagnoses a case; `say` hears of progress.
///
/// A recording of one second is answered, too:
///
/// ```
/// use smam::diagnose::{Case, Options, Verdict, diagnose};
/// use smam::scene::Scene;
/// use smam::system::{Schedule, Simulation, record};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let recording = record(&mut Simulation::new(Scene::load("muscle_bench", &[])?)?, &Schedule::even(1.0, 0.01))?;
/// recording.write_csv(&folder.path().join("short.csv"))?;
/// let set = r#"
/// format = 1
/// scene = "muscle_bench"
/// channel = [{ column = "plunger_mm", role = "input" }, { column = "elongation_mm", role = "output" }]
/// run = [{ file = "short.csv" }]
/// "#;
/// std::fs::write(folder.path().join("recordings.toml"), set)?;
/// let case = Case::load(&[folder.path()], None, &[])?;
/// // Of a single run the last third is held back.
/// assert_eq!(case.runs.iter().filter(|run| run.is_held_out).count(), 1);
/// let diagnosis = diagnose(case, Options { seed: 1 }, &|_| {})?.diagnosis;
/// assert_eq!(diagnosis.verdict, Verdict::UnusableData);
/// assert!(diagnosis.summary.contains("only 101 samples: record at least some ten seconds"));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// When the scene cannot be simulated at all. Recordings that cannot carry a diagnosis are an answer, not an error.
pub fn diagnose(mut case: Case, options: Options, say: &dyn Fn(String)) -> Result<Outcome, DiagnoseError> {
    let preflight = {
        let noise: Vec<Noise> = case.channels.iter().map(|_| Noise::white(1.0)).collect();
        preflight::preflight(&case, &Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise })?
    };
    if !preflight.unusable.is_empty() {
        return Ok(unusable(case, preflight));
    }
    let explained = explained::explain(&mut case, preflight.warnings, options.seed, say)?;
    answer(case, explained, say)
}

/// Said where nothing is left to be named of the open runs.
const HELD_OUT_ALONE: &str = "the open runs are explained down to their noise: what is left shows in the held-out runs alone, and cannot be \
    named from the others; record more runs of their kind, or hold back another one (use = \"holdout\" in recordings.toml)";

/// Names what was found and where, and proposes what to record next.
fn answer(case: Case, explained: Explained, say: &dyn Fn(String)) -> Result<Outcome, DiagnoseError> {
    let Explained { found, confirmed, proof, noise, after, excess, mut warnings, of_found } = explained;
    warnings.extend(of_found);
    warnings.extend(case.effort.note());
    let whole = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
    let (complete, of_scene) = complete_fits(&case, &found, &noise);
    let before = whole.residuals(&found.baseline.model, &found.baseline.x).ok_or_else(diverges)?;
    let left_by_scene = misfit::left(&whole, found.corrected()).map_or(excess.best, |(left, _)| left);
    let left = misfit::left_beyond_noise(&whole, &found.best);
    let Said { verdict, is_modelled, effects, contradicted } =
        said(&case, (&found, &complete, left), (confirmed, excess), &noise, &mut warnings);
    warnings.extend(figures::on_bounds(&case, &complete));
    let specimens = specimens::parameters(&case, &complete);
    warnings.extend(specimens::words(&case, &specimens));
    let withheld = found.withheld.as_ref().map_or_else(Vec::new, |known| verdict::named(known, &known.best, left));
    let said = if withheld.is_empty() { &effects } else { &withheld };
    let leaves_a_part = verdict == Verdict::UnknownPhysics && verdict::leaves_a_part(&found, excess);
    let location = location::location(&case, &found, said, &whole, &before, (verdict, leaves_a_part));
    say("next experiment".to_owned());
    let experiment = next_experiment(&whole, &found, left, leaves_a_part)?;
    let just_visible = found.screened.iter().filter_map(Screened::just_visible).collect();
    let mut diagnosis = Diagnosis {
        format: 1,
        scene: case.scene_name.clone(),
        recordings: case.folders.clone(),
        verdict,
        modelled: (verdict == Verdict::UnknownPhysics).then_some(is_modelled),
        summary: String::new(),
        detection: figures::detection(&case, &noise, &found, (excess, left_by_scene)),
        location,
        effects,
        withheld,
        discrepancy: of_scene.as_ref().map_or_else(Vec::new, |fit| verdict::discrepancy(&found, fit)),
        calibration: figures::calibration(&case, &complete),
        specimens,
        fit: proof,
        next_experiment: experiment.next,
        warnings: warnings::together(&case.runs.iter().map(|r| r.file.as_str()).collect::<Vec<_>>(), &warnings),
    };
    let caveats = caveats::caveats(&case, (&complete, &diagnosis.effects), &noise, &contradicted);
    diagnosis.summary = summary::summary(&diagnosis, &caveats);
    let rivals = verdict::lost(&found);
    Ok(Outcome {
        diagnosis,
        baseline: Some(found.baseline),
        corrected: Some(found.best),
        complete: Some(of_scene.unwrap_or(complete)),
        residuals: Some([before, after]),
        noise,
        rivals,
        just_visible,
        next_inputs: experiment.inputs,
        case,
    })
}

/// What was found, and what describes the rest beside it, fitted to the runs that may have a say.
fn complete_fits(case: &Case, found: &Found, noise: &[Noise]) -> (Fit, Option<Fit>) {
    // A specimen that is predicted from others has no say in their parameters.
    let runs = if case.is_transfer() { RunSet::Open } else { RunSet::All };
    let fitted = |noise| Problem { case, runs: case.subset(runs), noise };
    let complete = match &found.withheld {
        Some(_) => found.baseline.clone(),
        None => fitted_to(&fitted(noise), &found.best),
    };
    (complete, found.described.as_ref().map(|own| fitted_to(&fitted(&own.noise), &own.fit)))
}

/// What an answer says is missing.
struct Said {
    verdict: Verdict,
    is_modelled: bool,
    effects: Vec<NamedEffect>,
    /// Parameters in which runs contradict each other.
    contradicted: Vec<String>,
}

/// The effects and the verdict on them; `left` as in [`next_experiment`].
fn said(
    case: &Case,
    (found, complete, left): (&Found, &Fit, f64),
    (confirmed, excess): (Confirmed, verdict::Excess),
    noise: &[Noise],
    warnings: &mut Vec<String>,
) -> Said {
    let (mut effects, contradicted) = named(case, (found, complete, left), noise, warnings);
    let verdict = judged(case, (found, &effects), confirmed, excess);
    let is_modelled = complete.model.effects.iter().any(|e| e.entry.hypothetical);
    let is_refuted = confirmed == Confirmed::InPart && !is_modelled;
    // A curve describes what nothing simpler explains, from another port perhaps nearly as well.
    let is_described = found.best.model.effects.iter().any(|e| grammar::is_in_pieces(e.spec()));
    let leaves_more = verdict::leaves_a_part(found, excess) || verdict::is_approximate(found, excess);
    let is_doubtful = is_refuted || is_described || leaves_more;
    if verdict == Verdict::UnknownPhysics && is_doubtful {
        verdict::doubt(&mut effects);
    }
    if verdict == Verdict::UnknownPhysics && !is_modelled && !open_is_loud(case, noise, found) {
        warnings.push(HELD_OUT_ALONE.to_owned());
    }
    Said { verdict, is_modelled, effects, contradicted }
}

/// What would set apart what stays open, or else the answer from what comes next to it; `left` is the chi² that the best leaves beyond noise.
fn next_experiment(
    whole: &Problem,
    found: &Found,
    left: f64,
    leaves_a_part: bool,
) -> Result<Experiment, RecordingError> {
    let open = verdict::open(found, left);
    if open.rivals.is_empty() {
        return experiment::confirm(whole, &found.best, found.rivals.iter().flatten(), leaves_a_part);
    }
    experiment::settle(whole, &found.best, &open)
}

/// The effects of the answer with their curves and their sizes by run, and the parameters in which runs contradict each other.
fn named(
    case: &Case,
    (found, complete, left): (&Found, &Fit, f64),
    noise: &[Noise],
    warnings: &mut Vec<String>,
) -> (Vec<NamedEffect>, Vec<String>) {
    let mut effects = verdict::named(found, complete, left);
    add_curves(&Problem { case, runs: case.subset(RunSet::All), noise }, complete, &mut effects);
    for (index, placed) in found.best.model.effects.iter().enumerate() {
        if let Some(own) = effects.iter_mut().find(|e| verdict::is_said(e, placed)) {
            verdict::name_forms(case, found.forms_of(index), &mut own.forms);
        }
    }
    let sizes = consistency::sizes_by_run(case, complete, noise);
    let contradicted = consistency::report(sizes, complete, &mut effects, warnings);
    (effects, contradicted)
}

/// The verdict: what is explained in part, or known and withheld, is unknown physics.
fn judged(
    case: &Case,
    (found, effects): (&Found, &[NamedEffect]),
    confirmed: Confirmed,
    excess: verdict::Excess,
) -> Verdict {
    let is_open_set = !case.is_without(Step::OpenSet);
    if is_open_set && (confirmed == Confirmed::InPart || found.withheld.is_some()) {
        return Verdict::UnknownPhysics;
    }
    verdict::verdict(found, effects, excess, is_open_set)
}

/// Gives every effect that the complete fit has the curve of its law.
fn add_curves(whole: &Problem, complete: &Fit, effects: &mut [NamedEffect]) {
    for (at, placed) in complete.model.effects.iter().enumerate() {
        if let Some(own) = effects.iter_mut().find(|e| verdict::is_said(e, placed)) {
            let curve = verdict::curve(whole.case, complete, at);
            if complete.model.effects[..at].iter().any(|before| verdict::is_said(own, before)) {
                let first = own.curve.take().zip(curve);
                own.curve = first.and_then(|(first, curve)| verdict::together(&first, &curve, &own.acts));
                continue;
            }
            if let Some(curve) = &curve {
                verdict::name_over(placed, (&curve.x, &curve.y), &mut own.known_as);
            }
            own.curve = curve;
            if let Some(curve) = &mut own.curve {
                curve.freehand = freehand::freehand(whole, complete, at, curve);
            }
        }
    }
}

/// What was found, fitted to these runs.
fn fitted_to(whole: &Problem, found: &Fit) -> Fit {
    let fitted = whole.fit_to_the_end(&found.model, &found.x);
    let mut complete = fitted.unwrap_or_else(|| found.clone());
    intervals::widen(whole, &mut complete);
    // Parameters of all runs with which the full scene diverges are no use: then those of the open runs, with which it does not.
    let refined = refine::refine(whole, complete.clone()).or_else(|| refine::refine(whole, found.clone()));
    refined.unwrap_or(complete)
}

/// Whether the open runs hold more than noise that the best does not explain.
fn open_is_loud(case: &Case, noise: &[Noise], found: &Found) -> bool {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    misfit::left(&open, &found.best).is_none_or(|(excess, error)| verdict::is_loud(excess, error))
}

fn unusable(case: Case, preflight: preflight::Preflight) -> Outcome {
    let diagnosis = Diagnosis {
        format: 1,
        scene: case.scene_name.clone(),
        recordings: case.folders.clone(),
        verdict: Verdict::UnusableData,
        modelled: None,
        summary: format!("The recordings cannot be diagnosed: {}.", preflight.unusable.join("; ")),
        detection: Detection::default(),
        location: Location::default(),
        effects: Vec::new(),
        withheld: Vec::new(),
        discrepancy: Vec::new(),
        calibration: BTreeMap::new(),
        specimens: BTreeMap::new(),
        fit: Proof::default(),
        next_experiment: NextExperiment::none(
            "the recordings say nothing yet: see the warnings for what to record instead",
        ),
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
        next_inputs: None,
    }
}
