//! What a page's script draws, and how it gets into the page.

use serde::Serialize;

use super::{Exploration, Plot, TimeSeries};

/// The folder beside a page that holds the CSV files of what the page shows in part.
pub const FIGURES: &str = "figures";

/// A figure that a reader can explore.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "type")]
pub enum Figure {
    /// Measured and simulated over time, with residuals.
    TimeSeries(TimeSeries),
    /// Lines that all run to the right.
    Curve(Plot),
    /// Loops and points.
    Scatter(Plot),
    /// A table of points.
    Exploration(Exploration),
}

impl From<Exploration> for Figure {
    fn from(exploration: Exploration) -> Self {
        Self::Exploration(exploration)
    }
}

impl From<TimeSeries> for Figure {
    fn from(series: TimeSeries) -> Self {
        Self::TimeSeries(series)
    }
}

impl From<Plot> for Figure {
    fn from(plot: Plot) -> Self {
        if plot.is_curve() { Self::Curve(plot) } else { Self::Scatter(plot) }
    }
}

/// A figure as it stands in the page's data.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(super) struct Embedded {
    #[serde(flatten)]
    figure: Figure,
    /// Samples of a time series before which there is a gap in time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    cuts: Vec<usize>,
    /// What a download is called.
    file: String,
    /// The file beside the page that holds what was left out here.
    #[serde(skip_serializing_if = "Option::is_none")]
    whole: Option<String>,
}

impl Embedded {
    /// What goes into the page, and the file (its path from the page, and its text) of a figure that is too long for it.
    pub(super) fn of(figure: &Figure, number: usize) -> (Self, Option<(String, String)>) {
        let mut cuts = Vec::new();
        let (shown, is_less, name) = match figure {
            Figure::TimeSeries(series) => {
                let (shown, found) = series.for_page();
                cuts = found;
                let is_less = shown.time_s.len() < series.time_s.len();
                (Figure::TimeSeries(shown), is_less, &series.name)
            }
            Figure::Curve(plot) => {
                let (shown, is_less) = plot.for_page();
                (Figure::Curve(shown), is_less, &plot.title)
            }
            Figure::Scatter(plot) => {
                let (shown, is_less) = plot.for_page();
                (Figure::Scatter(shown), is_less, &plot.title)
            }
            Figure::Exploration(points) => {
                let (shown, is_less) = points.for_page();
                (Figure::Exploration(shown), is_less, &points.name)
            }
        };
        let file = file_name(number, name);
        let path = format!("{FIGURES}/{file}");
        let csv = match figure {
            _ if !is_less => None,
            Figure::TimeSeries(series) => Some(series.csv()),
            Figure::Curve(plot) | Figure::Scatter(plot) => Some(plot.csv()),
            // Its table is a file already.
            Figure::Exploration(points) => {
                return (Self { figure: shown, cuts, file, whole: Some(points.table.clone()) }, None);
            }
        };
        (Self { figure: shown, cuts, file, whole: csv.as_ref().map(|_| path.clone()) }, csv.map(|csv| (path, csv)))
    }
}

/// `3_sine_elongation_mm.csv`: of letters that every file system takes.
fn file_name(number: usize, name: &str) -> String {
    let plain: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).take(60).collect();
    let words: Vec<&str> = plain.split('_').filter(|word| !word.is_empty()).collect();
    format!("{}.csv", [&[(number + 1).to_string().as_str()], words.as_slice()].concat().join("_"))
}

/// Data as a script element takes them: no text in them, whatever a file or a column is called, can end the element.
pub(super) fn as_json(figures: &[Embedded]) -> String {
    // Nothing in a figure can fail to be written: maps with other keys than texts there are none.
    let text = serde_json::to_string(figures).unwrap_or_else(|_| "[]".to_owned());
    let mut safe = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '<' => safe.push_str("\\u003c"),
            '>' => safe.push_str("\\u003e"),
            '&' => safe.push_str("\\u0026"),
            '\u{2028}' => safe.push_str("\\u2028"),
            '\u{2029}' => safe.push_str("\\u2029"),
            other => safe.push(other),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_breaks_out_of_the_data() {
        let evil = "</script><script>alert(1)//\"'&\u{2028}<!--";
        let series = TimeSeries { name: evil.to_owned(), run: evil.to_owned(), ..TimeSeries::default() };
        let (embedded, _) = Embedded::of(&series.into(), 0);
        let text = as_json(&[embedded]);
        assert!(!text.contains(['<', '>', '&', '\u{2028}']), "{text}");
        let read: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(read[0]["run"], evil);
        assert_eq!(read[0]["type"], "TimeSeries");
    }

    #[test]
    fn files_have_plain_names() {
        assert_eq!(file_name(2, "../a b/sine.csv: elongation_mm"), "3_a_b_sine_csv_elongation_mm.csv");
        assert_eq!(file_name(0, "µ"), "1.csv");
    }
}
