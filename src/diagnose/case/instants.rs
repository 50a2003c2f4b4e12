//! The instants of a run that nobody recorded: samples of an input that a logger lost.

use crate::recording::PiecewiseLinear;

/// Instants nearer to each other than this are one, s: rounding of times that were computed.
const ONE_INSTANT_S: f64 = 1e-5;

/// The recorded times and those at which an input has a point that was not recorded (samples that a logger lost), in order.
pub(super) fn with_points_of(lines: &[PiecewiseLinear], recorded_s: &[f64]) -> Vec<f64> {
    let is_recorded = |t: &f64| {
        let after = recorded_s.partition_point(|r| r < t);
        recorded_s[after.saturating_sub(1)..].iter().take(2).any(|r| (r - t).abs() < ONE_INSTANT_S)
    };
    let mut lost_s: Vec<f64> =
        lines.iter().flat_map(|line| line.times_s()).copied().filter(|t| !is_recorded(t)).collect();
    lost_s.sort_by(f64::total_cmp);
    lost_s.dedup_by(|later, earlier| *later - *earlier < ONE_INSTANT_S);
    let mut times_s = [recorded_s, &lost_s].concat();
    times_s.sort_by(f64::total_cmp);
    times_s
}

/// What was recorded at each of more times; NaN at those that were not recorded.
pub(super) fn at_times(times_s: &[f64], recorded_s: &[f64], values: &[f64]) -> Vec<f64> {
    let mut samples = recorded_s.iter().zip(values).peekable();
    let at = |t: &f64| samples.next_if(|(recorded, _)| *recorded == t).map_or(f64::NAN, |(_, value)| *value);
    times_s.iter().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Channel, Recording};

    /// Rows without the input, rows that are not there at all, and two inputs that lack different ones: no instant twice, and no two
    /// that rounding alone sets apart.
    #[test]
    fn lost_samples_are_instants_of_their_own() {
        let time_s: Vec<f64> = (0..599).filter(|i| i % 11 != 5).map(|i| f64::from(i) * 0.01).collect();
        let input = |skipped: usize| {
            let value = |(i, t): (usize, &f64)| if i % 13 == skipped { f64::NAN } else { (3.0 * t).sin() };
            time_s.iter().enumerate().map(value).collect::<Vec<f64>>()
        };
        let channels = vec![Channel::new("plunger_1_mm", input(4)), Channel::new("plunger_2_mm", input(7))];
        let recording = Recording::new(time_s.clone(), channels).expect("increasing");
        let lines = ["plunger_1_mm", "plunger_2_mm"].map(|c| recording.piecewise_si(c).expect("a column"));
        let times_s = with_points_of(&lines, &time_s);
        assert_eq!(times_s.len(), 599);
        let least = times_s.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min);
        assert!(least > 0.0099, "{least:e}");
        let measured = at_times(&times_s, &time_s, &vec![1.0; time_s.len()]);
        assert_eq!(measured.iter().filter(|v| v.is_finite()).count(), time_s.len());
    }
}
