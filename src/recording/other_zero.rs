//! Zeros by where a channel begins: one that begins elsewhere than its simulation, in every run, counts from another zero.

use super::figures::spread;
use super::noise_sd;

/// Length of a recording's beginning, s; allowed initial difference from the scene, in noise standard deviations and as
/// a share of the spread.
const BEGINNING_S: f64 = 0.3;
const BEGINS_OFF: f64 = 10.0;
const BEGINS_OFF_SHARE: f64 = 0.05;
/// A place whose difference changes by less than this share of itself over a run has another origin, wherever the scene begins.
const SAME_THROUGHOUT: f64 = 0.2;

/// A channel of a run that begins with its inputs at zero, in the unit of its column, and its simulation.
#[derive(Clone, Debug)]
pub struct Begun<'a> {
    /// When it was sampled, s.
    pub times_s: &'a [f64],
    /// What was recorded; NaN where nothing was.
    pub measured: &'a [f64],
    /// What the scene shows.
    pub simulated: Vec<f64>,
}

/// Says that a channel begins elsewhere than its simulation in every run, and which zero would make up for it.
///
/// What only grows in the first moments is motion; if the scene itself starts away from zero (a muscle under tension), its parameters
/// decide, unless it is a place (`is_place`) whose difference stays what it is (a camera with an origin of its own).
///
/// ```
/// use smam::recording::{Begun, other_zero};
///
/// // An absolute pressure, where the scene counts from that of the surroundings.
/// let times_s: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
/// let simulated: Vec<f64> = times_s.iter().map(|t| 50.0 * (1.0 - t.cos())).collect();
/// let measured: Vec<f64> = simulated.iter().map(|p| p + 101.3).collect();
/// let run = Begun { times_s: &times_s, measured: &measured, simulated };
/// let words = other_zero("pressure_kpa", false, &[run]).expect("another zero");
/// assert!(words.contains("begins +1.013e2 kpa") && words.contains("zero = 101.3000"), "{words}");
/// ```
pub fn other_zero(column: &str, is_place: bool, runs: &[Begun<'_>]) -> Option<String> {
    let offsets: Vec<f64> = runs.iter().filter_map(|run| run.begins_off(is_place)).collect();
    let mean = offsets.iter().sum::<f64>() / offsets.len() as f64;
    let is_same = offsets.iter().all(|o| (o - mean).abs() < 0.2 * mean.abs());
    let noise = runs.iter().filter_map(|run| noise_sd(run.times_s, run.measured)).fold(0.0, f64::max);
    let shown: Vec<f64> = runs.iter().flat_map(Begun::both).map(|(_, simulated)| simulated).collect();
    let least = (BEGINS_OFF * noise).max(BEGINS_OFF_SHARE * spread(&shown));
    if !(mean.is_finite() && is_same && mean.abs() > least) {
        return None;
    }
    let (_, unit) = column.rsplit_once('_').unwrap_or(("", ""));
    Some(format!(
        "{column}: begins {mean:+.3e} {unit} from where the scene does, in every run: if its zero is another (a total length, an \
         absolute pressure, a camera's origin), say it in its [[channel]] (zero = {mean:.4} where the file has {unit})"
    ))
}

impl Begun<'_> {
    /// Samples that both have.
    fn both(&self) -> impl Iterator<Item = (f64, f64)> {
        let pairs = self.measured.iter().copied().zip(self.simulated.iter().copied());
        pairs.filter(|(m, s)| m.is_finite() && s.is_finite())
    }

    /// Mean initial offset; 0 where it is no other zero.
    fn begins_off(&self, is_place: bool) -> Option<f64> {
        let until = self.times_s.first()? + BEGINNING_S;
        let values = self.measured.iter().zip(&self.simulated).map(|(m, s)| (*m, m - s));
        let early = self.times_s.iter().zip(values).take_while(|(t, _)| **t <= until);
        let known: Vec<(f64, f64)> = early.map(|(_, own)| own).filter(|(_, off)| off.is_finite()).collect();
        let (measured, first) = *known.first()?;
        let mean = known.iter().map(|(_, off)| off).sum::<f64>() / known.len() as f64;
        let is_zero = first.abs() >= 0.5 * mean.abs() && (measured - first).abs() <= mean.abs();
        let whole: Vec<f64> = self.both().map(|(m, s)| m - s).collect();
        let stays = is_place && spread(&whole) < SAME_THROUGHOUT * mean.abs();
        Some(if is_zero || stays { mean } else { 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Pair = (fn(f64) -> f64, fn(f64) -> f64);

    fn said(is_place: bool, runs: &[Pair]) -> Option<String> {
        let times_s: Vec<f64> = (0..300).map(|i| 0.01 * f64::from(i)).collect();
        let series = |of: fn(f64) -> f64| -> Vec<f64> { times_s.iter().map(|t| of(*t)).collect() };
        let series: Vec<_> = runs.iter().map(|(measured, simulated)| (series(*measured), series(*simulated))).collect();
        let begun = series.iter().map(|(measured, simulated)| Begun {
            times_s: &times_s,
            measured,
            simulated: simulated.clone(),
        });
        other_zero("tip_x_mm", is_place, &begun.collect::<Vec<_>>())
    }

    #[test]
    fn another_zero_is_that_of_every_run() {
        assert!(said(false, &[(|t| 30.0 + t, |t| t), (|t| 31.0 + 2.0 * t, |t| 2.0 * t)]).is_some());
        assert_eq!(said(false, &[(|t| 30.0 + t, |t| t), (|t| t, |t| t)]), None);
    }

    /// Motion that begins at once, a scene that begins under tension: neither is a zero.
    #[test]
    fn motion_and_tension_are_none() {
        assert_eq!(said(false, &[(|t| 10.0 * t, |t| t)]), None);
        assert_eq!(said(false, &[(|t| 2.0 + t, |t| 50.0 + t)]), None);
        // A camera's origin is one, wherever the scene begins.
        assert!(said(true, &[(|t| 2.0 + t, |t| 50.0 + t)]).is_some());
    }
}
