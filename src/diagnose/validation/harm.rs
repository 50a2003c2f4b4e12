//! Do no harm: withholds answers that predict worse than the calibrated scene.

use super::fewer::with_one_less;
use super::prove;
use crate::diagnose::case::{Case, CaseRun, Noise, RunSet, Step};
use crate::diagnose::diagnosis::{ChannelProof, Proof};
use crate::diagnose::fit::{Fit, Problem, simulate};
use crate::diagnose::full::play_full;
use crate::diagnose::grammar::Reach;
use crate::diagnose::search::Found;
use crate::diagnose::unknown::{SAME, equally_good, leaves_something, propose};
use crate::diagnose::verdict::Confirmed;

/// Returns the answer if it does no harm. Otherwise, if cables go slack, the equally good fit (unlisted laws included)
/// closest to the samples left out of the open runs; else what is left of several effects when those that are missed
/// least go, one by one. The held-out runs choose nothing, they refuse; what they refuse to the last is located, not
/// modelled. `proof` becomes that of the result, and an answer that lost effects is one in part.
pub(in crate::diagnose) fn without(
    case: &Case,
    noise: &[Noise],
    mut found: Found,
    proof: &mut Proof,
    seed: u64,
    (warnings, say): (&mut Vec<String>, &dyn Fn(String)),
) -> (Found, Confirmed) {
    if !is_refused(case, noise, &found, proof) {
        return (found, Confirmed::Yes);
    }
    warnings.push(format!(
        "{} predicts the held-out runs worse than the calibrated scene{}: it is not put into scene.toml",
        found.best.model.title(),
        most_harmed(proof)
    ));
    let [held_out, open] = [RunSet::HeldOut, RunSet::Open].map(|runs| Problem { case, runs: case.subset(runs), noise });
    let harmless = |other: Found| {
        let renewed = prove::prove(&held_out, &other.baseline, &other.best, seed)?;
        (!is_refused(case, noise, &other, &renewed)).then_some((other, renewed))
    };
    let other = if case.goes_slack() { gentlest(case, noise, &found, say) } else { None };
    if let Some((other, renewed)) = other.and_then(harmless) {
        let title = other.best.model.title();
        warnings.push(format!(
            "another fit that explains the open runs as well, {title}, does not, and stands in its place"
        ));
        *proof = renewed;
        return (other, Confirmed::Yes);
    }
    let mut fewer = std::iter::successors(with_one_less(&open, &found), |fewer| with_one_less(&open, fewer));
    if let Some((fewer, renewed)) = fewer.find_map(harmless) {
        warnings.push(format!("{} alone does not, and stays", fewer.best.model.title()));
        *proof = renewed;
        return (fewer, Confirmed::InPart);
    }
    withhold(&mut found, proof);
    (found, Confirmed::Yes)
}

/// Whether the held-out runs refuse an answer with this proof; one that names nothing is not asked.
pub(in crate::diagnose) fn is_refused(case: &Case, noise: &[Noise], found: &Found, proof: &Proof) -> bool {
    !found.best.model.effects.is_empty() && is_harmful(case, noise, &found.baseline, &found.best, proof)
}

/// The same if the answer cannot be simulated beyond the runs that it was fitted to.
pub(in crate::diagnose) fn without_diverging(mut found: Found, warnings: &mut Vec<String>) -> Found {
    warnings.push(format!(
        "with {} the scene diverges in the held-out runs: it is not put into scene.toml",
        found.best.model.title()
    ));
    remove(&mut found);
    found
}

/// Removes the answer: located, not modelled.
fn withhold(found: &mut Found, proof: &mut Proof) {
    remove(found);
    proof.channels.values_mut().for_each(|c| c.rmse_corrected = c.rmse_baseline);
    (proof.gap_closed, proof.gain_ci95) = (0.0, [0.0, 0.0]);
    (proof.score_gain, proof.score_gain_ci95) = (0.0, [0.0, 0.0]);
}

fn remove(found: &mut Found) {
    let known = found.clone();
    found.best = found.baseline.clone();
    found.described = None;
    found.rivals.clear();
    found.forms.clear();
    found.withheld = Some(Box::new(known));
}

/// The same if the full scene diverges with the answer but not without it: nobody could run that scene.toml.
pub(in crate::diagnose) fn without_unplayable(
    case: &Case,
    noise: &[Noise],
    found: &mut Found,
    proof: &mut Proof,
    warnings: &mut Vec<String>,
) {
    if found.best.model.effects.is_empty() || play_full(case, &found.baseline, noise).is_err() {
        return;
    }
    warnings.push(format!(
        "the full scene cannot be played with {}: it is not put into scene.toml",
        found.best.model.title()
    ));
    withhold(found, proof);
}

