//! What can go wrong when a scene is built or run.

use std::path::PathBuf;

use crate::mechanism::MechanismError;
use crate::muscle::MuscleError;
use crate::recording::RecordingError;

/// A scene that cannot be built, or a run that cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum SystemError {
    #[error("{}: {source}", file.display())]
    Mechanism { file: PathBuf, source: MechanismError },
    #[error("{}: [muscles]: {source}\n  remedy: give a number in that range, in SI units", file.display())]
    Muscle { file: PathBuf, source: MuscleError },
    #[error("{}: {table}: {message}\n  remedy: {remedy}", file.display())]
    Name { file: PathBuf, table: String, message: String, remedy: String },
    #[error(
        "the run diverged at {time_s:.6} s: {what} is not a finite number\n  \
         remedy: halve simulation.step_s or double simulation.substeps; if it stays, look for a stiffness, mass or \
         damping that is off by orders of magnitude"
    )]
    Diverged { time_s: f64, what: String },
    #[error(
        "{}: [[law]] {law}: at {time_s:.4} s {what}\n  \
         remedy: bound the expression (max(x, 0), x/(1 + abs(x))), give its parameters other values, or, where a state runs away, \
         make its time constant longer or simulation.step_s shorter",
        file.display()
    )]
    Law { file: PathBuf, time_s: f64, law: String, what: String },
    #[error(transparent)]
    Recording(#[from] RecordingError),
}

impl SystemError {
    /// Whether the run began and could not go on: it diverged, or a law left the range in which it has a value.
    #[must_use]
    #[doc(hidden)]
    pub const fn is_breakdown(&self) -> bool {
        matches!(self, Self::Diverged { .. } | Self::Law { .. })
    }
}
