//! Writing recordings as CSV, row by row.

use super::{Recording, RecordingError, TIME_COLUMN};
use crate::files::{put_in_place, temporary_beside};
use std::fmt::Write as _;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Formats rows to anything that can be written to, standard output included.
///
/// Numbers have the fewest digits that read back to the same `f64`; a missing value is `NaN`. The
/// same values give the same bytes. One row is one `write_all` of a whole line.
///
/// ```
/// use smam::recording::RowWriter;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut rows = RowWriter::new(Vec::new(), &["force_n"])?;
/// rows.row(0.0, &[0.05])?;
/// rows.row(0.01, &[f64::NAN])?;
/// assert_eq!(String::from_utf8(rows.finish()?)?, "time_s,force_n\n0,0.05\n0.01,NaN\n");
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct RowWriter<W: Write> {
    target: W,
    column_count: usize,
    line: String,
}

impl<W: Write> RowWriter<W> {
    /// Writes the header: `time_s`, then `columns`.
    ///
    /// # Errors
    /// What the target says.
    pub fn new(mut target: W, columns: &[&str]) -> io::Result<Self> {
        let mut line = TIME_COLUMN.to_owned();
        for column in columns {
            line.push(',');
            push_quoted(&mut line, column);
        }
        line.push('\n');
        target.write_all(line.as_bytes())?;
        Ok(Self { target, column_count: columns.len(), line })
    }

    /// Writes one row: the time (s) and one value per column, in the column's unit.
    ///
    /// # Errors
    /// What the target says; another number of values than columns.
    pub fn row(&mut self, time_s: f64, values: &[f64]) -> io::Result<()> {
        check_width(values.len(), self.column_count)?;
        self.line.clear();
        let _ = write!(self.line, "{time_s}"); // a String takes every write
        for value in values {
            let _ = write!(self.line, ",{value}");
        }
        self.line.push('\n');
        self.target.write_all(self.line.as_bytes())
    }

    /// Writes every row of a recording whose channels are the columns.
    ///
    /// # Errors
    /// As [`RowWriter::row`].
    pub fn rows(&mut self, recording: &Recording) -> io::Result<()> {
        let mut values = vec![0.0; recording.channels().len()];
        for (index, time_s) in recording.time_s().iter().enumerate() {
            for (value, channel) in values.iter_mut().zip(recording.channels()) {
                *value = channel.values[index];
            }
            self.row(*time_s, &values)?;
        }
        Ok(())
    }

    /// Flushes and gives the target back.
    ///
    /// # Errors
    /// What the target says.
    pub fn finish(mut self) -> io::Result<W> {
        self.target.flush()?;
        Ok(self.target)
    }
}

/// A row has one value for each column.
pub(super) fn check_width(given: usize, expected: usize) -> io::Result<()> {
    if given == expected {
        return Ok(());
    }
    let said = format!("a row of {given} values for {expected} columns");
    Err(io::Error::new(io::ErrorKind::InvalidInput, said))
}

/// A name with a comma, quote or line break goes between quotes.
fn push_quoted(line: &mut String, name: &str) {
    if name.contains([',', '"', '\n', '\r']) {
        line.push('"');
        line.push_str(&name.replace('"', "\"\""));
        line.push('"');
    } else {
        line.push_str(name);
    }
}

/// Writes a CSV file that appears under its name only when it is complete or ended on purpose.
///
/// Rows stream into a temporary file in the target's folder; [`CsvWriter::finish`] moves it to the
/// target in one step. Called after an interrupt it keeps what was computed, in whole rows. Dropped
/// without it, nothing is left and a former file of that name is untouched.
///
/// ```
/// use smam::recording::CsvWriter;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("sine.csv");
/// let mut writer = CsvWriter::create(&path, &["force_n"])?;
/// writer.row(0.0, &[0.05])?;
/// assert!(!path.exists());
/// writer.finish()?;
/// assert!(path.exists());
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct CsvWriter {
    path: PathBuf,
    rows: RowWriter<BufWriter<NamedTempFile>>,
}

impl CsvWriter {
    /// Starts a file with columns `time_s` and `columns`.
    ///
    /// # Errors
    /// The folder does not exist or cannot be written to.
    pub fn create(path: &Path, columns: &[&str]) -> Result<Self, RecordingError> {
        let start = || RowWriter::new(BufWriter::new(temporary_beside(path)?), columns);
        Ok(Self { path: path.to_owned(), rows: start().map_err(|source| write_error(path, source))? })
    }

