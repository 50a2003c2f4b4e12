//! What could be known of a case at best: by one who knows the plant's equations, the rig's own numbers nearly and the
//! noise, and asks which of all things that may be hidden is there.
//!
//! Signatures are those of the plant itself, less what a linear refit of the rig's own numbers takes. With `D` the squared
//! distance of two hypotheses in units of the noise, the likelier one is the true one in a share `Phi(sqrt(D)/2)` of all
//! draws of the noise; against none, with one false alarm in a hundred, `Phi(sqrt(D) - 2.33)` are seen.

use nalgebra::DVector;
use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

use super::ConcealError;
use super::begin::Begun;
use super::case::Truth;
use super::secrets::{KINDS, Kind, Secret};
use super::size::{STRIDE, Sizing};

/// The best that could be done with one case.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ceiling {
    pub name: String,
    /// Probability that anything is seen, at one false alarm in a hundred.
    pub detection: f64,
    /// Probability that it is told from the most alike of all other things that may be hidden.
    pub naming: f64,
    /// The name of that, and its channel or element.
    pub nearest: String,
}

/// Quantile of the normal distribution beyond which one draw in a hundred lies.
const ONE_IN_A_HUNDRED: f64 = 2.326;

/// The ceiling of a case that hides one thing; none of one that hides nothing or several.
///
/// # Errors
/// A plant that the solver cannot follow.
pub fn ceiling(truth: &Truth) -> Result<Option<Ceiling>, ConcealError> {
    let [secret] = &truth.secrets[..] else { return Ok(None) };
    let (begun, _) = Begun::draw(truth.rig, truth.seed);
    let sizing = begun.sizing_for_slow_signals()?;
    let shown = sizing.left(secret)?;
    let mut nearest = (f64::INFINITY, String::new());
    for rival in rivals(truth, secret) {
        let distance = (&shown - &best_imitation(&sizing, rival.clone(), &shown)?).norm_squared();
        if distance < nearest.0 {
            nearest = (distance, format!("{} {}", rival.name, rival.channel.unwrap_or(rival.element)));
        }
    }
    let sigmas = |squares: f64| (squares * STRIDE as f64).sqrt();
    let below = |z: f64| Normal::standard().cdf(z);
    Ok(Some(Ceiling {
        name: truth.name.clone(),
        detection: below(sigmas(shown.norm_squared()) - ONE_IN_A_HUNDRED),
        naming: below(0.5 * sigmas(nearest.0)),
        nearest: nearest.1,
    }))
}

/// Everything else that the rig might hide, in its own form, at every place.
pub(super) fn rivals(truth: &Truth, secret: &Secret) -> Vec<Secret> {
    let places = |kind: &'static Kind| {
        let channels = truth.rig.outputs().len();
        let muscles = truth.rig.muscles();
        let all = (0..muscles).flat_map(move |m| (0..channels).map(move |c| Secret::typical(kind, truth.rig, m, c)));
        all.collect::<Vec<_>>()
    };
    let mut found: Vec<Secret> = Vec::new();
    for rival in KINDS.iter().filter(|k| k.fits(truth.rig)).flat_map(places) {
        if !rival.is_same_thing(secret) && !found.iter().any(|s| rival.is_same_thing(s)) {
            found.push(rival);
        }
    }
    found
}

/// The signature of a rival at the size at which it is most like another; its law counts as proportional to its size.
pub(super) fn best_imitation(
    sizing: &Sizing,
    mut rival: Secret,
    shown: &DVector<f64>,
) -> Result<DVector<f64>, ConcealError> {
    let kind = KINDS.iter().find(|k| k.name == rival.name);
    let (largest, is_signed) = kind.map_or((f64::INFINITY, true), |k| (k.largest, k.is_signed));
    let share = |own: &DVector<f64>| {
        let share = own.dot(shown) / own.norm_squared().max(f64::MIN_POSITIVE);
        if is_signed { share } else { share.max(0.0) }
    };
    let own = sizing.left(&rival)?;
    let at_typical = share(&own);
    if at_typical == 0.0 {
        return Ok(own * 0.0);
    }
    rival.size = (rival.size * at_typical).clamp(-largest, largest);
    let own = sizing.left(&rival)?;
    let again = share(&own);
    Ok(own * again)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::Rig;

    /// A thing imitates itself from another size; what bends loops does not imitate a leak.
    #[test]
    fn a_thing_is_told_from_others_and_not_from_itself() {
        let (begun, _) = Begun::draw(Rig::MuscleBench, 4);
        let sizing = begun.sizing_for_slow_signals().expect("the plant runs");
        let of = |name: &str| {
            let kind = KINDS.iter().find(|k| k.name == name).expect("listed");
            Secret::typical(kind, Rig::MuscleBench, 0, 0)
        };
        let mut leak = of("leak");
        leak.size *= 0.4;
        let shown = sizing.left(&leak).expect("the plant runs");
        let left = |rival: Secret| {
            let imitated = best_imitation(&sizing, rival, &shown).expect("the plant runs");
            (&shown - imitated).norm_squared() / shown.norm_squared()
        };
        assert!(left(of("leak")) < 0.02, "{}", left(of("leak")));
        assert!(left(of("viscoelasticity")) > 0.1, "{}", left(of("viscoelasticity")));
    }
}
