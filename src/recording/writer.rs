//! Writing recordings row by row, in every format.

use std::io;
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::csv_write::{check_width, write_error};
use super::{CsvWriter, FileFormat, Recording, RecordingError, TIME_COLUMN};
use crate::bag::BagWriter;
use crate::columns::NumberRows;
use crate::files::{part_place, put_in_place, temporary_beside};

/// A recording on its way into a file of the format that its name says.
///
/// Rows stream to the disk, so that memory does not grow with them. The file has another name until
/// [`RecordingWriter::finish`]; dropped without it, nothing is left and a former file of that name is untouched.
///
/// ```
/// use smam::recording::{RecordingWriter, read_recording};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// for name in ["sine.csv", "sine.parquet", "sine.mcap"] {
///     let path = folder.path().join(name);
///     let mut writer = RecordingWriter::create(&path, &["force_n"], &[])?;
///     writer.row(0.0, &[0.05], &[])?;
///     writer.row(0.01, &[0.06], &[])?;
///     assert!(!path.exists());
///     writer.finish()?;
///     assert_eq!(read_recording(&path)?.channel("force_n")?.values, [0.05, 0.06]);
/// }
/// # Ok(())
/// # }
/// ```
pub struct RecordingWriter {
    path: PathBuf,
    column_count: usize,
    rows: Rows,
}

enum Rows {
    Csv(CsvWriter),
    Parquet(Box<NumberRows<NamedTempFile>>),
    Mcap(Box<BagWriter<NamedTempFile>>),
}

impl RecordingWriter {
    /// Starts a file with columns `time_s` and `columns`; the joints go into a bag, the other formats have no place for them.
    ///
    /// # Errors
    /// A format that is not written; the folder does not exist or cannot be written to.
    pub fn create(path: &Path, columns: &[&str], joints: &[String]) -> Result<Self, RecordingError> {
        let begun = |format| -> io::Result<Rows> {
            let target = temporary_beside(path)?;
            Ok(match format {
                FileFormat::Mcap => Rows::Mcap(Box::new(BagWriter::new(target, columns, joints)?)),
                _ => Rows::Parquet(Box::new(NumberRows::new(target, &[&[TIME_COLUMN], columns].concat())?)),
            })
        };
        let rows = match FileFormat::of(path)? {
            FileFormat::Csv => Rows::Csv(CsvWriter::create(path, columns)?),
            format => begun(format).map_err(|source| write_error(path, source))?,
        };
        Ok(Self { path: path.to_owned(), column_count: columns.len(), rows })
    }

    /// Writes one row: the time (s), one value per column in the column's unit, one position per joint (rad, m for sliders).
    ///
    /// # Errors
    /// The file cannot be written, or the number of values is not that of the columns.
    pub fn row(&mut self, time_s: f64, values: &[f64], joint_positions: &[f64]) -> Result<(), RecordingError> {
        let width = check_width(values.len(), self.column_count);
        let written = match &mut self.rows {
            Rows::Csv(csv) => return csv.row(time_s, values),
            Rows::Parquet(rows) => width.and_then(|()| rows.row(&[&[time_s], values].concat())),
            Rows::Mcap(bag) => width.and_then(|()| bag.instant(time_s, values, joint_positions)),
        };
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

    /// Ends the file of a run that failed beside its place, by [`crate::files::part_name`]: a former file of its name is untouched.
    /// Returns where it is.
    ///
    /// # Errors
    /// As [`RecordingWriter::finish`].
    pub fn finish_as_part(self) -> Result<PathBuf, RecordingError> {
        let path = part_place(&self.path);
        self.finish_as(&path)?;
        Ok(path)
    }

    fn finish_as(self, path: &Path) -> Result<(), RecordingError> {
        let ended = match self.rows {
            Rows::Csv(csv) => return csv.finish_as(path),
            Rows::Parquet(rows) => rows.finish(),
            Rows::Mcap(bag) => bag.finish(),
        };
        ended.and_then(|file| put_in_place(file, path)).map_err(|source| write_error(path, source))
    }
}

impl Recording {
    /// Writes the recording in the format that the path's ending says.
    ///
    /// # Errors
    /// As [`RecordingWriter::create`] and [`RecordingWriter::row`].
    pub fn write(&self, path: &Path) -> Result<(), RecordingError> {
        let mut writer = RecordingWriter::create(path, &self.columns(), &[])?;
        for (index, time_s) in self.time_s().iter().enumerate() {
            let values: Vec<f64> = self.channels().iter().map(|c| c.values[index]).collect();
            writer.row(*time_s, &values, &[])?;
        }
        writer.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Channel, read_recording};

    const FORMATS: [&str; 3] = ["run.csv", "run.parquet", "run.mcap"];

    #[test]
    fn what_is_written_is_read_back_in_every_format() {
        let folder = tempfile::tempdir().expect("a folder");
        let channels = vec![
            Channel::new("plunger_mm", vec![0.0, 1.0 / 3.0, -2.5]),
            Channel::new("force_n", vec![1e-7, f64::NAN, 3.0]),
        ];
        let recording = Recording::new(vec![0.0, 0.01, 0.02], channels).expect("a recording");
        for name in FORMATS {
            let path = folder.path().join(name);
            recording.write(&path).expect("written");
            let back = read_recording(&path).expect("read");
            assert_eq!((back.time_s(), back.columns()), (recording.time_s(), recording.columns()), "{name}");
            assert_eq!(back.channels()[0], recording.channels()[0], "{name}");
            let force = &back.channels()[1].values;
            assert!(force[0] == 1e-7 && force[1].is_nan() && force[2] == 3.0, "{name}: {force:?}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 3);
    }

    /// More rows than one group of a Parquet file and one chunk of a bag hold; ended after them, or given up.
    #[test]
    fn many_rows_stream_and_what_is_given_up_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in FORMATS {
            let path = folder.path().join(name);
            let begun = |rows: usize| {
                let mut writer = RecordingWriter::create(&path, &["force_n"], &[]).expect("begun");
                (0..rows).for_each(|i| writer.row(i as f64 * 1e-3, &[i as f64], &[]).expect("written"));
                writer
            };
            begun(70_000).finish().expect("in place");
            drop(begun(10));
            let force = read_recording(&path).expect("read").channel("force_n").expect("it").values.clone();
            assert!(force.len() == 70_000 && force.iter().enumerate().all(|(i, v)| *v == i as f64), "{name}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 3);
    }

    #[test]
    fn a_row_has_a_value_for_each_column() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in FORMATS {
            let mut writer = RecordingWriter::create(&folder.path().join(name), &["force_n"], &[]).expect("begun");
            let said = writer.row(0.0, &[1.0, 2.0], &[]).expect_err("one too many").to_string();
            assert!(said.contains(&format!("{name}: cannot be written: a row of 2 values for 1 columns")), "{said}");
        }
    }

    #[test]
    fn a_run_of_no_row_is_a_file_all_the_same() {
        let folder = tempfile::tempdir().expect("a folder");
        for name in FORMATS {
            let path = folder.path().join(name);
            RecordingWriter::create(&path, &["force_n"], &[]).expect("begun").finish().expect("in place");
            assert!(path.metadata().expect("there").len() > 0);
        }
    }
}
