//! What is asked of a file before anybody has described it.

use std::collections::VecDeque;
use std::path::Path;

use super::super::{ChannelSpec, RecordingError};
use super::any_columns;
use super::cell::{Cell, number};
use super::header::Needed;
use super::labview::{is_labview, units, with_labview};
use super::options::{FileOptions, Header};
use super::sheet;
use super::stamp::{Moment, stamp};

/// The number of a cell, NaN where it says that it is missing; `None` where it is none.
pub(in crate::recording) fn cell_number(cell: &str, options: &FileOptions) -> Option<f64> {
    number(cell, options).ok()
}

/// Whether a cell is a stamp.
pub(in crate::recording) fn is_stamp(cell: &str) -> bool {
    stamp(cell).is_some()
}

/// The options of a LabVIEW file with all that its header says.
pub(in crate::recording) fn labview_options(text: &str, options: &FileOptions) -> Option<FileOptions> {
    with_labview(text, options).ok().filter(|_| is_labview(text))
}

/// Refuses a LabVIEW file whose header says that it is not one table.
pub(in crate::recording) fn check_labview(text: &str, file: &Path) -> Result<(), RecordingError> {
    let read = with_labview(text, &FileOptions::default());
    read.map(drop).map_err(|problem| problem.in_file(&file.display().to_string()))
}

/// The units of the columns by LabVIEW's header, in the order of the columns; none for any other text.
pub(in crate::recording) fn labview_units(text: &str) -> Vec<String> {
    if is_labview(text) { units(text) } else { Vec::new() }
}

/// Rows of a workbook's sheet, moments as seconds; of the first one where none is named.
pub(in crate::recording) fn workbook_rows(
    bytes: &[u8],
    sheet: Option<&str>,
    file: &Path,
) -> Result<Vec<Vec<String>>, RecordingError> {
    let options = FileOptions { sheet: sheet.map(str::to_owned), ..FileOptions::default() };
    let mut rows = Vec::new();
    let read = sheet::each_row(bytes, &options, &mut |cells| {
        rows.push(cells.iter().map(Cell::words).collect());
        Ok(())
    });
    read.map_err(|problem| problem.in_file(&file.display().to_string()))?;
    Ok(rows)
}

/// The sheets of a workbook.
pub(in crate::recording) fn sheet_names(bytes: &[u8], file: &Path) -> Result<Vec<String>, RecordingError> {
    sheet::names(bytes).map_err(|problem| problem.in_file(&file.display().to_string()))
}

/// The last rows of a file as texts, at most so many; that of the names is none.
pub(in crate::recording) fn last_rows(
    path: &Path,
    options: &FileOptions,
    count: usize,
) -> Result<Vec<Vec<String>>, RecordingError> {
    let mut rows: VecDeque<Vec<String>> = VecDeque::new();
    let mut is_first = options.header != Some(Header::Absent);
    super::each_row_of(path, options, &mut |cells| {
        if !std::mem::take(&mut is_first) {
            rows.push_back(cells.iter().map(Cell::words).collect());
        }
        if rows.len() > count {
            rows.pop_front();
        }
        Ok(())
    })?;
    Ok(rows.into())
}

/// The times of a file's rows, s.
pub(in crate::recording) fn times(path: &Path, options: &FileOptions) -> Result<Vec<f64>, RecordingError> {
    let lenient = FileOptions { split_at_restart: true, merge_repeated: true, ..options.clone() };
    Ok(any_columns(path, &lenient, Needed::These(&[]))?.0.clock.time_s)
}

/// What a file has, without the numbers.
#[derive(Clone, Debug)]
pub(in crate::recording) struct Seen {
    pub(in crate::recording) names: Vec<String>,
    /// The stamp of its first row, where its times are stamps.
    first: Option<Moment>,
}

impl Seen {
    /// Whether a channel is one of its columns.
    pub(in crate::recording) fn has(&self, spec: &ChannelSpec) -> bool {
        self.names.iter().any(|name| name == spec.name_in_table())
    }

    /// How long after another file it begins, where both have stamps of one kind.
    pub(in crate::recording) fn seconds_after(&self, other: &Self) -> Option<f64> {
        self.first?.seconds_after(other.first?)
    }
}

/// Looks at a file.
pub(in crate::recording) fn seen(path: &Path, options: &FileOptions) -> Result<Seen, RecordingError> {
    let (columns, _) = any_columns(path, options, Needed::These(&[]))?;
    Ok(Seen { first: columns.first_moment(), names: columns.names.columns })
}

/// Names and rows of a Parquet file.
pub(in crate::recording) fn parquet_rows(file: &Path) -> Result<Vec<Vec<String>>, RecordingError> {
    let columns = super::super::parquet_read::columns_of(file)?;
    let names = columns.iter().map(|(name, _)| name.clone()).collect();
    let rows = columns.first().map_or(0, |(_, column)| column.len());
    let row = |row: usize| columns.iter().map(|(_, column)| super::stored_cell(column, row).words()).collect();
    Ok(std::iter::once(names).chain((0..rows).map(row)).collect())
}

/// What is wrong with a file's clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::recording) struct ClockFaults {
    pub(in crate::recording) rows: usize,
    /// How often it went back and began anew.
    pub(in crate::recording) restarts: usize,
    /// How many rows stand behind a later one, in which it did not begin anew.
    pub(in crate::recording) swaps: usize,
    /// How often it stood still.
    pub(in crate::recording) repeats: usize,
}

/// Reads the times of a whole file.
pub(in crate::recording) fn clock_faults(path: &Path, options: &FileOptions) -> Result<ClockFaults, RecordingError> {
    let lenient = FileOptions { split_at_restart: true, merge_repeated: true, ..options.clone() };
    let (columns, _) = any_columns(path, &lenient, Needed::These(&[]))?;
    Ok(columns.clock.faults())
}
