//! Channels over time, measured and simulated, as a page shows them.

use serde::Serialize;

use super::rounding::{nanoseconds, rounded};
use crate::recording::gap_limit_s;

/// Samples of a run that a page holds at most. More are decimated, and the whole goes into a CSV file beside the page.
const MOST: usize = 8000;

/// One line over the times of its figure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    pub label: String,
    /// As SVG or the page's style names it: see [`crate::report::BLUE`] and [`crate::report::MEASURED`].
    #[serde(serialize_with = "super::plot::colour_name")]
    pub colour: &'static str,
    /// NaN where there is none.
    #[serde(serialize_with = "rounded")]
    pub values: Vec<f64>,
}

/// A channel of a run: what was measured, what models make of it, and the residuals of these.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TimeSeries {
    /// Of its CSV file.
    pub name: String,
    /// Figures of one run show the same stretch of time.
    pub run: String,
    /// Text at the y axis, with the unit.
    pub y_label: String,
    pub unit: String,
    #[serde(serialize_with = "nanoseconds")]
    pub time_s: Vec<f64>,
    /// The first is what was measured; residuals are this one less each other.
    pub lines: Vec<Line>,
    /// Standard deviation of the measurement noise: the residuals get a band of twice that.
    pub noise_sd: Option<f64>,
}

impl TimeSeries {
    /// The same with no more samples than a page holds, and those of them before which there is a gap in time.
    pub(super) fn for_page(&self) -> (Self, Vec<usize>) {
        let limit_s = gap_limit_s(&self.time_s);
        let gaps: Vec<usize> =
            (1..self.time_s.len()).filter(|&i| self.time_s[i] - self.time_s[i - 1] > limit_s).collect();
        let kept = self.kept();
        let pick = |from: &[f64]| kept.iter().map(|&i| from[i]).collect::<Vec<f64>>();
        let lines = self.lines.iter().map(|line| Line { values: pick(&line.values), ..line.clone() }).collect();
        let cuts = gaps.iter().map(|gap| kept.partition_point(|i| i < gap)).collect();
        (Self { time_s: pick(&self.time_s), lines, ..self.clone() }, cuts)
    }

    /// Samples to show: of each stretch those at which a line, or a residual, is lowest or highest.
    fn kept(&self) -> Vec<usize> {
        let count = self.time_s.len();
        let mut columns: Vec<Vec<f64>> = self.lines.iter().take(1).map(|line| line.values.clone()).collect();
        columns.extend(self.residuals());
        if count <= MOST || columns.is_empty() {
            return (0..count).collect();
        }
        let stretch = (2 * columns.len() * count).div_ceil(MOST);
        let mut kept = vec![0, count - 1];
        for from in (0..count).step_by(stretch) {
            let own = || from..(from + stretch).min(count);
            for column in &columns {
                let there = || own().filter(|&i| column[i].is_finite());
                kept.extend(there().min_by(|&a, &b| column[a].total_cmp(&column[b])));
                kept.extend(there().max_by(|&a, &b| column[a].total_cmp(&column[b])));
            }
        }
        kept.sort_unstable();
        kept.dedup();
        kept
    }

    /// The first line less each other.
    fn residuals(&self) -> impl Iterator<Item = Vec<f64>> {
        let others = self.lines.iter().skip(1);
        others.map(|line| self.lines[0].values.iter().zip(&line.values).map(|(was, is)| was - is).collect())
    }

    /// All samples, and all of their digits.
    pub(super) fn csv(&self) -> String {
        let labels: Vec<String> = self.lines.iter().map(|line| super::text::csv_cell(&line.label)).collect();
        let mut text = format!("time_s,{}\n", labels.join(","));
        for (i, time_s) in self.time_s.iter().enumerate() {
            text += &time_s.to_string();
            for line in &self.lines {
                text.push(',');
                if line.values[i].is_finite() {
                    text += &line.values[i].to_string();
                }
            }
            text.push('\n');
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(count: usize) -> TimeSeries {
        let time_s: Vec<f64> = (0..count).map(|i| 0.001 * i as f64).collect();
        let line = |label: &str, values| Line { label: label.to_owned(), colour: "measured", values };
        let mut measured: Vec<f64> = time_s.iter().map(|t| t.sin()).collect();
        measured[count / 2] = 9.0;
        let model = time_s.iter().map(|t| t.sin() + 0.1).collect();
        TimeSeries {
            time_s,
            lines: vec![line("measured", measured), line("model, fit", model)],
            ..TimeSeries::default()
        }
    }

    #[test]
    fn long_runs_are_decimated_peaks_and_ends_stay_and_the_csv_is_whole() {
        let long = series(100_000);
        let (shown, _) = long.for_page();
        assert!(shown.time_s.len() <= MOST + 2 && shown.time_s.len() > MOST / 4, "{}", shown.time_s.len());
        assert!(shown.lines[0].values.contains(&9.0));
        assert_eq!([shown.time_s[0], shown.time_s[shown.time_s.len() - 1]], [0.0, 99.999]);
        let csv = long.csv();
        assert_eq!(csv.lines().count(), 100_001);
        assert!(csv.starts_with("time_s,measured,\"model, fit\"\n0,0,0.1\n"), "{}", &csv[..60]);
        assert_eq!(series(5000).for_page().0.time_s.len(), 5000);
    }

    #[test]
    fn gaps_are_marked_even_among_fewer_samples() {
        let mut long = series(20_000);
        long.time_s.iter_mut().skip(12_345).for_each(|t| *t += 5.0);
        let (shown, cuts) = long.for_page();
        let [cut] = cuts[..] else { panic!("{cuts:?}") };
        assert!(shown.time_s[cut] - shown.time_s[cut - 1] > 5.0 && shown.time_s[cut] < 17.5);
    }
}
