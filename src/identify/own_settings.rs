//! Settings of a scene that only the recording knows: the state at which a run starts, and how closely its motion may be
//! differentiated.

use crate::recording::figures::{line_of_best_fit, rms};
use crate::recording::{PiecewiseLinear, Recording, RecordingError, median_interval_s, noise_sd};
use crate::scene::{Override, Quantity, Scene};

/// The start is read from so much of a recording, s: long beside the noise, short beside a leak.
const READ_S: f64 = 1.0;

/// The scene keys that a recording itself sets: the pressure at which a closed chamber starts, from its first second; the window over which an
/// axis' speed and acceleration are taken from its position, unless the scene states it.
///
/// # Errors
/// A channel whose name has no unit.
pub fn own_settings(scene: &Scene, recording: &Recording) -> Result<Vec<Override>, RecordingError> {
    let start = chamber_start_pa(scene, recording)?.map(|pa| Override::number("chamber.start_pressure_pa", pa));
    let window = window_s(scene, recording)?.map(|s| Override::number("axis.derivative_window_s", s));
    Ok(start.into_iter().chain(window).collect())
}

fn chamber_start_pa(scene: &Scene, recording: &Recording) -> Result<Option<f64>, RecordingError> {
    let mut outputs = scene.file.output.iter().filter(|o| o.quantity == Quantity::ChamberPressure);
    let Some(output) = outputs.find(|o| recording.find(&o.channel).is_some()) else { return Ok(None) };
    Ok(start(recording.time_s(), &recording.si(&output.channel)?))
}

fn window_s(scene: &Scene, recording: &Recording) -> Result<Option<f64>, RecordingError> {
    let axis = scene.file.axis.as_ref().filter(|axis| axis.derivative_window_s.is_none());
    let Some(column) = axis.map(|axis| &axis.position_input).filter(|c| recording.find(c).is_some()) else {
        return Ok(None);
    };
    Ok(narrowest_s(recording.time_s(), &recording.si(column)?))
}

/// Noise of the position may be this share of the acceleration, root mean square.
const NOISE_SHARE: f64 = 0.1;
/// The widest window, in sampling intervals.
const WIDEST: u32 = 100;

/// The narrowest window, in whole sampling intervals and two at least, in which noise of the position is a small share of the
/// second difference over it, `(x(t + w) - 2 x(t) + x(t - w))/w²`; the widest, if none is. `None` if the position says nothing.
fn narrowest_s(times_s: &[f64], position_m: &[f64]) -> Option<f64> {
    let interval_s = median_interval_s(times_s)?;
    let line = PiecewiseLinear::new(times_s, position_m)?;
    // Of white noise with a variance of one the second difference has six.
    let noise_m = 6f64.sqrt() * noise_sd(times_s, position_m).unwrap_or(0.0);
    let (first_s, last_s) = (*times_s.first()?, *times_s.last()?);
    let is_wide_enough = |steps: &u32| {
        let window_s = f64::from(*steps) * interval_s;
        let inside = times_s.iter().filter(|t| **t - first_s >= window_s && last_s - **t >= window_s);
        let bend = |t: &f64| line.value(t + window_s) - 2.0 * line.value(*t) + line.value(t - window_s);
        noise_m <= NOISE_SHARE * rms(&inside.map(bend).collect::<Vec<_>>())
    };
    Some(f64::from((2..WIDEST).find(is_wide_enough).unwrap_or(WIDEST)) * interval_s)
}

/// Value at the first instant of a straight line through the first [`READ_S`]; `None` where nothing was measured.
fn start(times_s: &[f64], values: &[f64]) -> Option<f64> {
    let begin_s = *times_s.first()?;
    let first = times_s.iter().zip(values).take_while(|(t, _)| **t - begin_s <= READ_S);
    let known = first.filter(|(_, v)| v.is_finite()).map(|(t, v)| (t - begin_s, *v));
    let (times_s, values): (Vec<f64>, Vec<f64>) = known.unzip();
    match values[..] {
        [only] => Some(only),
        _ => Some(line_of_best_fit(&times_s, &values).offset).filter(|start| start.is_finite()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sine of 2 Hz and 10 mm: without noise the samples' own spacing; with noise wider, until it is a tenth of what is seen.
    #[test]
    fn noise_widens_the_window() {
        let times_s: Vec<f64> = (0..1000).map(|i| 0.01 * f64::from(i)).collect();
        let omega = std::f64::consts::TAU * 2.0;
        let clean: Vec<f64> = times_s.iter().map(|t| 0.01 * (omega * t).sin()).collect();
        let is_two = |found: Option<f64>| found.is_some_and(|s| (s - 0.02).abs() < 1e-9);
        assert!(is_two(narrowest_s(&times_s, &clean)));
        // Not periodic with any window: a chaotic sequence of unit variance.
        let mut state = 0.3_f64;
        let mut noise = || {
            state = 1.0 - 2.0 * state * state;
            2f64.sqrt() * state
        };
        let noisy: Vec<f64> = clean.iter().map(|x| x + 1e-4 * noise()).collect();
        let window_s = narrowest_s(&times_s, &noisy).expect("it moves");
        let seen_m = 0.01 / 2f64.sqrt() * (omega * window_s).powi(2);
        assert!((0.03..0.12).contains(&window_s), "{window_s}");
        assert!(6f64.sqrt() * 1e-4 < 0.15 * seen_m, "{seen_m}");
        assert!(is_two(narrowest_s(&times_s, &vec![0.0; 1000])));
        assert_eq!(narrowest_s(&[], &[]), None);
    }

    #[test]
    fn the_start_is_that_of_the_line_through_the_first_second() {
        let times_s: Vec<f64> = (0..50).map(|i| 2.0 + 0.1 * f64::from(i)).collect();
        let falling: Vec<f64> = times_s.iter().map(|t| 7e5 - 2e4 * (t - 2.0)).collect();
        assert!((start(&times_s, &falling).expect("measured") - 7e5).abs() < 1e-6);
        assert_eq!(start(&times_s, &vec![f64::NAN; 50]), None);
        assert_eq!(start(&[1.0], &[5.0]), Some(5.0));
    }
}
