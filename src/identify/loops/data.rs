//! What a hysteresis model is identified from: plunger in, elongation out, over time.

use crate::recording::{Channel, PiecewiseLinear, Recording, RecordingError};

use super::LoopError;

/// One recorded run.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopRun {
    /// Its file, for messages.
    pub name: String,
    pub time_s: Vec<f64>,
    /// The input, mm; nothing missing.
    pub input_mm: Vec<f64>,
    /// The output, mm; NaN where missing or not to count.
    pub output_mm: Vec<f64>,
}

impl LoopRun {
    /// The run of two columns of a recording, of any unit of length; the first `skip_s` drive the model but do not count.
    ///
    /// Where the input is missing it goes on as [`Recording::piecewise_si`] says. The model is at rest at the first sample.
    pub fn of(name: &str, recording: &Recording, [input, output]: [&str; 2], skip_s: f64) -> Result<Self, LoopError> {
        let time_s = recording.time_s().to_vec();
        let in_file = |e: RecordingError| e.in_file(name);
        if input == output {
            return Err(LoopError::Same { file: name.to_owned(), column: input.to_owned() });
        }
        for column in [input, output] {
            let unit = recording.channel(column).and_then(Channel::unit).map_err(in_file)?;
            if unit.si_suffix != "m" {
                return Err(LoopError::Unit { file: name.to_owned(), column: column.to_owned() });
            }
        }
        let driven: PiecewiseLinear = recording.piecewise_si(input).map_err(in_file)?;
        let input_mm = time_s.iter().map(|&t| driven.value(t) * 1e3).collect();
        let from_s = time_s.first().copied().unwrap_or(0.0) + skip_s;
        let counted = time_s.iter().zip(recording.si(output).map_err(in_file)?);
        let output_mm = counted.map(|(&t, y)| if t < from_s { f64::NAN } else { y * 1e3 }).collect();
        let run = Self { name: name.to_owned(), time_s, input_mm, output_mm };
        run.check()?;
        Ok(run)
    }

    /// Whether a model can be identified from it.
    ///
    /// # Errors
    /// Columns of different length, too few samples, an input that does not move or is not all there.
    pub fn check(&self) -> Result<(), LoopError> {
        let length = self.time_s.len();
        if [self.input_mm.len(), self.output_mm.len()] != [length; 2] || self.input_mm.iter().any(|x| !x.is_finite()) {
            return Err(LoopError::Ragged { file: self.name.clone() });
        }
        let [least, most] = range(self.input_mm.iter().copied());
        let counted = self.output_mm.iter().filter(|y| y.is_finite()).count();
        if counted < FEWEST_SAMPLES || most <= least {
            return Err(LoopError::TooLittle { file: self.name.clone(), counted, travel_mm: most - least });
        }
        Ok(())
    }
}

/// Fewer samples of an output decide nothing about up to ten parameters.
const FEWEST_SAMPLES: usize = 50;

/// What sizes the searches: ranges of input and output over all runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopScale {
    /// Least and greatest input, mm.
    pub input_mm: [f64; 2],
    /// Range of the output over that of the input.
    pub slope: f64,
}

impl LoopScale {
    pub fn of(runs: &[LoopRun]) -> Self {
        let input_mm = range(runs.iter().flat_map(|r| r.input_mm.iter().copied()));
        let output = range(runs.iter().flat_map(|r| r.output_mm.iter().copied()));
        Self { input_mm, slope: (output[1] - output[0]) / (input_mm[1] - input_mm[0]) }
    }

    /// Range of the input, mm.
    pub fn stroke_mm(&self) -> f64 {
        self.input_mm[1] - self.input_mm[0]
    }

    /// Whether the input stays on the side where it is positive, but for a hundredth of its range (noise around zero).
    pub(crate) fn is_one_sided(&self) -> bool {
        self.input_mm[0] > -0.01 * self.stroke_mm()
    }
}

/// Least and greatest of the finite values.
fn range(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.filter(|v| v.is_finite()).fold([f64::MAX, f64::MIN], |[low, high], v| [low.min(v), high.max(v)])
}
