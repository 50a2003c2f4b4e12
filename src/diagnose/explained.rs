//! Explains the recordings by the calibration, by effects of the catalogue and by unlisted laws, and evaluates the
//! result on the held-out runs.

use super::case::{Case, Noise, RunSet, Step};
use super::diagnosis::Proof;
use super::error::DiagnoseError;
use super::fit::{Fit, Problem, Variant, baseline};
use super::search::{Begun, Bound, Found, candidates, creep, detection_limit, discrepancy, reweight};
use super::unknown::by_run::{by_run, untied};
use super::unknown::hypothesis;
use super::unknown::one_law::{OneLaw, one_law, one_law_from_effect};
use super::unknown::pair::{self, Pair};
use super::unknown::tried::Tried;
use super::unknown::{misplaced, stand_ins};
use super::validation::{confirm, harm, prove};
use super::verdict::{Confirmed, Excess, Residuals, leaves_a_part, misfit};

/// Result of the search and of the checks on held-out runs.
pub(super) struct Explained {
    pub found: Found,
    pub confirmed: Confirmed,
    pub proof: Proof,
    pub noise: Vec<Noise>,
    /// Residuals of the best model, and the part above noise for baseline and best.
    pub after: Residuals,
    pub excess: Excess,
    /// Warnings about the recordings and the calibration.
    pub warnings: Vec<String>,
    /// Warnings about the answer; they are dropped if another answer replaces it.
    pub of_found: Vec<String>,
}

/// Calibrates the scene, then explains the residual by one effect of the catalogue, by one law, by several effects, or
/// by several laws.
///
/// If one law explains everything, the search for several effects is skipped. It takes most of the time when nothing
/// listed is the truth.
pub(super) fn explain(
    case: &mut Case,
    warnings: Vec<String>,
    seed: u64,
    say: &dyn Fn(String),
) -> Result<Explained, DiagnoseError> {
    say("baseline".to_owned());
    let base = baseline::baseline(case)?;
    let variants = candidates::variants(case);
    let begun = Begun::with_one(&reweight::open_runs(case, &base.noise), base.fit, &variants, say);
    let search = Search { variants: &variants, seed, say };
    let mut explained = search.searched(case, begun, base.noise)?;
    explained.warnings = [warnings, base.warnings, case.notes()].concat();
    withhold_harm(case, &mut explained, seed, say)?;
    describe_discrepancy(case, &mut explained, &variants, seed, say);
    hold_against_full_scene(case, &mut explained, seed, say);
    Ok(explained)
}

/// Searches for several effects and several laws.
struct Search<'a> {
    variants: &'a [Variant],
    seed: u64,
    say: &'a dyn Fn(String),
}

