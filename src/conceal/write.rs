//! A case as files: what everyone may see, what is kept back, and the sealed answer.

use std::fmt::Write as _;
use std::path::Path;

use super::ConcealError;
use super::case::{Drawn, Truth};
use super::seal::{seal, sealed_text};
use crate::files::write_whole;

/// Folder of sealed answers inside a folder of cases.
pub const SEALED: &str = "sealed";

/// Writes `NAME/` (recordings), `NAME.holdout.csv` and, of a law, `NAME.larger.csv` (kept back) and `sealed/NAME.json` (the answer) into `folder`; returns
/// the seal.
///
/// # Errors
/// A folder that cannot be written.
pub fn write_case(drawn: &Drawn, folder: &Path) -> Result<String, ConcealError> {
    let name = &drawn.truth.name;
    let sealed = folder.join(SEALED).join(format!("{name}.json"));
    let text = sealed_text(&drawn.truth).map_err(|e| ConcealError::Write { file: sealed.clone(), source: e.into() })?;
    let own = folder.join(name);
    std::fs::create_dir_all(&own).map_err(|source| ConcealError::Write { file: own.clone(), source })?;
    for (file, recording) in &drawn.runs {
        recording.write_csv(&own.join(file))?;
    }
    drawn.holdout.write_csv(&folder.join(format!("{name}.holdout.csv")))?;
    if let Some(larger) = &drawn.larger {
        larger.write_csv(&folder.join(format!("{name}.larger.csv")))?;
    }
    write(&sealed, &text)?;
    // Last: a folder with this file is whole.
    write(&own.join("recordings.toml"), &recordings_toml(drawn))?;
    Ok(seal(&text))
}

/// Whether another case lies in the folder under this one's name. The same one does where a run before was interrupted, or is repeated.
#[doc(hidden)]
pub fn is_another_there(truth: &Truth, folder: &Path) -> bool {
    // The last file of a case: without it none was written whole.
    if !folder.join(&truth.name).join("recordings.toml").exists() {
        return false;
    }
    let sealed = std::fs::read_to_string(folder.join(SEALED).join(format!("{}.json", truth.name))).ok();
    sealed.is_none() || sealed != sealed_text(truth).ok()
}

fn recordings_toml(drawn: &Drawn) -> String {
    let truth = &drawn.truth;
    let mut text = format!("format = 1\nscene = \"{}\"\n", truth.rig.scene());
    for column in truth.rig.inputs() {
        let _ = write!(text, "\n[[channel]]\ncolumn = \"{column}\"\nrole = \"input\"\n");
    }
    for (output, noise) in truth.rig.outputs().iter().zip(&truth.noise) {
        if drawn.holdout.find(output.column).is_some() {
            let _ = write!(text, "\n[[channel]]\ncolumn = \"{}\"\nrole = \"output\"\n", output.column);
            if truth.is_noise_stated {
                let _ = writeln!(text, "noise_sd = {:.4}", noise.sd);
            }
        }
    }
    for (file, _) in &drawn.runs {
        let _ = write!(text, "\n[[run]]\nfile = \"{file}\"\n");
    }
    text
}

fn write(path: &Path, text: &str) -> Result<(), ConcealError> {
    write_whole(path, text).map_err(|source| ConcealError::Write { file: path.to_path_buf(), source })
}
