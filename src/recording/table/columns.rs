//! Rows to named columns of numbers.

use super::cell::{Cell, number, shown};
use super::clock::Clock;
use super::file_unit::FileUnit;
use super::header::Names;
use super::label::label;
use super::options::{FileOptions, seconds, time_unit};
use super::place::Problem;
use super::stamp::{Moment, stamp};

/// The columns of a table while its rows are read.
pub(super) struct Columns {
    options: FileOptions,
    pub(super) names: Names,
    pub(super) values: Vec<Vec<f64>>,
    /// Whether a column that nobody needs holds texts.
    pub(super) has_texts: Vec<bool>,
    pub(super) clock: Clock,
    /// What is to be said of the file.
    pub(super) notes: Vec<String>,
    time_unit: Option<&'static FileUnit>,
    /// What the first row's stamp was, where times are stamps.
    first: Option<Moment>,
    rows: usize,
}

impl Columns {
    pub(super) fn new(names: Names, options: FileOptions) -> Self {
        let count = names.columns.len();
        let of_header = || names.time.and_then(|at| label(&names.columns[at]).unit).filter(|u| u.si_suffix == "s");
        let time_unit = options.time_unit.or_else(of_header).or(time_unit("s"));
        Self {
            values: vec![Vec::new(); count],
            has_texts: vec![false; count],
            clock: Clock::new(&options),
            notes: Vec::new(),
            time_unit,
            first: None,
            rows: 0,
            names,
            options,
        }
    }

    pub(super) fn push(&mut self, cells: &[Cell<'_>]) -> Result<(), Problem> {
        self.rows += 1;
        if self.rows == 1 && self.options.units_row {
            return Ok(());
        }
        self.check_width(cells)?;
        if self.values.first().is_none_or(Vec::is_empty) && cells.iter().all(is_word) {
            return Err(words_below(cells));
        }
        for index in 0..self.values.len() {
            let cell = cells.get(index).copied().unwrap_or(Cell::Text(""));
            let value = if self.names.time == Some(index) { self.time(cell) } else { self.number(index, cell) };
            self.values[index].push(value.map_err(|text| Problem::in_column(&self.names.columns[index], text))?);
        }
        if self.names.time.is_none() {
            self.clock.tick();
        }
        Ok(())
    }

    /// What the first row's stamp was, where times are stamps.
    pub(super) fn first_moment(&self) -> Option<Moment> {
        self.first
    }

    /// The name of the time.
    pub(super) fn time_name(&self) -> &str {
        self.names.time.map_or("", |at| &self.names.columns[at])
    }

    fn number(&mut self, index: usize, cell: Cell<'_>) -> Result<f64, String> {
        let value = match cell {
            Cell::Number(number) | Cell::Moment(number) => Ok(number),
            Cell::Text(text) => number(text, &self.options),
        };
        if value.is_err() && !self.names.is_needed[index] {
            self.has_texts[index] = true;
            return Ok(f64::NAN);
        }
        value
    }

    fn time(&mut self, cell: Cell<'_>) -> Result<f64, String> {
        let value = match (cell, self.time_unit) {
            (Cell::Moment(at_s), _) => {
                let nanoseconds = (at_s * 1e9) as i128;
                self.since_first(Moment::Local(nanoseconds)).ok_or_else(mixed)?
            }
            (Cell::Number(number), Some(unit)) => seconds(unit, number),
            (Cell::Text(text), Some(unit)) => match stamp(text) {
                Some(moment) => self.since_first(moment).ok_or_else(mixed)?,
                None => seconds(unit, number(text, &self.options).map_err(|said| no_sample(text).unwrap_or(said))?),
            },
            // `time_unit("s")` is one of the table.
            (_, None) => f64::NAN,
        };
        self.clock.push(value)?;
        Ok(value)
    }

    fn since_first(&mut self, moment: Moment) -> Option<f64> {
        moment.seconds_after(*self.first.get_or_insert(moment))
    }

    /// Ragged rows are damaged, unless what is missing or too much says nothing.
    fn check_width(&self, cells: &[Cell<'_>]) -> Result<(), Problem> {
        let names = self.names.columns.len();
        let is_short = (cells.len()..names).any(|index| self.names.is_needed[index]);
        let is_long = cells.iter().skip(names).any(|cell| !cell.is_empty());
        if !is_short && !is_long {
            return Ok(());
        }
        let count = cells.len();
        Err(Problem::new(format!(
            "{count} cells where the header names {names} columns\n  remedy: fill up the row, leaving missing cells empty between \
             commas, and write decimals with a point"
        )))
    }
}

/// What is said of a word in the place of a time: a row of means, a closing remark.
fn no_sample(text: &str) -> Option<String> {
    text.trim().starts_with(char::is_alphabetic).then(|| {
        format!(
            "{} is not a finite number\n  remedy: give every row its time; if the rows at the end are no samples, say skip_last_rows = 1 \
             in recordings.toml (`smam import` counts them)",
            shown(text)
        )
    })
}

fn mixed() -> String {
    "is a stamp of another kind than the first row's\n  remedy: write all with a zone or all without".to_owned()
}

/// Neither a number nor missing: a unit, say.
fn is_word(cell: &Cell<'_>) -> bool {
    match cell {
        Cell::Text(text) => {
            text.starts_with(|c: char| c.is_alphabetic() || "[(%°".contains(c)) && text.parse::<f64>().is_err()
        }
        _ => false,
    }
}

fn words_below(cells: &[Cell<'_>]) -> Problem {
    let words: Vec<String> = cells.iter().map(Cell::words).collect();
    Problem::new(format!(
        "words where the first numbers should be: {}\n  remedy: remove the line (the end of a column's name says its unit, as in \
         plunger_mm), or say units_row = true in recordings.toml",
        shown(&words.join(", "))
    ))
}
