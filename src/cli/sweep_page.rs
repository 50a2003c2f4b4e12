//! The page of a sweep: each measure over the first key, what it depends on, and the best points.

use std::path::{Component, Path, PathBuf};

use smam::report::{HtmlPage, figure_svg};
use smam::sweep::{Goal, MeasureSpec, Plan, SamplingSpec, Sensitivity, Table, best, sensitivity};

use super::CliError;
use super::files::Together;
use super::sweep_exploration::exploration;
use super::sweep_panels::{bars, broken, front_panel, panels, scale_of, short};
use super::sweep_trouble::{is_sound, said_of_trouble};

const SIZE: (f64, f64) = (860.0, 260.0);
/// Rows of the table of the best; `best.csv` has them all.
const BEST_SHOWN: usize = 20;

/// Writes `sweep.html` and, for use elsewhere, its figures.
pub fn write_page(plan: &Plan, table: &Table, folder: &Path) -> Result<(), CliError> {
    let file = &plan.file;
    let keys: Vec<String> = file.vary.iter().map(|v| v.key.clone()).collect();
    let what = what(plan);
    let mut page = HtmlPage::new(if file.title.is_empty() { &what } else { &file.title });
    if !file.title.is_empty() {
        page.paragraph(&what);
    }
    let failed = table.failed().count();
    page.paragraph(&format!(
        "{} of {} points of the scene {}, {failed} of them failed. Varied: {}.",
        table.rows.len(),
        table.points,
        plain(&file.scene),
        keys.join(", ")
    ));
    if let Some(words) = said_of_trouble(plan, table) {
        page.paragraph(&format!("{words}."));
    }
    let best = best(plan, table);
    if !file.objective.is_empty() {
        best_points(&mut page, plan, table, &best);
    }
    let mut files = Together::default();
    if let Some(panel) = front_panel(plan, table, &best) {
        files.text(&folder.join("front.svg"), &figure_svg(&[panel], SIZE.0, SIZE.1 + 100.0))?;
    }
    if let Some(found) = sensitivity(plan, table) {
        influences(&mut page, plan, &found);
    }
    let panels = panels(plan, table, &best);
    if is_grid_of_lines(plan) {
        page.heading("Measures over the first key");
        page.panels(&panels, "A gap is a point that failed.");
    }
    page.heading("Explore the points");
    let caption = match best.is_empty() {
        true => "",
        false => "Best (★): within the limits, and beaten by no other in all objectives.",
    };
    page.figure(exploration(plan, table, &best), caption);
    page.heading("Extremes");
    page.table(&["measure", "least", "at", "greatest", "at"], &extremes(plan, table));
    files.text(&folder.join("sweep.svg"), &figure_svg(&panels, SIZE.0, SIZE.1))?;
    files.page(folder, "sweep.html", &page)?;
    files.place()
}

/// Whether lines over the first key show the whole sweep.
fn is_grid_of_lines(plan: &Plan) -> bool {
    plan.file.sampling == SamplingSpec::Grid && plan.file.vary.len() <= 2
}

/// What was measured and what was varied: `range_mm, peak_kpa of muscle_bench over bore_m`.
fn what(plan: &Plan) -> String {
    let file = &plan.file;
    let scene =
        Path::new(&file.scene).file_stem().map_or_else(|| file.scene.clone(), |s| s.to_string_lossy().into_owned());
    let measures: Vec<&str> = file.measure.iter().map(|m| m.name.as_str()).collect();
    let keys: Vec<&str> = file.vary.iter().map(|v| short(&v.key)).collect();
    format!("{} of {scene} over {}", measures.join(", "), keys.join(", "))
}

/// A number to five digits.
fn digits(value: f64) -> String {
    let power = value.abs().log10().floor();
    match value {
        0.0 => "0".to_owned(),
        _ if !value.is_finite() => "-".to_owned(),
        _ if !(-4.0..9.0).contains(&power) => format!("{value:.4e}"),
        _ => format!("{value:.*}", (4.0 - power).max(0.0) as usize),
    }
}

/// A path without `.` and the `..` that can be resolved in it.
pub fn plain(path: &str) -> String {
    let mut shown = PathBuf::new();
    for part in Path::new(path).components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir if matches!(shown.components().next_back(), Some(Component::Normal(_))) => {
                shown.pop();
            }
            other => shown.push(other),
        }
    }
    shown.display().to_string()
}