    /// Writes one row: the time (s) and one value per column, in the column's unit.
    ///
    /// # Errors
    /// The file cannot be written, or the number of values is not that of the columns.
    pub fn row(&mut self, time_s: f64, values: &[f64]) -> Result<(), RecordingError> {
        let written = self.rows.row(time_s, values);
        written.map_err(|source| write_error(&self.path, source))
    }

    /// Ends the file, be it complete or interrupted, and puts it in its place.
    ///
    /// # Errors
    /// The rows cannot be written out or the file cannot be moved to its name.
    pub fn finish(self) -> Result<(), RecordingError> {
        let path = self.path.clone();
        self.finish_as(&path)
    }

    /// Ends the file under another name.
    pub(super) fn finish_as(self, path: &Path) -> Result<(), RecordingError> {
        place(self.rows, path).map_err(|source| write_error(path, source))
    }
}

impl Recording {
    /// Writes the recording as a CSV file, in the units of its columns.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_csv(&self, path: &Path) -> Result<(), RecordingError> {
        let mut writer = CsvWriter::create(path, &self.columns())?;
        let written = writer.rows.rows(self);
        written.map_err(|source| write_error(path, source))?;
        writer.finish()
    }
}

fn place(rows: RowWriter<BufWriter<NamedTempFile>>, path: &Path) -> io::Result<()> {
    let file = rows.finish()?.into_inner().map_err(|e| e.into_error())?;
    put_in_place(file, path)
}

pub(super) fn write_error(path: &Path, source: io::Error) -> RecordingError {
    RecordingError::Write { file: path.to_owned(), source }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Channel, read_csv, read_csv_from};
    use proptest::prelude::*;

    fn text(recording: &Recording) -> String {
        let mut writer = RowWriter::new(Vec::new(), &recording.columns()).unwrap();
        writer.rows(recording).unwrap();
        String::from_utf8(writer.finish().unwrap()).unwrap()
    }

    #[test]
    fn rows_look_as_documented() {
        let recording = Recording::new(
            vec![0.0, 0.1],
            vec![Channel::new("a_mm", vec![1.5, f64::NAN]), Channel::new("odd, \"name\"", vec![-0.0, 1e-7])],
        )
        .unwrap();
        assert_eq!(text(&recording), "time_s,a_mm,\"odd, \"\"name\"\"\"\n0,1.5,-0\n0.1,NaN,0.0000001\n");
        let back = read_csv_from(text(&recording).as_bytes(), "x").unwrap();
        assert_eq!(back.columns(), recording.columns());
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_back_bit_by_bit(
            rows in prop::collection::vec((1e-9f64..1e3, any::<f64>(), any::<f64>()), 1..40)
        ) {
            let mut time_s = Vec::new();
            let mut now_s = -1.0;
            for (step_s, _, _) in &rows {
                now_s += step_s;
                time_s.push(now_s);
            }
            let finite = |v: f64| if v.is_infinite() { f64::MAX } else { v };
            let a = rows.iter().map(|r| finite(r.1)).collect();
            let b = rows.iter().map(|r| finite(r.2)).collect();
            let channels = vec![Channel::new("a_mm", a), Channel::new("b_kpa", b)];
            let recording = Recording::new(time_s, channels).unwrap();
            let back = read_csv_from(text(&recording).as_bytes(), "x").unwrap();
            // Every NaN means "missing": its bits carry nothing.
            let bits = |v: &f64| if v.is_nan() { 0 } else { v.to_bits() };
            prop_assert_eq!(back.time_s(), recording.time_s());
            for (left, right) in back.channels().iter().zip(recording.channels()) {
                prop_assert!(left.values.iter().map(bits).eq(right.values.iter().map(bits)));
            }
        }
    }

    #[test]
    fn interrupted_file_keeps_whole_rows_dropped_one_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        let mut writer = CsvWriter::create(&path, &["a_mm"]).unwrap();
        writer.row(0.0, &[1.0]).unwrap();
        assert!(!path.exists());
        writer.finish().unwrap();
        let mut dropped = CsvWriter::create(&path, &["a_mm"]).unwrap();
        dropped.row(5.0, &[7.0]).unwrap();
        drop(dropped);
        assert_eq!(read_csv(&path).unwrap().time_s(), [0.0]);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn errors_name_the_file() {
        let error = CsvWriter::create(Path::new("no/such/out.csv"), &[]).unwrap_err();
        assert!(error.to_string().starts_with("no/such/out.csv: cannot be written: "));
        let mut rows = RowWriter::new(Vec::new(), &["a_mm"]).unwrap();
        assert_eq!(rows.row(0.0, &[]).unwrap_err().to_string(), "a row of 0 values for 1 columns");
    }
}
