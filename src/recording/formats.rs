//! Files of recordings by what their name ends in.

use std::path::Path;

use super::{Recording, RecordingError, bag_read, parquet_read, read_csv, table};

/// How a file holds a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileFormat {
    /// Text; whatever is not called otherwise.
    Csv,
    /// `.parquet`
    Parquet,
    /// `.xlsx`: a workbook.
    Workbook,
    /// `.mcap`: a ROS 2 bag.
    Mcap,
}

/// Endings of files that are refused, and how to make one that is read.
const REFUSED: [(&str, &str); 6] = [
    (
        "mat",
        "MATLAB files are neither read nor written; make a CSV file of it: in MATLAB \
         `load run.mat; writetable(table(time_s(:), force_n(:), 'VariableNames', {'time_s','force_n'}), 'run.csv')`, \
         in Python `m = scipy.io.loadmat('run.mat', squeeze_me=True); \
         pandas.DataFrame({k: m[k] for k in ['time_s', 'force_n']}).to_csv('run.csv', index=False)` \
         (a file saved with -v7.3: save it again with -v7 first)",
    ),
    ("db3", "SQLite bags are not read; convert it to MCAP with `ros2 bag convert`"),
    ("bag", "ROS 1 bags are not read; write its topics to CSV with `rostopic echo -b RUN.bag -p /TOPIC`"),
    ("xls", "spreadsheets of the old format are not read; save it as .xlsx, or the sheet as CSV"),
    ("h5", "HDF5 files are not read; write the columns to CSV or Parquet, with pandas for one"),
    ("hdf5", "HDF5 files are not read; write the columns to CSV or Parquet, with pandas for one"),
];

impl FileFormat {
    /// What a path's ending says.
    ///
    /// # Errors
    /// A format that is known and not read, with how to convert it.
    pub fn of(path: &Path) -> Result<Self, RecordingError> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
        match ending.as_str() {
            "parquet" => return Ok(Self::Parquet),
            "mcap" => return Ok(Self::Mcap),
            "xlsx" => return Ok(Self::Workbook),
            _ => {}
        }
        match REFUSED.iter().find(|(refused, _)| *refused == ending) {
            Some((_, remedy)) => Err(RecordingError::Format { file: path.to_owned(), problem: (*remedy).to_owned() }),
            None => Ok(Self::Csv),
        }
    }
}

/// Reads a recording: a Parquet file or a bag where the file is called so, else CSV.
///
/// A null, a NaN or an empty cell is a missing sample and kept as NaN.
///
/// ```
/// use smam::columns::{Column, encode};
/// use smam::recording::read_recording;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let [csv, parquet] = ["sine.csv", "sine.parquet"].map(|name| folder.path().join(name));
/// std::fs::write(&csv, "time_s,plunger_mm\n0,0\n0.01,0.3\n")?;
/// let column = |name: &str, values: [f64; 2]| (name.to_owned(), Column::Numbers(values.to_vec()));
/// std::fs::write(&parquet, encode(&[column("time_s", [0.0, 0.01]), column("plunger_mm", [0.0, 0.3])])?)?;
/// assert_eq!(read_recording(&csv)?, read_recording(&parquet)?);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// As [`read_csv`]; a Parquet file without the time, or with columns that are no numbers; a bag without a topic that is
/// called as a column is.
pub fn read_recording(path: &Path) -> Result<Recording, RecordingError> {
    match FileFormat::of(path)? {
        FileFormat::Csv => read_csv(path),
        FileFormat::Workbook => table::read_plain_workbook(path),
        FileFormat::Parquet => parquet_read::read_parquet(path),
        FileFormat::Mcap => Ok(bag_read::read_bag(path, &[])?.recording),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_refused_with_a_way_out() {
        let refusal = |name: &str| read_recording(Path::new(name)).expect_err("refused").to_string();
        let said = refusal("rig/run.MAT");
        assert!(
            said.starts_with("rig/run.MAT: MATLAB files are neither read nor written; make a CSV file of it: "),
            "{said}"
        );
        assert!(said.contains("writetable(") && said.contains("scipy.io.loadmat(") && said.contains("-v7.3"), "{said}");
        assert!(refusal("run.db3").contains("ros2 bag convert"));
        let written = Recording::new(vec![0.0], vec![]).expect("one").write(Path::new("x.mat"));
        assert!(written.is_err());
    }
}
