//! A folder of recordings: `recordings.toml` and one file per run.

use super::bag_source::BagSource;
use super::folder_keys::Keys;
use super::folder_tables::{TOP_KEYS, channels, check_format, check_outputs, layout, runs};
use super::source::unopened;
use super::table::FILE_KEYS;
use super::{AlsoFile, FileOptions, Recording, RecordingError, TableSource};
use crate::files::read_text;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use toml::Table;

/// Name of the file that says what the recordings of a folder are.
pub const SET_FILE_NAME: &str = "recordings.toml";

/// What a channel is to a simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Commanded and measured; drives the simulation.
    Input,
    /// What the simulation must reproduce.
    Output,
}

/// What a run may be used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunUse {
    /// To fit parameters.
    Fit,
    /// Held out, to test what was fitted.
    Holdout,
}

/// A declared channel.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelSpec {
    /// Its column, with the unit as suffix.
    pub column: String,
    /// Input or output.
    pub role: Role,
    /// Standard deviation of its noise in the column's unit, if stated.
    pub noise_sd: Option<f64>,
    /// Value at which an input stood that no file has, in the column's unit.
    pub constant: Option<f64>,
    /// Where a bag has it, if stated.
    pub bag: Option<BagSource>,
    /// Where a table has it, and in which unit.
    pub table: TableSource,
}

impl ChannelSpec {
    /// The name of its column in a table.
    pub(crate) fn name_in_table(&self) -> &str {
        self.table.name.as_deref().unwrap_or(&self.column)
    }
}

/// A declared run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Run {
    /// Its file, relative to the folder.
    pub file: String,
    /// Its use, if stated.
    pub run_use: Option<RunUse>,
    /// Known conditions, by a name that carries its unit: `hanging_mass_kg`.
    pub conditions: BTreeMap<String, f64>,
    /// Declared outputs that this run was recorded without: a sensor that was added later.
    pub not_recorded: Vec<String>,
    /// Which sample, or set-up, it was recorded on: calibrated numbers are each one's own.
    pub specimen: Option<String>,
    /// How its file is laid out.
    pub layout: FileOptions,
    /// Other files with channels of the same run.
    pub also: Vec<AlsoFile>,
}

impl Run {
    /// All its files, relative to the folder.
    #[doc(hidden)]
    pub fn files(&self) -> impl Iterator<Item = &str> {
        std::iter::once(self.file.as_str()).chain(self.also.iter().map(|also| also.file.as_str()))
    }
}

/// The recordings of one folder.
///
/// ```
/// use smam::recording::{RecordingSet, Role};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let set = r#"
/// format = 1
/// scene = "muscle_bench"
/// channel = [{ column = "plunger_mm", role = "input" }, { column = "elongation_mm", role = "output" }]
/// run = [{ file = "sine.csv", use = "fit", hanging_mass_kg = 0.05 }]
/// "#;
/// std::fs::write(folder.path().join("recordings.toml"), set)?;
/// let sine = "time_s,plunger_mm,elongation_mm,room_v\n0,0,0,1\n0.01,0.1,0.9,1\n";
/// std::fs::write(folder.path().join("sine.csv"), sine)?;
/// let set = RecordingSet::load(folder.path())?;
/// assert_eq!(set.of_role(Role::Output).map(|c| c.column.as_str()).collect::<Vec<_>>(), ["elongation_mm"]);
/// assert_eq!(set.runs[0].conditions["hanging_mass_kg"], 0.05);
/// let run = set.load_run(&set.runs[0])?;
/// assert!(run.recording.sample_count() == 2 && run.notes[0].contains("room_v"));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingSet {
    /// The folder.
    pub dir: PathBuf,
    /// Scene by name or path, as written.
    pub scene: String,
    /// Declared channels.
    pub channels: Vec<ChannelSpec>,
    /// Declared runs.
    pub runs: Vec<Run>,
}

