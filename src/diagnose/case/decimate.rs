//! Fast recordings averaged down.

use crate::recording::{Channel, Recording, RecordingError, median_interval_s};

/// The recording with as many neighbouring samples averaged as fit into `interval_s`, and how many those are; none when
/// it is slow enough already. Nothing is averaged over a gap, and what is missing in part is the mean of the rest.
///
/// # Errors
/// None that the recording itself does not have.
pub(super) fn thin(recording: &Recording, interval_s: f64) -> Result<Option<(Recording, usize)>, RecordingError> {
    let times_s = recording.time_s();
    let Some(own_s) = median_interval_s(times_s).filter(|s| *s > 0.0) else { return Ok(None) };
    let count = (interval_s / own_s + 1e-6).floor() as usize;
    if count < 2 {
        return Ok(None);
    }
    let mut blocks = vec![0];
    for i in 1..times_s.len() {
        let is_full = i - blocks[blocks.len() - 1] >= count;
        if is_full || times_s[i] - times_s[i - 1] > 3.0 * own_s {
            blocks.push(i);
        }
    }
    blocks.push(times_s.len());
    let averaged = |values: &[f64]| -> Vec<f64> { blocks.windows(2).map(|b| mean(&values[b[0]..b[1]])).collect() };
    let channels = recording.channels().iter().map(|c| Channel::new(c.column.clone(), averaged(&c.values))).collect();
    Ok(Some((Recording::new(averaged(times_s), channels)?, count)))
}

fn mean(values: &[f64]) -> f64 {
    let (sum, count) = values.iter().filter(|v| v.is_finite()).fold((0.0, 0.0), |(s, n), v| (s + v, n + 1.0));
    if count > 0.0 { sum / count } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recording(times_s: Vec<f64>) -> Recording {
        let values = times_s.iter().map(|t| 10.0 * t).collect();
        Recording::new(times_s, vec![Channel::new("angle_deg", values)]).expect("valid")
    }

    #[test]
    fn averages_keep_a_straight_line_and_stop_at_gaps() {
        let times_s = (0..100).map(|i| f64::from(i) * 1e-3 + if i >= 37 { 0.5 } else { 0.0 }).collect();
        let (thin, count) = thin(&recording(times_s), 0.01).expect("valid").expect("fast");
        assert_eq!(count, 10);
        assert_eq!(thin.sample_count(), 4 + 7);
        for (t, v) in thin.time_s().iter().zip(&thin.channels()[0].values) {
            assert!((v - 10.0 * t).abs() < 1e-9, "{t} {v}");
            assert!(*t < 0.037 || *t > 0.53, "{t} lies in the gap");
        }
    }

    #[test]
    fn slow_recordings_stay_as_they_are() {
        let slow = recording((0..50).map(|i| f64::from(i) * 0.01).collect());
        assert!(thin(&slow, 0.01).expect("valid").is_none());
    }
}
