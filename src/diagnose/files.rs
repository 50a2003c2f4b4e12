//! The answer as files.

use std::path::Path;

use super::{DiagnoseError, Outcome};
use crate::recording::write_whole;

/// Writes `diagnosis.json`, `scene.toml`, `baseline.toml` and `next_experiment.csv` (those that there are) into a folder.
///
/// # Errors
/// A folder that cannot be written; a fitted number that the scene's own checks refuse.
pub fn write_answer(outcome: &Outcome, folder: &Path) -> Result<(), DiagnoseError> {
    let write = |name: &str, text: &str| {
        let file = folder.join(name);
        write_whole(&file, text).map_err(|source| DiagnoseError::Write { file, source })
    };
    let json = serde_json::to_string_pretty(&outcome.diagnosis)
        .map_err(|e| DiagnoseError::Write { file: folder.join("diagnosis.json"), source: e.into() })?;
    write("diagnosis.json", &format!("{json}\n"))?;
    if let Some(inputs) = &outcome.next_inputs {
        inputs.write_csv(&folder.join("next_experiment.csv"))?;
    }
    for (name, scene) in [("scene.toml", outcome.scene_text()), ("baseline.toml", outcome.baseline_text())] {
        if let Some(text) = scene {
            write(name, &text?)?;
        }
    }
    Ok(())
}