impl Search<'_> {
    /// One law, numbers that differ from run to run, several effects or several laws; where runs differ in what was found, with numbers for
    /// each.
    fn searched(&self, case: &mut Case, begun: Begun, noise: Vec<Noise>) -> Result<Explained, DiagnoseError> {
        let (seed, say) = (self.seed, self.say);
        let explained = match one_law(case, &noise, (&begun.found(), self.variants), say) {
            OneLaw::All(found, noise) => proven(case, *found, noise, seed)?,
            OneLaw::Listed(fit, tried) => {
                let begun = self.from(case, &noise, (begun.found().baseline, fit));
                self.several(case, begun, noise, *tried)?
            }
            OneLaw::Part(tried) => match by_run(case, &noise, (&begun.found(), self.variants), say) {
                Some((found, noise)) => return proven(case, found, noise, seed),
                None => self.several(case, begun, noise, *tried)?,
            },
        };
        let explained = without_misplaced(case, explained, seed, say)?;
        let explained = at_better_places(case, explained, seed)?;
        let is_whole = explained.confirmed == Confirmed::Yes && !leaves_a_part(&explained.found, explained.excess);
        let in_each = if is_whole { None } else { untied(case, &explained.noise, &explained.found, say) };
        in_each.map_or(Ok(explained), |(found, noise)| proven(case, found, noise, seed))
    }

    /// Begins with effects of the catalogue that laws have led to, beside the calibration.
    fn from(&self, case: &Case, noise: &[Noise], fits: (Fit, Fit)) -> Begun {
        Begun::again(&reweight::open_runs(case, noise), fits, self.variants, Vec::new(), self.say)
    }

    /// Tries several effects, several laws, and laws beside effects. Stops adding effects once a law outdoes
    /// them; resumes if none remains in their place.
    fn several(
        &self,
        case: &mut Case,
        begun: Begun,
        noise: Vec<Noise>,
        tried: Tried,
    ) -> Result<Explained, DiagnoseError> {
        let one = begun.found();
        let begun = begun.up_to(&reweight::open_runs(case, &noise), self.variants, 2, self.say);
        let two = begun.found();
        let (begun, tried) = match one_law_from_effect(case, &noise, (&one, &two, self.variants), tried, self.say) {
            OneLaw::All(found, noise) => return proven(case, *found, noise, self.seed),
            OneLaw::Listed(fit, tried) => (self.from(case, &noise, (two.baseline, fit)), *tried),
            OneLaw::Part(tried) => (begun, *tried),
        };
        // A third effect takes seconds to try, two things of which one has no name minutes.
        let begun = begun.up_to(&reweight::open_runs(case, &noise), self.variants, 3, self.say);
        let (begun, tried) = match pair::pair(case, &noise, (&begun.found(), self.variants), tried, self.say) {
            Pair::All(found, noise) => return proven(case, *found, noise, self.seed),
            Pair::Listed(two, tried) => (self.from(case, &noise, (begun.found().baseline, two)), *tried),
            Pair::Part(tried) => (begun, *tried),
        };
        let open = reweight::open_runs(case, &noise);
        let law = tried.bound(&open, &begun.found().baseline);
        let found = begun.clone().finish(&open, self.variants, law, self.say);
        if !law.outdoes(&open, &found.baseline, &found.best) {
            return self.to_the_end(case, noise, found, tried);
        }
        let mut cut_short =
            Explained { confirmed: Confirmed::InPart, ..proven(case, found, noise.clone(), self.seed)? };
        let again = Tried { instead: tried.instead.clone(), ..Tried::default() };
        if let Some(lawful) = self.by_laws(case, &mut cut_short, tried)? {
            return Ok(lawful);
        }
        let found = begun.finish(&reweight::open_runs(case, &noise), self.variants, Bound::default(), self.say);
        self.to_the_end(case, noise, found, again)
    }

    /// Reweights the catalogue's answer and compares it with the held-out runs and with laws. `tried`: earlier results
    /// for one law.
    fn to_the_end(
        &self,
        case: &mut Case,
        noise: Vec<Noise>,
        found: Found,
        tried: Tried,
    ) -> Result<Explained, DiagnoseError> {
        let (found, noise) = reweight::weigh(case, noise, found, self.variants, self.say);
        let mut listed = self.held_against_others(case, found, noise)?;
        Ok(self.by_laws(case, &mut listed, tried)?.unwrap_or(listed))
    }

    /// The catalogue's answer without the effects that fail, compared with the held-out runs.
    fn held_against_others(
        &self,
        case: &mut Case,
        found: Found,
        noise: Vec<Noise>,
    ) -> Result<Explained, DiagnoseError> {
        let (variants, say) = (self.variants, self.say);
        let found = creep::broaden(case, &noise, found, variants, say);
        let case = &*case;
        let problem = |runs: RunSet| Problem { case, runs: case.subset(runs), noise: &noise };
        let (open, held_out, whole) = (problem(RunSet::Open), problem(RunSet::HeldOut), problem(RunSet::All));
        let mut found = confirm::prune(&open, found, variants, say);
        detection_limit::confirm_least_sizes(&open, &found.baseline, &mut found.screened);
        let mut warnings = Vec::new();
        let found = confirm::take_back_unplayable(&whole, found, &mut warnings);
        let (found, possible) = confirm::take_back_contradicted(&whole, &open, found, variants, &mut warnings);
        say("held-out runs".to_owned());
        let mut explained = proven(case, found, noise.clone(), self.seed)?;
        explained.confirmed =
            confirm::confirm(&held_out, &explained.found, &explained.proof, &mut warnings).and(possible);
        Ok(Explained { of_found: warnings, ..explained })
    }

    /// Replaces the answer by unlisted laws where they explain clearly more.
    fn by_laws(
        &self,
        case: &mut Case,
        listed: &mut Explained,
        tried: Tried,
    ) -> Result<Option<Explained>, DiagnoseError> {
        let Explained { found, confirmed, proof, excess, noise, .. } = &mut *listed;
        // What the held-out runs refuse leaves room for laws, however well it explains the open ones.
        let is_refused = harm::is_refused(case, noise, found, proof);
        let confirmed = if is_refused { Confirmed::InPart } else { *confirmed };
        let Some(found) = hypothesis::weigh_laws(case, noise, (found, confirmed), *excess, tried, self.say) else {
            return Ok(None);
        };
        let noise = noise.clone();
        taken(case, listed, found, &noise, self.seed)
    }
}

