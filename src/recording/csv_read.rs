//! Reading a recording from CSV: header line, `time_s`, one column per channel.

use super::source::{read_lines, read_settled};
use super::{Channel, Recording, RecordingError, TIME_COLUMN};
use ::csv::{ErrorKind, Position, Reader, ReaderBuilder, StringRecord, Trim};
use std::collections::HashSet;
use std::io::Read;
use std::path::Path;

/// Reads a CSV file.
///
/// An empty cell or `NaN` is a missing sample and kept as NaN; see [`super::survey`].
///
/// ```
/// use smam::recording::read_csv;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("sine.csv");
/// std::fs::write(&path, "time_s,plunger_mm,force_n\n0,0,0.05\n0.01,0.5,\n")?;
/// let recording = read_csv(&path)?;
/// assert_eq!(recording.si("plunger_mm")?, [0.0, 0.5e-3]);
/// assert!(recording.channel("force_n")?.values[1].is_nan());
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// File, line, column, cause and remedy of the first thing that is wrong.
pub fn read_csv(path: &Path) -> Result<Recording, RecordingError> {
    parse(&read_settled(path)?, &path.display().to_string())
}

/// Reads CSV from anywhere; `name` stands for the file in errors.
///
/// ```
/// use smam::recording::read_csv_from;
///
/// let text = "time_s;plunger_mm\n0;0,5\n";
/// let message = read_csv_from(text.as_bytes(), "sine.csv").err().map_or_else(String::new, |e| e.to_string());
/// assert!(message.contains("sine.csv") && message.contains("separated by semicolons"));
/// ```
///
/// # Errors
/// As [`read_csv`].
pub fn read_csv_from(source: impl Read, name: &str) -> Result<Recording, RecordingError> {
    parse(&read_lines(source).map_err(|e| e.in_reading(Path::new(name)))?, name)
}

fn parse(bytes: &[u8], name: &str) -> Result<Recording, RecordingError> {
    let text = Text { file: name, bytes: bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes) };
    text.check_bytes()?;
    let mut reader = ReaderBuilder::new()
        // Ragged rows are found here, to say what to do.
        .flexible(true)
        .trim(Trim::All)
        .from_reader(text.bytes);
    let header = Header::read(&mut reader, text)?;
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); header.columns.len()];
    let mut row = StringRecord::new();
    while reader.read_record(&mut row).map_err(|e| text.error(e))? {
        header.append(&row, &mut columns)?;
    }
    header.into_recording(columns)
}

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// The whole file, kept so that an error can tell its line.
#[derive(Clone, Copy)]
struct Text<'a> {
    file: &'a str,
    bytes: &'a [u8],
}

impl Text<'_> {
    /// The line, from 1, of the record at a position. The reader's own count is one behind after
    /// blank lines, which it counts to the record below them.
    fn line(&self, position: Option<&Position>) -> u64 {
        let start = position.map_or(0, |p| p.byte() as usize).min(self.bytes.len());
        let is_blank = |byte: &&u8| matches!(byte, b'\r' | b'\n');
        let blanks = self.bytes[start..].iter().take_while(is_blank).count();
        let before = &self.bytes[..start + blanks];
        1 + before.iter().filter(|byte| **byte == b'\n').count() as u64
    }

    /// UTF-16 and binary files hold zero bytes, text in UTF-8 never does.
    fn check_bytes(&self) -> Result<(), RecordingError> {
        let is_utf16 = self.bytes.starts_with(b"\xff\xfe") || self.bytes.starts_with(b"\xfe\xff");
        let zero = self.bytes.iter().position(|byte| *byte == 0);
        let Some(at) = zero.or(is_utf16.then_some(0)) else { return Ok(()) };
        let line = 1 + self.bytes[..at].iter().filter(|byte| **byte == b'\n').count() as u64;
        let problem = "is not UTF-8 text but UTF-16 or no text at all\n  remedy: save the file as CSV in UTF-8";
        Err(self.line_error(line, problem.to_owned()))
    }

    fn line_error(&self, line: u64, problem: String) -> RecordingError {
        RecordingError::Line { file: self.file.to_owned(), line, problem }
    }

    fn no_data(&self, what: &'static str) -> RecordingError {
        RecordingError::NoData { file: self.file.to_owned(), what }
    }

    fn error(&self, error: ::csv::Error) -> RecordingError {
        let problem = match error.kind() {
            ErrorKind::Utf8 { .. } => "is not UTF-8 text\n  remedy: save the file as CSV in UTF-8".to_owned(),
            other => format!("is not CSV: {other:?}\n  remedy: save the file as comma separated values"),
        };
        self.line_error(self.line(error.position()), problem)
    }
}

/// The names of the columns and which of them is the time.
struct Header<'a> {
    text: Text<'a>,
    columns: Vec<String>,
    time_index: usize,
}

impl<'a> Header<'a> {
    fn read(reader: &mut Reader<&[u8]>, text: Text<'a>) -> Result<Self, RecordingError> {
        let names = reader.headers().map_err(|error| text.error(error))?;
        let columns: Vec<String> = names.iter().map(str::to_owned).collect();
        if columns.iter().all(String::is_empty) {
            return Err(text.no_data("the file is empty"));
        }
        let line = text.line(names.position());
        let time_index = check_names(&columns).map_err(|problem| text.line_error(line, problem))?;
        Ok(Self { text, columns, time_index })
    }

