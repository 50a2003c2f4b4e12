//! What can be wrong with a mechanism, each error naming the place and the remedy.

use std::path::{Path, PathBuf};

/// Why a mechanism could not be loaded.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MechanismError {
    /// A file named by the scene or the URDF cannot be read.
    #[error("{}: cannot be read: {reason}\n  remedy: {remedy}", file.display())]
    Read { file: PathBuf, reason: String, remedy: String },
    /// The file is not a URDF.
    #[error("{}: not a valid URDF: {reason}\n  remedy: correct the XML there; a URDF is one <robot> with links and joints", file.display())]
    Parse { file: PathBuf, reason: String },
    /// One element of the URDF cannot be simulated as written.
    #[error("{}: {element} \"{name}\": {problem}\n  remedy: {remedy}", file.display())]
    Urdf {
        file: PathBuf,
        element: &'static str,
        name: String,
        /// The offending value and the rule it breaks.
        problem: String,
        remedy: String,
    },
    /// One entry of the scene's `[mechanism]` table is wrong.
    #[error("[mechanism] {table} \"{name}\": {problem}\n  remedy: {remedy}")]
    Spec {
        table: &'static str,
        name: String,
        /// The offending value and the rule it breaks.
        problem: String,
        remedy: String,
    },
}

impl MechanismError {
    pub(super) fn urdf(
        file: &Path,
        element: &'static str,
        name: &str,
        problem: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self::Urdf {
            file: file.to_path_buf(),
            element,
            name: name.to_owned(),
            problem: problem.into(),
            remedy: remedy.into(),
        }
    }

    pub(super) fn spec(table: &'static str, name: &str, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Spec { table, name: name.to_owned(), problem: problem.into(), remedy: remedy.into() }
    }
}

/// `name one of "a", "b"` for a remedy that lists what could have been meant.
pub(super) fn known_names<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = names.map(|n| format!("\"{n}\"")).collect();
    format!("name one of {}", quoted.join(", "))
}
