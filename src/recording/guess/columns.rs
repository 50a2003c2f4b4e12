//! Time, units and channels of a table that was taken apart.

use std::path::Path;

use super::super::survey::median;
use super::super::table::{
    FileOptions, Label, READ_STAMPS, cell_number, clock_faults, file_unit, is_formula, is_like_a_stamp, is_stamp,
    is_unread, label, unread_unit,
};
use super::super::{TIME_COLUMN, parse_column};
use super::footer;
use super::layout::Layout;
use super::likeness::{is_time, likeness};
use super::{Guess, GuessedColumn, Said, Sureness, Wanted};

/// A median interval of so many seconds is none of a moving muscle: rather milliseconds, s.
const SLOW_S: f64 = 2.0;
/// A clock runs for so many rows between two restarts, in the mean.
const FEWEST_ROWS: usize = 10;
/// One of so many milliseconds rather counts microseconds.
const SLOW_MS: f64 = 2000.0;

pub(super) fn guessed(file: &Path, mut layout: Layout, wanted: &[Wanted]) -> Guess {
    let labels: Vec<Label> =
        layout.names.iter().enumerate().map(|(at, name)| labelled(name, layout.units.get(at))).collect();
    footer::leave_out(file, &mut layout, |layout| time_column(layout, &labels).map(|(at, _)| at));
    let time = time_column(&layout, &labels)
        .filter(|(at, sureness)| is_clock(file, &mut layout, *at, &labels[*at], *sureness));
    let others = (0..layout.names.len()).filter(|at| time.is_none_or(|(time, _)| time != *at));
    let mut columns: Vec<GuessedColumn> = others
        .filter(|at| !layout.names[*at].is_empty())
        .map(|at| GuessedColumn {
            name: layout.names[at].clone(),
            unit: labels[at].unit,
            unread_unit: unread(&layout.names[at], layout.units.get(at)).filter(|_| labels[at].unit.is_none()),
            channel: None,
            is_text: !layout
                .rows
                .iter()
                .any(|row| row.get(at).is_some_and(|c| is_formula(c) || is_finite(c, &layout.options))),
            greatest: numbers(&layout, at).into_iter().filter(|v| v.is_finite()).map(f64::abs).reduce(f64::max),
        })
        .collect();
    assign(&mut columns, wanted);
    if time.is_none() {
        let what = "no column of times: interval_s in recordings.toml takes rows at an even pace".to_owned();
        layout.said.push(Said { what, sureness: Sureness::Likely });
        layout.said.extend(unread_stamps(&layout));
    }
    Guess {
        file: file.to_owned(),
        time: time.map(|(at, _)| layout.names[at].clone()),
        columns,
        first_rows: std::iter::once(layout.names).chain(layout.rows.into_iter().take(3)).collect(),
        options: layout.options,
        said: layout.said,
    }
}

fn is_finite(cell: &str, options: &FileOptions) -> bool {
    cell_number(cell, options).is_some_and(f64::is_finite)
}

/// A column of dates or times of day in a form that is not read, and which is.
fn unread_stamps(layout: &Layout) -> Option<Said> {
    let first = layout.rows.first()?;
    let at = first.iter().position(|cell| is_like_a_stamp(cell) && !is_stamp(cell))?;
    let name = layout.names.get(at)?;
    let what = format!("\"{name}\" holds \"{}\": {READ_STAMPS}", first[at]);
    Some(Said { what, sureness: Sureness::Sure })
}

/// A header's label, with the unit of the row below where it states none.
fn labelled(name: &str, unit: Option<&String>) -> Label {
    let own = label(name);
    let below = unit.and_then(|text| file_unit(text.trim_matches(['[', ']', '(', ')'])));
    Label { unit: own.unit.or(below), ..own }
}

/// A text in the place of a unit that is none, in the name or in the row of units.
fn unread(name: &str, below: Option<&String>) -> Option<String> {
    let below = below.map(|text| text.trim_matches(['[', ']', '(', ')']).trim()).filter(|text| is_unread(text));
    unread_unit(name).or(below).map(str::to_owned)
}

/// A column called as the time is, else one in a unit of time, else the first if it rises throughout.
fn time_column(layout: &Layout, labels: &[Label]) -> Option<(usize, Sureness)> {
    let named = |at: &usize| {
        layout.names[*at] == TIME_COLUMN || layout.options.time_column.as_ref() == Some(&layout.names[*at])
    };
    let all = || 0..labels.len();
    if let Some(at) = all().find(named) {
        return Some((at, Sureness::Sure));
    }
    let is_second = |at: usize| labels[at].unit.is_some_and(|unit| unit.si_suffix == "s");
    let called = all().filter(|at| is_time(&labels[*at].quantity) || is_second(*at));
    let numbers = |at: &usize| {
        layout.rows.first().is_some_and(|row| row.get(*at).is_some_and(|c| cell_number(c, &layout.options).is_some()))
    };
    let stamps = |at: &usize| layout.rows.first().is_some_and(|row| row.get(*at).is_some_and(|c| is_stamp(c)));
    // A count of seconds before a stamp: it has more digits.
    let called: Vec<usize> = called.collect();
    if let Some(at) = called.iter().find(|at| numbers(at)).or_else(|| called.iter().find(|at| stamps(at))) {
        return Some((*at, Sureness::Sure));
    }
    if let Some(at) = all().find(stamps) {
        return Some((at, Sureness::Likely));
    }
    // What is measured in millimetres is no time, however it rises.
    (labels.first()?.unit.is_none() && rises(layout, 0)).then_some((0, Sureness::Assumed))
}

/// The numbers of a column in the rows that were looked at.
fn numbers(layout: &Layout, at: usize) -> Vec<f64> {
    layout.rows.iter().filter_map(|row| cell_number(row.get(at)?, &layout.options)).collect()
}

