//! What can go wrong while showing a run, with the remedy.

use std::path::PathBuf;

use rerun::sink::{FileSinkError, SinkFlushError};
use rerun::{RecordingStreamError, SerializationError};

/// Why a run cannot be shown.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    #[error(
        "the Rerun viewer (`rerun`) is not in PATH: `pip install rerun-sdk==0.36.3`, \
         or save with `--rrd FILE` and open the file on another machine"
    )]
    ViewerNotFound,

    #[error(
        "no display to open a viewer window on (DISPLAY and WAYLAND_DISPLAY are unset): \
         save with `--rrd FILE`, or use `--serve` and forward the port"
    )]
    NoDisplay,

    #[error("the Rerun viewer did not start: {detail}; save with `--rrd FILE` instead")]
    ViewerFailed { detail: String },

    #[error("{path}: cannot write: {source}; check the folder, its rights and the free space")]
    CannotWrite { path: PathBuf, source: std::io::Error },

    #[error("port {port} on 127.0.0.1 is not free: {source}; choose another port (0 picks a free one)")]
    PortTaken { port: u16, source: std::io::Error },

    #[error("a frame came before the scene: call `begin` first")]
    NotBegun,

    #[error("`begin` was called twice: use a new `Viewer` for each run")]
    AlreadyBegun,

    #[error(
        "frame at {time_s} s has {found} {what}, the scene has {expected}: \
         fill every frame in the order of its `SceneGraph`"
    )]
    FrameShape { time_s: f64, what: &'static str, expected: usize, found: usize },

    #[error(
        "scene graph: {what} refers to number {index}, but there are only {count}: \
         indices start at 0"
    )]
    BadIndex { what: &'static str, index: usize, count: usize },

    #[error("no recorded run to show: a comparison needs at least one")]
    NothingToCompare,

    #[error("not everything reached the viewer or file within {seconds} s: {detail}")]
    Unsent { seconds: u64, detail: String },

    #[error("Rerun refused the data: {detail}")]
    Refused { detail: String },
}

impl From<RecordingStreamError> for ViewError {
    fn from(error: RecordingStreamError) -> Self {
        ViewError::Refused { detail: error.to_string() }
    }
}

impl From<SerializationError> for ViewError {
    fn from(error: SerializationError) -> Self {
        ViewError::Refused { detail: error.to_string() }
    }
}

impl ViewError {
    /// Error of a file that could not be opened.
    pub(super) fn opening(path: &std::path::Path, error: RecordingStreamError) -> Self {
        match error {
            RecordingStreamError::FileSink(FileSinkError::CreateFile { source, .. }) => {
                ViewError::CannotWrite { path: path.to_owned(), source }
            }
            other => other.into(),
        }
    }

    /// Error of a flush that did not get through in `seconds`.
    pub(super) fn unsent(seconds: u64, error: &SinkFlushError) -> Self {
        ViewError::Unsent { seconds, detail: error.to_string() }
    }
}
