//! Tables as labs write them: text in many layouts, and workbooks.
//!
//! Bytes → text ([`decode`]) → rows of cells ([`rows`], [`sheet`]) → columns of numbers with a clock ([`columns`], [`clock`]). What a
//! file does not say itself stands in [`FileOptions`]. Nothing is guessed here.

mod beside;
mod cell;
mod clock;
mod columns;
mod decode;
mod file_unit;
mod header;
mod keys;
mod label;
mod labview;
mod looked_at;
mod options;
mod place;
mod rows;
mod sheet;
mod source;
mod stamp;

use std::path::Path;

use super::source::{read_lines, read_settled};
use super::survey::median;
use super::{Channel, ChannelSpec, FileFormat, LoadedRun, Recording, RecordingError, TIME_COLUMN, parse_column};
use crate::columns::Column;
use beside::Beside;
use cell::Cell;
use columns::Columns;
use header::{Names, Needed};
use place::Problem;

pub use file_unit::{FILE_UNITS, FileUnit, file_unit};
pub use label::{Label, label};
pub use options::{Delimiter, FileOptions, Header, TimeSource};
pub use source::TableSource;

pub(super) use cell::is_formula;
pub(super) use decode::without_nul_end;
pub(super) use keys::{FILE_KEYS, file_options};
pub(super) use label::{is_unread, unread_unit};
pub(super) use looked_at::{
    Seen, cell_number, check_labview, clock_faults, is_stamp, labview_options, labview_units, last_rows, parquet_rows,
    seen, sheet_names, times, workbook_rows,
};
pub(super) use options::TIME_UNITS;
pub(super) use source::{TABLE_KEYS, table_source};
pub(super) use stamp::{READ_STAMPS, is_like_a_stamp};

/// Reads a CSV file of plain layout, every column of it.
pub(super) fn read_plain(path: &Path) -> Result<Recording, RecordingError> {
    plain(&read_settled(path)?, &path.display().to_string())
}

/// As [`read_plain`], from anywhere; `name` stands for the file in errors.
pub(super) fn read_plain_from(source: impl std::io::Read, name: &str) -> Result<Recording, RecordingError> {
    plain(&read_lines(source).map_err(|e| e.in_reading(Path::new(name)))?, name)
}

fn plain(bytes: &[u8], name: &str) -> Result<Recording, RecordingError> {
    let (columns, _) = text_columns(bytes, name, &FileOptions::default(), Needed::All)?;
    every_column(columns)
}

/// Reads every column of the first sheet of a workbook: names in its first row, the time in `time_s`.
pub(super) fn read_plain_workbook(path: &Path) -> Result<Recording, RecordingError> {
    let (bytes, name) = (super::source::read_whole(path)?, path.display().to_string());
    every_column(sheet_columns(&bytes, &name, &FileOptions::default(), Needed::All)?)
}

fn every_column(columns: Columns) -> Result<Recording, RecordingError> {
    let Columns { names, values, clock, .. } = columns;
    let named = names.columns.into_iter().zip(values).enumerate();
    let channels = named.filter(|(index, _)| Some(*index) != names.time);
    Recording::new(clock.time_s, channels.map(|(_, (name, values))| Channel::new(name, values)).collect())
}

/// Reads the declared channels of a file in their own units, and what else it has in numbers. More than one where the clock
/// started anew and that was declared.
pub(super) fn read_declared(
    path: &Path,
    declared: &[ChannelSpec],
    options: &FileOptions,
) -> Result<Vec<LoadedRun>, RecordingError> {
    let file = path.display().to_string();
    let names: Vec<String> = declared.iter().map(|spec| spec.name_in_table().to_owned()).collect();
    let needed = Needed::These(&names);
    let (columns, options) = any_columns(path, options, needed)?;
    if let Some(absent) = declared.iter().find(|spec| !columns.names.columns.contains(&spec.name_in_table().to_owned()))
    {
        return Err(RecordingError::MissingInRun {
            file: path.to_owned(),
            column: absent.name_in_table().to_owned(),
            found: found(&columns.names),
        });
    }
    in_channels(columns, declared, &options).map_err(|problem| problem.in_file(&file))
}

/// What the file has besides the time.
fn found(names: &Names) -> String {
    let others = names.columns.iter().enumerate().filter(|(index, _)| Some(*index) != names.time);
    others.map(|(_, name)| name.as_str()).collect::<Vec<_>>().join(", ")
}

