//! Runs and channels, measured and simulated: what `smam compare` and a diagnosis show of a recording.

use super::axis::three_digits;
use super::colour::MEASURED;
use super::kit::{Choice, Line, TimeSeries};
use super::quantity::with;
use crate::recording::{axis_label, parse_column};

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedRun {
    /// Its name, on its button.
    pub name: String,
    /// Sample times, s.
    pub time_s: Vec<f64>,
    /// Its output channels.
    pub channels: Vec<ComparedChannel>,
}

/// One output channel of a run; all values in the column's own unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedChannel {
    /// Its column, with the unit as suffix.
    pub column: String,
    /// Measured samples, NaN where missing.
    pub measured: Vec<f64>,
    /// Simulated samples at the same times, by each model: name, colour, values.
    pub simulated: Vec<(&'static str, &'static str, Vec<f64>)>,
    /// Standard deviation of the measurement noise; `None`: no band is drawn.
    pub noise_sd: Option<f64>,
}

/// A figure for each run and channel, for the chooser of a page.
pub fn choices(runs: &[ComparedRun]) -> Vec<Choice> {
    let of_run = |run: &ComparedRun| run.channels.iter().map(|channel| choice(run, channel)).collect::<Vec<_>>();
    runs.iter().flat_map(of_run).collect()
}

fn choice(run: &ComparedRun, channel: &ComparedChannel) -> Choice {
    let name = parse_column(&channel.column).ok();
    let line = |label: &str, colour, values: &[f64]| Line { label: label.to_owned(), colour, values: values.to_vec() };
    let models = channel.simulated.iter().map(|(name, colour, values)| line(name, colour, values));
    let series = TimeSeries {
        name: format!("{} {}", run.name, channel.column),
        run: run.name.clone(),
        y_label: axis_label(&channel.column),
        unit: name.map_or_else(String::new, |n| n.unit.symbol.to_owned()),
        time_s: run.time_s.clone(),
        lines: std::iter::once(line("measured", MEASURED, &channel.measured)).chain(models).collect(),
        noise_sd: channel.noise_sd,
    };
    let each = channel.simulated.iter().map(|(name, _, values)| accuracy(channel, name, values));
    Choice {
        run: run.name.clone(),
        channel: channel.column.clone(),
        caption: format!("{}, {}: {}.", run.name, channel.column, each.collect::<Vec<_>>().join("; ")),
        figure: series.into(),
    }
}

/// `simulated: RMSE 0.0312 mm, 0.116 % of the range, 1.56 times the noise (sd 0.0200 mm)`.
fn accuracy(channel: &ComparedChannel, name: &str, values: &[f64]) -> String {
    let symbol = parse_column(&channel.column).map_or("", |name| name.unit.symbol);
    let pairs = channel.measured.iter().zip(values).map(|(was, is)| was - is).filter(|r| r.is_finite());
    let (count, squares) = pairs.fold((0usize, 0.0), |(n, s), r| (n + 1, s + r * r));
    let rmse = (squares / count.max(1) as f64).sqrt();
    let finite = channel.measured.iter().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let mut text = format!("{name}: RMSE {}", with(&three_digits(rmse), symbol));
    if high > low {
        text += &format!(", {} % of the range", three_digits(100.0 * rmse / (high - low)));
    }
    if let Some(sd) = channel.noise_sd {
        text += &format!(", {} times the noise (sd {})", three_digits(rmse / sd), with(&three_digits(sd), symbol));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{BLUE, Figure};

    #[test]
    fn every_run_and_channel_has_its_figure() {
        let time_s: Vec<f64> = (0..50).map(|i| f64::from(i) * 0.1).collect();
        let channel = |column: &str| ComparedChannel {
            column: column.to_owned(),
            measured: time_s.iter().map(|t| t.sin()).collect(),
            simulated: vec![("simulated", BLUE, time_s.iter().map(|t| t.sin() + 0.03).collect())],
            noise_sd: Some(0.02),
        };
        let run = |name: &str, columns: &[&str]| ComparedRun {
            name: name.to_owned(),
            channels: columns.iter().map(|c| channel(c)).collect(),
            time_s: time_s.clone(),
        };
        let all = choices(&[run("sine", &["elongation_mm", "pressure_kpa"]), run("steps", &["elongation_mm"])]);
        assert_eq!(all.len(), 3);
        let caption =
            "sine, elongation_mm: simulated: RMSE 0.0300 mm, 1.50 % of the range, 1.50 times the noise (sd 0.0200 mm).";
        assert_eq!(all[0].caption, caption);
        let Figure::TimeSeries(series) = &all[1].figure else { panic!("{:?}", all[1].figure) };
        assert_eq!((series.y_label.as_str(), series.unit.as_str(), series.lines.len()), ("pressure (kPa)", "kPa", 2));
        assert_eq!(series.run, all[0].run);
    }
}