/// The same if the full scene, whose figures count where the reduced-order model differs, predicts the held-out runs worse with it.
pub(in crate::diagnose) fn without_harm_on_full_scene(
    case: &Case,
    noise: &[Noise],
    found: &mut Found,
    proof: &mut Proof,
    warnings: &mut Vec<String>,
) {
    if !proof.full_scene.differs() || !is_refused(case, noise, found, proof) {
        return;
    }
    let (title, harmed) = (found.best.model.title(), most_harmed(proof));
    warnings.push(format!(
        "on the full scene {title} predicts the held-out runs worse than the calibrated scene{harmed}: it is not put into scene.toml"
    ));
    withhold(found, proof);
}

/// Of the equally good fits, the one closest to the left-out samples; `None` if that is the answer.
fn gentlest(case: &Case, noise: &[Noise], found: &Found, say: &dyn Fn(String)) -> Option<Found> {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    let distance = |fit: &Fit| left_out(&open, fit).unwrap_or(f64::INFINITY);
    let mut least = distance(&found.best);
    let mut nearest = None;
    for (place, fit) in as_good(found) {
        if distance(&fit) < least {
            least = distance(&fit);
            nearest = Some((place, fit));
        }
    }
    let mut laws = laws(&open, found, say);
    laws.retain(|fit| distance(fit) < least - SAME);
    if let Some((best, forms)) = equally_good(&open, &laws, found.baseline.cost) {
        let lawful = Found { rivals_against: best.cost, best, rivals: vec![Vec::new()], ..found.clone() };
        return Some(lawful.with_last_forms(forms));
    }
    let (place, fit) = nearest?;
    let mut other = found.clone();
    exchange(&mut other, place, fit);
    Some(other)
}

/// Laws that explain the open runs as well as a single effect; cheapest first.
fn laws(open: &Problem, found: &Found, say: &dyn Fn(String)) -> Vec<Fit> {
    if open.case.is_without(Step::OpenSet) || found.best.model.effects.len() > 1 {
        return Vec::new();
    }
    let mut fits = propose(open, &found.baseline, Reach::Plain, say).map_or_else(Vec::new, |p| p.fits);
    fits.retain(|fit| fit.cost <= found.best.cost + SAME);
    fits
}

/// Position of another fit among the alternatives of the last effect.
#[derive(Clone, Copy)]
enum Place {
    Form(usize),
    Rival(usize),
}

fn as_good(found: &Found) -> Vec<(Place, Fit)> {
    let near = found.best.cost + SAME;
    let forms = found.forms.last().into_iter().flatten().enumerate().map(|(i, fit)| (Place::Form(i), fit));
    let rivals = found.rivals.last().into_iter().flatten().enumerate().map(|(i, fit)| (Place::Rival(i), fit));
    forms.chain(rivals).filter(|(_, fit)| fit.cost <= near).map(|(place, fit)| (place, fit.clone())).collect()
}

/// Exchanges the best fit with another.
fn exchange(found: &mut Found, other: Place, own: Fit) {
    let was = std::mem::replace(&mut found.best, own);
    match other {
        Place::Form(i) => {
            if let Some(forms) = found.forms.last_mut() {
                forms[i] = was;
            }
        }
        Place::Rival(i) => {
            found.rivals_against = found.best.cost;
            if let Some(rivals) = found.rivals.last_mut() {
                rivals[i] = was;
            }
        }
    }
}

/// Whether a fit with laws predicts the held-out runs worse, beyond chance, than the listed effects found before. For
/// the calibrated scene see [`without`].
pub(in crate::diagnose) fn is_worse(held_out: &Problem, listed: &Found, lawful: &Fit, seed: u64) -> bool {
    let has_listed = !listed.best.model.effects.is_empty();
    has_listed && prove::prove(held_out, &listed.best, lawful, seed).is_none_or(|p| is_beyond_chance(&p))
}

/// Whether it predicts worse, not by the draw of the moments.
fn is_beyond_chance(proof: &Proof) -> bool {
    proof.score_gain < 0.0 && proof.score_gain_ci95[1] < 0.0
}

