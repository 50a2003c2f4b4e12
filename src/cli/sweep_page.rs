//! The page of a sweep: each measure over the first key, one line for each value of the second.

use std::path::Path;

use smam::report::{BLUE, GREEN, HtmlPage, ORANGE, PURPLE, Panel, Series, VERMILION, figure_svg};
use smam::sweep::{Mark, Plan, SamplingSpec, Table};

use super::CliError;
use super::files::write;

const SIZE: (f64, f64) = (720.0, 260.0);
/// Lines of one panel; more values of a second key are thinned to so many.
const COLOURS: [&str; 6] = [BLUE, ORANGE, GREEN, PURPLE, VERMILION, "#404040"];

/// Writes `sweep.html` and, for use elsewhere, `sweep.svg`.
pub fn write_page(plan: &Plan, table: &Table, folder: &Path) -> Result<(), CliError> {
    let svg = figure_svg(&panels(plan, table), SIZE.0, SIZE.1);
    let file = &plan.file;
    let mut page = HtmlPage::new(if file.title.is_empty() { &file.name } else { &file.title });
    let keys: Vec<String> = file.vary.iter().map(|v| v.key.clone()).collect();
    let failed = table.failed().count();
    page.paragraph(&format!(
        "{} of {} points of the scene {}, {failed} of them failed. Varied: {}.",
        table.rows.len(),
        table.points,
        file.scene,
        keys.join(", ")
    ));
    page.figure(&svg, "Each measure over the first key. A gap is a point that failed.");
    page.heading("Extremes");
    page.table(&["measure", "least", "at", "greatest", "at"], &extremes(plan, table));
    write(&folder.join("sweep.svg"), &svg)?;
    write(&folder.join("sweep.html"), &page.finish())
}

fn panels(plan: &Plan, table: &Table) -> Vec<Panel> {
    let Some(first) = plan.file.vary.first() else { return Vec::new() };
    let x = table.column(&first.key).unwrap_or_default();
    let panel = |m: &smam::sweep::MeasureSpec| {
        let y = table.column(&m.name).unwrap_or_default();
        Panel {
            title: vec![m.name.clone(), m.of.clone()],
            x_label: first.key.clone(),
            y_label: m.name.clone(),
            behind: first.mark.iter().map(|mark| upright(mark, &y)).collect(),
            series: lines(plan, table, &x, &y),
            ..Panel::default()
        }
    };
    plan.file.measure.iter().map(panel).collect()
}

/// Lines over the first key of a grid, one for each value of the second; crosses for samples.
fn lines(plan: &Plan, table: &Table, x: &[f64], y: &[f64]) -> Vec<Series> {
    if plan.file.sampling != SamplingSpec::Grid || plan.file.vary.len() > 2 {
        return vec![crosses(x, y)];
    }
    let Some(second) = plan.file.vary.get(1) else { return vec![line(String::new(), BLUE, x.to_vec(), y.to_vec())] };
    let of_second = table.column(&second.key).unwrap_or_default();
    let mut values = of_second.clone();
    values.sort_by(f64::total_cmp);
    values.dedup();
    let every = values.len().div_ceil(COLOURS.len()).max(1);
    let shown = values.into_iter().step_by(every).zip(COLOURS);
    shown
        .map(|(value, colour)| {
            let own: Vec<usize> = (0..x.len()).filter(|i| of_second[*i] == value).collect();
            let pick = |from: &[f64]| own.iter().map(|&i| from[i]).collect();
            line(format!("{} = {value:.4}", short(&second.key)), colour, pick(x), pick(y))
        })
        .collect()
}

/// A marked value as an upright line over what a measure reaches.
fn upright(mark: &Mark, y: &[f64]) -> Series {
    let finite = || y.iter().copied().filter(|v| v.is_finite());
    let (low, high) = (finite().fold(f64::MAX, f64::min), finite().fold(f64::MIN, f64::max));
    line(mark.label.clone(), "#bdbdbd", vec![mark.at; 2], vec![low, high])
}

/// Last words of a key.
fn short(key: &str) -> &str {
    key.rsplit('.').next().unwrap_or(key)
}

fn line(label: String, colour: &'static str, x: Vec<f64>, y: Vec<f64>) -> Series {
    Series { label, colour, x, y }
}

/// A small cross at every point.
fn crosses(x: &[f64], y: &[f64]) -> Series {
    let reach = |v: &[f64]| {
        let finite = || v.iter().copied().filter(|v| v.is_finite());
        (finite().fold(f64::MIN, f64::max) - finite().fold(f64::MAX, f64::min)).max(f64::MIN_POSITIVE)
    };
    let (dx, dy) = (0.004 * reach(x), 0.012 * reach(y));
    let (mut along, mut up) = (Vec::new(), Vec::new());
    for (x, y) in x.iter().zip(y).filter(|(_, y)| y.is_finite()) {
        along.extend([x - dx, x + dx, f64::NAN, *x, *x, f64::NAN]);
        up.extend([*y, *y, f64::NAN, y - dy, y + dy, f64::NAN]);
    }
    line(String::new(), BLUE, along, up)
}

fn extremes(plan: &Plan, table: &Table) -> Vec<Vec<String>> {
    let at = |row: usize| {
        let keys = plan.file.vary.iter().zip(&table.rows[row].values);
        keys.map(|(v, value)| format!("{} {value:.4}", short(&v.key))).collect::<Vec<_>>().join(", ")
    };
    let row = |m: &smam::sweep::MeasureSpec| {
        let values = table.column(&m.name).unwrap_or_default();
        let there = || values.iter().enumerate().filter(|(_, v)| v.is_finite());
        let least = there().min_by(|a, b| a.1.total_cmp(b.1));
        let greatest = there().max_by(|a, b| a.1.total_cmp(b.1));
        let words = |found: Option<(usize, &f64)>| match found {
            Some((row, value)) => [format!("{value:.4}"), at(row)],
            None => ["-".to_owned(), "-".to_owned()],
        };
        [vec![m.name.clone()], words(least).to_vec(), words(greatest).to_vec()].concat()
    };
    plan.file.measure.iter().map(row).collect()
}
