//! Feedback on top of a feedforward programme.

/// An integral trim: `u = u_ff + s`, `ds/dt = (wanted - measured)/(k T)`, `k` the mean slope of output over input.
///
/// The simplest law that takes a lasting error away whatever brings it: a load, a leak, a muscle other than the one
/// identified. `T` must be several times the delay from plunger to output. Lengths in mm, times in s.
///
/// ```
/// use smam::feedforward::Trim;
///
/// // A muscle of 9 mm per mm of plunger, 2 mm too short, trimmed a hundred times a second for ten time constants.
/// let mut trim = Trim::new(9.0, 0.2, 1.0);
/// let mut elongation_mm = 0.0;
/// for _ in 0..200 {
///     elongation_mm = 9.0 * trim.step(2.0 - elongation_mm, 0.01);
/// }
/// assert!((elongation_mm - 2.0_f64).abs() < 1e-3);
/// // However great the error, the plunger is never moved by more than 1 mm.
/// assert_eq!(trim.step(1e9, 1.0), 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trim {
    slope: f64,
    time_s: f64,
    most_mm: f64,
    sum_mm: f64,
}

impl Trim {
    /// A trim that closes an error with the time constant `time_s` and never adds more than `most_mm`.
    pub fn new(slope: f64, time_s: f64, most_mm: f64) -> Self {
        Self { slope, time_s, most_mm, sum_mm: 0.0 }
    }

    /// What to add to the input after an error has been measured for `duration_s`, mm.
    pub fn step(&mut self, error_mm: f64, duration_s: f64) -> f64 {
        if error_mm.is_finite() {
            let grown = self.sum_mm + error_mm * duration_s / (self.slope * self.time_s);
            self.sum_mm = grown.max(-self.most_mm).min(self.most_mm);
        }
        self.sum_mm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lasting_offset_goes_and_a_missing_sample_changes_nothing() {
        let (slope, mut trim) = (9.0, Trim::new(9.0, 0.2, 1.0));
        let mut output = 0.0;
        for _ in 0..400 {
            output = slope * trim.step(2.0 - output, 0.01);
        }
        assert!((output - 2.0).abs() < 1e-6, "{output}");
        assert_eq!(trim.step(f64::NAN, 0.01), output / slope);
    }

    #[test]
    fn it_stops_at_its_most() {
        let mut trim = Trim::new(1.0, 0.1, 0.5);
        assert_eq!(trim.step(1e9, 1.0), 0.5);
    }
}
