//! The recording itself: sample times and channels of equal length.

use super::{PiecewiseLinear, RecordingError, Unit, parse_column};
use std::collections::HashSet;

/// Name of the time column of every file.
pub const TIME_COLUMN: &str = "time_s";

/// One column of samples.
///
/// ```
/// use smam::recording::Channel;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let pressure = Channel::new("pressure_kpa", vec![-99.0, 1900.0]);
/// assert_eq!((pressure.unit()?.symbol, pressure.si()?), ("kPa", vec![-99e3, 1.9e6]));
/// assert!(Channel::new("pressure_torr", Vec::new()).unit().is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Column name; its suffix is the unit of `values`.
    pub column: String,
    /// Samples in the column's own unit; NaN where a sample is missing.
    pub values: Vec<f64>,
}

impl Channel {
    /// A channel of a column name and its values.
    pub fn new(column: impl Into<String>, values: Vec<f64>) -> Self {
        Self { column: column.into(), values }
    }

    /// The unit its name ends in.
    ///
    /// # Errors
    /// [`RecordingError::UnknownUnit`].
    pub fn unit(&self) -> Result<Unit, RecordingError> {
        Ok(parse_column(&self.column)?.unit)
    }

    /// The samples in SI units, NaN where missing.
    ///
    /// # Errors
    /// [`RecordingError::UnknownUnit`].
    pub fn si(&self) -> Result<Vec<f64>, RecordingError> {
        let unit = self.unit()?;
        Ok(self.values.iter().map(|v| unit.to_si(*v)).collect())
    }
}

/// Channels sampled at common, increasing times.
///
/// Sampling may be uneven. The fields are private so that lengths, order of time and unique names
/// always hold.
///
/// ```
/// use smam::recording::{Channel, Recording};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut recording = Recording::new(vec![0.0, 0.5], vec![Channel::new("plunger_mm", vec![1.0, 3.0])])?;
/// assert_eq!(recording.value_at("plunger_mm", 0.25)?, 2.0);
/// assert!(recording.push(Channel::new("force_n", vec![1.0])).is_err());
/// // Time does not stand still.
/// assert!(Recording::new(vec![0.0, 0.0], Vec::new()).is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    time_s: Vec<f64>,
    channels: Vec<Channel>,
}

impl Recording {
    /// A recording of sample times (s) and channels.
    ///
    /// # Errors
    /// Times not finite and increasing, a channel of another length, a column twice.
    pub fn new(time_s: Vec<f64>, channels: Vec<Channel>) -> Result<Self, RecordingError> {
        check_times(&time_s)?;
        let mut recording = Self { time_s, channels: Vec::with_capacity(channels.len()) };
        let mut seen = HashSet::from([TIME_COLUMN.to_owned()]);
        for channel in channels {
            recording.check_length(&channel)?;
            if !seen.insert(channel.column.clone()) {
                return Err(duplicate(channel.column));
            }
            recording.channels.push(channel);
        }
        Ok(recording)
    }

    /// Adds a channel.
    ///
    /// # Errors
    /// A channel of another length, a column that is there already.
    pub fn push(&mut self, channel: Channel) -> Result<(), RecordingError> {
        self.check_length(&channel)?;
        if channel.column == TIME_COLUMN || self.find(&channel.column).is_some() {
            return Err(duplicate(channel.column));
        }
        self.channels.push(channel);
        Ok(())
    }

    /// Sample times, s.
    pub fn time_s(&self) -> &[f64] {
        &self.time_s
    }

    /// Number of samples.
    pub fn sample_count(&self) -> usize {
        self.time_s.len()
    }

    /// Every channel, in the order of the columns.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The names of the channels, in the order of the columns.
    pub fn columns(&self) -> Vec<&str> {
        self.channels.iter().map(|c| c.column.as_str()).collect()
    }

    /// The channel of a column, if there is one.
    pub fn find(&self, column: &str) -> Option<&Channel> {
        self.channels.iter().find(|c| c.column == column)
    }

