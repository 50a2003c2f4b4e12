//! The state at which a run starts, where only the recording knows it.

use crate::recording::figures::line_of_best_fit;
use crate::recording::{Recording, RecordingError};
use crate::scene::{Override, Quantity, Scene};

/// The start is read from so much of a recording, s: long beside the noise, short beside a leak.
const READ_S: f64 = 1.0;

/// The scene keys that a recording's first second sets: the pressure at which a closed chamber starts.
///
/// # Errors
/// A channel whose name has no unit.
pub fn own_start(scene: &Scene, recording: &Recording) -> Result<Vec<Override>, RecordingError> {
    let outputs = scene.file.output.iter().filter(|o| o.quantity == Quantity::ChamberPressure);
    let mut overrides = Vec::new();
    for output in outputs.filter(|o| recording.find(&o.channel).is_some()).take(1) {
        let start_pa = start(recording.time_s(), &recording.si(&output.channel)?);
        overrides.extend(start_pa.map(|pa| Override::number("chamber.start_pressure_pa", pa)));
    }
    Ok(overrides)
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

    #[test]
    fn the_start_is_that_of_the_line_through_the_first_second() {
        let times_s: Vec<f64> = (0..50).map(|i| 2.0 + 0.1 * f64::from(i)).collect();
        let falling: Vec<f64> = times_s.iter().map(|t| 7e5 - 2e4 * (t - 2.0)).collect();
        assert!((start(&times_s, &falling).expect("measured") - 7e5).abs() < 1e-6);
        assert_eq!(start(&times_s, &vec![f64::NAN; 50]), None);
        assert_eq!(start(&[1.0], &[5.0]), Some(5.0));
    }
}
