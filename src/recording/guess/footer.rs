//! Rows at the end of a file that are no samples: means, extremes, a closing remark.

use std::path::Path;

use super::super::survey::median;
use super::super::table::{FileOptions, cell_number, is_stamp, last_rows, times};
use super::layout::Layout;
use super::{Said, Sureness};

/// So many rows at the end are looked at; a summary that is longer is none.
const LOOKED_AT: usize = 12;
/// How near to a mean, as a share of all times, the time of a row of means is.
const NEAR: f64 = 1e-3;

/// Words before a row of figures about the rows above it.
const WORDS: [&str; 25] = [
    "mean",
    "average",
    "avg",
    "max",
    "maximum",
    "min",
    "minimum",
    "std",
    "stdev",
    "std dev",
    "sd",
    "sigma",
    "rms",
    "median",
    "sum",
    "total",
    "range",
    "variance",
    "mittelwert",
    "mittel",
    "summe",
    "standardabweichung",
    "spannweite",
    "平均",
    "最大",
];

/// Finds such rows and leaves them out. `time` tells which column is the time.
pub(super) fn leave_out(file: &Path, layout: &mut Layout, time: impl Fn(&Layout) -> Option<usize>) {
    // What cannot be read at all is said when what was written is read.
    let Ok(rows) = last_rows(file, &layout.options, LOOKED_AT + 1) else { return };
    let labelled = trailing(&rows, |row| is_figures(row, &layout.options));
    drop_rows(layout, &rows[rows.len() - labelled..]);
    let time = time(layout);
    let timeless = |row: &[String]| time.is_some_and(|at| !has_time(row, at, &layout.options));
    let count = trailing(&rows, |row| is_figures(row, &layout.options) || timeless(row));
    // The whole file would be a summary: its time is another column.
    let count = if count > LOOKED_AT || count >= rows.len() { labelled } else { count };
    let count = count + unlabelled(file, layout, time, count);
    if count == 0 || count > LOOKED_AT || count >= rows.len() {
        return;
    }
    let left_out = rows[rows.len() - count..].to_vec();
    drop_rows(layout, &left_out);
    layout.options.skip_last_rows = count;
    let first: Vec<&str> =
        left_out.iter().filter_map(|row| row.iter().find(|c| !c.is_empty())).map(String::as_str).collect();
    let what = format!("{count} rows at the end are no samples and are left out: \"{}\"", first.join("\", \""));
    layout.said.push(Said { what, sureness: Sureness::Likely });
}

fn trailing(rows: &[Vec<String>], is_summary: impl Fn(&[String]) -> bool) -> usize {
    rows.iter().rev().take_while(|row| is_summary(row)).count()
}

fn drop_rows(layout: &mut Layout, summary: &[Vec<String>]) {
    layout.rows.retain(|row| !summary.contains(row));
}

/// A row that a word begins, or one without a number.
fn is_figures(row: &[String], options: &FileOptions) -> bool {
    let first = row.iter().find(|cell| !cell.is_empty());
    let word = first.map(|cell| cell.trim_matches([':', '=', '.', ' ', '#']).to_lowercase());
    let has_number = row.iter().any(|cell| cell_number(cell, options).is_some_and(f64::is_finite) || is_stamp(cell));
    !has_number || word.is_some_and(|word| WORDS.contains(&word.as_str()))
}

fn has_time(row: &[String], at: usize, options: &FileOptions) -> bool {
    row.get(at).is_some_and(|cell| is_stamp(cell) || cell_number(cell, options).is_some_and(f64::is_finite))
}

/// Rows of figures that nothing marks but their time: it goes back to a mean or an extreme of the times before.
fn unlabelled(file: &Path, layout: &Layout, time: Option<usize>, labelled: usize) -> usize {
    if time.is_none() {
        return 0;
    }
    let name = time.map(|at| layout.names[at].clone());
    let options = FileOptions { time_column: name, skip_last_rows: labelled, ..layout.options.clone() };
    let Ok(times) = times(file, &options) else { return 0 };
    let from = times.len().saturating_sub(LOOKED_AT).max(1);
    let Some(begin) = (from..times.len()).find(|i| times[*i] <= times[i - 1]) else { return 0 };
    let (before, summary) = times.split_at(begin);
    let figures = figures(before);
    let range = before[before.len() - 1] - before[0];
    let is_one = |time: &f64| figures.iter().any(|figure| (figure - time).abs() <= NEAR * range);
    // A single sample before the clock starts anew is no summary, nor is a file of a few rows.
    if before.len() > LOOKED_AT && summary.iter().all(is_one) { summary.len() } else { 0 }
}

/// Mean, extremes, median and standard deviation.
fn figures(values: &[f64]) -> [f64; 5] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count;
    let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    [mean, low, high, median(&mut values.to_vec()).unwrap_or(mean), variance.sqrt()]
}
