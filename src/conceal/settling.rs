//! What one more experiment could decide at best: for one who knows the plant's equations, the rig's own numbers nearly and
//! the noise, and asks which of the things that were named is there.

use serde::{Deserialize, Serialize};
use statrs::distribution::{ContinuousCDF, Normal};

use super::ConcealError;
use super::begin::Begun;
use super::case::{Truth, sensor_noise};
use super::ceiling::{best_imitation, rivals};
use super::more::{asked_drives, begins_s};
use super::secrets::{KINDS, Secret};
use super::size::{STRIDE, Sizing, Weighed, WeighedRun};
use crate::recording::Recording;

/// How far an experiment sets what is hidden apart from what it was taken for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settling {
    pub name: String,
    /// What is hidden, and what imitates it best of all that was named.
    pub hidden: String,
    pub rival: String,
    /// Standard errors between the two with that run more.
    pub sigma: f64,
}

impl Settling {
    /// Share of all draws of the noise in which the likelier of the two is the true one, `Phi(sigma / 2)`.
    pub fn is_right(&self) -> f64 {
        Normal::standard().cdf(0.5 * self.sigma)
    }
}

/// Computes it for the secrets that an answer left open (`is_open`) and the things that it named in their place (`is_named`), with
/// the programme played after the case's runs and a sensor, if one is asked for. Everything else that is hidden is there, its size as
/// little known as the rig's own numbers. `None` where nothing named is something that the plant could have.
///
/// # Errors
/// A plant that the solver cannot follow, a programme of another rig.
pub fn settling(
    truth: &Truth,
    is_open: impl Fn(&Secret) -> bool,
    is_named: impl Fn(&Secret) -> bool,
    programme: &Recording,
    sensor: Option<&str>,
) -> Result<Option<Settling>, ConcealError> {
    let mut nearest: Option<Settling> = None;
    for secret in truth.secrets.iter().filter(|s| is_open(s)) {
        let is_hidden = |rival: &Secret| truth.secrets.iter().any(|s| s.is_same_thing(rival));
        let named: Vec<Secret> =
            rivals(truth, secret).into_iter().filter(|rival| is_named(rival) && !is_hidden(rival)).collect();
        if named.is_empty() {
            continue;
        }
        let sizing = Sizing::new(with_programme(truth, secret, programme, sensor)?)?;
        let shown = sizing.left(secret)?;
        for rival in named.into_iter().flat_map(over_its_range) {
            let title = title(&rival);
            let distance = (&shown - &best_imitation(&sizing, rival, &shown)?).norm_squared();
            let sigma = (distance * STRIDE as f64).sqrt();
            if nearest.as_ref().is_none_or(|n| sigma < n.sigma) {
                let (name, hidden) = (truth.name.clone(), self::title(secret));
                nearest = Some(Settling { name, hidden, rival: title, sigma });
            }
        }
    }
    Ok(nearest)
}

fn title(secret: &Secret) -> String {
    format!("{} {}", secret.name, secret.channel.as_deref().unwrap_or(&secret.element))
}

/// The case's own runs and the one that is asked for, all of it, beside everything hidden but one secret.
fn with_programme(
    truth: &Truth,
    secret: &Secret,
    programme: &Recording,
    sensor: Option<&str>,
) -> Result<Weighed, ConcealError> {
    let (begun, _) = Begun::draw(truth.rig, truth.seed);
    let mut weighed = begun.weighed_for_slow_signals();
    let place = |column: &str| truth.rig.more_sensors().iter().position(|o| o.column == column);
    let sensor = sensor.and_then(|column| Some((place(column)?, sensor_noise(truth, column)?.sd)));
    let drives = asked_drives(truth.rig, programme)?;
    weighed.runs.push(WeighedRun { begun_s: begins_s(truth), drives, sensor });
    weighed.present = truth.secrets.iter().filter(|s| !s.is_same_thing(secret)).cloned().collect();
    Ok(weighed)
}

/// A thing with its further number at the ends and in the middle of where it is drawn from.
fn over_its_range(rival: Secret) -> Vec<Secret> {
    let range = KINDS.iter().find(|k| k.name == rival.name).map_or((1.0, 1.0), |k| k.second);
    let mut seconds = vec![range.0, rival.second, range.1];
    seconds.dedup();
    seconds.into_iter().map(|second| Secret { second, ..rival.clone() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::{Hiding, Rig, draw};
    use crate::recording::Channel;

    /// A weight and a coil wound tight pull alike once the muscle is out by a millimetre; a load cell tells which it is.
    #[test]
    fn a_sensor_may_tell_what_no_programme_does() {
        // A line that warms up and a weight, taken for a coil wound tight.
        let drawn = draw("open", Rig::MuscleBench, Hiding::Several, 2026 * 1_000_003 + 352).expect("the plant runs");
        let time_s: Vec<f64> = (0..600).map(|k| f64::from(k) * 0.05).collect();
        let plunger_mm = time_s.iter().map(|t| 0.5 - 0.5 * (0.4 * t).cos()).collect();
        let programme = Recording::new(time_s, vec![Channel::new("plunger_mm", plunger_mm)]).expect("increasing");
        let sigma = |sensor: Option<&str>| {
            let (open, named) = (|s: &Secret| s.name == "gravity_load", |s: &Secret| s.name == "coil_preload");
            let found =
                settling(&drawn.truth, open, named, &programme, sensor).expect("the plant runs").expect("a rival");
            assert_eq!((found.hidden.as_str(), found.rival.as_str()), ("gravity_load muscle", "coil_preload muscle"));
            found.sigma
        };
        let [without, with] = [sigma(None), sigma(Some("force_n"))];
        assert!(with > 1.5 * without, "{without} {with}");
        // Nothing that the plant could have was named.
        let none = settling(&drawn.truth, |_| true, |_| false, &programme, None).expect("nothing is solved");
        assert_eq!(none, None);
    }
}
