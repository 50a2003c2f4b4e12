//! Measured against simulated, channel by channel.

use super::{ChannelSpec, Recording, RecordingError, Role, noise_sd};

/// How well a simulation meets one measured channel, in the column's own unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelFit {
    /// The column.
    pub column: String,
    /// Root mean square of measured minus simulated; NaN without a common sample.
    pub rmse: f64,
    /// Standard deviation of the measurement noise, stated or estimated; `None` when neither.
    pub noise_sd: Option<f64>,
    /// Largest minus smallest measured value; NaN without a common sample.
    pub range: f64,
    /// Samples compared: those missing in neither.
    pub count: usize,
}

impl ChannelFit {
    /// RMSE in noise standard deviations: about 1 when only noise is left.
    pub fn rmse_over_noise(&self) -> Option<f64> {
        self.noise_sd.map(|sd| self.rmse / sd)
    }
}

/// Compares the channels of role output; inputs among `channels` are left out.
///
/// Samples missing in either recording are skipped.
///
/// ```
/// use smam::recording::{TableSource, Channel, ChannelSpec, Recording, Role, compare};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let recording = |force_n: [f64; 3]| {
///     Recording::new(vec![0.0, 1.0, 2.0], vec![Channel::new("force_n", force_n.to_vec())])
/// };
/// let (measured, simulated) = (recording([1.0, f64::NAN, 5.0])?, recording([2.0, 7.0, 4.0])?);
/// let force = ChannelSpec { column: "force_n".to_owned(), role: Role::Output, noise_sd: Some(0.5), constant: None, bag: None, table: TableSource::default() };
/// let fits = compare(&measured, &simulated, &[force])?;
/// // 1 N off at the two samples that there are: twice the noise.
/// assert_eq!((fits[0].rmse, fits[0].count, fits[0].rmse_over_noise()), (1.0, 2, Some(2.0)));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The sample times differ; an output is missing in either recording.
pub fn compare(
    measured: &Recording,
    simulated: &Recording,
    channels: &[ChannelSpec],
) -> Result<Vec<ChannelFit>, RecordingError> {
    check_same_times(measured.time_s(), simulated.time_s())?;
    channels
        .iter()
        .filter(|spec| spec.role == Role::Output)
        .map(|spec| {
            let was = &measured.channel(&spec.column)?.values;
            let is = &simulated.channel(&spec.column)?.values;
            let noise = spec.noise_sd.or_else(|| noise_sd(measured.time_s(), was));
            Ok(fit(&spec.column, was, is, noise))
        })
        .collect()
}

fn check_same_times(measured_s: &[f64], simulated_s: &[f64]) -> Result<(), RecordingError> {
    let common = measured_s.len().min(simulated_s.len());
    let differs = (0..common).find(|i| measured_s[*i] != simulated_s[*i]);
    match differs {
        Some(index) => Err(RecordingError::TimesDiffer { index }),
        None if measured_s.len() != simulated_s.len() => Err(RecordingError::TimesDiffer { index: common }),
        None => Ok(()),
    }
}

fn fit(column: &str, measured: &[f64], simulated: &[f64], noise_sd: Option<f64>) -> ChannelFit {
    let mut sum_squares = 0.0;
    let mut count = 0;
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    let pairs = measured.iter().zip(simulated);
    for (was, is) in pairs.filter(|(was, is)| !was.is_nan() && !is.is_nan()) {
        sum_squares += (was - is).powi(2);
        count += 1;
        low = low.min(*was);
        high = high.max(*was);
    }
    ChannelFit {
        column: column.to_owned(),
        rmse: (sum_squares / count as f64).sqrt(),
        noise_sd,
        range: if count == 0 { f64::NAN } else { high - low },
        count,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Channel;
    use crate::recording::TableSource;

    fn recording(time_s: &[f64], force_n: &[f64]) -> Recording {
        let force = Channel::new("force_n", force_n.to_vec());
        Recording::new(time_s.to_vec(), vec![force]).unwrap()
    }

    fn force_output() -> Vec<ChannelSpec> {
        vec![ChannelSpec {
            column: "force_n".into(),
            role: Role::Output,
            noise_sd: Some(0.5),
            constant: None,
            bag: None,
            table: TableSource::default(),
        }]
    }

    #[test]
    fn missing_samples_are_skipped() {
        let time_s = [0.0, 1.0, 2.0, 3.0];
        let measured = recording(&time_s, &[1.0, f64::NAN, 5.0, 9.0]);
        let simulated = recording(&time_s, &[2.0, 7.0, 4.0, f64::NAN]);
        let fits = compare(&measured, &simulated, &force_output()).unwrap();
        assert_eq!((fits[0].rmse, fits[0].range, fits[0].count), (1.0, 4.0, 2));
        assert_eq!(fits[0].rmse_over_noise(), Some(2.0));
    }

    #[test]
    fn other_sample_times_are_refused() {
        let measured = recording(&[0.0, 1.0], &[0.0, 0.0]);
        for times in [&[0.0, 1.5][..], &[0.0]] {
            let simulated = recording(times, &vec![0.0; times.len()]);
            let error = compare(&measured, &simulated, &force_output()).unwrap_err();
            assert_eq!(
                error.to_string(),
                "measured and simulated times differ at sample 1\n  remedy: simulate at the recording's sample times"
            );
        }
    }
}
