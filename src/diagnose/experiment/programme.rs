//! Input trajectories that a rig can play: waves between 0 and 1 over the stroke of every plunger.
//!
//! ```
//! use smam::diagnose::programme::{sample, sine, strokes};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let moved = [("plunger_mm".to_owned(), vec![0.0, 1.5e-3, 3.0e-3])];
//! let next = sample(&strokes(&moved), 20.0, |t, _| sine(t, 0.1))?;
//! let plunger_mm = &next.channel("plunger_mm")?.values;
//! // From rest, over the stroke that was recorded and no further; its end is met at one and a half periods.
//! assert_eq!(plunger_mm[0], 0.0);
//! assert!((plunger_mm[1500] - 3.0).abs() < 1e-9);
//! assert!(plunger_mm.iter().all(|x| (0.0..=3.0 + 1e-9).contains(x)));
//! # Ok(())
//! # }
//! ```

use crate::recording::figures::correlation;
use crate::recording::{Channel, Recording, RecordingError, parse_column};

/// Sampling interval, s, and the time over which the plungers go from rest into the programme.
pub(super) const INTERVAL_S: f64 = 0.01;
const ENTRY_S: f64 = 2.0;
/// Speed between held levels, in strokes per second.
const STROKES_PER_S: f64 = 0.4;

/// Stroke of one input: where it goes, SI, and whether it moves with the first one (1), against it (-1), or by itself (0).
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    pub column: String,
    pub low: f64,
    pub high: f64,
    pub with_first: f64,
}

/// Strokes of inputs from what they did, SI, all at the same times.
pub fn strokes(inputs: &[(String, Vec<f64>)]) -> Vec<Stroke> {
    let first = inputs.first().map_or(&[][..], |(_, x)| x);
    let stroke = |(column, x): &(String, Vec<f64>)| {
        let alike = correlation(x, first);
        let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        let with_first = if alike.abs() > 0.9 { alike.signum() } else { 0.0 };
        Stroke { column: column.clone(), low, high, with_first }
    };
    inputs.iter().map(stroke).collect()
}

/// Levels held for six seconds each, with ramps between them.
pub fn held(levels: &[f64], t: f64) -> f64 {
    let index = ((t / 6.0) as usize).min(levels.len() - 1);
    let from = if index == 0 { 0.5 } else { levels[index - 1] };
    let way = levels[index] - from;
    let gone = STROKES_PER_S * (t - 6.0 * index as f64);
    from + way.signum() * gone.min(way.abs())
}

/// A sine from 0 that swings between 0 and 1.
pub fn sine(t: f64, frequency_hz: f64) -> f64 {
    0.5 - 0.5 * (2.0 * std::f64::consts::PI * frequency_hz * t).cos()
}

/// A sine whose frequency rises from one to the other over a duration.
pub fn chirp(t: f64, from_hz: f64, to_hz: f64, over_s: f64) -> f64 {
    sine(1.0, from_hz * t + (to_hz - from_hz) * t * t / (2.0 * over_s))
}

/// Samples a wave, of the first input (0) and of one that moves by itself (1), over every stroke.
///
/// # Errors
/// Columns without a known unit.
pub fn sample(
    strokes: &[Stroke],
    duration_s: f64,
    wave: impl Fn(f64, usize) -> f64,
) -> Result<Recording, RecordingError> {
    let times_s: Vec<f64> = (0..(duration_s / INTERVAL_S) as usize).map(|i| i as f64 * INTERVAL_S).collect();
    let mut channels = Vec::new();
    for stroke in strokes {
        let unit = parse_column(&stroke.column)?.unit;
        let value = |t: f64| {
            let w = wave(t, usize::from(stroke.with_first == 0.0));
            let share = if stroke.with_first < 0.0 { 1.0 - w } else { w };
            let entered = (t / ENTRY_S).min(1.0);
            unit.from_si(entered * (stroke.low + share * (stroke.high - stroke.low)))
        };
        channels.push(Channel::new(stroke.column.clone(), times_s.iter().map(|&t| value(t)).collect()));
    }
    Recording::new(times_s, channels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_that_move_against_each_other_do_so_in_the_programme() {
        let x: Vec<f64> = (0..100).map(|i| f64::from(i) * 1e-5).collect();
        let against: Vec<f64> = x.iter().map(|x| -x).collect();
        let strokes = strokes(&[("plunger_1_mm".to_owned(), x), ("plunger_2_mm".to_owned(), against)]);
        assert_eq!((strokes[0].with_first, strokes[1].with_first), (1.0, -1.0));
        let r = sample(&strokes, 20.0, |t, _| sine(t, 0.1)).expect("known units");
        let (a, b) = (&r.channels()[0].values, &r.channels()[1].values);
        assert!(a.iter().zip(b).skip(200).all(|(a, b)| (a + b).abs() < 1e-9));
        assert!(a.iter().all(|a| (-1e-9..0.991).contains(a)));
    }

    #[test]
    fn a_chirp_begins_slowly_and_levels_are_held() {
        assert!(chirp(0.0, 0.1, 1.0, 50.0).abs() < 1e-12);
        assert_eq!(held(&[0.2, 0.8], 5.9), 0.2);
        assert_eq!(held(&[0.2, 0.8], 11.0), 0.8);
    }
}