/// The columns of a file of any kind, and the options with what it says itself.
fn any_columns(
    path: &Path,
    options: &FileOptions,
    needed: Needed<'_>,
) -> Result<(Columns, FileOptions), RecordingError> {
    let file = path.display().to_string();
    Ok(match FileFormat::of(path)? {
        FileFormat::Workbook => {
            (sheet_columns(&super::source::read_whole(path)?, &file, options, needed)?, options.clone())
        }
        FileFormat::Parquet => (parquet_columns(path, options, needed)?, options.clone()),
        _ => text_columns(&read_settled(path)?, &file, options, needed)?,
    })
}

/// Hands each row of a text or a workbook to `take`, that of the names included; of a Parquet file none.
fn each_row_of(path: &Path, options: &FileOptions, take: &mut rows::Take<'_>) -> Result<(), RecordingError> {
    let refuse = |problem: Problem| problem.in_file(&path.display().to_string());
    match FileFormat::of(path)? {
        FileFormat::Workbook => sheet::each_row(&super::source::read_whole(path)?, options, take).map_err(refuse),
        FileFormat::Csv => {
            let bytes = read_settled(path)?;
            let text = decode::decode(without_nul_end(&bytes).0, options.encoding).map_err(refuse)?;
            let options = labview::with_labview(&text, options).map_err(refuse)?;
            rows::each_row(&text, &options, take).map_err(refuse)
        }
        _ => Ok(()),
    }
}

fn text_columns(
    bytes: &[u8],
    file: &str,
    options: &FileOptions,
    needed: Needed<'_>,
) -> Result<(Columns, FileOptions), RecordingError> {
    let refuse = |problem: Problem| problem.in_file(file);
    let (bytes, nul_end) = without_nul_end(bytes);
    let text = decode::decode(bytes, options.encoding).map_err(refuse)?;
    let options = labview::with_labview(&text, options).map_err(refuse)?;
    let mut columns = collect(file, &options, needed, |take| rows::each_row(&text, &options, take))?;
    columns.notes.extend(nul_end);
    Ok((columns, options))
}

fn sheet_columns(
    bytes: &[u8],
    file: &str,
    options: &FileOptions,
    needed: Needed<'_>,
) -> Result<Columns, RecordingError> {
    collect(file, options, needed, |take| {
        let mut beside = Beside::new(options);
        sheet::each_row(bytes, options, &mut |cells| take(&beside.without_remarks(cells)))
    })
}

/// Names and rows of a Parquet file, as those of any table; the first row of numbers is line 2.
fn parquet_columns(path: &Path, options: &FileOptions, needed: Needed<'_>) -> Result<Columns, RecordingError> {
    let stored = super::parquet_read::columns_of(path)?;
    collect(&path.display().to_string(), options, needed, |take| {
        take(&stored.iter().map(|(name, _)| Cell::Text(name)).collect::<Vec<_>>())?;
        let rows = stored.first().map_or(0, |(_, column)| column.len());
        (0..rows).try_for_each(|row| {
            let cells: Vec<Cell<'_>> = stored.iter().map(|(_, column)| stored_cell(column, row)).collect();
            take(&cells).map_err(|problem| problem.or_line(|| row + 2))
        })
    })
}

fn stored_cell(column: &Column, row: usize) -> Cell<'_> {
    match column {
        Column::Whole(values) => Cell::Number(values[row] as f64),
        Column::Numbers(values) => Cell::Number(values[row]),
        Column::Texts(values) => Cell::Text(values[row].as_deref().unwrap_or("")),
    }
}

