//! A sampled signal as a continuous function of time.

use super::lost::put_back;
use super::survey::median_interval_s;

/// Straight lines between samples, the end values held outside.
///
/// ```text
/// u(t) = u_i + (u_{i+1} - u_i) (t - t_i) / (t_{i+1} - t_i),   t_i <= t < t_{i+1}
/// ```
/// `t` in seconds, `u` in the unit of the values given (SI where a simulation is driven). Missing
/// samples are no points: the line runs on from the last to the next sample there is.
/// [`super::survey`] says where such stretches are.
///
/// ```
/// use smam::recording::PiecewiseLinear;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let plunger_m = PiecewiseLinear::new(&[0.0, 1.0, 2.0], &[0.0, f64::NAN, 3e-3]).ok_or("two samples are there")?;
/// assert_eq!((plunger_m.value(1.0), plunger_m.slope(1.0)), (1.5e-3, 1.5e-3));
/// assert_eq!((plunger_m.value(9.0), plunger_m.slope(9.0)), (3e-3, 0.0));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct PiecewiseLinear {
    times_s: Vec<f64>,
    values: Vec<f64>,
}

impl PiecewiseLinear {
    /// A function through the samples that are finite; `None` when there is none.
    ///
    /// `time_s` must increase, as the times of a [`super::Recording`] do.
    pub fn new(time_s: &[f64], values: &[f64]) -> Option<Self> {
        let (times_s, values): (Vec<f64>, Vec<f64>) = time_s
            .iter()
            .zip(values)
            .filter(|(_, value)| value.is_finite())
            .map(|(time, value)| (*time, *value))
            .unzip();
        (!times_s.is_empty()).then_some(Self { times_s, values })
    }

    /// The same with points where a logger lost samples ([`super::lost`]).
    pub(super) fn with_lost_put_back(self) -> Self {
        let Some(median_s) = median_interval_s(&self.times_s) else { return self };
        let (times_s, values) = put_back(self.times_s, self.values, median_s);
        Self { times_s, values }
    }

    /// Times of its points, s.
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// Values at its points.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The value at a time, s.
    pub fn value(&self, time_s: f64) -> f64 {
        let after = self.first_after(time_s);
        if after == 0 {
            return self.values[0];
        }
        let start = self.values[after - 1];
        start + self.slope(time_s) * (time_s - self.times_s[after - 1])
    }

    /// The derivative at a time (s), per second; at a point that of the line to its right, 0 outside.
    pub fn slope(&self, time_s: f64) -> f64 {
        let after = self.first_after(time_s);
        if after == 0 || after == self.times_s.len() {
            return 0.0;
        }
        let rise = self.values[after] - self.values[after - 1];
        rise / (self.times_s[after] - self.times_s[after - 1])
    }

    fn first_after(&self, time_s: f64) -> usize {
        self.times_s.partition_point(|t| *t <= time_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_between_points_ends_held_missing_skipped() {
        let u = PiecewiseLinear::new(&[0.0, 1.0, 2.0, 4.0], &[1.0, 3.0, f64::NAN, 0.0]).unwrap();
        assert_eq!(u.times_s(), [0.0, 1.0, 4.0]);
        assert_eq!(u.value(-1.0), 1.0);
        assert_eq!(u.value(0.5), 2.0);
        assert_eq!(u.value(1.0), 3.0);
        assert_eq!(u.value(2.5), 1.5);
        assert_eq!(u.value(9.0), 0.0);
        assert_eq!((u.slope(-1.0), u.slope(0.0)), (0.0, 2.0));
        assert_eq!((u.slope(1.0), u.slope(4.0)), (-1.0, 0.0));
    }

    #[test]
    fn nothing_measured_is_no_function() {
        assert!(PiecewiseLinear::new(&[0.0], &[f64::NAN]).is_none());
    }
}
