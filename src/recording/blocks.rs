//! Loggers that hand over their samples in blocks: regular gaps, with as many samples between them.
//!
//! Either time was lost between the blocks, or none was and the blocks were stamped late. Motion tells: across a gap of length `g` it goes
//! on by `g v` where time passed, and by one sample interval's worth, `dt v`, where none did. The speed `v` is that on both sides.

use super::{Recording, median_interval_s};

/// An interval of so many median ones lies between two blocks: less than what counts as a gap, for here the pattern tells.
const BETWEEN_BLOCKS: f64 = 1.5;
/// Fewer gaps are no pattern.
const LEAST_GAPS: usize = 4;
/// Share of the blocks that have the usual number of samples.
const REGULAR: f64 = 0.8;
/// Motion across the gaps must be told from noise: so many times what the residual of the straight lines is.
const TOLD_APART: f64 = 3.0;

/// Samples in blocks.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocks {
    /// Samples in a block.
    pub samples: usize,
    /// Median gap between blocks, s.
    pub gap_s: f64,
    /// Share of the gaps in which time passed, by what the channels moved: 1 all, 0 none. `None` where nothing moved enough.
    pub passed: Option<f64>,
}

impl Blocks {
    /// A sentence on it.
    pub fn note(&self) -> String {
        let gap_ms = (self.gap_s * 1e7).round() / 1e4;
        let begun = format!("its logger writes blocks of {} samples with {gap_ms} ms between them; ", self.samples);
        begun
            + match self.passed {
                Some(share) if share > 0.5 => "the channels moved on meanwhile: that time was lost, and is left out",
                Some(_) => {
                    "the channels did not move on meanwhile: the blocks were stamped late, and motion seems slower than it was; \
                     if the sampling was even, say interval_s (rows at an even pace) in recordings.toml in place of the stamps"
                }
                None => {
                    "whether time was lost there or the blocks were stamped late cannot be told: nothing moved enough"
                }
            }
    }
}

/// The blocks of a recording, if it has any.
pub(super) fn blocks(recording: &Recording) -> Option<Blocks> {
    let time_s = recording.time_s();
    let interval_s = median_interval_s(time_s)?;
    let is_between = |i: &usize| time_s[*i] - time_s[*i - 1] > BETWEEN_BLOCKS * interval_s;
    let ends: Vec<usize> = (1..time_s.len()).filter(is_between).collect();
    if ends.len() < LEAST_GAPS {
        return None;
    }
    let mut lengths: Vec<f64> = ends.windows(2).map(|w| (w[1] - w[0]) as f64).collect();
    let usual = super::median(&mut lengths)?;
    let regular = lengths.iter().filter(|length| **length == usual).count();
    if usual < 3.0 || (regular as f64) < REGULAR * lengths.len() as f64 {
        return None;
    }
    let mut gaps_s: Vec<f64> = ends.iter().map(|i| time_s[*i] - time_s[*i - 1]).collect();
    let gap_s = super::median(&mut gaps_s)?;
    let channels = recording.channels().iter();
    let shares = channels.filter_map(|channel| passed(time_s, &channel.values, &ends, interval_s));
    let best = shares.max_by(|a, b| a.1.total_cmp(&b.1));
    Some(Blocks {
        samples: usual as usize,
        gap_s,
        passed: best.filter(|(_, told)| *told > TOLD_APART).map(|(share, _)| share),
    })
}

/// The share of the gaps' time that a channel moved through, by least squares, and how many times its own error that is told apart from
/// 0 and 1: `x = (jump - dt v) / ((g - dt) v)`.
fn passed(time_s: &[f64], values: &[f64], ends: &[usize], interval_s: f64) -> Option<(f64, f64)> {
    let points: Vec<(f64, f64)> = ends
        .iter()
        .filter_map(|i| {
            let (before, after) = (slope(time_s, values, i.checked_sub(3)?..*i)?, slope(time_s, values, *i..i + 3)?);
            let (speed, gap_s) = (0.5 * (before + after), time_s[*i] - time_s[i - 1]);
            Some(((gap_s - interval_s) * speed, values[*i] - values[i - 1] - interval_s * speed))
        })
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .collect();
    let xx: f64 = points.iter().map(|(x, _)| x * x).sum();
    let share = points.iter().map(|(x, y)| x * y).sum::<f64>() / xx;
    let residual: f64 = points.iter().map(|(x, y)| (y - share * x).powi(2)).sum();
    let error = (residual / points.len() as f64 / xx).sqrt().max(f64::MIN_POSITIVE);
    // Half way between the two answers nothing is decided.
    (xx > 0.0).then(|| (share, (share - 0.5).abs() / error))
}

/// Mean speed over some samples.
fn slope(time_s: &[f64], values: &[f64], rows: std::ops::Range<usize>) -> Option<f64> {
    let last = rows.end.checked_sub(1)?;
    let (from, to) = (time_s.get(rows.start)?, time_s.get(last)?);
    Some((values[last] - values[rows.start]) / (to - from))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Channel;

    /// Blocks of 20 samples of 1 ms with 19 ms more between them; `position` of the true time (lost) or of the count (late).
    fn recorded(is_late: bool) -> Recording {
        let mut stamp_s = 0.0;
        let (mut time_s, mut values) = (Vec::new(), Vec::new());
        for i in 0..400 {
            stamp_s += if i % 20 == 0 { 0.020 } else { 0.001 };
            time_s.push(stamp_s);
            let true_s = if is_late { 0.001 * f64::from(i) } else { stamp_s };
            values.push((5.0 * true_s).sin());
        }
        Recording::new(time_s, vec![Channel::new("position_mm", values)]).unwrap()
    }

    #[test]
    fn lost_time_and_late_stamps_are_told_apart_by_motion() {
        let [lost, late] = [false, true].map(|is_late| blocks(&recorded(is_late)).expect("blocks"));
        assert_eq!((lost.samples, (lost.gap_s * 1e6).round()), (20, 20_000.0));
        assert!(lost.passed.is_some_and(|share| (share - 1.0).abs() < 0.1), "{lost:?}");
        assert!(late.passed.is_some_and(|share| share.abs() < 0.1), "{late:?}");
        assert!(lost.note().contains("time was lost") && late.note().contains("stamped late"));
    }

    #[test]
    fn rest_says_nothing_and_even_sampling_has_no_blocks() {
        let moving = recorded(false);
        let still = Recording::new(moving.time_s().to_vec(), vec![Channel::new("a_mm", vec![1.0; 400])]).unwrap();
        assert_eq!(blocks(&still).expect("blocks").passed, None);
        let even = (0..400).map(|i| 0.01 * f64::from(i)).collect();
        assert_eq!(blocks(&Recording::new(even, Vec::new()).unwrap()), None);
    }
}
