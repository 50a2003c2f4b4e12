//! What explains the recordings: the calibration, effects of the catalogue, laws that nobody listed, and what they are worth on the
//! sealed runs.

use super::answer::Proof;
use super::baseline;
use super::candidates::{self, Variant};
use super::case::{Case, Sealed};
use super::confirm::{self, Confirmed};
use super::error::DiagnoseError;
use super::fit::Problem;
use super::hypothesis::{self, OneLaw};
use super::noise::{self, Noise};
use super::search::{Begun, Found};
use super::unlisted::Proposals;
use super::verdict::Excess;
use super::{broad, harm, prove, visible, weigh};

/// Residuals by run, channel and time.
type Residuals = Vec<Vec<Vec<f64>>>;

/// What stands after the search and its proofs.
pub(super) struct Explained {
    pub found: Found,
    pub confirmed: Confirmed,
    pub proof: Proof,
    pub noise: Vec<Noise>,
    /// Residuals of the best, and what is more than noise in those of baseline and best.
    pub after: Residuals,
    pub excess: Excess,
    /// Of the recordings and the calibration.
    pub warnings: Vec<String>,
    /// Warnings about what was found: gone with it where something else takes its place.
    pub of_found: Vec<String>,
}

/// Calibrates, and explains what that leaves: by an effect of the catalogue, by one law, by several effects, by several laws.
///
/// One law that explains it all spares the search for several effects, which takes most of the time where nothing listed is the truth.
pub(super) fn explain(
    case: &mut Case,
    warnings: Vec<String>,
    seed: u64,
    say: &dyn Fn(String),
) -> Result<Explained, DiagnoseError> {
    say("baseline".to_owned());
    let base = baseline::baseline(case)?;
    let variants = candidates::variants(case);
    let begun = Begun::with_one(&weigh::open_runs(case, &base.noise), base.fit.clone(), &variants, say);
    let explained = match hypothesis::one_law(case, &base.noise, &begun.found(), say) {
        OneLaw::All(found, noise) => proven(case, *found, noise, seed)?,
        OneLaw::Part(proposals) => {
            let listed = by_catalogue(case, (begun, base.noise), &variants, seed, say)?;
            by_laws(case, listed, proposals, seed, say)?
        }
    };
    let warnings = [warnings, base.warnings, case.notes()].concat();
    Ok(hold_against_full_scene(case, Explained { warnings, ..explained }, seed, say))
}

/// Searches the catalogue on from what has begun, and holds what is found against the sealed runs.
fn by_catalogue(
    case: &mut Case,
    (begun, noise): (Begun, Vec<Noise>),
    variants: &[Variant],
    seed: u64,
    say: &dyn Fn(String),
) -> Result<Explained, DiagnoseError> {
    let (found, noise) = weigh::search_and_weigh(case, noise, begun, variants, say);
    let found = broad::broaden(case, &noise, found, variants, say);
    let case = &*case;
    let problem = |runs: Sealed| Problem { case, runs: case.subset(runs), noise: &noise };
    let (open, sealed, whole) = (problem(Sealed::Open), problem(Sealed::Sealed), problem(Sealed::Both));
    let mut found = confirm::prune(&open, found, variants, say);
    visible::confirm_least_sizes(&open, &found.baseline, &mut found.screened);
    let mut warnings = Vec::new();
    let found = confirm::take_back_unplayable(&whole, found, &mut warnings);
    let (found, possible) = confirm::take_back_contradicted(&whole, &open, found, variants, &mut warnings);
    say("sealed runs".to_owned());
    let mut explained = proven(case, found, noise.clone(), seed)?;
    explained.confirmed = confirm::confirm(&sealed, &explained.found, &explained.proof, &mut warnings).and(possible);
    Ok(Explained { of_found: warnings, ..explained })
}

/// Puts laws that nobody listed in the place of what was found, where they explain clearly more; `begun`: those that were proposed
/// before.
fn by_laws(
    case: &mut Case,
    mut listed: Explained,
    begun: Option<Proposals>,
    seed: u64,
    say: &dyn Fn(String),
) -> Result<Explained, DiagnoseError> {
    let Explained { found, confirmed, excess, noise, .. } = &mut listed;
    let Some(found) = hypothesis::weigh_laws(case, noise, (found, *confirmed), *excess, begun, say) else {
        return Ok(listed);
    };
    let (found, noise) = hypothesis::renew(case, noise, found);
    Ok(Explained { confirmed: listed.confirmed, ..proven(case, found, noise, seed)? })
}

/// What was found with what it is worth on the sealed runs.
fn proven(case: &Case, found: Found, noise: Vec<Noise>, seed: u64) -> Result<Explained, DiagnoseError> {
    let problem = |runs: Sealed| Problem { case, runs: case.subset(runs), noise: &noise };
    let (sealed, whole) = (problem(Sealed::Sealed), problem(Sealed::Both));
    let proof = prove::prove(&sealed, &found.baseline, &found.best, seed).ok_or_else(diverges)?;
    let (after, excess) = misfit(&whole, &found).ok_or_else(diverges)?;
    let (confirmed, warnings, of_found) = (Confirmed::Yes, Vec::new(), Vec::new());
    Ok(Explained { found, confirmed, proof, noise, after, excess, warnings, of_found })
}

/// Takes back what does harm, and holds the rest against the full scene.
fn hold_against_full_scene(case: &Case, explained: Explained, seed: u64, say: &dyn Fn(String)) -> Explained {
    let Explained { found, mut proof, noise, mut of_found, .. } = explained;
    let found = harm::without(case, &noise, found, &mut proof, seed, (&mut of_found, say));
    say("full scene".to_owned());
    let sealed = Problem { case, runs: case.subset(Sealed::Sealed), noise: &noise };
    proof.placebo_gap_closed = confirm::placebos(&sealed, &found, seed);
    confirm::check_on_full_scene(&sealed, &found, &mut proof, seed, &mut of_found);
    Explained { found, proof, noise, of_found, ..explained }
}

pub(super) fn diverges() -> DiagnoseError {
    DiagnoseError::Simulation("it diverges".to_owned())
}

/// Residuals with what was found, and how much of baseline and best is more than noise.
pub(super) fn misfit(whole: &Problem, found: &Found) -> Option<(Residuals, Excess)> {
    let before = whole.residuals(&found.baseline.model, &found.baseline.x)?;
    let after = whole.residuals(&found.best.model, &found.best.x)?;
    let (baseline, error) = noise::structured_excess(&before, whole.noise);
    let (best, _) = noise::structured_excess(&after, whole.noise);
    Some((after, Excess { baseline, best, error }))
}