/// The channel that loses most, for the reader: the sum of squares may say otherwise.
fn most_harmed(proof: &Proof) -> String {
    let factor = |own: &ChannelProof| own.rmse_corrected.max(own.noise_sd) / own.rmse_baseline.max(own.noise_sd);
    let harmed = proof.channels.iter().max_by(|a, b| factor(a.1).total_cmp(&factor(b.1)));
    harmed.filter(|(_, own)| factor(own) > 1.0).map_or(String::new(), |(column, own)| {
        let [before, after] = [own.rmse_baseline, own.rmse_corrected].map(|rmse| rmse / own.noise_sd);
        format!(" ({column}: {before:.2} -> {after:.2} of the noise)")
    })
}

/// Whether an answer with what describes its discrepancy predicts held-out runs worse than the answer or the calibrated
/// scene, beyond chance, or cannot be played on the full scene. `proof` is its own.
pub(in crate::diagnose) fn does_harm(
    case: &Case,
    noise: &[Noise],
    (found, described): (&Found, &Fit),
    proof: &Proof,
    seed: u64,
) -> bool {
    let held_out = Problem { case, runs: case.subset(RunSet::HeldOut), noise };
    is_worse(&held_out, found, described, seed)
        || is_harmful(case, noise, &found.baseline, described, proof)
        || play_full(case, described, noise).is_err()
}

/// Whether a fit predicts held-out runs worse than the calibrated scene: beyond chance, or at all if it leaves something of the open
/// runs and so has no claim to be the truth; or gains less there than it loses on samples left out of the fit, where a joint is almost free and a small wrong force moves it anywhere.
fn is_harmful(case: &Case, noise: &[Noise], baseline: &Fit, fit: &Fit, proof: &Proof) -> bool {
    let open = Problem { case, runs: case.subset(RunSet::Open), noise };
    if is_beyond_chance(proof) || proof.score_gain < 0.0 && leaves_something(&open, fit) {
        return true;
    }
    if !case.goes_slack() {
        return false;
    }
    let Some([gained, lost]) = gain_and_loss(case, noise, baseline, fit) else { return true };
    lost > 0.0 && lost > gained
}

/// Gain in chi² on the held-out runs, and loss on the samples left out of any run; `None` if the fit cannot be
/// simulated.
fn gain_and_loss(case: &Case, noise: &[Noise], baseline: &Fit, fit: &Fit) -> Option<[f64; 2]> {
    let [held_out, whole] = [RunSet::HeldOut, RunSet::All].map(|runs| Problem { case, runs: case.subset(runs), noise });
    let cost = |fit: &Fit| held_out.cost_at(&fit.model, &fit.x);
    Some([cost(baseline)? - cost(fit)?, left_out(&whole, fit)? - left_out(&whole, baseline)?])
}

/// Sum of squared residuals at the samples left out of the runs; `None` if the fit cannot be simulated.
pub(super) fn left_out(problem: &Problem, fit: &Fit) -> Option<f64> {
    let each = problem.runs.iter().map(|run| at_left_out(problem.case, run, problem.noise, fit));
    each.sum()
}

