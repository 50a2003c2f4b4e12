//! Text to rows of cells.

use csv::{ErrorKind, ReaderBuilder, StringRecord, Trim};

use super::cell::{Cell, is_missing};
use super::options::{Delimiter, FileOptions, Header};
use super::place::Problem;

/// What a row is handed to; the first is that of the names where the file has them.
pub(super) type Take<'a> = dyn FnMut(&[Cell<'_>]) -> Result<(), Problem> + 'a;

/// Hands each row of a text to `take`, comments and blank rows left out.
pub(super) fn each_row(text: &str, options: &FileOptions, take: &mut Take<'_>) -> Result<(), Problem> {
    let start = start(text, options)?;
    let body = &text[start..];
    match options.delimiter() {
        Delimiter::Character(delimiter) => each_record(body, delimiter, options, take),
        Delimiter::Blanks => each_line(body, options, take),
    }
    .map_err(|(at, problem)| problem.or_line(|| line_at(text, start + at)))
}

/// The line, from 1, that begins at or after a byte: blank lines are counted to what is below them.
fn line_at(text: &str, at: usize) -> usize {
    let at = at.min(text.len());
    let blanks = text.as_bytes()[at..].iter().take_while(|byte| matches!(byte, b'\r' | b'\n')).count();
    1 + text.as_bytes()[..at + blanks].iter().filter(|byte| **byte == b'\n').count()
}

/// Where the table begins: at the line of names that was declared, else at the first that is neither blank nor a comment.
fn start(text: &str, options: &FileOptions) -> Result<usize, Problem> {
    let declared = match options.header {
        Some(Header::Line(line)) => Some(line),
        _ => None,
    };
    let skipped = declared.map_or(options.skip_rows, |line| line.saturating_sub(1));
    let mut at = 0;
    for (index, line) in text.split_inclusive('\n').enumerate() {
        if index >= skipped && (declared.is_some() || !is_passed_over(line, options)) {
            // Names in a comment: the mark is none of them.
            let mark = line.len() - line.trim_start_matches(['#', '%', ' ']).len();
            return Ok(at + if declared.is_some() { mark } else { 0 });
        }
        at += line.len();
    }
    match declared {
        Some(line) => {
            let lines = text.lines().count();
            Err(Problem::new(format!(
                "header = {line} is beyond its {lines} lines\n  remedy: write the number of the line with the names of the columns"
            )))
        }
        None => Ok(text.len()),
    }
}

fn is_passed_over(line: &str, options: &FileOptions) -> bool {
    line.trim().is_empty() || is_comment(line, options)
}

/// Whether a row is a comment; `#N/A` is none.
fn is_comment(first: &str, options: &FileOptions) -> bool {
    let first = first.trim();
    first.starts_with(['#', '%']) && !is_missing(first.split([',', ';', '\t']).next().unwrap_or(first), options)
}

type Placed = (usize, Problem);

fn each_record(body: &str, delimiter: u8, options: &FileOptions, take: &mut Take<'_>) -> Result<(), Placed> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        // Ragged rows are found later, to say what to do.
        .flexible(true)
        .delimiter(delimiter)
        .trim(Trim::All)
        .from_reader(body.as_bytes());
    let mut record = StringRecord::new();
    loop {
        match reader.read_record(&mut record) {
            Ok(false) => return Ok(()),
            Ok(true) => {}
            Err(e) => {
                let at = e.position().map_or(0, |p| p.byte() as usize);
                return Err((at, no_csv(e.kind())));
            }
        }
        let cells: Vec<Cell<'_>> = record.iter().map(Cell::Text).collect();
        if cells.iter().all(Cell::is_empty) || record.get(0).is_some_and(|first| is_comment(first, options)) {
            continue;
        }
        take(&cells).map_err(|problem| (record.position().map_or(0, |p| p.byte() as usize), problem))?;
    }
}

fn no_csv(kind: &ErrorKind) -> Problem {
    Problem::new(format!("is not CSV: {kind:?}\n  remedy: save the file as comma separated values"))
}

fn each_line(body: &str, options: &FileOptions, take: &mut Take<'_>) -> Result<(), Placed> {
    let mut at = 0;
    for line in body.split_inclusive('\n') {
        if !is_passed_over(line, options) {
            let cells: Vec<Cell<'_>> = line.split_whitespace().map(Cell::Text).collect();
            take(&cells).map_err(|problem| (at, problem))?;
        }
        at += line.len();
    }
    Ok(())
}
