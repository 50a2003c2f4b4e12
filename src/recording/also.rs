//! `[[run.also]]`: other files of a run. A camera, a tracker or a second logger writes its own, with a clock of its own.

use super::folder_keys::Keys;
use super::table::{FILE_KEYS, file_options};
use super::{FileOptions, RecordingError};
use crate::nearest::did_you_mean;

/// Keys of `[[run.also]]` beside those of `[file]`.
pub(super) const ALSO_KEYS: [&str; 2] = ["file", "starts_s"];

/// A further file of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AlsoFile {
    /// Its file, relative to the folder.
    pub file: String,
    /// Where its time 0 lies in the time of the run's file, s. Stamps in both files say it themselves.
    pub starts_s: Option<f64>,
    /// How it is laid out. What `[file]` says does not hold for it: another program wrote it.
    pub layout: FileOptions,
}

/// The further files of a run.
pub(super) fn also(run: &Keys<'_>, own: &str, layout: &FileOptions) -> Result<Vec<AlsoFile>, RecordingError> {
    let mut files: Vec<AlsoFile> = Vec::new();
    for keys in run.tables_below("run", "also")? {
        let file = one(&keys)?;
        if file.file == own || files.iter().any(|f| f.file == file.file) {
            return Err(keys.error("the file is listed twice in this run\n  remedy: remove one of the two"));
        }
        files.push(file);
    }
    if !files.is_empty() && needs_one_clock(layout) {
        return Err(run.error(NEEDS_ONE_CLOCK));
    }
    Ok(files)
}

const NEEDS_ONE_CLOCK: &str = "files of one run are brought to one clock, and this one has none (time = \"index\") or several \
    (split_at_restart)\n  remedy: say interval_s for rows at an even pace; split the file where its clock starts anew";

fn needs_one_clock(layout: &FileOptions) -> bool {
    layout.counts_rows() || layout.split_at_restart
}

fn one(keys: &Keys<'_>) -> Result<AlsoFile, RecordingError> {
    let known = [&ALSO_KEYS[..], &FILE_KEYS].concat();
    if let Some(odd) = keys.others(&known).first() {
        return Err(keys.error(format!(
            "unknown key \"{odd}\"{}\n  remedy: the keys here are {} and those of [file]",
            did_you_mean(odd, &known),
            ALSO_KEYS.join(", ")
        )));
    }
    let layout = file_options(keys, &FileOptions::default())?;
    if needs_one_clock(&layout) {
        return Err(keys.error(NEEDS_ONE_CLOCK));
    }
    Ok(AlsoFile {
        file: keys.required_text("file", "camera.csv")?.to_owned(),
        starts_s: keys.number("starts_s")?,
        layout,
    })
}
