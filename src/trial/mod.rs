//! The diagnosis on trial: every effect of the catalogue at three sizes, and scenes that lack nothing.
//!
//! The full scene makes the recordings ([`make_specimen`]), noise is added, and the diagnosis answers without knowing.
//! Sizes are counted from what the diagnosis itself says it could just see, so that 'small' means the same everywhere.
//!
//! A leak at three sizes takes minutes:
//!
//! ```no_run
//! use smam::trial::{plan, table, try_case};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let cases = plan("muscle_bench", 0, Some("leak"), 1)?;
//! let rows = cases.iter().map(try_case).collect::<Result<Vec<_>, _>>()?;
//! println!("{}", table(&rows));
//! # Ok(())
//! # }
//! ```

mod judge;
mod plan;
mod programme;
mod specimen;
mod table;

use std::path::{Path, PathBuf};

pub use judge::{Judgement, Row};
pub use plan::{Size, TrialCase, plan};
pub use specimen::make_specimen;
pub use table::table;

use crate::diagnose::{Case, DiagnoseError, Options, diagnose};
use crate::recording::RecordingError;
use crate::scene::SceneError;
use crate::system::SystemError;

/// Why a trial cannot be held.
#[derive(Debug, thiserror::Error)]
pub enum TrialError {
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    System(#[from] SystemError),
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    #[error("{file}: cannot be written: {source}\n  remedy: give another folder with --out")]
    Write { file: PathBuf, source: std::io::Error },
}

/// Makes the recordings of a case in a folder that is gone afterwards, diagnoses them, and compares.
///
/// # Errors
/// A scene that cannot be run, a folder that cannot be written.
pub fn try_case(case: &TrialCase) -> Result<Row, TrialError> {
    // By this name it is known after a kill.
    let folder = tempfile::Builder::new().prefix("smam-trial-").tempdir();
    let folder = folder.map_err(|source| TrialError::Write { file: std::env::temp_dir(), source })?;
    try_case_in(case, folder.path())
}

/// The same with the recordings left in `folder`, made where it is missing: `smam diagnose` gives the same answer on them.
///
/// # Errors
/// As for [`try_case`].
pub fn try_case_in(case: &TrialCase, folder: &Path) -> Result<Row, TrialError> {
    std::fs::create_dir_all(folder).map_err(|source| TrialError::Write { file: folder.to_owned(), source })?;
    make_specimen(&case.scene, case.effect.as_ref(), 1.0, case.seed, folder)?;
    let begun = std::time::Instant::now();
    let loaded = Case::load(&[folder], None, &[])?;
    let outcome = diagnose(loaded, Options { seed: case.seed }, &|_| {})?;
    Ok(judge::judge(case, &outcome, begun.elapsed().as_secs_f64()))
}