/// Replaces effects that are surrogates for something at a more likely place by laws there.
fn without_misplaced(
    case: &mut Case,
    mut explained: Explained,
    seed: u64,
    say: &dyn Fn(String),
) -> Result<Explained, DiagnoseError> {
    for _ in 0..explained.found.best.model.effects.len() {
        let noise = explained.noise.clone();
        let Some(found) = misplaced::exchanged(case, &noise, &explained.found, say) else { break };
        let Some(lawful) = taken(case, &mut explained, found, &noise, seed)? else { break };
        explained = lawful;
    }
    Ok(explained)
}

/// Adds the alternatives of each of several effects; replaces one of several laws where a law elsewhere is better.
fn at_better_places(case: &mut Case, mut explained: Explained, seed: u64) -> Result<Explained, DiagnoseError> {
    for _ in 0..explained.found.best.model.effects.len() {
        let noise = explained.noise.clone();
        let Some(found) = stand_ins::of_several(case, &noise, &mut explained.found) else { break };
        let Some(lawful) = taken(case, &mut explained, found, &noise, seed)? else { break };
        explained = lawful;
    }
    Ok(explained)
}

/// Replaces the answer by a law, with renewed weights and steps. `None` if the law predicts the held-out runs worse.
fn taken(
    case: &mut Case,
    listed: &mut Explained,
    found: Found,
    noise: &[Noise],
    seed: u64,
) -> Result<Option<Explained>, DiagnoseError> {
    let former = case.runs.clone();
    let (found, noise) = hypothesis::renew(case, noise, found);
    let lawful = Explained { confirmed: listed.confirmed, ..proven(case, found, noise, seed)? };
    if lawful.found.withheld.is_some() {
        listed.of_found.extend(lawful.of_found);
        case.runs = former;
        return Ok(None);
    }
    let held_out = Problem { case, runs: case.subset(RunSet::HeldOut), noise: &lawful.noise };
    if harm::is_worse(&held_out, &listed.found, &lawful.found.best, seed) {
        let [own, known] = [&lawful.found, &listed.found].map(|f| f.best.model.title());
        listed
            .of_found
            .push(format!("{own} predicts the held-out runs worse than {known} alone: it is not put into scene.toml"));
        case.runs = former;
        return Ok(None);
    }
    Ok(Some(lawful))
}

/// The answer with its evaluation on the held-out runs; one that diverges there is withheld.
fn proven(case: &Case, found: Found, noise: Vec<Noise>, seed: u64) -> Result<Explained, DiagnoseError> {
    let problem = |runs: RunSet| Problem { case, runs: case.subset(runs), noise: &noise };
    let (held_out, whole) = (problem(RunSet::HeldOut), problem(RunSet::All));
    let shown = |found: &Found| {
        let proof = prove::prove(&held_out, &found.baseline, &found.best, seed)?;
        let (after, excess) = misfit(&whole, found)?;
        Some((proof, after, excess))
    };
    let mut of_found = Vec::new();
    let (found, (proof, after, excess)) = match shown(&found) {
        Some(own) => (found, own),
        None => {
            let found = harm::without_diverging(found, &mut of_found);
            let own = shown(&found).ok_or_else(diverges)?;
            (found, own)
        }
    };
    let (confirmed, warnings) = (Confirmed::Yes, Vec::new());
    Ok(Explained { found, confirmed, proof, noise, after, excess, warnings, of_found })
}

/// Withdraws what predicts held-out runs worse than the calibration.
fn withhold_harm(case: &Case, explained: &mut Explained, seed: u64, say: &dyn Fn(String)) -> Result<(), DiagnoseError> {
    let Explained { found, confirmed, proof, noise, after, excess, of_found, .. } = explained;
    let (kept, of_kept) = harm::without(case, noise, found.clone(), proof, seed, (of_found, say));
    *found = kept;
    if of_kept == Confirmed::InPart {
        let whole = Problem { case, runs: case.subset(RunSet::All), noise };
        *confirmed = of_kept;
        (*after, *excess) = misfit(&whole, found).ok_or_else(diverges)?;
    }
    Ok(())
}

