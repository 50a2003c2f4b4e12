//! One drawn thing: what it logs at the beginning, for each stretch of frames, and when it settles.

use rerun::{EntityPath, EntityPathPart, RecordingStream, TimeColumn};

use super::error::ViewError;
use crate::system::observe::Frame;

/// The one timeline: simulated time.
pub(super) const TIMELINE: &str = "time";

/// A part of the picture.
pub(super) trait Layer: Send {
    /// Logs what stays the same.
    fn begin(&mut self, _out: &RecordingStream) -> Result<(), ViewError> {
        Ok(())
    }

    /// Logs a stretch of frames; never empty.
    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError>;

    /// Logs what sums up the run so far, replacing what it logged before.
    fn settle(&mut self, _out: &RecordingStream) -> Result<(), ViewError> {
        Ok(())
    }
}

/// Time column of a stretch.
pub(super) fn times(frames: &[Frame]) -> TimeColumn {
    time_column(frames.iter().map(|frame| frame.time_s))
}

/// Time column of some instants, s.
pub(super) fn time_column(times_s: impl IntoIterator<Item = f64>) -> TimeColumn {
    TimeColumn::new_duration_secs(TIMELINE, times_s)
}

/// Where the mechanism of a plain run stands.
pub(super) const WORLD: &str = "world";

/// Path of an entity; names may contain any character.
pub(super) fn path<const N: usize>(parts: [&str; N]) -> EntityPath {
    let parts: Vec<_> = parts.iter().map(|part| EntityPathPart::new(*part)).collect();
    EntityPath::from(parts)
}
