//! The keys of `[file]` and of a `[[run]]` that say how a file is laid out.

use super::super::RecordingError;
use super::super::folder_keys::Keys;
use super::options::{Delimiter, FileOptions, Header, TIME_UNITS, TimeSource, time_unit};

/// Keys that `[file]` and `[[run]]` share.
pub(in crate::recording) const FILE_KEYS: [&str; 17] = [
    "encoding",
    "delimiter",
    "decimal",
    "thousands",
    "skip_rows",
    "skip_last_rows",
    "header",
    "names",
    "units_row",
    "missing",
    "sheet",
    "time_column",
    "time_unit",
    "time",
    "interval_s",
    "split_at_restart",
    "merge_repeated",
];

/// What stands in a table, over what holds for all files.
pub(in crate::recording) fn file_options(keys: &Keys<'_>, all: &FileOptions) -> Result<FileOptions, RecordingError> {
    let mut options = all.clone();
    if let Some(text) = keys.text("encoding")? {
        options.encoding = Some(encoding_rs::Encoding::for_label(text.as_bytes()).ok_or_else(|| {
            keys.error(format!(
                "encoding = \"{text}\" is not known\n  remedy: write one of \"utf-8\", \"utf-16le\", \"utf-16be\", \"latin1\", \
                 \"windows-1252\", \"gbk\", or another of the Encoding Standard"
            ))
        })?);
    }
    if let Some(text) = keys.text("delimiter")? {
        options.delimiter = Some(Delimiter::of(text).ok_or_else(|| {
            keys.error(format!(
                "delimiter = \"{text}\" is not known\n  remedy: write one of \",\", \";\", \"tab\", \"|\", \"blanks\""
            ))
        })?);
    }
    options.decimal = keys.word("decimal", &[(".", '.'), (",", ',')])?.or(options.decimal);
    options.thousands =
        keys.word("thousands", &[(".", '.'), (",", ','), ("'", '\''), (" ", ' ')])?.or(options.thousands);
    layout(keys, &mut options)?;
    time(keys, &mut options)?;
    check(keys, &options)?;
    Ok(options)
}

fn layout(keys: &Keys<'_>, options: &mut FileOptions) -> Result<(), RecordingError> {
    options.skip_rows = keys.count("skip_rows")?.unwrap_or(options.skip_rows);
    options.skip_last_rows = keys.count("skip_last_rows")?.unwrap_or(options.skip_last_rows);
    options.header = keys.header()?.or(options.header);
    if keys.has("names") {
        options.names = keys.texts("names")?;
    }
    if keys.has("missing") {
        options.missing = keys.texts("missing")?;
    }
    options.units_row = keys.flag("units_row")?.unwrap_or(options.units_row);
    options.sheet = keys.text("sheet")?.map(str::to_owned).or(options.sheet.take());
    Ok(())
}

fn time(keys: &Keys<'_>, options: &mut FileOptions) -> Result<(), RecordingError> {
    options.time_column = keys.text("time_column")?.map(str::to_owned).or(options.time_column.take());
    if let Some(text) = keys.text("time_unit")? {
        options.time_unit = Some(time_unit(text).ok_or_else(|| {
            let known = TIME_UNITS.join("\", \"");
            keys.error(format!("time_unit = \"{text}\" is not known\n  remedy: write one of \"{known}\""))
        })?);
    }
    options.split_at_restart = keys.flag("split_at_restart")?.unwrap_or(options.split_at_restart);
    options.merge_repeated = keys.flag("merge_repeated")?.unwrap_or(options.merge_repeated);
    let interval_s = keys.number("interval_s")?;
    if let Some(s) = interval_s.filter(|s| *s <= 0.0) {
        return Err(keys.error(format!("interval_s = {s} must be > 0\n  remedy: write the time between two rows, s")));
    }
    let is_index = keys.word("time", &[("column", false), ("index", true)])?;
    options.time = match (is_index, interval_s) {
        (None, None) => options.time,
        (Some(false), _) => TimeSource::Column,
        (Some(true), None) => {
            return Err(keys.error(
                "time = \"index\" needs an interval to stand in for the clock\n  remedy: add interval_s = 0.1, or whatever \
                 one row may have taken",
            ));
        }
        (Some(true), Some(s)) => TimeSource::Index(s),
        (None, Some(s)) => TimeSource::Interval(s),
    };
    Ok(())
}

fn check(keys: &Keys<'_>, options: &FileOptions) -> Result<(), RecordingError> {
    if options.header == Some(Header::Absent) && options.names.is_empty() {
        return Err(keys.error(
            "header = false needs the names of the columns\n  remedy: add names = [\"time_s\", \"plunger_mm\"], one for each column",
        ));
    }
    if options.header != Some(Header::Absent) && !options.names.is_empty() {
        return Err(keys.error(
            "names are for files without a line of names\n  remedy: add header = false, or say in each [[channel]] which name it \
             has: name = \"Pressure [bar]\"",
        ));
    }
    let decimal = options.decimal.unwrap_or('.');
    // Said twice it is meant: cells in quotes.
    if options.delimiter.is_none() && options.delimiter() == Delimiter::Character(decimal as u8) {
        return Err(keys.error(format!(
            "decimal = \"{decimal}\" is the delimiter too\n  remedy: say what separates the columns, as delimiter = \";\" (\",\" \
             too, where the numbers are in quotes)"
        )));
    }
    Ok(())
}
