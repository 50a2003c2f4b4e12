//! What drives a run: stock programmes or recorded channels.

use crate::recording::PiecewiseLinear;
use crate::scene::Program;

/// One input channel over time, SI.
///
/// ```
/// use smam::recording::PiecewiseLinear;
/// use smam::scene::Scene;
/// use smam::system::{InputSource, Simulation};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut simulation = Simulation::new(Scene::load("muscle_bench", &[])?)?;
/// let ramp_m = PiecewiseLinear::new(&[0.0, 1.0], &[0.0, 1e-3]).ok_or("two samples")?;
/// assert_eq!(InputSource::Recorded(ramp_m.clone()).value(0.5), 0.5e-3);
/// simulation.set_input("plunger_mm", InputSource::Recorded(ramp_m));
/// simulation.advance_to(0.5)?;
/// assert!(simulation.joint_position("slide").is_some_and(|elongation_m| elongation_m > 2e-3));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum InputSource {
    Program(Program),
    /// A recorded channel, straight between its samples.
    Recorded(PiecewiseLinear),
}

impl InputSource {
    /// Value at a time, in the channel's SI unit.
    pub fn value(&self, time_s: f64) -> f64 {
        match self {
            Self::Program(program) => program.value(time_s),
            Self::Recorded(samples) => samples.value(time_s),
        }
    }

    /// Where a recorded channel begins, s.
    pub(crate) fn begins_s(&self) -> Option<f64> {
        self.span_s().map(|(begins_s, _)| begins_s)
    }

    /// Where a recorded channel begins and ends, s.
    pub(crate) fn span_s(&self) -> Option<(f64, f64)> {
        match self {
            Self::Program(_) => None,
            Self::Recorded(samples) => samples.times_s().first().copied().zip(samples.times_s().last().copied()),
        }
    }
}
