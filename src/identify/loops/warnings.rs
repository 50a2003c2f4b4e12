//! What one must know before believing the numbers.

use super::Identification;
use super::data::{LoopRun, LoopScale};
use statrs::statistics::Statistics;

/// Two parameters this much alike move together.
const ALIKE: f64 = 0.95;
/// Condition number of the scaled `JᵀJ` from which sums of several columns nearly vanish.
const ILL: f64 = 1e6;
/// Residuals this much above the output's own noise are misfit.
const MISFIT: f64 = 1.3;

/// What a fit may leave of the output's variance before it explains next to nothing.
const HOPELESS: f64 = 0.2;
/// How far the first sample may lie from the model, as a share of the output's range.
const AWAY: f64 = 0.2;

pub(super) fn warnings(found: &Identification, scale: &LoopScale, runs: &[LoopRun]) -> Vec<String> {
    let mut said = Vec::new();
    said.extend(hopeless(found, runs));
    said.extend(runs.iter().filter_map(|run| away(found, run)));
    said.extend(fixed(found));
    said.extend(alike(found));
    if found.certainty.condition > ILL {
        said.push(format!(
            "the parameters as a whole are ill-conditioned (JᵀJ scaled: {:.1e}): other sets fit almost as well; \
             use a simpler form or a programme with inner loops of several sizes",
            found.certainty.condition
        ));
    }
    said.extend(vague(found));
    said.extend(found.parameters.iter().filter(|p| p.on_bound).map(|p| {
        format!("{} = {:.4} lies on its bound ({}); its interval does not hold", p.spec.name, p.value, p.spec.why)
    }));
    said.extend(misfit(found));
    if let Err(reason) = found.model.check_loops(scale.input_mm) {
        said.push(format!("not every closed loop of this model is sure to take energy: {reason}"));
    }
    said
}

/// A fit that is hardly better than a constant.
fn hopeless(found: &Identification, runs: &[LoopRun]) -> Option<String> {
    let outputs: Vec<f64> = runs.iter().flat_map(|r| &r.output_mm).copied().filter(|y| y.is_finite()).collect();
    let share = found.mean_square_mm2 / outputs.iter().population_variance();
    (share > HOPELESS).then(|| {
        format!(
            "the fit leaves {:.0} % of the output's variance: it explains next to nothing; look whether the columns belong \
             together, and where the output counts from",
            100.0 * share
        )
    })
}

/// An output that does not begin where the model at rest does.
fn away(found: &Identification, run: &LoopRun) -> Option<String> {
    let first = run.output_mm.iter().position(|y| y.is_finite())?;
    let finite = || run.output_mm.iter().copied().filter(|y| y.is_finite());
    let range = finite().fold(f64::MIN, f64::max) - finite().fold(f64::MAX, f64::min);
    let expected = found.model.follow(&run.time_s[..=first], &run.input_mm[..=first])[first];
    ((run.output_mm[first] - expected).abs() > AWAY * range).then(|| {
        format!(
            "{}: the output begins at {:.2} mm with the input at {:.2} mm, the model there has {expected:.2} mm: a model \
             starts at rest; count input and output from the muscle at rest, or skip the beginning",
            run.name, run.output_mm[first], run.input_mm[first]
        )
    })
}

fn fixed(found: &Identification) -> impl Iterator<Item = String> {
    found.parameters.iter().filter_map(|p| {
        let (value, why) = p.spec.fixed?;
        Some(format!("{} is fixed at {value}: {why}", p.spec.name))
    })
}

fn alike(found: &Identification) -> Vec<String> {
    let mut said = Vec::new();
    for (i, first) in found.free.iter().enumerate() {
        for (j, second) in found.free.iter().enumerate().skip(i + 1) {
            let r = found.certainty.correlation[(i, j)];
            if r.abs() > ALIKE {
                said.push(format!(
                    "{first} and {second} cannot be told apart well (correlation {r:.3}): believe their joint effect, \
                     not each number"
                ));
            }
        }
    }
    said
}

fn vague(found: &Identification) -> impl Iterator<Item = String> {
    found.parameters.iter().filter_map(|p| {
        let half_width = p.half_width?;
        let is_vague = half_width.is_nan() || half_width > 0.5 * (p.spec.max - p.spec.min);
        is_vague.then(|| format!("{} is not determined: its interval is as wide as its bounds", p.spec.name))
    })
}

fn misfit(found: &Identification) -> Option<String> {
    let (left, noise) = (found.mean_square_mm2.sqrt(), found.noise_mm?);
    (left > MISFIT * noise).then(|| {
        format!(
            "the model leaves {left:.3} mm, the output's own noise is {noise:.3} mm: the form is not the whole truth, and the \
             intervals (scatter about this misfit) do not say how far its numbers are from any other form's"
        )
    })
}
