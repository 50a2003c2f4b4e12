//! Names of columns, and which of them is the time.

use super::super::TIME_COLUMN;
use super::cell::Cell;
use super::options::FileOptions;
use super::place::Problem;

/// Which columns a reader needs.
#[derive(Clone, Copy, Debug)]
pub(super) enum Needed<'a> {
    /// All: any that cannot be read is an error.
    All,
    /// These, by their names in the file; any other may hold what it likes.
    These(&'a [String]),
}

/// The names of a table's columns.
#[derive(Clone, Debug)]
pub(super) struct Names {
    pub(super) columns: Vec<String>,
    pub(super) is_needed: Vec<bool>,
    /// Index of the time; `None` where rows are counted.
    pub(super) time: Option<usize>,
}

impl Names {
    pub(super) fn of_row(cells: &[Cell<'_>], options: &FileOptions, needed: Needed<'_>) -> Result<Self, Problem> {
        let mut columns: Vec<String> = cells.iter().map(Cell::words).collect();
        if columns.iter().all(|name| name.parse::<f64>().is_ok()) {
            return Err(Problem::new(format!(
                "there are numbers where the names of the columns should be\n  remedy: put a header line above them, such as \
                 {TIME_COLUMN},plunger_mm; or say header = false and names = [\"{TIME_COLUMN}\", \"plunger_mm\"] in recordings.toml"
            )));
        }
        // A delimiter at the end of the line makes a column that is none.
        while columns.last().is_some_and(String::is_empty) {
            columns.pop();
        }
        Self::new(columns, options, needed)
    }

    pub(super) fn new(columns: Vec<String>, options: &FileOptions, needed: Needed<'_>) -> Result<Self, Problem> {
        check_delimiter(&columns)?;
        let time = match options.has_clock() {
            true => Some(position(&columns, options.time_name()).ok_or_else(|| no_time(&columns, options))?),
            false => None,
        };
        let is_needed: Vec<bool> = columns
            .iter()
            .enumerate()
            .map(|(index, name)| match needed {
                _ if Some(index) == time => true,
                Needed::All => true,
                Needed::These(names) => names.contains(name),
            })
            .collect();
        check(&columns, &is_needed)?;
        Ok(Self { columns, is_needed, time })
    }
}

fn position(columns: &[String], name: &str) -> Option<usize> {
    columns.iter().position(|column| column == name)
}

fn check_delimiter(columns: &[String]) -> Result<(), Problem> {
    for (separator, called, word) in [(';', "semicolons", ";"), ('\t', "tabs", "tab")] {
        if columns.len() == 1 && columns[0].contains(separator) {
            return Err(Problem::new(format!(
                "the columns are separated by {called}\n  remedy: say delimiter = \"{word}\" in recordings.toml (`smam import` writes \
                 it), or save the file with commas between the columns and points as decimal marks"
            )));
        }
    }
    Ok(())
}

fn check(columns: &[String], is_needed: &[bool]) -> Result<(), Problem> {
    for (index, name) in columns.iter().enumerate().filter(|(index, _)| is_needed[*index]) {
        if name.is_empty() {
            let number = index + 1;
            return Err(Problem::new(format!(
                "column {number} has no name\n  remedy: name it, or remove it and its comma"
            )));
        }
        if columns[..index].contains(name) {
            return Err(Problem::new(format!(
                "column \"{name}\" occurs twice\n  remedy: rename or remove one; or give the columns names in recordings.toml, by \
                 header = false, skip_rows and names (`smam import` writes them)"
            )));
        }
    }
    Ok(())
}

fn no_time(columns: &[String], options: &FileOptions) -> Problem {
    let (name, found) = (options.time_name(), columns.join(", "));
    Problem::new(match options.time_column {
        None => format!(
            "no column \"{name}\" (found: {found})\n  remedy: name the time column \"{name}\" and give it in seconds, or say \
             time_column = \"...\" in recordings.toml (`smam import` writes it); of rows at an even pace, their interval: interval_s = 0.01"
        ),
        Some(_) => format!("no column \"{name}\" (found: {found})\n  remedy: write one of these as time_column"),
    })
}
