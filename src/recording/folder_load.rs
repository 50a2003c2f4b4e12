//! The data of a declared run.

use super::bag_read::{found_in_bag, read_bag};
use super::table::read_declared;
use super::{Channel, ChannelSpec, FileFormat, LoadedRun, Recording, RecordingError, RecordingSet, Run, TableSource};
use std::path::Path;

impl RecordingSet {
    /// Reads a run's file and checks that every declared column is there; one that the run was recorded without is
    /// filled with missing samples.
    ///
    /// Columns that are not declared are kept where they are numbers, and named in a note.
    ///
    /// # Errors
    /// As [`read_recording`](super::read_recording); a declared column is missing, or there although it was said not to be; a file
    /// that [`Self::load_parts`] makes several runs of.
    pub fn load_run(&self, run: &Run) -> Result<LoadedRun, RecordingError> {
        let mut parts = self.load_parts(run)?;
        match (parts.pop(), parts.is_empty()) {
            (Some(only), true) => Ok(only),
            _ => Err(RecordingError::Format {
                file: self.dir.join(&run.file),
                problem:
                    "is several runs: its clock starts anew (split_at_restart)\n  remedy: give each a file of its \
                          own, and leave split_at_restart out"
                        .to_owned(),
            }),
        }
    }

    /// As [`Self::load_run`]; several where a run's clock started anew and `split_at_restart` says to split it there.
    ///
    /// # Errors
    /// As [`Self::load_run`].
    #[doc(hidden)]
    pub fn load_parts(&self, run: &Run) -> Result<Vec<LoadedRun>, RecordingError> {
        let file = self.dir.join(&run.file);
        let declared = self.channels_of(run);
        let parts = match FileFormat::of(&file)? {
            _ if !run.also.is_empty() => vec![self.load_joined(run, &declared)?],
            FileFormat::Mcap => {
                check_topics(&declared, &file)?;
                self.check_absent_from_bag(run, &file)?;
                vec![read_bag(&file, &declared)?]
            }
            FileFormat::Csv | FileFormat::Workbook | FileFormat::Parquet => {
                read_declared(&file, &declared, &run.layout)?
            }
        };
        let is_table = !matches!(FileFormat::of(&file)?, FileFormat::Mcap);
        let whole = |(index, LoadedRun { recording, mut notes }): (usize, LoadedRun)| {
            if is_table && index == 0 {
                notes.extend(self.undeclared_note(&recording).into_iter().chain(taken_as_it_stands(&declared)));
            }
            let missing: Vec<(&str, f64)> = run.not_recorded.iter().map(|column| (column.as_str(), f64::NAN)).collect();
            let recording = with_filled(recording, &missing, &NOT_RECORDED, &file)?;
            Ok(LoadedRun { recording: with_filled(recording, &self.constants(), &STOOD_STILL, &file)?, notes })
        };
        parts.into_iter().enumerate().map(whole).collect()
    }

    /// A table's columns are seen anyway; of a bag only those that are asked for.
    fn check_absent_from_bag(&self, run: &Run, file: &Path) -> Result<(), RecordingError> {
        let is_absent = |spec: &&ChannelSpec| run.not_recorded.contains(&spec.column);
        let absent: Vec<ChannelSpec> = self.channels.iter().filter(is_absent).cloned().collect();
        if absent.is_empty() {
            return Ok(());
        }
        found_in_bag(file, &absent)?.map_or(Ok(()), |column| Err(NOT_RECORDED.is_there(&column, file)))
    }

    /// Inputs that stood still, and where.
    fn constants(&self) -> Vec<(&str, f64)> {
        self.channels.iter().filter_map(|spec| Some((spec.column.as_str(), spec.constant?))).collect()
    }

    fn undeclared_note(&self, recording: &Recording) -> Option<String> {
        let is_declared = |column: &str| self.channels.iter().any(|spec| spec.column == column);
        let mut others = recording.columns();
        others.retain(|column| !is_declared(column));
        (!others.is_empty())
            .then(|| format!("columns that recordings.toml does not declare are not used: {}", others.join(", ")))
    }
}

/// Without a topic `name`, `unit`, `scale` and `zero` are a table's: a bag's numbers would be taken as they stand.
fn check_topics(declared: &[ChannelSpec], file: &Path) -> Result<(), RecordingError> {
    let unheeded = declared.iter().find(|spec| spec.bag.is_none() && spec.table != TableSource::default());
    unheeded.map_or(Ok(()), |spec| {
        let problem = format!(
            "column \"{}\": its name, unit, scale and zero are for tables\n  remedy: add topic = \"/NAME\" to its [[channel]], \
             which has unit and zero for bags",
            spec.column
        );
        Err(RecordingError::Format { file: file.to_owned(), problem })
    })
}

/// That a unit or a zero of a bag's channel is not applied to a table's column.
fn taken_as_it_stands(declared: &[ChannelSpec]) -> Option<String> {
    let converted = |spec: &&ChannelSpec| spec.bag.as_ref().is_some_and(|b| b.unit.is_some() || b.zero.is_some());
    let columns: Vec<&str> = declared.iter().filter(converted).map(|spec| spec.column.as_str()).collect();
    (!columns.is_empty())
        .then(|| format!("unit and zero are for bags: {} taken as in the file, convert there", columns.join(", ")))
}

/// Why a file lacks a column: what recordings.toml says of it, and what to do where it is there.
struct Lacking {
    said: &'static str,
    remedy: &'static str,
}

const NOT_RECORDED: Lacking = Lacking { said: "is not_recorded", remedy: "remove it from that list" };
const STOOD_STILL: Lacking = Lacking { said: "stood still (constant)", remedy: "remove constant from its [[channel]]" };

impl Lacking {
    fn is_there(&self, column: &str, file: &Path) -> RecordingError {
        let Self { said, remedy } = self;
        let problem = format!(
            "column \"{column}\" is there, and recordings.toml says that it {said}\n  remedy: {remedy}, or rename the column"
        );
        RecordingError::Format { file: file.to_owned(), problem }
    }
}

/// A recording with columns that its file lacks, each of one value; an empty one counts as lacking.
fn with_filled(
    recording: Recording,
    columns: &[(&str, f64)],
    why: &Lacking,
    file: &Path,
) -> Result<Recording, RecordingError> {
    if columns.is_empty() {
        return Ok(recording);
    }
    let mut channels = recording.channels().to_vec();
    for (column, value) in columns {
        if recording.find(column).is_some_and(|there| there.values.iter().any(|v| !v.is_nan())) {
            return Err(why.is_there(column, file));
        }
        channels.retain(|channel| channel.column != *column);
        channels.push(Channel::new(*column, vec![*value; recording.sample_count()]));
    }
    Recording::new(recording.time_s().to_vec(), channels).map_err(|e| e.in_file(file.display().to_string()))
}