fn best_points(page: &mut HtmlPage, plan: &Plan, table: &Table, best: &[usize]) {
    let file = &plan.file;
    page.heading("Best under these limits");
    let goal = |goal: Goal| if goal == Goal::Maximise { "greatest" } else { "least" };
    let goals: Vec<String> = file.objective.iter().map(|o| format!("{} {}", goal(o.goal), o.measure)).collect();
    let limits: Vec<String> = file.limit.iter().map(broken).collect();
    let refused = if limits.is_empty() { String::new() } else { format!("; refused: {}", limits.join(", ")) };
    let found = match best {
        [] => "No point keeps the limits.".to_owned(),
        [one] => format!("Point {}: {}.", table.rows[*one].index, at(plan, table, *one)),
        many => format!("{} points that no other beats in all of this.", many.len()),
    };
    page.paragraph(&format!("Wanted: {}{refused}. {found}", goals.join(", ")));
    let header: Vec<&str> = table.columns.iter().map(|c| short(c)).collect();
    let every = best.len().div_ceil(BEST_SHOWN).max(1);
    let row = |i: &usize| {
        let row = &table.rows[*i];
        std::iter::once(row.index.to_string()).chain(row.numbers(plan.measures.len()).map(digits)).collect()
    };
    let rows: Vec<Vec<String>> = best.iter().step_by(every).map(row).collect();
    page.table(&header, &rows);
}

fn influences(page: &mut HtmlPage, plan: &Plan, found: &Sensitivity) {
    page.heading("What the measures depend on");
    for panel in bars(plan, found) {
        page.bars(&panel, "Lines: 95 % of 500 bootstrap rounds.");
    }
    let names: Vec<&str> = found.names.iter().flat_map(|name| [*name, "95 %"]).collect();
    let header = [&["measure", "key", "samples"][..], &names].concat();
    let row = |i: &smam::sweep::Influence| {
        let numbers =
            i.numbers.iter().flat_map(|n| [format!("{:.4}", n.value), format!("{:.4} to {:.4}", n.low, n.high)]);
        [i.measure.clone(), i.key.clone(), i.samples.to_string()].into_iter().chain(numbers).collect()
    };
    page.table(&header, &found.influences.iter().map(row).collect::<Vec<_>>());
}

/// Values of the keys at a row, in words.
fn at(plan: &Plan, table: &Table, row: usize) -> String {
    let keys = plan.file.vary.iter().zip(&table.rows[row].values);
    let words = keys.map(|(v, value)| {
        let scale = scale_of(&v.key, &table.column(&v.key).unwrap_or_default());
        format!("{} = {}", short(&v.key), scale.short(*value))
    });
    words.collect::<Vec<_>>().join(", ")
}

fn extremes(plan: &Plan, table: &Table) -> Vec<Vec<String>> {
    let row = |m: &MeasureSpec| {
        let values = table.column(&m.name).unwrap_or_default();
        let is_sound = |i: usize| is_sound(plan, &table.rows[i]);
        // Where no point is sound those that are not are all that there is.
        let any = (0..values.len()).any(|i| values[i].is_finite() && is_sound(i));
        let there = || values.iter().enumerate().filter(|(i, v)| v.is_finite() && (!any || is_sound(*i)));
        let least = there().min_by(|a, b| a.1.total_cmp(b.1));
        let greatest = there().max_by(|a, b| a.1.total_cmp(b.1));
        let at_row = |found: Option<(usize, &f64)>| match found {
            Some((row, value)) => [digits(*value), at(plan, table, row)],
            None => ["-".to_owned(), "-".to_owned()],
        };
        let cells = match (least, greatest) {
            (Some((_, low)), Some((_, high))) if high - low <= 1e-9 * high.abs().max(low.abs()) && values.len() > 1 => {
                let same = digits(*low);
                [same.clone(), "does not change".to_owned(), same, "does not change".to_owned()].to_vec()
            }
            _ => [at_row(least), at_row(greatest)].concat(),
        };
        [vec![m.name.clone()], cells].concat()
    };
    plan.file.measure.iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_digits_are_shown_of_any_number() {
        let shown = [0.0038962976, -140.83847, 2750194.0, 8e-15, -0.0, f64::NAN].map(digits);
        assert_eq!(shown, ["0.0038963", "-140.84", "2750194", "8.0000e-15", "0", "-"]);
    }

    #[test]
    fn paths_are_shown_plain() {
        assert_eq!(plain("scenes/sweeps/../pulley.toml"), "scenes/pulley.toml");
        assert_eq!(plain("../x/./a.toml"), "../x/a.toml");
        assert_eq!(plain("../../a.toml"), "../../a.toml");
    }
}
