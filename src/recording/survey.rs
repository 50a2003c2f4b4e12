//! What is irregular in a recording. Nothing here changes a sample.

use super::Recording;
use super::blocks::{Blocks, blocks};
use super::strays::strays;
use std::fmt;

/// An interval longer than this many median intervals is a gap.
const GAP_FACTOR: f64 = 3.0;
/// Muscles move faster than samples this far apart could show: a clock of milliseconds, more likely, s.
const SLOW_S: f64 = 1.0;
/// Sensors of muscles are not read 20 000 times a second: seconds that are called milliseconds, more likely, s.
const FAST_S: f64 = 5e-5;
/// An interval this far from the median (as a share of it) is uneven; clocks that count in
/// milliseconds stay below it at 100 Hz.
const UNEVEN_TOLERANCE: f64 = 0.2;
/// Sampling is called uneven when more than this share of the intervals is.
const UNEVEN_SHARE: f64 = 0.01;

/// A stretch of time without samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Last sample before it, s.
    pub from_s: f64,
    /// First sample after it, s.
    pub to_s: f64,
}

/// Missing samples of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// The column.
    pub column: String,
    /// How many of its samples are missing.
    pub count: usize,
}

/// Samples of one channel that lie far outside all others ([`strays`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Strays {
    /// The column.
    pub column: String,
    /// How many.
    pub count: usize,
    /// Value of the first of them, and when it was taken, s.
    pub first: (f64, f64),
}

/// Findings about one recording; `Display` prints one line per finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    /// Samples in time.
    pub sample_count: usize,
    /// From the first to the last sample, s.
    pub duration_s: f64,
    /// Median time between samples, s; `None` with fewer than two samples.
    pub median_interval_s: Option<f64>,
    /// Share of the intervals, gaps left out, that differ by more than a fifth from the median.
    pub uneven_share: f64,
    /// Intervals longer than three medians.
    pub gaps: Vec<Gap>,
    /// Samples in blocks with regular gaps between them.
    pub blocks: Option<Blocks>,
    /// Channels with missing samples.
    pub missing: Vec<Missing>,
    /// Channels with samples far outside all others.
    pub strays: Vec<Strays>,
}

impl Survey {
    /// Whether more than 1 % of the intervals are uneven.
    pub(crate) fn is_uneven(&self) -> bool {
        self.uneven_share > UNEVEN_SHARE
    }

    /// What a user should know, one sentence each; empty when all is regular.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if self.sample_count == 1 {
            notes.push("one sample only: nothing moves".to_owned());
        }
        if let Some(interval_s) = self.median_interval_s.filter(|s| *s > SLOW_S) {
            notes.push(format!(
                "one sample in {interval_s} s: is the time in seconds, not in milliseconds? (time_unit = \"ms\" in recordings.toml)"
            ));
        }
        if let Some(interval_s) = self.median_interval_s.filter(|s| *s < FAST_S) {
            notes.push(format!(
                "{:.0} samples a second: is the time in another unit than its name says? (time_unit in recordings.toml)",
                1.0 / interval_s
            ));
        }
        if self.is_uneven() {
            let percent = 100.0 * self.uneven_share;
            notes.push(format!("uneven sampling: {percent:.1} % of the intervals are more than 20 % off the median"));
        }
        notes.extend(self.gap_note());
        notes.extend(self.blocks.as_ref().map(Blocks::note));
        notes.extend(self.missing.iter().map(|m| {
            format!(
                "column \"{}\": {} of {} samples missing: left out of an output, bridged in an input",
                m.column, m.count, self.sample_count
            )
        }));
        notes.extend(self.strays.iter().map(|Strays { column, count, first: (value, at_s) }| {
            format!(
                "column \"{column}\": {count} of {} samples lie far outside all others ({value} at {at_s} s): if that is the logger's mark for no \
                 value, leave those cells empty",
                self.sample_count
            )
        }));
        notes
    }

    fn gap_note(&self) -> Option<String> {
        const SHOWN: usize = 5;
        let first: Vec<String> = self.gaps.iter().take(SHOWN).map(Gap::to_string).collect();
        let more = match self.gaps.len().saturating_sub(SHOWN) {
            0 => String::new(),
            rest => format!(" and {rest} more"),
        };
        (!first.is_empty()).then(|| {
            let count = self.gaps.len();
            format!("gaps ({count}): {}{more}", first.join(", "))
        })
    }
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Ten digits drop the rounding error of times that were computed.
        let [from_s, to_s] = [self.from_s, self.to_s].map(|s| (s * 1e10).round() / 1e10);
        write!(f, "{from_s} to {to_s} s")
    }
}

impl fmt::Display for Survey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} samples over {} s", self.sample_count, self.duration_s)?;
        if let Some(interval_s) = self.median_interval_s {
            // Seven digits drop the rounding error of a difference of times.
            let interval_ms = (interval_s * 1e10).round() / 1e7;
            write!(f, ", median interval {interval_ms} ms")?;
        }
        self.notes().iter().try_for_each(|note| write!(f, "\n{note}"))
    }
}