/// Sum of squared residuals at the samples left out of one run, in units of [`Fit::cost`].
fn at_left_out(case: &Case, run: &CaseRun, noise: &[Noise], fit: &Fit) -> Option<f64> {
    if run.slack.iter().all(Vec::is_empty) {
        return Some(0.0);
    }
    let simulated = simulate(case, run, &fit.model, &fit.x)?;
    let channels = run.slack.iter().zip(&simulated).zip(noise);
    let of_channel = channels.map(|((samples, values), noise)| -> f64 {
        samples.iter().map(|(i, measured)| ((measured - values[*i]) / noise.scale()).powi(2)).sum()
    });
    Some(of_channel.sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::made;
    use crate::diagnose::fit::{Model, Placed};
    use crate::diagnose::grammar;
    use crate::diagnose::search::Begun;
    use crate::effects::{Element, ElementKind, find};
    use crate::scene::Override;

    /// A muscle without area after two seconds: the scene.toml that holds this law could not be run.
    #[test]
    fn what_the_full_scene_cannot_be_played_with_is_known_and_withheld() {
        let law = "law.worn={port=\"muscle.area\", scales=\"1 - worn*time_s/end_s\", candidate=true, \
            parameter={worn={value=1.0}, end_s={value=2.0}}}";
        let own = [Override::parse(law).expect("a law")];
        let case = made::recorded_for("muscle_bench", [&[], &own], &["plunger_mm"], &["elongation_mm"]);
        let noise = [Noise::white(0.01)];
        let open = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let calibrated = Model::baseline();
        let baseline = open.fit(&calibrated, &open.start(&calibrated, None)).expect("played");
        let mut found = Begun::with_one(&open, baseline.clone(), &[], &|_| {}).found();
        let channel = ChannelProof { rmse_baseline: 0.2, rmse_corrected: 0.1, noise_sd: 0.01 };
        let mut proof = Proof { gap_closed: 0.5, ..Proof::default() };
        proof.channels.insert("elongation_mm".to_owned(), channel);
        let mut warnings = Vec::new();

        without_unplayable(&case, &noise, &mut found, &mut proof, &mut warnings);
        assert!(found.withheld.is_none() && warnings.is_empty(), "the calibration alone does no harm: {warnings:?}");

        let worn = grammar::candidate(&case, &case.scene.candidates[0]);
        let model = calibrated.plus(&worn.placed, &worn.values);
        found.best =
            Fit { model: model.clone(), x: [baseline.x.as_slice(), &worn.values].concat(), ..baseline.clone() };
        without_unplayable(&case, &noise, &mut found, &mut proof, &mut warnings);
        assert_eq!(found.withheld.as_ref().map(|known| known.best.model.title()), Some(model.title()));
        assert!(found.best.model.effects.is_empty() && found.best.x == baseline.x);
        assert_eq!((proof.gap_closed, proof.channels["elongation_mm"].rmse_corrected), (0.0, 0.2));
        let [warning] = &warnings[..] else { panic!("{warnings:?}") };
        assert!(warning.starts_with("the full scene cannot be played with worn in muscle"), "{warning}");
    }

    /// A gauge that reads too much, and a bubble that nobody needs, refused together.
    #[test]
    fn of_several_effects_what_the_held_out_runs_bear_stays() {
        let (inputs, outputs) = (["plunger_mm"], ["elongation_mm", "pressure_kpa"]);
        let mut case = made::recorded_for("muscle_bench", [&[], &[]], &inputs, &outputs);
        case.parameters.clear();
        case.runs.iter_mut().for_each(|run| run.measured[1].iter_mut().for_each(|p| *p *= 1.05));
        case.runs[1].is_held_out = true;
        let noise = [0.01, 1.0].map(Noise::white);
        let open = Problem { case: &case, runs: case.subset(RunSet::Open), noise: &noise };
        let fit = |model: &Model| open.fit(model, &open.start(model, None)).expect("played");
        let plus = |model: Model, name: &str, element, channel: Option<&str>| {
            let entry = find(name).expect("of the catalogue");
            let (element, channel) = (Element::of(element, 0, 1), channel.map(str::to_owned));
            model.plus(&Placed { entry, element, channel }, &entry.typical())
        };
        let both = plus(Model::baseline(), "sensor_gain", ElementKind::Sensor, Some(outputs[1]));
        let both = plus(both, "trapped_air", ElementKind::Line, None);
        let (baseline, best) = (fit(&Model::baseline()), fit(&both));
        let mut found = Begun::with_one(&open, baseline, &[], &|_| {}).found();
        (found.rivals_against, found.rivals, found.best) = (best.cost, vec![Vec::new(); 2], best);

        let mut proof = Proof { score_gain: -1.0, score_gain_ci95: [-2.0, -1.0], ..Proof::default() };
        let mut warnings = Vec::new();
        let (kept, confirmed) = without(&case, &noise, found.clone(), &mut proof, 1, (&mut warnings, &|_| {}));
        assert_eq!(kept.best.model.effects, found.best.model.effects[..1]);
        assert!(confirmed == Confirmed::InPart && kept.withheld.is_none() && proof.gap_closed > 0.99, "{proof:?}");
        let [refused, stays] = &warnings[..] else { panic!("{warnings:?}") };
        assert!(refused.contains("+ trapped_air in line predicts the held-out runs worse"), "{refused}");
        assert_eq!(stays, "sensor_gain on pressure_kpa alone does not, and stays");

        // Nothing is left of one.
        let mut proof = Proof { score_gain: -1.0, score_gain_ci95: [-2.0, -1.0], ..Proof::default() };
        let (kept, confirmed) = without(&case, &noise, kept, &mut proof, 1, (&mut warnings, &|_| {}));
        assert!(confirmed == Confirmed::Yes && kept.withheld.is_some() && kept.best.model.effects.is_empty());
    }
}
