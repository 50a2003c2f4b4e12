//! Figures of a run: one number from one or two channels.

use crate::recording::Recording;

use super::SweepError;

/// What can be asked of channels; the names as they stand in a measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Figure {
    Min,
    Max,
    Range,
    Mean,
    Final,
    Rms,
    /// Mean distance of the two ways of a loop: the area it encloses over the range of the first channel.
    LoopWidth,
    /// Area that the second channel encloses over the first, per closed loop of the whole run.
    LoopArea,
    /// Time during which a channel is at or below a level.
    TimeBelow,
}

/// Name, figure, number of channels, number of numbers after them.
pub const FIGURES: [(&str, Figure, usize, usize); 9] = [
    ("min", Figure::Min, 1, 0),
    ("max", Figure::Max, 1, 0),
    ("range", Figure::Range, 1, 0),
    ("mean", Figure::Mean, 1, 0),
    ("final", Figure::Final, 1, 0),
    ("rms", Figure::Rms, 1, 0),
    ("loop_width", Figure::LoopWidth, 2, 0),
    ("loop_area", Figure::LoopArea, 2, 0),
    ("time_below", Figure::TimeBelow, 1, 1),
];

/// One figure of named channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    pub figure: Figure,
    pub channels: Vec<String>,
    pub numbers: Vec<f64>,
}

impl Call {
    /// The figure of a run, in the channels' own units; NaN where there are no samples.
    ///
    /// # Errors
    /// Channels that the run does not have.
    pub fn value(&self, run: &Recording) -> Result<f64, SweepError> {
        let mut series = Vec::new();
        for name in &self.channels {
            series.push(run.channel(name)?.values.as_slice());
        }
        let y = series[series.len() - 1];
        let count = y.len() as f64;
        let least = || y.iter().copied().reduce(f64::min).unwrap_or(f64::NAN);
        let greatest = || y.iter().copied().reduce(f64::max).unwrap_or(f64::NAN);
        Ok(match self.figure {
            Figure::Min => least(),
            Figure::Max => greatest(),
            Figure::Range => greatest() - least(),
            Figure::Mean => y.iter().sum::<f64>() / count,
            Figure::Final => y.last().copied().unwrap_or(f64::NAN),
            Figure::Rms => (y.iter().map(|v| v * v).sum::<f64>() / count).sqrt(),
            Figure::LoopArea => enclosed(series[0], y).abs(),
            Figure::LoopWidth => {
                let x = series[0];
                let reach = x.iter().copied().fold(f64::MIN, f64::max) - x.iter().copied().fold(f64::MAX, f64::min);
                enclosed(x, y).abs() / reach
            }
            Figure::TimeBelow => time_below(run.time_s(), y, self.numbers[0]),
        })
    }
}

/// Area enclosed by a path that is closed by a straight line (trapezoids).
fn enclosed(x: &[f64], y: &[f64]) -> f64 {
    let pairs: Vec<(f64, f64)> = x.iter().copied().zip(y.iter().copied()).collect();
    let next = pairs.iter().cycle().skip(1);
    pairs.iter().zip(next).map(|(a, b)| 0.5 * (b.0 - a.0) * (a.1 + b.1)).sum()
}

fn time_below(time_s: &[f64], y: &[f64], level: f64) -> f64 {
    let spans = time_s.windows(2).zip(y.windows(2));
    spans.filter(|(_, y)| y[0] <= level && y[1] <= level).map(|(t, _)| t[1] - t[0]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Channel;

    fn run() -> Recording {
        let t: Vec<f64> = (0..=400).map(|i| f64::from(i) * 0.01).collect();
        let angle = |t: f64| std::f64::consts::TAU * t / 4.0;
        let x = t.iter().map(|t| angle(*t).cos()).collect();
        let y = t.iter().map(|t| 2.0 * angle(*t).sin()).collect();
        Recording::new(t, vec![Channel::new("x_mm", x), Channel::new("y_n", y)]).expect("a recording")
    }

    fn call(figure: Figure, channels: &[&str], numbers: &[f64]) -> f64 {
        let channels = channels.iter().map(|c| (*c).to_owned()).collect();
        Call { figure, channels, numbers: numbers.to_vec() }.value(&run()).expect("there")
    }

    #[test]
    fn figures_of_an_ellipse() {
        let pi = std::f64::consts::PI;
        assert!((call(Figure::LoopArea, &["x_mm", "y_n"], &[]) - 2.0 * pi).abs() < 1e-3);
        assert!((call(Figure::LoopWidth, &["x_mm", "y_n"], &[]) - pi).abs() < 1e-3);
        assert!((call(Figure::Range, &["y_n"], &[]) - 4.0).abs() < 1e-6);
        assert!((call(Figure::Rms, &["y_n"], &[]) - 2.0f64.sqrt()).abs() < 1e-2);
        assert!((call(Figure::TimeBelow, &["y_n"], &[0.0]) - 2.0).abs() < 0.02);
        assert!(call(Figure::Mean, &["y_n"], &[]).abs() < 1e-9);
    }
}
