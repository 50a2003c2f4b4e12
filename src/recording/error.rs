//! What can be wrong with recordings. Every message names the place, the cause and the remedy.

use super::unit::known_suffixes;
use std::path::PathBuf;
use thiserror::Error;

/// An error of [`crate::recording`].
#[derive(Debug, Error)]
pub enum RecordingError {
    /// A file cannot be opened or read.
    #[error("{}: cannot be read: {source}\n  remedy: check the path and its permissions", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file cannot be written.
    #[error(
        "{}: cannot be written: {source}\n  remedy: choose a folder that exists, may be written to and has room",
        file.display()
    )]
    Write {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A column name without a known unit.
    #[error(
        "column \"{column}\": its name ends in no known unit\n  remedy: rename it to end in one of {}",
        known_suffixes()
    )]
    UnknownUnit {
        /// The column.
        column: String,
    },
    /// Something wrong at a line of a CSV file.
    #[error("{file}: line {line}: {problem}")]
    Line {
        /// The file.
        file: String,
        /// Line, from 1.
        line: u64,
        /// Cause and remedy.
        problem: String,
    },
    /// Something wrong in one cell of a CSV file.
    #[error("{file}: line {line}, column \"{column}\": {problem}")]
    Cell {
        /// The file.
        file: String,
        /// Line, from 1.
        line: u64,
        /// The column.
        column: String,
        /// Cause and remedy.
        problem: String,
    },
    /// A file that is no recording, or of a format that is none here.
    #[error("{}: {problem}", file.display())]
    Format {
        /// The file.
        file: PathBuf,
        /// Cause and remedy.
        problem: String,
    },
    /// A CSV file without data.
    #[error(
        "{file}: {what}\n  remedy: a recording needs a header line with \"time_s\" and at least one line of numbers"
    )]
    NoData {
        /// The file.
        file: String,
        /// What is missing.
        what: &'static str,
    },
    /// Something wrong with a recording whose file is known only to whoever read it.
    #[error("{file}: {source}")]
    In {
        /// The file.
        file: String,
        /// What is wrong.
        source: Box<RecordingError>,
    },
    /// A channel that a recording does not have.
    #[error("no column \"{column}\" (found: {found})\n  remedy: name one of those; the unit belongs to the name")]
    NoChannel {
        /// The column asked for.
        column: String,
        /// The columns there are.
        found: String,
    },
    /// A run's file lacks a column its set declares.
    #[error(
        "{}: no column \"{column}\", which recordings.toml declares (found: {found})\n  remedy: rename the column, say name = \"...\" in the [[channel]], or list it under not_recorded in the [[run]] of this file",
        file.display()
    )]
    MissingInRun {
        /// The run's file.
        file: PathBuf,
        /// The declared column.
        column: String,
        /// The columns there are.
        found: String,
    },
    /// A channel with another number of samples than the time has.
    #[error("column \"{column}\": {values} values for {times} times\n  remedy: give one value per time")]
    Length {
        /// The column.
        column: String,
        /// Its values.
        values: usize,
        /// Samples of the time.
        times: usize,
    },
    /// The same column twice.
    #[error("column \"{column}\" occurs twice\n  remedy: rename or remove one")]
    DuplicateChannel {
        /// The column.
        column: String,
    },
    /// A time that is not after the one before, or not finite.
    #[error(
        "sample {index}: time_s = {time_s} is not after {previous_s}\n  remedy: give finite times that increase from sample to sample"
    )]
    Time {
        /// Index of the sample, from 0.
        index: usize,
        /// Its time, s.
        time_s: f64,
        /// The time before it, s.
        previous_s: f64,
    },
    /// A channel with no usable value.
    #[error("column \"{column}\": every sample is missing\n  remedy: record it, or leave the channel out")]
    AllMissing {
        /// The column.
        column: String,
    },
    /// Measured and simulated samples do not belong together.
    #[error(
        "measured and simulated times differ at sample {index}\n  remedy: simulate at the recording's sample times"
    )]
    TimesDiffer {
        /// First sample that differs, from 0.
        index: usize,
    },
    /// `recordings.toml` is no TOML.
    #[error("{}: is not valid TOML: {problem}\n  remedy: fix that line", file.display())]
    Toml {
        /// The file.
        file: PathBuf,
        /// What the parser said, with line and column.
        problem: String,
    },
    /// Something wrong at a key of `recordings.toml`.
    #[error("{}: {table}: {problem}", file.display())]
    Key {
        /// The file.
        file: PathBuf,
        /// The table, as `[[run]] 2 ("sine.csv")`.
        table: String,
        /// Key, cause and remedy.
        problem: String,
    },
}

impl RecordingError {
    /// The same error with its file in front.
    #[must_use]
    #[doc(hidden)]
    pub fn in_file(self, file: impl Into<String>) -> Self {
        Self::In { file: file.into(), source: Box::new(self) }
    }
}
