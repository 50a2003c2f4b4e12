//! The way from rest to where a recording begins.

use crate::recording::PiecewiseLinear;
use crate::scene::Scene;

/// Speed of the way to the first recorded plunger position, m/s, the rest after it, s, and the time between its instants, s.
const SPEED_M_S: f64 = 2.0e-3;
const REST_S: f64 = 1.0;
const INTERVAL_S: f64 = 0.02;
/// A plunger that begins nearer to zero than this begins there, m.
const AT_ZERO_M: f64 = 5.0e-5;

/// A run that begins with a plunger away from zero has come there: how is not recorded. It is led there from rest, all inputs at
/// once and evenly, and rests a second.
#[derive(Clone, Debug, PartialEq)]
pub struct LeadIn {
    times_s: Vec<f64>,
    /// Share of the way at each of the times.
    shares: Vec<f64>,
    farthest_m: f64,
    /// What is led there: `a plunger`.
    input: &'static str,
}

impl LeadIn {
    /// The way to a scene's first input values (SI) at the time `start_s`; `None` for a run that begins at rest, or a scene
    /// without plungers whose recordings are not said to begin in motion.
    pub fn before(scene: &Scene, start_s: f64, first: &[f64]) -> Option<Self> {
        let farthest_m = first.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let has_plungers = scene.file.hydraulics.is_some();
        if !(has_plungers || scene.file.simulation.recorded_in_motion) || farthest_m < AT_ZERO_M {
            return None;
        }
        let moving_s = farthest_m / SPEED_M_S;
        let total_s = moving_s + REST_S;
        let count = (total_s / INTERVAL_S).ceil() as usize;
        let at = |i: usize| total_s * i as f64 / count as f64;
        Some(Self {
            times_s: (0..count).map(|i| start_s - total_s + at(i)).collect(),
            shares: (0..count).map(|i| (at(i) / moving_s).min(1.0)).collect(),
            farthest_m,
            input: if has_plungers { "a plunger" } else { "an input" },
        })
    }

    /// Its instants, all before the recording, s.
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// An input on the way to its first value.
    pub fn values(&self, first: f64) -> impl Iterator<Item = f64> {
        self.shares.iter().map(move |share| first * share)
    }

    /// The way, and then the recorded input; both in SI.
    pub fn lead(&self, recorded: &PiecewiseLinear) -> Option<PiecewiseLinear> {
        let first = *recorded.values().first()?;
        let values: Vec<f64> = self.values(first).chain(recorded.values().iter().copied()).collect();
        PiecewiseLinear::new(&[&self.times_s, recorded.times_s()].concat(), &values)
    }

    /// What a user should know of it.
    pub fn note(&self) -> String {
        format!(
            "begins with {} at {:.3} mm: led there from zero, at {:.0} mm/s, before the recording",
            self.input,
            1e3 * self.farthest_m,
            1e3 * SPEED_M_S
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tendon_is_led_there_where_recordings_begin_in_motion() {
        let catheter = Scene::load("tendon_catheter", &[]).expect("stock scene");
        let way = LeadIn::before(&catheter, 0.0, &[2.0e-3]).expect("away from zero");
        assert!(way.note().contains("begins with an input at 2.000 mm"), "{}", way.note());
        let sheath = Scene::load("tendon_sheath", &[]).expect("stock scene");
        assert_eq!(LeadIn::before(&sheath, 0.0, &[2.0]), None);
    }

    #[test]
    fn a_plunger_is_led_to_where_the_recording_begins() {
        let scene = Scene::load("muscle_bench", &[]).expect("stock scene");
        assert_eq!(LeadIn::before(&scene, 0.0, &[4.0e-5]), None);
        let way = LeadIn::before(&scene, 5.0, &[1.0e-3, -2.0e-3]).expect("away from zero");
        // One second of motion and one of rest.
        assert!((way.times_s()[0] - 3.0).abs() < 1e-12 && way.times_s().iter().all(|t| *t < 5.0));
        let line = way.lead(&PiecewiseLinear::new(&[5.0, 6.0], &[-2.0e-3, 0.0]).expect("samples")).expect("samples");
        assert!((line.value(3.5) + 1.0e-3).abs() < 1e-9 && (line.value(4.5) + 2.0e-3).abs() < 1e-12);
    }
}