/// Rows, handed over by `each`, to columns: the first row has the names unless they are declared.
fn collect(
    file: &str,
    options: &FileOptions,
    needed: Needed<'_>,
    each: impl Fn(&mut rows::Take<'_>) -> Result<(), Problem>,
) -> Result<Columns, RecordingError> {
    let last = last_row(options, &each).map_err(|problem| problem.in_file(file))?;
    let mut row = 0;
    let no_data = |what| RecordingError::NoData { file: file.to_owned(), what };
    let mut columns = match options.header {
        Some(Header::Absent) => Some(Columns::new(
            Names::new(options.names.clone(), options, needed).map_err(|p| p.in_file(file))?,
            options.clone(),
        )),
        _ => None,
    };
    each(&mut |cells| {
        row += 1;
        match &mut columns {
            _ if row > last => {}
            Some(columns) => columns.push(cells)?,
            None => columns = Some(Columns::new(Names::of_row(cells, options, needed)?, options.clone())),
        }
        Ok(())
    })
    .map_err(|problem| problem.in_file(file))?;
    let columns = columns.ok_or_else(|| no_data("the file is empty"))?;
    match columns.clock.time_s.is_empty() {
        true => Err(no_data("there is no row below the header")),
        false => Ok(columns),
    }
}

/// How many rows, that of the names included, are read; rows at the end are counted only where some are to be left out.
fn last_row(
    options: &FileOptions,
    each: &impl Fn(&mut rows::Take<'_>) -> Result<(), Problem>,
) -> Result<usize, Problem> {
    if options.skip_last_rows == 0 {
        return Ok(usize::MAX);
    }
    let mut rows = 0_usize;
    each(&mut |_| {
        rows += 1;
        Ok(())
    })?;
    Ok(rows.saturating_sub(options.skip_last_rows))
}

/// A file whose own times contradict the interval that was declared in their place.
fn other_pace(columns: &Columns, options: &FileOptions) -> Option<String> {
    let TimeSource::Interval(declared_s) = options.time else { return None };
    let at = columns.names.columns.iter().position(|name| name == TIME_COLUMN)?;
    let mut intervals: Vec<f64> = columns.values[at].windows(2).map(|w| w[1] - w[0]).filter(|dt| *dt > 0.0).collect();
    let own_s = median(&mut intervals)?;
    ((own_s / declared_s - 1.0).abs() > 0.01).then(|| {
        format!(
            "interval_s = {declared_s}, but the times in its column \"{TIME_COLUMN}\" are {own_s:.6} s apart: without interval_s they are \
             read"
        )
    })
}

/// Columns under the names and in the units of the channels.
fn in_channels(
    mut columns: Columns,
    declared: &[ChannelSpec],
    options: &FileOptions,
) -> Result<Vec<LoadedRun>, Problem> {
    let mut kept: Vec<(String, Vec<f64>)> = Vec::new();
    for spec in declared {
        let Some(at) = columns.names.columns.iter().position(|name| name == spec.name_in_table()) else { continue };
        let mut values = columns.values[at].clone();
        let unit = parse_column(&spec.column).map_err(|e| Problem::new(e.to_string()))?.unit;
        let header = &columns.names.columns[at];
        spec.table.convert(header, unit, &mut values).map_err(|text| Problem::in_column(header, text).or_line(|| 1))?;
        kept.push((spec.column.clone(), values));
    }
    columns.notes.extend(other_pace(&columns, options));
    let mut texts = Vec::new();
    for (index, name) in columns.names.columns.iter().enumerate() {
        if Some(index) == columns.names.time || columns.names.is_needed[index] || name.is_empty() {
            continue;
        }
        let is_taken = name == TIME_COLUMN || kept.iter().any(|(column, _)| column == name);
        match columns.has_texts[index] || is_taken {
            true => texts.push(name.clone()),
            false => kept.push((name.clone(), std::mem::take(&mut columns.values[index]))),
        }
    }
    let (names, values): (Vec<String>, Vec<Vec<f64>>) = kept.into_iter().unzip();
    let in_clock = |text: String| Problem::new(format!("column \"{}\": {text}", columns.time_name()));
    columns.clock.check_order().map_err(in_clock)?;
    let mut notes = columns.clock.notes();
    notes.append(&mut columns.notes);
    if !texts.is_empty() {
        notes.push(format!("columns of texts, dates or no use are not read: {}", texts.join(", ")));
    }
    if let TimeSource::Index(interval_s) = options.time {
        notes.push(format!(
            "time = \"index\": its rows have no clock, {interval_s} s a row stands in for one; what depends on rate (damping, creep, \
             lag, leak, line) cannot be judged from it"
        ));
    }
    // What holds for the whole file is said once.
    let part = |(index, (time_s, values)): (usize, (Vec<f64>, Vec<Vec<f64>>))| {
        let channels = names.iter().cloned().zip(values).map(|(name, values)| Channel::new(name, values)).collect();
        let recording = Recording::new(time_s, channels).map_err(|e| Problem::new(e.to_string()))?;
        Ok(LoadedRun { recording, notes: if index == 0 { notes.clone() } else { Vec::new() } })
    };
    columns.clock.cut(&values).into_iter().enumerate().map(part).collect()
}
