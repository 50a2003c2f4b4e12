//! What drives a run: stock programmes or recorded channels.

use crate::recording::PiecewiseLinear;
use crate::scene::Program;

/// One input channel over time, SI.
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
}
