//! What can go wrong while a figure is made.

use crate::recording::RecordingError;
use crate::scene::SceneError;
use crate::system::SystemError;

/// Why a figure of the paper could not be made again.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    System(#[from] SystemError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error("figure {figure}: {message}\n  remedy: {remedy}")]
    Figure { figure: &'static str, message: String, remedy: &'static str },
}

/// A figure that needs what the stock scene no longer gives.
pub(super) fn lacking(figure: &'static str, message: impl Into<String>) -> ReproduceError {
    ReproduceError::Figure {
        figure,
        message: message.into(),
        remedy: "run it with the stock scenes as they were delivered",
    }
}
