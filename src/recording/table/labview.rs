//! Headers of LabVIEW's measurement files (`.lvm`): a block of keys, a block for the channels, then a table.

use super::options::{Delimiter, FileOptions, Header, TimeSource, time_unit};
use super::place::Problem;

const FIRST_WORDS: &str = "LabVIEW Measurement";
const END: &str = "***End_of_Header***";

/// Options with what a LabVIEW header says in the place of what was not declared; as they are for any other file.
pub(super) fn with_labview(text: &str, options: &FileOptions) -> Result<FileOptions, Problem> {
    let mut options = options.clone();
    if !text.trim_start().starts_with(FIRST_WORDS) {
        return Ok(options);
    }
    let ends: Vec<usize> = text.lines().enumerate().filter(|(_, l)| l.starts_with(END)).map(|(i, _)| i).collect();
    let &[.., last] = ends.as_slice() else {
        return Err(Problem::at_line(
            1,
            format!("is a LabVIEW header without \"{END}\"\n  remedy: save the measurement again"),
        ));
    };
    if ends.len() > 2 {
        return Err(Problem::at_line(
            last + 1,
            "begins another segment with a header of its own\n  remedy: save one segment per file, or choose one header for all in \
             LabVIEW's Write To Measurement File",
        ));
    }
    let separator = if value(text, "Separator") == Some("Comma") { b',' } else { b'\t' };
    options.delimiter.get_or_insert(Delimiter::Character(separator));
    options.decimal.get_or_insert(if value(text, "Decimal_Separator") == Some(",") { ',' } else { '.' });
    // From 1, and the line behind the last mark.
    options.header.get_or_insert(Header::Line(last + 2));
    time(text, &mut options)?;
    Ok(options)
}

fn time(text: &str, options: &mut FileOptions) -> Result<(), Problem> {
    match value(text, "X_Columns") {
        Some("No") if options.time == TimeSource::Column => {
            let interval_s = value(text, "Delta_X").and_then(|v| v.replace(',', ".").parse::<f64>().ok());
            let interval_s = interval_s.filter(|s| s.is_finite() && *s > 0.0).ok_or_else(|| {
                Problem::at_line(1, "has neither times nor Delta_X\n  remedy: say interval_s = 0.01 in recordings.toml, or whatever it is")
            })?;
            options.time = TimeSource::Interval(interval_s);
        }
        Some("Multi") => {
            return Err(Problem::at_line(
                1,
                "has a time for each channel (X_Columns Multi)\n  remedy: save it with one X column for all channels",
            ));
        }
        _ => {
            if options.time_column.is_none() {
                options.time_column = Some("X_Value".to_owned());
                options.time_unit = options.time_unit.or(time_unit("s"));
            }
        }
    }
    Ok(())
}

/// The first value of a key of the header.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let rest = text.lines().find_map(|line| line.strip_prefix(key).filter(|rest| rest.starts_with(['\t', ','])))?;
    // The first mark is the separator, what follows may be a comma itself.
    let separator = if rest.starts_with('\t') { '\t' } else { ',' };
    match rest[1..].split(separator).map(str::trim).find(|v| !v.is_empty()) {
        None if separator == ',' => Some(","),
        found => found,
    }
}

/// The cells of `Y_Unit_Label`: one for each column, the first, which is that of the times, empty.
pub(super) fn units(text: &str) -> Vec<String> {
    const KEY: &str = "Y_Unit_Label";
    let line = text.lines().find_map(|line| line.strip_prefix(KEY).filter(|rest| rest.starts_with(['\t', ','])));
    let Some(rest) = line else { return Vec::new() };
    let separator = if rest.starts_with('\t') { '\t' } else { ',' };
    rest.split(separator).map(|cell| cell.trim().to_owned()).collect()
}

/// Whether a text is one of LabVIEW's.
pub(in crate::recording) fn is_labview(text: &str) -> bool {
    text.trim_start().starts_with(FIRST_WORDS)
}
