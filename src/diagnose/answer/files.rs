//! The answer as files.

use std::io;
use std::path::Path;

use super::outcome::Outcome;
use crate::diagnose::error::DiagnoseError;
use crate::files::{Staged, place_all};
use crate::recording::{Recording, RowWriter};

/// Written last: if it exists, the answer is complete.
const LAST: &str = "diagnosis.json";
/// Other files of an answer; `baseline.toml` is removed last, so that it marks an old answer until all of it is gone.
const OTHERS: [&str; 5] = ["report.html", "diagnosis.rrd", "next_experiment.csv", "scene.toml", "baseline.toml"];

/// Writes `diagnosis.json`, `scene.toml`, `baseline.toml` and `next_experiment.csv` (those that there are) into a folder,
/// in the place of a former answer.
///
/// # Errors
/// A folder that cannot be written; a fitted number that the scene's own checks refuse.
pub fn write_answer(outcome: &Outcome, folder: &Path) -> Result<(), DiagnoseError> {
    write_answer_with(outcome, &[], folder)
}

/// The same with additional files (name and text). An old answer stays until the new one is on the disk; then it is
/// removed, and `diagnosis.json` is named last.
///
/// # Errors
/// As [`write_answer`].
pub fn write_answer_with(outcome: &Outcome, more: &[(&str, &str)], folder: &Path) -> Result<(), DiagnoseError> {
    let stage = |name: &str, bytes: &[u8]| {
        let file = folder.join(name);
        Staged::write(&file, bytes).map_err(|source| DiagnoseError::Write { file, source })
    };
    let json = serde_json::to_string_pretty(&outcome.diagnosis)
        .map_err(|e| DiagnoseError::Write { file: folder.join(LAST), source: e.into() })?;
    let mut staged = Vec::new();
    for (name, text) in more {
        staged.push(stage(name, text.as_bytes())?);
    }
    if let Some(inputs) = &outcome.next_inputs {
        let name = "next_experiment.csv";
        let csv = csv(inputs).map_err(|source| DiagnoseError::Write { file: folder.join(name), source })?;
        staged.push(stage(name, &csv)?);
    }
    for (name, scene) in [("scene.toml", outcome.scene_text()), ("baseline.toml", outcome.baseline_text())] {
        if let Some(text) = scene {
            staged.push(stage(name, text?.as_bytes())?);
        }
    }
    for specimen in outcome.case.specimens().into_iter().skip(1) {
        if let Some(text) = outcome.scene_text_of(Some(specimen)) {
            staged.push(stage(&format!("scene_{}.toml", file_word(specimen)), text?.as_bytes())?);
        }
    }
    staged.push(stage(LAST, format!("{json}\n").as_bytes())?);
    remove_former(folder)?;
    place_all(staged).map_err(|(file, source)| DiagnoseError::Write { file, source })
}

/// A specimen's name as part of a file's.
fn file_word(specimen: &str) -> String {
    specimen.chars().map(|c| if c.is_alphanumeric() || c == '-' { c } else { '_' }).collect()
}

fn csv(recording: &Recording) -> io::Result<Vec<u8>> {
    let mut rows = RowWriter::new(Vec::new(), &recording.columns())?;
    rows.rows(recording)?;
    rows.finish()
}

/// Removes an old answer, so that no two are mixed. Other files in the folder stay: they may be somebody's own
/// `scene.toml`.
fn remove_former(folder: &Path) -> Result<(), DiagnoseError> {
    let is_there = |name: &&str| folder.join(name).is_file();
    if ![LAST, "baseline.toml"].iter().any(is_there) {
        return Ok(());
    }
    for name in [LAST].into_iter().chain(OTHERS) {
        let file = folder.join(name);
        match std::fs::remove_file(&file) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                return Err(DiagnoseError::Write { file, source });
            }
            _ => {}
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_former_answer_goes_and_a_scene_of_ones_own_stays() {
        let folder = tempfile::tempdir().unwrap();
        let put = |name: &str| std::fs::write(folder.path().join(name), "x").unwrap();
        let count = || std::fs::read_dir(folder.path()).unwrap().count();
        put("scene.toml");
        put("recordings.toml");
        remove_former(folder.path()).unwrap();
        assert_eq!(count(), 2);
        // What a kill left of an answer whose diagnosis.json was taken away already.
        for name in ["baseline.toml", "next_experiment.csv", "report.html"] {
            put(name);
        }
        remove_former(folder.path()).unwrap();
        assert_eq!(count(), 1);
        assert!(folder.path().join("recordings.toml").is_file());
    }
}
