//! Where in a file something is wrong.

use super::super::RecordingError;

/// What is wrong, with its remedy, and as much of its place as was known where it was found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Problem {
    /// Line, from 1.
    pub(super) line: Option<usize>,
    pub(super) column: Option<String>,
    pub(super) text: String,
}

impl Problem {
    /// Of a row or of the whole file.
    pub(super) fn new(text: impl Into<String>) -> Self {
        Self { line: None, column: None, text: text.into() }
    }

    pub(super) fn at_line(line: usize, text: impl Into<String>) -> Self {
        Self { line: Some(line), ..Self::new(text) }
    }

    pub(super) fn in_column(column: &str, text: impl Into<String>) -> Self {
        Self { column: Some(column.to_owned()), ..Self::new(text) }
    }

    /// With its line, unless that is known.
    pub(super) fn or_line(self, line: impl FnOnce() -> usize) -> Self {
        let line = self.line.unwrap_or_else(line);
        Self { line: Some(line), ..self }
    }

    pub(super) fn in_file(self, file: &str) -> RecordingError {
        let file = file.to_owned();
        match (self.line.map(|line| line as u64), self.column) {
            (Some(line), Some(column)) => RecordingError::Cell { file, line, column, problem: self.text },
            (Some(line), None) => RecordingError::Line { file, line, problem: self.text },
            (None, _) => RecordingError::Format { file: file.into(), problem: self.text },
        }
    }
}