fn rises(layout: &Layout, at: usize) -> bool {
    let times = numbers(layout, at);
    times.len() > 2 && times.windows(2).all(|w| w[1] > w[0])
}

/// Declares a column as the time, unless the whole file shows that it is none.
fn is_clock(file: &Path, layout: &mut Layout, at: usize, label: &Label, sureness: Sureness) -> bool {
    let (options, count) = (layout.options.clone(), layout.said.len());
    declare_time(layout, at, label, sureness);
    let refused = repair_clock(file, layout, sureness).err();
    let is_one = refused.is_none();
    if let Some(why) = refused {
        layout.options = options;
        layout.said.truncate(count);
        layout.said.extend(why);
    }
    is_one
}

fn declare_time(layout: &mut Layout, at: usize, label: &Label, sureness: Sureness) {
    let name = layout.names[at].clone();
    let is_stamped = layout.rows.first().is_some_and(|row| row.get(at).is_some_and(|cell| is_stamp(cell)));
    let mut intervals: Vec<f64> = numbers(layout, at).windows(2).map(|w| w[1] - w[0]).filter(|dt| *dt > 0.0).collect();
    let interval = median(&mut intervals).unwrap_or(0.0);
    let stated = layout.options.time_unit.or(label.unit.filter(|unit| unit.si_suffix == "s"));
    // A unit that is stated holds: what reads slow is noted when the file is read.
    let unit = if is_stamped { None } else { stated.or_else(|| file_unit(by_size(interval))) };
    let by = if stated.is_some() { "as its name says" } else { "by the size of its intervals" };
    let what = match unit {
        None => format!("time: \"{name}\", stamps of date or time of day"),
        Some(unit) => format!("time: \"{name}\" in {} ({by})", unit.name),
    };
    let is_guessed = unit.is_some() && stated.is_none();
    layout.said.push(Said { what, sureness: if is_guessed { sureness.min(Sureness::Likely) } else { sureness } });
    if name != TIME_COLUMN {
        layout.options.time_column = Some(name);
    }
    // What the name itself says need not be said again; a row of units is not read for it.
    let says_itself = super::super::table::label(&layout.names[at]).unit.map(|u| u.name);
    layout.options.time_unit = unit.filter(|unit| says_itself.unwrap_or("s") != unit.name);
}

/// The unit that the size of a clock's intervals speaks for.
fn by_size(interval: f64) -> &'static str {
    match interval {
        SLOW_MS.. => "us",
        SLOW_S.. => "ms",
        _ => "s",
    }
}

/// Each channel's likeliest column, the likest pair first.
fn assign(columns: &mut [GuessedColumn], wanted: &[Wanted]) {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (c, column) in columns.iter().enumerate().filter(|(_, column)| !column.is_text) {
        for (w, wanted) in wanted.iter().enumerate() {
            pairs.push((pair(column, wanted), c, w));
        }
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut is_taken = vec![false; wanted.len()];
    for (score, c, w) in pairs {
        let sureness = match score {
            2.0.. => Sureness::Sure,
            0.5.. => Sureness::Likely,
            _ => continue,
        };
        if columns[c].channel.is_none() && !is_taken[w] {
            is_taken[w] = true;
            columns[c].channel = Some((wanted[w].clone(), sureness));
        }
    }
}

/// 2 and more for the same name, 0 where the units exclude it.
fn pair(column: &GuessedColumn, wanted: &Wanted) -> f64 {
    if column.name == wanted.column {
        return 3.0;
    }
    let Ok(name) = parse_column(&wanted.column) else { return 0.0 };
    let likeness = likeness(&label(&column.name).quantity, name.base);
    match column.unit {
        // Volts may be anything, with a factor.
        Some(unit) if unit.si_suffix != name.unit.si_suffix && unit.si_suffix != "v" => 0.0,
        Some(unit) if unit.si_suffix == "v" => 0.9 * likeness,
        Some(_) if likeness >= 1.0 => 2.0,
        Some(_) if likeness > 0.0 => likeness + 0.3,
        Some(_) => 0.2,
        None => likeness,
    }
}

/// Restarts and repeated stamps, over the whole file; an error, with what is to be said of it, for a column that goes back so often, or
/// at all where it was only assumed to be the time, that it is no clock.
fn repair_clock(file: &Path, layout: &mut Layout, sureness: Sureness) -> Result<(), Option<Said>> {
    // What cannot be read at all is said when what was written is read.
    let Ok(faults) = clock_faults(file, &layout.options) else { return Ok(()) };
    let most = if sureness == Sureness::Assumed { 0 } else { faults.rows / FEWEST_ROWS };
    // A clock that stands still is none.
    let is_still = faults.repeats > 0 && faults.repeats + 1 >= faults.rows;
    let backwards = faults.restarts + faults.swaps;
    if backwards > most || is_still {
        let name = layout.options.time_name();
        let what = format!(
            "\"{name}\" goes back {backwards} times in {} rows: sort the rows by time, if it is the time",
            faults.rows
        );
        let is_said = backwards > most && sureness > Sureness::Assumed;
        return Err(is_said.then_some(Said { what, sureness: Sureness::Sure }));
    }
    layout.options.split_at_restart = faults.restarts > 0;
    layout.options.merge_repeated = faults.repeats > 0;
    let words = [
        (faults.swaps, "rows that stand behind later ones: to be sorted by time"),
        (faults.restarts, "a clock that starts anew: split there, each part a start from rest"),
        (faults.repeats, "repeated stamps: the mean of their rows"),
    ];
    let found = words.into_iter().filter(|(count, _)| *count > 0);
    layout.said.extend(found.map(|(_, what)| Said { what: what.to_owned(), sureness: Sureness::Sure }));
    Ok(())
}