/// Describes by further effects what the answer leaves, unless the held-out runs are predicted worse with them.
fn describe_discrepancy(case: &Case, explained: &mut Explained, variants: &[Variant], seed: u64, say: &dyn Fn(String)) {
    if case.is_without(Step::CrossValidation) {
        return;
    }
    let Explained { found, proof, noise, after, of_found, .. } = explained;
    let problem = |runs: RunSet| Problem { case, runs: case.subset(runs), noise };
    let (open, held_out, whole) = (problem(RunSet::Open), problem(RunSet::HeldOut), problem(RunSet::All));
    let Some(described) = discrepancy::described(&open, &found.best, variants, say) else { return };
    let fit = &described.fit;
    let renewed = prove::prove(&held_out, &found.baseline, fit, seed);
    let (Some(renewed), Some(left)) = (renewed, whole.residuals(&fit.model, &fit.x)) else { return };
    if harm::does_harm(case, noise, (found, fit), &renewed, seed) {
        let [own, known] = [fit, &found.best].map(|fit| fit.model.title());
        of_found.push(format!("{own} predicts the held-out runs worse than {known}, which scene.toml has"));
        return;
    }
    (*proof, *after) = (renewed, left);
    found.described = Some(described);
}

/// Compares the answer with the full scene.
fn hold_against_full_scene(case: &Case, explained: &mut Explained, seed: u64, say: &dyn Fn(String)) {
    say("full scene".to_owned());
    let Explained { found, proof, noise, of_found, .. } = explained;
    let held_out = Problem { case, runs: case.subset(RunSet::HeldOut), noise };
    proof.placebo_gap_closed = confirm::placebos(&held_out, found, seed);
    match confirm::check_on_full_scene(&held_out, found, proof, seed, of_found) {
        true => harm::without_harm_on_full_scene(case, noise, found, proof, of_found),
        false => harm::without_unplayable(case, noise, found, proof, of_found),
    }
}

pub(super) fn diverges() -> DiagnoseError {
    DiagnoseError::Simulation("it diverges".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::made;
    use crate::diagnose::fit::Model;
    use crate::diagnose::grammar;
    use crate::scene::Override;

    /// A muscle that has no area after two seconds, as a law fitted to runs of one second might have it.
    #[test]
    fn what_diverges_in_a_held_out_run_is_withheld() {
        let law = "law.worn={port=\"muscle.area\", scales=\"1 - worn*time_s/end_s\", candidate=true, \
            parameter={worn={value=1.0}, end_s={value=2.0}}}";
        let own = [Override::parse(law).expect("a law")];
        let mut case = made::recorded_for("muscle_bench", [&[], &own], &["plunger_mm"], &["elongation_mm"]);
        case.runs[1].is_held_out = true;
        let noise = vec![Noise::white(0.01)];
        let open = Problem { case: &case, runs: case.subset(RunSet::Open), noise: &noise };
        let calibrated = Model::baseline();
        let baseline = open.fit(&calibrated, &open.start(&calibrated, None)).expect("played");
        let mut found = Begun::with_one(&open, baseline.clone(), &[], &|_| {}).found();
        let explained = proven(&case, found.clone(), noise.clone(), 1).expect("the calibration alone can be played");
        assert!(explained.found.withheld.is_none() && explained.of_found.is_empty());

        let worn = grammar::candidate(&case, &case.scene.candidates[0]);
        let model = calibrated.plus(&worn.placed, &worn.values);
        found.best = Fit { model, x: [baseline.x.as_slice(), &worn.values].concat(), ..baseline };
        let explained = proven(&case, found, noise, 1).expect("an answer");
        let withheld = explained.found.withheld.expect("withheld");
        assert_eq!(withheld.best.model.title(), "worn in muscle");
        assert!(explained.found.best.model.effects.is_empty() && explained.proof.gap_closed == 0.0);
        let [warning] = &explained.of_found[..] else { panic!("{:?}", explained.of_found) };
        assert!(warning.starts_with("with worn in muscle the scene diverges in the held-out runs"), "{warning}");
    }
}
