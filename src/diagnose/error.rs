//! Why a diagnosis cannot begin.

use std::path::PathBuf;

use crate::identify::IdentifyError;
use crate::recording::RecordingError;
use crate::scene::SceneError;
use crate::system::SystemError;

/// Anything that keeps recordings from being diagnosed.
#[derive(Debug, thiserror::Error)]
pub enum DiagnoseError {
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    System(#[from] SystemError),
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    #[error("there is no run to look at\n  remedy: list runs as [[run]] file = \"...\" in recordings.toml")]
    Nothing,
    #[error(
        "{folder} is named twice\n  remedy: name each folder once: the runs that are held back must not be fitted too"
    )]
    Repeated { folder: PathBuf },
    #[error(
        "{first} and {other} are not of one rig: their scenes are {of_first} and {of_other}\n  \
         remedy: diagnose them one after the other"
    )]
    Scenes { first: PathBuf, other: PathBuf, of_first: String, of_other: String },
    #[error(
        "{folder}/recordings.toml does not declare {column}, which another folder does\n  \
         remedy: declare it there too, and list it under not_recorded in each [[run]] that lacks it"
    )]
    Undeclared { folder: PathBuf, column: String },
    #[error(
        "{file}: [[calibrate]] key = \"{key}\": the reduced-order model cannot vary it\n  \
         remedy: calibrate a number of tube, coil, friction, compliance, linear muscle, cable, joint spring or axis"
    )]
    Parameter { file: PathBuf, key: String },
    #[error("the scene cannot be simulated with what was recorded: {0}\n  remedy: try `smam compare` on the folder")]
    Simulation(String),
    #[error(
        "no specimen \"{name}\" stands beside others{}\n  remedy: name each run's in recordings.toml ([[run]] specimen = \"sample 1\") \
         and give one of them",
        match known.is_empty() { true => String::new(), false => format!(": there are {}", known.join(", ")) }
    )]
    Specimen { name: String, known: Vec<String> },
    #[error("{}: cannot be written: {source}\n  remedy: choose a folder that exists, may be written to and has room", file.display())]
    Write { file: PathBuf, source: std::io::Error },
}
