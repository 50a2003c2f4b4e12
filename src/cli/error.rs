//! Every way a command can fail, and the exit code for it.

use std::path::PathBuf;
use std::process::ExitCode;

use smam::diagnose::DiagnoseError;
use smam::identify::IdentifyError;
use smam::mechanism::MechanismError;
use smam::recording::RecordingError;
use smam::scene::SceneError;
use smam::sweep::SweepError;
use smam::system::{RunError, SystemError};

/// Why a command stopped.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    System(#[from] SystemError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    #[error(transparent)]
    Sweep(#[from] SweepError),
    #[error("{0}")]
    Usage(String),
    #[error("{}: cannot be written: {source}\n  remedy: choose a folder that exists, may be written to and has room", file.display())]
    Write { file: PathBuf, source: std::io::Error },
    #[error("{0}")]
    Failed(String),
    #[error(transparent)]
    Mechanism(#[from] MechanismError),
    #[cfg(feature = "validation")]
    #[error(transparent)]
    Validation(super::validation::ValidationError),
    #[cfg(feature = "viz")]
    #[error(transparent)]
    View(#[from] smam::view::ViewError),
}

impl CliError {
    /// 1 for what failed, 2 for what was asked wrongly.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::System(error)
            | Self::Identify(IdentifyError::System(error))
            | Self::Sweep(SweepError::System(error))
            | Self::Diagnose(DiagnoseError::System(error))
                if error.is_breakdown() =>
            {
                ExitCode::from(1)
            }
            Self::Diagnose(DiagnoseError::Write { .. })
            | Self::Write { .. }
            | Self::Recording(RecordingError::Write { .. })
            | Self::Sweep(SweepError::Write { .. })
            | Self::Failed(_) => ExitCode::from(1),
            #[cfg(feature = "validation")]
            Self::Validation(error) if error.is_unwritten() => ExitCode::from(1),
            #[cfg(feature = "viz")]
            Self::View(_) => ExitCode::from(1),
            _ => ExitCode::from(2),
        }
    }
}

impl From<RunError<CliError>> for CliError {
    fn from(error: RunError<CliError>) -> Self {
        match error {
            RunError::System(e) => Self::System(e),
            RunError::Observer(e) => e,
        }
    }
}