/// A run's data.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedRun {
    /// Every column of the file.
    pub recording: Recording,
    /// What the user should know of it; empty when nothing.
    pub notes: Vec<String>,
}

impl RecordingSet {
    /// Reads `recordings.toml`, given its folder or itself.
    ///
    /// # Errors
    /// File, table, key and remedy of the first thing that is wrong.
    pub fn load(path: &Path) -> Result<Self, RecordingError> {
        let file = match path.is_file() {
            true => path.to_owned(),
            false => path.join(SET_FILE_NAME),
        };
        let text = read_text(&file).map_err(|source| unreadable(&file, source))?;
        Self::parse(&text, &file)
    }

    /// What the `recordings.toml` beside a file declares it to be; `None` where there is none, or where no run names the file.
    ///
    /// # Errors
    /// As [`RecordingSet::load`].
    pub fn declaring(file: &Path) -> Result<Option<(Self, Run)>, RecordingError> {
        let set = file.parent().unwrap_or(Path::new("")).join(SET_FILE_NAME);
        if !set.is_file() {
            return Ok(None);
        }
        let text = read_text(&set).map_err(|source| unreadable(&set, source))?;
        let own = Self::parse_channels(&text, &set, |_, _| Ok(()))?;
        let is_its = |run: &&Run| file.file_name().is_some_and(|name| Path::new(&run.file) == Path::new(name));
        Ok(own.runs.iter().find(is_its).cloned().map(|run| (own, run)))
    }

    /// Parses the text of a `recordings.toml`; `file` is where it stands.
    ///
    /// # Errors
    /// As [`RecordingSet::load`].
    #[doc(hidden)]
    pub fn parse(text: &str, file: &Path) -> Result<Self, RecordingError> {
        Self::parse_channels(text, file, check_outputs)
    }

    fn parse_channels(
        text: &str,
        file: &Path,
        check: impl Fn(&Keys<'_>, &[ChannelSpec]) -> Result<(), RecordingError>,
    ) -> Result<Self, RecordingError> {
        let table: Table = toml::from_str(text).map_err(|error| RecordingError::Toml {
            file: file.to_owned(),
            problem: error.to_string().trim_end().to_owned(),
        })?;
        let top = Keys::new(file, "top level", &table);
        check_format(&top)?;
        top.refuse_keys_of("[file]", &FILE_KEYS)?;
        top.refuse_unknown(&TOP_KEYS)?;
        let channels = channels(&top, file)?;
        check(&top, &channels)?;
        let layout = layout(&top, file)?;
        Ok(Self {
            dir: file.parent().unwrap_or(Path::new("")).to_owned(),
            scene: top.required_text("scene", "muscle_bench")?.to_owned(),
            runs: runs(&top, file, &channels, &layout)?,
            channels,
        })
    }

    /// Where its scene is: a path is relative to the recordings, anything else a stock name.
    pub fn scene_path(&self) -> String {
        let beside = self.dir.join(&self.scene);
        if beside.is_file() { beside.display().to_string() } else { self.scene.clone() }
    }

    /// The declared channels of one role.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &ChannelSpec> {
        self.channels.iter().filter(move |spec| spec.role == role)
    }

    /// The declared channels that a run's file has.
    pub fn channels_of(&self, run: &Run) -> Vec<ChannelSpec> {
        let is_there = |spec: &&ChannelSpec| spec.constant.is_none() && !run.not_recorded.contains(&spec.column);
        self.channels.iter().filter(is_there).cloned().collect()
    }
}

/// A file that is there but no text has another remedy than one that is not there.
fn unreadable(file: &Path, source: std::io::Error) -> RecordingError {
    let file = file.to_owned();
    match source.kind() {
        std::io::ErrorKind::InvalidData => {
            let problem = "it is not UTF-8 text\n  remedy: save it as text in UTF-8".to_owned();
            RecordingError::Key { file, table: "encoding".to_owned(), problem }
        }
        _ => unopened(&file, source),
    }
}

#[cfg(test)]
#[path = "folder_tests.rs"]
mod tests;
