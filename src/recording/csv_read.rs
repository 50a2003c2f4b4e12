//! Reading a recording from CSV of plain layout: header line, `time_s`, one column per channel, commas, points.

use super::table::{read_plain, read_plain_from};
use super::{Recording, RecordingError};
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
    read_plain(path)
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
    read_plain_from(source, name)
}

#[cfg(test)]
#[path = "csv_read_tests.rs"]
mod tests;