    fn append(&self, row: &StringRecord, columns: &mut [Vec<f64>]) -> Result<(), RecordingError> {
        if row.len() != self.columns.len() {
            let (cells, names) = (row.len(), self.columns.len());
            let problem = format!(
                "{cells} cells where the header names {names} columns\n  remedy: fill up the row, leaving missing cells \
                 empty between commas, and write decimals with a point"
            );
            return Err(self.text.line_error(self.text.line(row.position()), problem));
        }
        let is_first = columns[0].is_empty();
        if is_first && row.iter().all(is_word) {
            let words = shown(&row.iter().collect::<Vec<_>>().join(", "));
            let problem = format!(
                "words where the first numbers should be: {words}\n  remedy: remove the line; the end of a column's name says its \
                 unit, as in plunger_mm"
            );
            return Err(self.text.line_error(self.text.line(row.position()), problem));
        }
        for (index, cell) in row.iter().enumerate() {
            let value = number(cell).map_err(|problem| self.cell_error(row, index, problem))?;
            if index == self.time_index {
                check_time(value, columns[index].last().copied())
                    .map_err(|problem| self.cell_error(row, index, problem))?;
            }
            columns[index].push(value);
        }
        Ok(())
    }

    fn cell_error(&self, row: &StringRecord, index: usize, problem: String) -> RecordingError {
        RecordingError::Cell {
            file: self.text.file.to_owned(),
            line: self.text.line(row.position()),
            column: self.columns[index].clone(),
            problem,
        }
    }

    fn into_recording(self, mut columns: Vec<Vec<f64>>) -> Result<Recording, RecordingError> {
        let time_s = columns.remove(self.time_index);
        if time_s.is_empty() {
            return Err(self.text.no_data("there is no row below the header"));
        }
        let mut names = self.columns;
        names.remove(self.time_index);
        let channels = names.into_iter().zip(columns);
        Recording::new(time_s, channels.map(|(n, values)| Channel::new(n, values)).collect())
    }
}

/// The index of the time column, or what is wrong with the header.
fn check_names(columns: &[String]) -> Result<usize, String> {
    for (separator, called) in [(';', "semicolons"), ('\t', "tabs")] {
        if columns.len() == 1 && columns[0].contains(separator) {
            return Err(format!(
                "the columns are separated by {called}\n  remedy: save the file with commas between the columns and \
                 points as decimal marks"
            ));
        }
    }
    if columns.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err(format!(
            "there are numbers where the names of the columns should be\n  remedy: put a header line above them, such as \
             {TIME_COLUMN},plunger_mm"
        ));
    }
    if let Some(unnamed) = columns.iter().position(String::is_empty) {
        return Err(format!("column {} has no name\n  remedy: name it, or remove it and its comma", unnamed + 1));
    }
    let mut seen = HashSet::new();
    if let Some(twice) = columns.iter().find(|name| !seen.insert(name.as_str())) {
        return Err(format!("column \"{twice}\" occurs twice\n  remedy: rename or remove one"));
    }
    columns.iter().position(|name| name == TIME_COLUMN).ok_or_else(|| {
        format!(
            "no column \"{TIME_COLUMN}\" (found: {})\n  remedy: name the time column \"{TIME_COLUMN}\" and give it \
                 in seconds",
            columns.join(", ")
        )
    })
}

fn number(cell: &str) -> Result<f64, String> {
    if cell.is_empty() {
        return Ok(f64::NAN);
    }
    match cell.parse::<f64>() {
        Ok(value) if !value.is_infinite() => Ok(value),
        _ => Err(format!("{} is not a finite number\n  remedy: {}", shown(cell), remedy(cell))),
    }
}

/// What to write in place of a cell that is no number.
fn remedy(cell: &str) -> String {
    let with_point = cell.replace(',', ".");
    let is_clock =
        cell.starts_with(|c: char| c.is_ascii_digit()) && (cell.contains(':') || cell.matches('-').count() == 2);
    if cell.contains(',') && with_point.parse::<f64>().is_ok_and(f64::is_finite) {
        format!("write decimals with a point: {with_point}")
    } else if is_clock {
        "give the time in seconds as a number, counted from the first row or from any other moment".to_owned()
    } else {
        "write a number with a point as decimal mark, or leave the cell empty where the sample is missing".to_owned()
    }
}

/// Neither a number nor missing: a unit, say.
fn is_word(cell: &str) -> bool {
    cell.starts_with(|c: char| c.is_alphabetic() || "[(%°".contains(c)) && cell.parse::<f64>().is_err()
}

/// A cell as an error shows it: its beginning (an open quote takes in the rest of the file), with what cannot be seen escaped.
fn shown(cell: &str) -> String {
    const LONGEST: usize = 40;
    let beginning: String = cell.chars().take(LONGEST).collect();
    let more = if beginning.len() < cell.len() { "..." } else { "" };
    format!("{beginning:?}{more}")
}

/// Eleven days without a sample: a simulation would run across them, so it is rather the unit that is wrong.
const LONGEST_GAP_S: f64 = 1e6;

fn check_time(time_s: f64, previous_s: Option<f64>) -> Result<(), String> {
    match previous_s {
        _ if time_s.is_nan() => {
            Err("the time is missing\n  remedy: give every row its time, or remove the row".to_owned())
        }
        Some(previous_s) if time_s <= previous_s => Err(format!(
            "{time_s} is not after {previous_s}\n  remedy: remove repeated rows, sort the rows by time, or split the \
             file where its clock starts anew"
        )),
        Some(previous_s) if time_s - previous_s > LONGEST_GAP_S => Err(format!(
            "{time_s:e} is more than {LONGEST_GAP_S:e} s after {previous_s}\n  remedy: give the time in seconds, or split the \
             file where nothing was recorded"
        )),
        _ => Ok(()),
    }
}

#[cfg(test)]
#[path = "csv_read_tests.rs"]
mod tests;
