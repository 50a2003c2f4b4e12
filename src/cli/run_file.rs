//! The file that a run is recorded in: CSV as it goes, Parquet and MCAP when it ends.

use std::path::{Path, PathBuf};

use smam::recording::{CsvWriter, FileFormat, JointPositions, RecordingError};
use smam::system::observe::{Frame, SceneGraph};

use super::CliError;
use super::observers::Recorder;

/// A recording on its way into a file.
pub struct RunFile {
    path: PathBuf,
    content: Content,
}

enum Content {
    Csv(Option<CsvWriter>),
    /// Formats that hold columns or an index are written whole.
    Kept(Recorder, JointPositions),
}

impl RunFile {
    /// A file of the format that its name says.
    pub fn new(path: &Path) -> Result<Self, CliError> {
        let content = match FileFormat::of(path)? {
            FileFormat::Csv => Content::Csv(None),
            FileFormat::Parquet | FileFormat::Mcap => Content::Kept(Recorder::default(), JointPositions::default()),
        };
        Ok(Self { path: path.to_owned(), content })
    }

    pub fn begin(&mut self, graph: &SceneGraph) -> Result<(), CliError> {
        if let Some(folder) = self.path.parent().filter(|p| !p.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|source| CliError::Write { file: folder.to_owned(), source })?;
        }
        match &mut self.content {
            Content::Csv(writer) => {
                let columns: Vec<&str> = graph.channels.iter().map(String::as_str).collect();
                *writer = Some(CsvWriter::create(&self.path, &columns).map_err(failed_write)?);
            }
            Content::Kept(recorder, joints) => {
                recorder.begin(graph);
                joints.names = graph.joints.iter().map(|j| j.name.clone()).collect();
            }
        }
        Ok(())
    }

    pub fn frame(&mut self, frame: &Frame) -> Result<(), CliError> {
        match &mut self.content {
            Content::Csv(Some(writer)) => writer.row(frame.time_s, &frame.channels).map_err(failed_write)?,
            Content::Csv(None) => {}
            Content::Kept(recorder, joints) => {
                recorder.frame(frame);
                joints.positions.push(frame.joint_positions.clone());
            }
        }
        Ok(())
    }

    /// Puts the file in its place, complete or interrupted.
    pub fn finish(self) -> Result<(), CliError> {
        match self.content {
            Content::Csv(writer) => writer.map_or(Ok(()), |w| w.finish().map_err(failed_write)),
            Content::Kept(recorder, joints) => recorder.finish()?.write(&self.path, &joints).map_err(failed_write),
        }
    }
}

/// A full disk or a closed folder is a failure, not wrong usage.
fn failed_write(error: RecordingError) -> CliError {
    CliError::Failed(error.to_string())
}
