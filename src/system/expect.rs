//! Scenes as checks: the figure of each `[[expect]]` and whether it passes.

use crate::recording::{Recording, figures, parse_column, read_recording};
use crate::scene::{ExpectSpec, Measure, Scene};

use super::SystemError;

/// One expectation with its figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    pub name: String,
    /// In the channel's unit.
    pub value: f64,
    pub unit: String,
    /// The bounds in words: `26 .. 29`.
    pub bounds: String,
    pub passed: bool,
    pub source: String,
}

/// Judges a recorded run of a scene by the scene's expectations. A figure that cannot be taken fails.
///
/// ```
/// use smam::scene::Scene;
/// use smam::system::{Schedule, Simulation, judge, record};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let scene = Scene::load("muscle_bench", &[])?;
/// let short = record(&mut Simulation::new(scene.clone())?, &Schedule::even(0.1, 0.05))?;
/// let verdicts = judge(&scene, &short)?;
/// // Expected from 10 s on: what was not played does not pass.
/// assert!(verdicts.len() == scene.file.expect.len() && verdicts.iter().all(|v| !v.passed));
/// # Ok(())
/// # }
/// ```
pub fn judge(scene: &Scene, recording: &Recording) -> Result<Vec<Verdict>, SystemError> {
    scene.file.expect.iter().map(|e| verdict(scene, e, recording)).collect()
}

fn verdict(scene: &Scene, expect: &ExpectSpec, recording: &Recording) -> Result<Verdict, SystemError> {
    let value = figure(scene, expect, recording)?;
    let passed = value.is_finite() && expect.min.is_none_or(|m| value >= m) && expect.max.is_none_or(|m| value <= m);
    let bounds = match (expect.min, expect.max) {
        (Some(a), Some(b)) => format!("{a} .. {b}"),
        (Some(a), None) => format!(">= {a}"),
        (None, Some(b)) => format!("<= {b}"),
        (None, None) => "anything".to_owned(),
    };
    let unit = match expect.measure {
        Measure::RSquared => String::new(),
        _ => parse_column(&expect.channel)?.unit.symbol.to_owned(),
    };
    Ok(Verdict { name: expect.name.clone(), value, unit, bounds, passed, source: expect.source.clone() })
}

fn figure(scene: &Scene, expect: &ExpectSpec, recording: &Recording) -> Result<f64, SystemError> {
    let y = windowed(recording, &expect.channel, expect)?;
    let other = || windowed(recording, expect.against.as_deref().unwrap_or_default(), expect);
    Ok(match expect.measure {
        Measure::Min => figures::least(&y),
        Measure::Max => figures::greatest(&y),
        Measure::Range => figures::range(&y),
        Measure::Final => y.last().copied().unwrap_or(f64::NAN),
        Measure::ValueAt => recording.value_at(&expect.channel, expect.at_s.unwrap_or(0.0))?,
        Measure::LoopWidth => loop_width(&other()?, &y, expect.at.unwrap_or(0.0)),
        Measure::RSquared => figures::line_of_best_fit(&other()?, &y).r_squared,
        Measure::Rmse => rmse_to_file(scene, expect, recording)?,
    })
}

fn windowed(recording: &Recording, channel: &str, expect: &ExpectSpec) -> Result<Vec<f64>, SystemError> {
    let inside = |t: f64| expect.from_s.is_none_or(|f| t >= f - 1e-9) && expect.to_s.is_none_or(|e| t <= e + 1e-9);
    let values = &recording.channel(channel)?.values;
    Ok(recording.time_s().iter().zip(values).filter(|(t, _)| inside(**t)).map(|(_, v)| *v).collect())
}

/// Value on the way down minus value on the way up, where the horizontal channel last passed `at` either way.
fn loop_width(x: &[f64], y: &[f64], at: f64) -> f64 {
    let mut crossings = [f64::NAN; 2];
    for i in 1..x.len().min(y.len()) {
        let (a, b) = (x[i - 1] - at, x[i] - at);
        if (a < 0.0) == (b < 0.0) {
            continue;
        }
        let value = y[i - 1] + (y[i] - y[i - 1]) * a / (a - b);
        crossings[usize::from(a > b)] = value;
    }
    crossings[1] - crossings[0]
}

fn rmse_to_file(scene: &Scene, expect: &ExpectSpec, recording: &Recording) -> Result<f64, SystemError> {
    let Some(file) = &expect.file else { return Ok(f64::NAN) };
    let reference = read_recording(&scene.folder().join(file))?;
    let simulated = recording.channel(&expect.channel)?;
    let Some(line) = crate::recording::PiecewiseLinear::new(recording.time_s(), &simulated.values) else {
        return Ok(f64::NAN);
    };
    let measured = &reference.channel(&expect.channel)?.values;
    let errors: Vec<f64> = reference
        .time_s()
        .iter()
        .zip(measured)
        .filter(|(t, m)| m.is_finite() && **t <= recording.time_s().last().copied().unwrap_or(0.0))
        .map(|(t, m)| (line.value(*t) - m).powi(2))
        .collect();
    Ok(figures::mean(&errors).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loop_width_is_positive_when_unloading_lies_above() {
        let t: Vec<f64> = (0..=200).map(|i| f64::from(i) * 0.01 * std::f64::consts::TAU).collect();
        let x: Vec<f64> = t.iter().map(|t| 1.0 - t.cos()).collect();
        let y: Vec<f64> = t.iter().map(|t| 3.0 * (1.0 - t.cos()) - 0.5 * t.sin()).collect();
        assert!((loop_width(&x, &y, 1.0) - 1.0).abs() < 1e-3);
    }
}
