//! Rows of a workbook (`.xlsx`).

use std::collections::BTreeMap;
use std::io::Cursor;

use calamine::{Data, Range, Reader, Xlsx};

use super::cell::Cell;
use super::options::{FileOptions, Header};
use super::place::Problem;
use super::rows::Take;

/// Hands each row of a sheet to `take`, blank ones left out; lines of errors are rows of the sheet.
pub(super) fn each_row(bytes: &[u8], options: &FileOptions, take: &mut Take<'_>) -> Result<(), Problem> {
    let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(|e| unreadable(&e.to_string()))?;
    let names = book.sheet_names();
    let name = match &options.sheet {
        Some(name) if names.contains(name) => name.clone(),
        Some(name) => {
            let known = names.join("\", \"");
            return Err(Problem::new(format!("has no sheet \"{name}\"\n  remedy: write one of \"{known}\"")));
        }
        None => names.first().cloned().ok_or_else(|| unreadable("it has no sheet"))?,
    };
    refuse_huge(&mut book, &name)?;
    let range = book.worksheet_range(&name).map_err(|e| unreadable(&e.to_string()))?;
    let formulas = unsaved(&mut book, &name, &range)?;
    let first = range.start().map_or(0, |(row, _)| row as usize);
    let skipped = match options.header {
        Some(Header::Line(line)) => line.saturating_sub(1),
        _ => options.skip_rows,
    };
    for (index, row) in range.rows().enumerate().skip(skipped.saturating_sub(first)) {
        let mut cells: Vec<Cell<'_>> = row.iter().map(cell).collect();
        for (at, formula) in formulas.get(&index).into_iter().flatten() {
            cells[*at] = Cell::Text(formula);
        }
        if !cells.iter().all(Cell::is_empty) {
            take(&cells).map_err(|problem| problem.or_line(|| first + index + 1))?;
        }
    }
    Ok(())
}

/// Formulas by the rows and columns of a range.
type Formulas = BTreeMap<usize, Vec<(usize, String)>>;

/// Formulas whose values the workbook does not hold: what writes a workbook without calculating it leaves them out. They are handed on as
/// they stand, `=C2*80`, so that they are never taken for missing samples.
fn unsaved(book: &mut Xlsx<Cursor<&[u8]>>, name: &str, values: &Range<Data>) -> Result<Formulas, Problem> {
    let mut found = Formulas::new();
    let mut cells = book.worksheet_cells_reader(name).map_err(|e| unreadable(&e.to_string()))?;
    let Some((first_row, first_column)) = values.start() else { return Ok(found) };
    while let Some(cell) = cells.next_formula().map_err(|e| unreadable(&e.to_string()))? {
        let at = cell.get_position();
        let is_empty = values.get_value(at).is_some_and(|value| *value == Data::Empty);
        if is_empty && !cell.get_value().is_empty() {
            let (row, column) = ((at.0 - first_row) as usize, (at.1 - first_column) as usize);
            found.entry(row).or_default().push((column, format!("={}", cell.get_value())));
        }
    }
    Ok(found)
}

/// Names of the sheets, in their order.
pub(super) fn names(bytes: &[u8]) -> Result<Vec<String>, Problem> {
    let book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(|e| unreadable(&e.to_string()))?;
    Ok(book.sheet_names())
}

/// Cells of the rectangle around all that a sheet holds, at most: the reader makes room for each.
const MOST_CELLS: u64 = 20_000_000;
/// Rows and columns that a sheet can have (ECMA-376: the last cell is XFD1048576). A damaged reference may be far beyond.
const MOST_ROWS: u64 = 1 << 20;
const MOST_COLUMNS: u64 = 1 << 14;

/// Refuses a sheet in which a stray cell far away would ask for more memory than there is.
fn refuse_huge(book: &mut Xlsx<Cursor<&[u8]>>, name: &str) -> Result<(), Problem> {
    let mut cells = book.worksheet_cells_reader(name).map_err(|e| unreadable(&e.to_string()))?;
    let (mut rows, mut columns) = (0, 0);
    while let Some(cell) = cells.next_cell().map_err(|e| unreadable(&e.to_string()))? {
        let (row, column) = cell.get_position();
        (rows, columns) = (rows.max(u64::from(row) + 1), columns.max(u64::from(column) + 1));
    }
    if rows > MOST_ROWS || columns > MOST_COLUMNS {
        return Err(unreadable(&format!(
            "sheet \"{name}\" has a cell in row {rows}, column {columns}, where no sheet has one"
        )));
    }
    if rows * columns <= MOST_CELLS {
        return Ok(());
    }
    Err(Problem::new(format!(
        "has a sheet \"{name}\" of {rows} rows and {columns} columns, more than {MOST_CELLS} cells\n  remedy: delete the stray cells \
         beside and below the table, or save the sheet as CSV"
    )))
}

fn unreadable(why: &str) -> Problem {
    Problem::new(format!("cannot be read as a workbook: {why}\n  remedy: save it again as .xlsx, or the sheet as CSV"))
}

/// Seconds in the day that a workbook counts by.
const DAY_S: f64 = 86_400.0;

fn cell(data: &Data) -> Cell<'_> {
    match data {
        Data::Int(whole) => Cell::Number(*whole as f64),
        Data::Float(number) => Cell::Number(*number),
        Data::DateTime(at) => Cell::Moment((at.as_f64() * DAY_S * 1e6).round() / 1e6),
        Data::String(text) | Data::DateTimeIso(text) | Data::DurationIso(text) => Cell::Text(text),
        Data::Bool(true) => Cell::Number(1.0),
        Data::Bool(false) => Cell::Number(0.0),
        Data::Error(_) => Cell::Text("NaN"),
        // Nothing, and what a later version of the reader may know.
        _ => Cell::Text(""),
    }
}
