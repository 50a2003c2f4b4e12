//! Channels of several clocks as one recording.
//!
//! The topic with the most samples is the clock, of equals one that is compared rather than one that drives. Another that keeps up with it is read at every instant of the clock, on the
//! straight line between its own samples. A slower one is read so at the instants nearest to its samples only, and is
//! missing at the others: a sample counts once, however fast the clock is. Nothing is read across a gap.

use super::{gap_limit_s, median_interval_s};

/// A topic keeps up when its median interval is at most this many of the clock's.
const KEEPS_UP: f64 = 1.5;

/// A column with its own times.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sampled {
    pub(super) column: String,
    pub(super) topic: String,
    pub(super) is_output: bool,
    /// Increasing, s; at least one.
    pub(super) time_s: Vec<f64>,
    pub(super) values: Vec<f64>,
}

/// Instants (s), values of each column at them, and a note where the columns had several clocks.
pub(super) fn on_one_clock(sampled: &[Sampled]) -> (Vec<f64>, Vec<Vec<f64>>, Option<String>) {
    // The first of the best: a driving input runs straight between its samples anyway.
    let Some(clock) = sampled.iter().rev().max_by_key(|s| (s.time_s.len(), s.is_output)) else {
        return (Vec::new(), Vec::new(), None);
    };
    let values = sampled.iter().map(|s| if s.time_s == clock.time_s { s.values.clone() } else { at(&clock.time_s, s) });
    (clock.time_s.clone(), values.collect(), note(clock, sampled))
}

fn note(clock: &Sampled, sampled: &[Sampled]) -> Option<String> {
    let mut others: Vec<String> = Vec::new();
    for other in sampled.iter().filter(|s| s.time_s != clock.time_s) {
        let named = format!("{} ({} samples)", other.topic, other.time_s.len());
        if !others.contains(&named) {
            others.push(named);
        }
    }
    (!others.is_empty()).then(|| {
        let (topic, count) = (&clock.topic, clock.time_s.len());
        format!("one time for all channels, that of {topic} ({count} samples); brought to it: {}", others.join(", "))
    })
}

/// A column at the instants of the clock.
fn at(clock_s: &[f64], sampled: &Sampled) -> Vec<f64> {
    let clock_interval_s = median_interval_s(clock_s).unwrap_or(f64::INFINITY);
    let interval_s = median_interval_s(&sampled.time_s).unwrap_or(f64::INFINITY);
    let mut is_read = vec![interval_s <= KEEPS_UP * clock_interval_s; clock_s.len()];
    sampled.time_s.iter().for_each(|t| is_read[nearest(clock_s, *t)] = true);
    let (gap_s, reach_s) = (gap_limit_s(&sampled.time_s), 0.5 * clock_interval_s);
    let read = clock_s.iter().zip(is_read);
    read.map(|(t, is_read)| if is_read { value_at(sampled, *t, gap_s, reach_s) } else { f64::NAN }).collect()
}

/// On the line between the samples around `time_s`; where there is none, the sample within reach, else missing.
fn value_at(sampled: &Sampled, time_s: f64, gap_s: f64, reach_s: f64) -> f64 {
    let (times, values) = (&sampled.time_s, &sampled.values);
    let after = times.partition_point(|t| *t < time_s);
    if after > 0 && after < times.len() && times[after] - times[after - 1] <= gap_s {
        let part = (time_s - times[after - 1]) / (times[after] - times[after - 1]);
        // At a sample: the sample itself, whatever its neighbour is.
        return if part == 1.0 {
            values[after]
        } else {
            values[after - 1] + part * (values[after] - values[after - 1])
        };
    }
    let near = nearest(times, time_s);
    if (times[near] - time_s).abs() <= reach_s { values[near] } else { f64::NAN }
}

/// Index of the time nearest to `time_s`; `times` has at least one.
fn nearest(times: &[f64], time_s: f64) -> usize {
    let after = times.partition_point(|t| *t < time_s).min(times.len() - 1);
    let before = after.saturating_sub(1);
    if (times[before] - time_s).abs() <= (times[after] - time_s).abs() { before } else { after }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(topic: &str, time_s: Vec<f64>, value: impl Fn(f64) -> f64) -> Sampled {
        let values = time_s.iter().map(|t| value(*t)).collect();
        Sampled { column: format!("{topic}_n"), topic: topic.to_owned(), is_output: true, time_s, values }
    }

    fn even(count: usize, from_s: f64, interval_s: f64) -> Vec<f64> {
        (0..count).map(|i| from_s + i as f64 * interval_s).collect()
    }

    #[test]
    fn one_clock_is_left_as_it_is() {
        let both = [sampled("a", even(4, 0.0, 0.1), |t| t), sampled("b", even(4, 0.0, 0.1), |_| f64::NAN)];
        let (time_s, values, note) = on_one_clock(&both);
        assert_eq!((time_s, &values[0], note), (even(4, 0.0, 0.1), &both[0].values, None));
        assert!(values[1].iter().all(|v| v.is_nan()));
    }

    /// Same rate, half an interval late: on the line, so a ramp is met exactly; no value before its first sample but the
    /// one within reach.
    #[test]
    fn a_topic_that_keeps_up_is_read_everywhere() {
        let both = [sampled("a", even(11, 0.0, 0.25), |t| t), sampled("b", even(10, 0.125, 0.25), |t| 2.0 * t)];
        let (time_s, values, note) = on_one_clock(&both);
        assert_eq!(time_s.len(), 11);
        let expected: Vec<f64> = time_s.iter().map(|t| (2.0 * t).clamp(0.25, 4.75)).collect();
        assert_eq!(values[1], expected);
        assert_eq!(note.unwrap(), "one time for all channels, that of a (11 samples); brought to it: b (10 samples)");
    }

    #[test]
    fn a_slower_topic_counts_each_sample_once_and_its_gap_stays() {
        let clock = sampled("a", even(101, 0.0, 0.0625), |_| 0.0);
        let mut times = even(7, 0.03125, 0.625);
        times.retain(|t| !(1.2..2.6).contains(t));
        let slow = sampled("b", times, |t| t);
        let (time_s, values, _) = on_one_clock(&[slow.clone(), clock]);
        let there: Vec<(f64, f64)> =
            time_s.iter().copied().zip(values[0].iter().copied()).filter(|(_, v)| !v.is_nan()).collect();
        assert_eq!(there.len(), slow.time_s.len(), "{there:?}");
        assert!(there.iter().all(|(t, v)| (t - v).abs() <= 0.03125), "{there:?}");
    }

    #[test]
    fn a_missing_sample_stays_missing() {
        let mut late = sampled("b", even(5, 0.5, 1.0), |t| t);
        late.values[2] = f64::NAN;
        let (_, values, _) = on_one_clock(&[sampled("a", even(6, 0.0, 1.0), |_| 0.0), late]);
        let missing: Vec<bool> = values[1].iter().map(|v| v.is_nan()).collect();
        assert_eq!(missing, [false, false, true, true, false, false]);
    }
}
