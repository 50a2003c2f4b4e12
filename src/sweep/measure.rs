//! Figures of a run: one number from channels, or from muscles, cables and joints by name.

use crate::recording::{Recording, figures};
use crate::scene::{OutputSpec, Scene};

use super::SweepError;
use super::built_in::{self, hidden_outputs};
use super::probe;

/// What can be asked of a run; the names as they stand in a measure.
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
    SlackTime,
    ClosedTime,
    YieldMargin,
    CavitationMargin,
    Loss,
    StopForce,
    Stiffness,
    Bandwidth,
}

/// What an argument of a figure names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Argument {
    Channel,
    Input,
    Muscle,
    Cable,
    Joint,
    Number,
}

use Argument::{Cable, Channel, Input, Joint, Muscle, Number};

/// Name, figure and arguments; names come before numbers.
pub const FIGURES: [(&str, Figure, &[Argument]); 17] = [
    ("min", Figure::Min, &[Channel]),
    ("max", Figure::Max, &[Channel]),
    ("range", Figure::Range, &[Channel]),
    ("mean", Figure::Mean, &[Channel]),
    ("final", Figure::Final, &[Channel]),
    ("rms", Figure::Rms, &[Channel]),
    ("loop_width", Figure::LoopWidth, &[Channel, Channel]),
    ("loop_area", Figure::LoopArea, &[Channel, Channel]),
    ("time_below", Figure::TimeBelow, &[Channel, Number]),
    ("slack_time", Figure::SlackTime, &[Cable]),
    ("closed_time", Figure::ClosedTime, &[Muscle]),
    ("yield_margin", Figure::YieldMargin, &[Muscle]),
    ("cavitation_margin", Figure::CavitationMargin, &[Muscle]),
    ("loss", Figure::Loss, &[Muscle]),
    ("stop_force", Figure::StopForce, &[Joint, Number]),
    ("stiffness", Figure::Stiffness, &[Channel, Number, Number]),
    ("bandwidth", Figure::Bandwidth, &[Input, Channel, Number, Number]),
];

/// One figure with its arguments.
#[derive(Clone, Debug, PartialEq)]
pub struct Call {
    pub figure: Figure,
    /// Channels, muscles, cables, joints.
    pub names: Vec<String>,
    pub numbers: Vec<f64>,
}

/// A run that is over.
#[derive(Clone, Copy, Debug)]
pub struct Ran<'a> {
    pub scene: &'a Scene,
    pub recording: &'a Recording,
}

impl Call {
    /// Outputs that the figure needs besides those of the scene.
    pub fn outputs(&self) -> Vec<OutputSpec> {
        self.names.first().map_or(Vec::new(), |name| hidden_outputs(self.figure, name))
    }

    /// The figure of a run: of channels in their own units, of anything else in SI; NaN where there is none.
    ///
    /// # Errors
    /// Channels that the run does not have; a probe that diverges.
    pub fn value(&self, ran: Ran) -> Result<f64, SweepError> {
        let name = |i: usize| self.names.get(i).map_or("", String::as_str);
        let number = |i: usize| self.numbers.get(i).copied().unwrap_or(f64::NAN);
        let series = |i: usize| -> Result<&[f64], SweepError> { Ok(&ran.recording.channel(name(i))?.values) };
        Ok(match self.figure {
            Figure::Min => figures::least(series(0)?),
            Figure::Max => figures::greatest(series(0)?),
            Figure::Range => figures::range(series(0)?),
            Figure::Mean => figures::mean(series(0)?),
            Figure::Final => series(0)?.last().copied().unwrap_or(f64::NAN),
            Figure::Rms => figures::rms(series(0)?),
            Figure::LoopArea => figures::enclosed(series(0)?, series(1)?).abs(),
            Figure::LoopWidth => figures::enclosed(series(0)?, series(1)?).abs() / figures::range(series(0)?),
            Figure::TimeBelow => time_below(ran.recording.time_s(), series(0)?, number(0)),
            Figure::SlackTime => built_in::slack_time_s(ran, name(0))?,
            Figure::ClosedTime => built_in::closed_time_s(ran, name(0))?,
            Figure::YieldMargin => built_in::yield_margin_ratio(ran, name(0))?,
            Figure::CavitationMargin => built_in::cavitation_margin_pa(ran, name(0))?,
            Figure::Loss => built_in::loss_j(ran, name(0))?,
            Figure::StopForce => built_in::stop_force_n(ran, name(0), number(0))?,
            Figure::Stiffness => probe::stiffness(ran.scene, name(0), number(0), number(1))?,
            Figure::Bandwidth => {
                let sine = probe::Sine { input: name(0), channel: name(1), amplitude: number(0), plunger_m: number(1) };
                probe::bandwidth_hz(ran.scene, sine)?
            }
        })
    }
}

/// Time that a series spends at or below a level, s: intervals of which both ends are.
pub(super) fn time_below(time_s: &[f64], y: &[f64], level: f64) -> f64 {
    let spans = time_s.windows(2).zip(y.windows(2));
    spans.filter(|(_, y)| y[0] <= level && y[1] <= level).map(|(t, _)| t[1] - t[0]).fold(0.0, |all, span| all + span)
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
        let names = channels.iter().map(|c| (*c).to_owned()).collect();
        let scene = Scene::load("muscle_bench", &[]).expect("a stock scene");
        let ran = Ran { scene: &scene, recording: &run() };
        Call { figure, names, numbers: numbers.to_vec() }.value(ran).expect("there")
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
