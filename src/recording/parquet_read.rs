//! Reading a recording from Parquet: the columns of a CSV file by the same names.

use std::path::Path;

use super::source::open_file;
use super::{Channel, Recording, RecordingError, TIME_COLUMN};
use crate::columns::{Column, decode};

/// Reads the columns of a Parquet file.
pub(super) fn read_parquet(path: &Path) -> Result<Recording, RecordingError> {
    let file = path.display().to_string();
    let refuse = |problem: String| RecordingError::Format { file: path.to_owned(), problem };
    let mut columns = Vec::new();
    for (name, column) in columns_of(path)? {
        let values = column.numbers();
        columns.push((
            values.ok_or_else(|| refuse(format!("column \"{name}\" holds texts\n  remedy: leave it out")))?,
            name,
        ));
    }
    let names = || columns.iter().map(|(_, name)| name.as_str()).collect::<Vec<_>>().join(", ");
    let Some(at) = columns.iter().position(|(_, name)| name == TIME_COLUMN) else {
        return Err(refuse(format!(
            "no column \"{TIME_COLUMN}\" (found: {})\n  remedy: give the time in seconds",
            names()
        )));
    };
    let (time_s, _) = columns.remove(at);
    if time_s.is_empty() {
        return Err(RecordingError::NoData { file, what: "there is no row" });
    }
    let channels = columns.into_iter().map(|(values, name)| Channel::new(name, values));
    Recording::new(time_s, channels.collect()).map_err(|e| refuse(e.to_string()))
}

/// The columns of a Parquet file as it holds them.
pub(super) fn columns_of(path: &Path) -> Result<Vec<(String, Column)>, RecordingError> {
    decode(open_file(path)?).map_err(|e| RecordingError::Format { file: path.to_owned(), problem: unreadable(&e) })
}

/// What cannot be decoded may say itself what to do about it.
fn unreadable(problem: &str) -> String {
    if problem.contains("remedy: ") {
        return problem.to_owned();
    }
    format!("cannot be read as Parquet: {problem}\n  remedy: write the file again, or save it as CSV")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::columns::encode;

    fn read(table: &[(&str, Column)]) -> Result<Recording, RecordingError> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("run.parquet");
        let named: Vec<(String, Column)> = table.iter().map(|(n, c)| ((*n).to_owned(), c.clone())).collect();
        std::fs::write(&path, encode(&named).expect("encoded")).expect("written");
        read_parquet(&path)
    }

    #[test]
    fn columns_are_channels_and_nulls_are_missing() {
        let time = ("time_s", Column::Numbers(vec![0.0, 0.5]));
        let run =
            read(&[("a_mm", Column::Numbers(vec![1.0, f64::NAN])), time.clone(), ("n_s", Column::Whole(vec![3, 4]))]);
        let run = run.expect("a recording");
        assert_eq!((run.time_s(), run.columns()), (&[0.0, 0.5][..], vec!["a_mm", "n_s"]));
        assert!(run.channel("a_mm").expect("there").values[1].is_nan());
        assert_eq!(run.si("n_s").expect("there"), [3.0, 4.0]);
        let message = |table: &[(&str, Column)]| read(table).expect_err("wrong").to_string();
        assert!(message(&[("t", Column::Numbers(vec![0.0]))]).contains("no column \"time_s\" (found: t)"));
        let texts = ("note", Column::Texts(vec![None, Some("x".to_owned())]));
        assert!(message(&[time, texts]).contains("\"note\" holds texts"));
        assert!(message(&[("time_s", Column::Numbers(vec![1.0, 1.0]))]).contains("not after"));
    }
}