    /// The channel of a column.
    ///
    /// # Errors
    /// [`RecordingError::NoChannel`], which lists the columns there are.
    pub fn channel(&self, column: &str) -> Result<&Channel, RecordingError> {
        self.find(column)
            .ok_or_else(|| RecordingError::NoChannel { column: column.to_owned(), found: self.columns().join(", ") })
    }

    /// The samples of a column in SI units, NaN where missing.
    ///
    /// # Errors
    /// No such column, no known unit.
    pub fn si(&self, column: &str) -> Result<Vec<f64>, RecordingError> {
        self.channel(column)?.si()
    }

    /// A column as a continuous function of time in SI units, to drive a simulation: straight between samples; where a logger
    /// lost some (up to ten in a row and 0.1 s) along Akima's curve, which cuts no corners.
    ///
    /// # Errors
    /// No such column, no known unit, not a single sample.
    #[doc(hidden)]
    pub fn piecewise_si(&self, column: &str) -> Result<PiecewiseLinear, RecordingError> {
        let line = PiecewiseLinear::new(&self.time_s, &self.si(column)?)
            .ok_or_else(|| RecordingError::AllMissing { column: column.to_owned() })?;
        Ok(line.with_lost_put_back())
    }

    /// A column at a time, in its own unit: straight between samples, NaN where it has none.
    ///
    /// # Errors
    /// No such column.
    pub fn value_at(&self, column: &str, at_s: f64) -> Result<f64, RecordingError> {
        let values = &self.channel(column)?.values;
        Ok(PiecewiseLinear::new(&self.time_s, values).map_or(f64::NAN, |line| line.value(at_s)))
    }

    fn check_length(&self, channel: &Channel) -> Result<(), RecordingError> {
        if channel.values.len() == self.time_s.len() {
            return Ok(());
        }
        Err(RecordingError::Length {
            column: channel.column.clone(),
            values: channel.values.len(),
            times: self.time_s.len(),
        })
    }
}

fn duplicate(column: String) -> RecordingError {
    RecordingError::DuplicateChannel { column }
}

fn check_times(time_s: &[f64]) -> Result<(), RecordingError> {
    let mut previous_s = f64::NEG_INFINITY;
    for (index, &time) in time_s.iter().enumerate() {
        if !time.is_finite() || time <= previous_s {
            return Err(RecordingError::Time { index, time_s: time, previous_s });
        }
        previous_s = time;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two_samples() -> Recording {
        Recording::new(vec![0.0, 0.5], vec![Channel::new("plunger_mm", vec![1.0, 3.0])]).unwrap()
    }

    #[test]
    fn values_come_in_their_unit_and_in_si() {
        let recording = two_samples();
        assert_eq!(recording.channel("plunger_mm").unwrap().values, [1.0, 3.0]);
        assert_eq!(recording.si("plunger_mm").unwrap(), [0.001, 0.003]);
        assert_eq!(recording.piecewise_si("plunger_mm").unwrap().value(0.25), 0.002);
    }

    #[test]
    fn broken_recordings_are_refused() {
        let mut recording = two_samples();
        let says = |result: Result<(), RecordingError>| result.unwrap_err().to_string();
        assert_eq!(
            says(recording.push(Channel::new("force_n", vec![1.0]))),
            "column \"force_n\": 1 values for 2 times\n  remedy: give one value per time"
        );
        assert_eq!(
            says(recording.push(Channel::new("plunger_mm", vec![1.0, 2.0]))),
            "column \"plunger_mm\" occurs twice\n  remedy: rename or remove one"
        );
        assert_eq!(
            says(Recording::new(vec![0.0, 0.0], vec![]).map(drop)),
            "sample 1: time_s = 0 is not after 0\n  remedy: give finite times that increase from sample to sample"
        );
        assert_eq!(
            says(recording.channel("force_n").map(drop)),
            "no column \"force_n\" (found: plunger_mm)\n  remedy: name one of those; the unit belongs to the name"
        );
        let empty = Channel::new("force_n", vec![f64::NAN; 2]);
        recording.push(empty).unwrap();
        assert!(recording.piecewise_si("force_n").is_err());
    }
}
