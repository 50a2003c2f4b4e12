//! What a sensor does to the quantity it shows.

use crate::scalar::Scalar;

/// One sensor error on one channel, in the channel's unit.
///
/// ```
/// use smam::effects::{Sensor, SensorHistory};
///
/// let mut filtered = SensorHistory::new(Sensor::Lag { time_constant_s: 0.1_f64 });
/// let mut late = SensorHistory::new(Sensor::Delay { delay_s: 0.1_f64 });
/// // A ramp of 1 mm/s, once the filter has settled: both show it a tenth of a millimetre late.
/// let shown_mm = [0.0, 2.0].map(|t| [filtered.show(t, t), late.show(t, t)]);
/// assert_eq!(shown_mm[0], [0.0, 0.0]);
/// assert!(shown_mm[1].iter().all(|mm| (mm - 1.9).abs() < 1e-6));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Sensor<D> {
    /// First-order filter `T dy/dt = u - y`, s; starts settled.
    Lag { time_constant_s: D },
    /// Pure delay, s; what was before the start is the first value.
    Delay { delay_s: D },
    /// `y = u + r (t - t0)`, `r` per second.
    Drift { rate_per_s: D },
    /// `y = (1 + g) u`.
    Gain { gain_error: D },
}

/// What a [`Sensor`] remembers from sample to sample.
#[derive(Clone, Debug)]
pub struct SensorHistory<D> {
    sensor: Sensor<D>,
    start_s: f64,
    samples: Vec<(f64, D)>,
    shown: Option<D>,
}

impl<D: Scalar> SensorHistory<D> {
    pub fn new(sensor: Sensor<D>) -> Self {
        Self { sensor, start_s: 0.0, samples: Vec::new(), shown: None }
    }

    /// What is shown when the quantity is `value` at `time_s`; times must increase. Between samples the quantity is
    /// taken as a straight line, for which filter and delay are exact.
    pub fn show(&mut self, time_s: f64, value: D) -> D {
        if self.shown.is_none() {
            self.start_s = time_s;
        }
        let shown = match self.sensor {
            Sensor::Gain { gain_error } => value + gain_error * value,
            Sensor::Drift { rate_per_s } => value + rate_per_s * (time_s - self.start_s),
            Sensor::Lag { time_constant_s } => self.filtered(time_s, value, time_constant_s),
            Sensor::Delay { delay_s } => self.delayed(time_s, value, delay_s),
        };
        self.shown = Some(shown);
        shown
    }

    fn filtered(&mut self, time_s: f64, value: D, tau: D) -> D {
        let before = self.samples.pop();
        self.samples.push((time_s, value));
        let (Some((t0, u0)), Some(y0)) = (before, self.shown) else { return value };
        let dt = time_s - t0;
        if tau.value() <= 0.0 {
            // At zero the filter is absent; its derivative there is that of a delay of the same size.
            let slope = if dt > 0.0 { (value - u0) / dt } else { D::constant(0.0) };
            return value - tau * slope;
        }
        let lead = tau * (value - u0) / dt;
        value - lead + (y0 - u0 + lead) * (-(tau.recip() * dt)).exp()
    }

    fn delayed(&mut self, time_s: f64, value: D, delay: D) -> D {
        let before = self.samples.last().copied();
        self.samples.push((time_s, value));
        let Some((t0, u0)) = before else { return value };
        if delay.value() <= 0.0 {
            return value - delay * ((value - u0) / (time_s - t0));
        }
        let when = -delay + time_s;
        let after = self.samples.partition_point(|(t, _)| *t < when.value()).clamp(1, self.samples.len() - 1);
        let ((t0, u0), (t1, u1)) = (self.samples[after - 1], self.samples[after]);
        if when.value() <= t0 {
            return u0;
        }
        u0 + (u1 - u0) * ((when - t0) / (t1 - t0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(sensor: Sensor<f64>) -> Vec<f64> {
        let mut history = SensorHistory::new(sensor);
        (0..200).map(|i| history.show(0.01 * f64::from(i), 0.02 * f64::from(i))).collect()
    }

    #[test]
    fn a_ramp_lags_by_the_time_constant_and_by_the_delay() {
        // Slope 2 per second: the settled lag is 2 T.
        assert!((ramp(Sensor::Lag { time_constant_s: 0.05 })[199] - (3.98 - 0.1)).abs() < 1e-12);
        assert!((ramp(Sensor::Delay { delay_s: 0.033 })[199] - (3.98 - 0.066)).abs() < 1e-12);
        assert_eq!(ramp(Sensor::Delay { delay_s: 0.5 })[3], 0.0);
    }

    #[test]
    fn zero_size_changes_nothing() {
        let plain: Vec<f64> = (0..200).map(|i| 0.02 * f64::from(i)).collect();
        for sensor in [
            Sensor::Lag { time_constant_s: 0.0 },
            Sensor::Delay { delay_s: 0.0 },
            Sensor::Drift { rate_per_s: 0.0 },
            Sensor::Gain { gain_error: 0.0 },
        ] {
            assert_eq!(ramp(sensor), plain);
        }
    }
}
