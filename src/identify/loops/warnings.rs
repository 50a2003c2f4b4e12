//! What one must know before believing the numbers.

use super::Identification;
use super::data::LoopScale;

/// Two parameters this much alike move together.
const ALIKE: f64 = 0.95;
/// Condition number of the scaled `JᵀJ` from which sums of several columns nearly vanish.
const ILL: f64 = 1e6;
/// Residuals this much above the output's own noise are misfit.
const MISFIT: f64 = 1.3;

pub(super) fn warnings(found: &Identification, scale: &LoopScale) -> Vec<String> {
    let mut said = Vec::new();
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
