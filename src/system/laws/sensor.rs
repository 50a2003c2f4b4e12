//! Laws on what a channel shows.

use super::{Act, LawSampled};
use crate::laws::Law;
use crate::scalar::Scalar;

/// A law on one channel.
#[derive(Clone, Debug)]
pub struct LawSensor<D> {
    law: LawSampled<D>,
    /// SI units in one of the channel's.
    factor: f64,
}

impl<D: Scalar> LawSensor<D> {
    /// At its start.
    pub fn new(law: &Law, values: Vec<D>, factor: f64) -> Self {
        Self { law: LawSampled::new(law, values), factor }
    }

    /// Name and port.
    pub fn title(&self) -> String {
        self.law.title()
    }

    /// What is shown when the quantity is `value`, in the channel's unit; times must increase.
    pub fn show(&mut self, time_s: f64, value: D) -> D {
        let reading = value * self.factor;
        let mut act = Act::neutral();
        act.set(self.law.law().acts, self.law.at(time_s, &[reading]));
        act.on(reading) / self.factor
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{LawTable, Surroundings};

    fn shown(text: &str, at: &[(f64, f64)]) -> Vec<f64> {
        let table: LawTable = toml::from_str(&format!("name = 'x'\nport = 'sensor.angle_deg'\n{text}")).expect("TOML");
        let law = table.law(&Surroundings::default()).unwrap_or_else(|e| panic!("{e}"));
        let mut sensor = LawSensor::new(&law, law.values(), std::f64::consts::PI / 180.0);
        at.iter().map(|(t, x)| sensor.show(*t, *x)).collect()
    }

    /// A channel in degrees: what is added is in radians, what scales has no unit.
    #[test]
    fn gain_offset_and_lag_are_what_they_say() {
        let gain = shown("scales = '1 + 0.1'", &[(0.0, 10.0)]);
        assert!((gain[0] - 11.0).abs() < 1e-12);
        let offset = shown("adds = '0.5 * time_s'", &[(0.0, 0.0), (2.0, 0.0)]);
        assert!((offset[1] - 57.295_779_5).abs() < 1e-6);
        let lag = "adds = 's - reading'\nstate.s = { rate = '(reading - s)/tau_s', start = 'reading' }\nparameter.tau_s = { value = 0.05 }";
        let ramp: Vec<(f64, f64)> = (0..200).map(|i| (0.01 * f64::from(i), 0.02 * f64::from(i))).collect();
        // A settled first-order lag of a ramp of 2 per second is 2 tau behind.
        assert!((shown(lag, &ramp)[199] - (3.98 - 0.1)).abs() < 1e-4);
        let play = "adds = 's - reading'\nstate.s = { play_of = 'reading', width = '0.02' }";
        let turned = shown(play, &[(0.0, 0.0), (0.1, 10.0), (0.2, 9.9)]);
        let half = 0.01_f64.to_degrees();
        assert!((turned[1] - (10.0 - half)).abs() < 1e-9 && (turned[2] - turned[1]).abs() < 1e-9, "{turned:?}");
    }
}
