//! The file that a run is recorded in, as it goes.

use std::path::{Path, PathBuf};

use smam::recording::{FileFormat, RecordingError, RecordingWriter};
use smam::system::observe::{Frame, SceneGraph};

use super::CliError;

/// A recording on its way into a file.
pub struct RunFile {
    path: PathBuf,
    /// From the run's beginning on.
    writer: Option<RecordingWriter>,
    rows: usize,
}

impl RunFile {
    /// A file of the format that its name says.
    pub fn new(path: &Path) -> Result<Self, CliError> {
        FileFormat::of(path)?;
        Ok(Self { path: path.to_owned(), writer: None, rows: 0 })
    }

    pub fn begin(&mut self, graph: &SceneGraph) -> Result<(), CliError> {
        if let Some(folder) = self.path.parent().filter(|p| !p.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|source| CliError::Write { file: folder.to_owned(), source })?;
        }
        let columns: Vec<&str> = graph.channels.iter().map(String::as_str).collect();
        let joints: Vec<String> = graph.joints.iter().map(|j| j.name.clone()).collect();
        self.writer = Some(RecordingWriter::create(&self.path, &columns, &joints).map_err(failed_write)?);
        Ok(())
    }

    pub fn frame(&mut self, frame: &Frame) -> Result<(), CliError> {
        let Some(writer) = &mut self.writer else { return Ok(()) };
        self.rows += 1;
        writer.row(frame.time_s, &frame.channels, &frame.joint_positions).map_err(failed_write)
    }

    /// Puts what was computed before a failure beside the file's place, and says where; a former file stays.
    pub fn finish_as_part(self) -> Result<(), CliError> {
        let Some(writer) = self.writer.filter(|_| self.rows > 0) else { return Ok(()) };
        let path = writer.finish_as_part().map_err(failed_write)?;
        eprintln!("what was computed until then: {}", path.display());
        Ok(())
    }

    /// Puts the file in its place, complete or interrupted.
    pub fn finish(self) -> Result<(), CliError> {
        self.writer.map_or(Ok(()), |w| w.finish().map_err(failed_write))
    }
}

/// A full disk or a closed folder is a failure, not wrong usage.
fn failed_write(error: RecordingError) -> CliError {
    CliError::Failed(error.to_string())
}