/// Surveys the sampling and the missing samples of a recording.
///
/// ```
/// use smam::recording::{Channel, Recording, survey};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let force = Channel::new("force_n", vec![1.0, f64::NAN, 1.0, 1.0, 1.0]);
/// let found = survey(&Recording::new(vec![0.0, 1.0, 2.0, 3.0, 7.0], vec![force])?);
/// assert_eq!((found.gaps[0].from_s, found.gaps[0].to_s), (3.0, 7.0));
/// assert_eq!((found.missing[0].column.as_str(), found.missing[0].count), ("force_n", 1));
/// # Ok(())
/// # }
/// ```
pub fn survey(recording: &Recording) -> Survey {
    let time_s = recording.time_s();
    let gap_limit_s = gap_limit_s(time_s);
    Survey {
        sample_count: time_s.len(),
        duration_s: time_s.last().zip(time_s.first()).map_or(0.0, |(b, a)| b - a),
        median_interval_s: median_interval_s(time_s),
        uneven_share: uneven_share(time_s),
        gaps: time_s
            .windows(2)
            .filter(|w| w[1] - w[0] > gap_limit_s)
            .map(|w| Gap { from_s: w[0], to_s: w[1] })
            .collect(),
        blocks: blocks(recording),
        missing: missing(recording),
        strays: all_strays(recording),
    }
}

/// The longest interval (s) between samples that is no gap; infinite with fewer than two samples.
pub fn gap_limit_s(time_s: &[f64]) -> f64 {
    median_interval_s(time_s).map_or(f64::INFINITY, |median_s| GAP_FACTOR * median_s)
}

/// Median time between samples, s; `None` with fewer than two samples.
pub fn median_interval_s(time_s: &[f64]) -> Option<f64> {
    let mut intervals_s: Vec<f64> = time_s.windows(2).map(|w| w[1] - w[0]).collect();
    median(&mut intervals_s)
}

/// The median, of the two middle values the upper; reorders `values`.
pub fn median(values: &mut [f64]) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

fn uneven_share(time_s: &[f64]) -> f64 {
    let Some(median_s) = median_interval_s(time_s) else {
        return 0.0;
    };
    let intervals_s: Vec<f64> =
        time_s.windows(2).map(|w| w[1] - w[0]).filter(|dt| *dt <= GAP_FACTOR * median_s).collect();
    let uneven = intervals_s.iter().filter(|dt| (**dt - median_s).abs() > UNEVEN_TOLERANCE * median_s).count();
    uneven as f64 / intervals_s.len() as f64
}

fn missing(recording: &Recording) -> Vec<Missing> {
    let channels = recording.channels().iter();
    channels
        .map(|channel| Missing {
            column: channel.column.clone(),
            count: channel.values.iter().filter(|v| v.is_nan()).count(),
        })
        .filter(|missing| missing.count > 0)
        .collect()
}

fn all_strays(recording: &Recording) -> Vec<Strays> {
    let of = |channel: &super::Channel| {
        let found = strays(&channel.values);
        let first = *found.first()?;
        let first = (channel.values[first], recording.time_s()[first]);
        Some(Strays { column: channel.column.clone(), count: found.len(), first })
    };
    recording.channels().iter().filter_map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Channel;

    #[test]
    fn regular_recording_has_no_notes() {
        let time_s = (0..100).map(|i| f64::from(i) * 0.01).collect();
        let survey = survey(&Recording::new(time_s, vec![]).unwrap());
        assert_eq!(survey.notes(), Vec::<String>::new());
        assert_eq!(survey.to_string(), "100 samples over 0.99 s, median interval 10 ms");
    }

    #[test]
    fn gaps_missing_and_uneven_sampling_are_reported() {
        let time_s = vec![0.0, 1.0, 2.0, 3.0, 7.0, 8.0, 9.5, 10.5];
        let mut force = vec![1.0; 8];
        force[2] = f64::NAN;
        let recording = Recording::new(time_s, vec![Channel::new("force_n", force)]).unwrap();
        assert_eq!(
            survey(&recording).to_string(),
            "8 samples over 10.5 s, median interval 1000 ms\n\
             uneven sampling: 16.7 % of the intervals are more than 20 % off the median\n\
             gaps (1): 3 to 7 s\n\
             column \"force_n\": 1 of 8 samples missing: left out of an output, bridged in an input"
        );
    }

    /// Milliseconds called seconds, and seconds called milliseconds, of a recording at 100 Hz.
    #[test]
    fn a_clock_in_another_unit_is_asked_for() {
        let of = |interval_s: f64| {
            let time_s = (0..100).map(|i| f64::from(i) * interval_s).collect();
            survey(&Recording::new(time_s, vec![]).unwrap()).notes().concat()
        };
        assert!(of(10.0).contains("not in milliseconds? (time_unit = \"ms\""));
        assert!(of(10e-6).contains("100000 samples a second: is the time in another unit"));
        assert_eq!(of(0.001) + &of(0.01) + &of(0.5), "");
    }

    #[test]
    fn one_sample_has_no_interval() {
        let survey = survey(&Recording::new(vec![2.0], vec![]).unwrap());
        assert_eq!(survey.median_interval_s, None);
        assert_eq!(survey.duration_s, 0.0);
        assert!(!survey.is_uneven());
    }
}
