//! One more run of a concealed case, after those that it has.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::ConcealError;
use super::case::{Truth, record};
use super::programme::{Drive, SAMPLE_S, Wave, programme};
use super::stock::Rig;
use crate::recording::{PiecewiseLinear, Recording};

/// Which of the runs that are added to a case: the first by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Further {
    /// How many were added before.
    pub before: u64,
    /// How long those took, s.
    pub after_s: f64,
}

/// Records a programme that somebody asks for: the plungers' positions in the rig's own columns; with a sensor that the
/// other runs do not have, if one is asked for and the rig can be given it ([`sensor_noise`](super::sensor_noise)).
///
/// # Errors
/// Columns that the rig does not have, a plant that the solver cannot follow.
pub fn record_asked(
    truth: &Truth,
    inputs: &Recording,
    sensor: Option<&str>,
    run: Further,
) -> Result<Recording, ConcealError> {
    let drives = asked_drives(truth.rig, inputs)?;
    let mut random = ChaCha8Rng::seed_from_u64((!truth.seed).wrapping_add(run.before));
    record(truth, &drives, begins_s(truth) + run.after_s, sensor, &mut random)
}

/// What the plungers of a rig are asked to do.
///
/// # Errors
/// Columns that the rig does not have.
pub(super) fn asked_drives(rig: Rig, inputs: &Recording) -> Result<Vec<Drive>, ConcealError> {
    let end_s = inputs.time_s().last().copied().unwrap_or(0.0);
    let count = (end_s / SAMPLE_S).round() as usize + 1;
    let mut drives = Vec::new();
    for column in rig.inputs() {
        let asked = PiecewiseLinear::new(inputs.time_s(), &inputs.si(column)?);
        let asked = asked.ok_or_else(|| ConcealError::Solver(format!("{column}: no position is asked for")))?;
        drives.push(Drive { positions_m: (0..count).map(|k| asked.value(k as f64 * SAMPLE_S)).collect() });
    }
    Ok(drives)
}

/// Records a waveform that is drawn, over so many seconds, with a sensor as [`record_asked`].
///
/// # Errors
/// A plant that the solver cannot follow.
pub fn record_drawn(
    truth: &Truth,
    duration_s: f64,
    sensor: Option<&str>,
    run: Further,
) -> Result<Recording, ConcealError> {
    let mut random = ChaCha8Rng::seed_from_u64((truth.seed ^ 0x5eed).wrapping_add(run.before));
    let waves = [Wave::Sine, Wave::Steps, Wave::Chirp, Wave::Triangle, Wave::Wander];
    let wave = waves[random.random_range(0..waves.len())];
    let drives = programme(truth.rig, wave, duration_s, &mut random);
    record(truth, &drives, begins_s(truth) + run.after_s, sensor, &mut random)
}

/// When the runs of the case have ended, s.
pub(super) fn begins_s(truth: &Truth) -> f64 {
    truth.waves.iter().map(|w| w.duration_s() + SAMPLE_S).sum()
}
