//! The file that a run is recorded in, as it goes.

use std::io::{self, BufWriter, ErrorKind, Stdout};
use std::path::{Path, PathBuf};

use smam::recording::{FileFormat, RecordingError, RecordingWriter, RowWriter};
use smam::system::observe::{Frame, SceneGraph};

use super::CliError;

/// The name that means the standard output.
pub const STANDARD_OUTPUT: &str = "-";

/// A recording on its way into a file.
pub struct RunFile {
    path: PathBuf,
    /// From the run's beginning on.
    writer: Option<Writer>,
    rows: usize,
}

enum Writer {
    File(RecordingWriter),
    /// As CSV.
    Output(RowWriter<BufWriter<Stdout>>),
}

impl RunFile {
    /// A file of the format that its name says.
    pub fn new(path: &Path) -> Result<Self, CliError> {
        FileFormat::of(path)?;
        Ok(Self { path: path.to_owned(), writer: None, rows: 0 })
    }

    pub fn begin(&mut self, graph: &SceneGraph) -> Result<(), CliError> {
        let columns: Vec<&str> = graph.channels.iter().map(String::as_str).collect();
        if self.path.as_path() == Path::new(STANDARD_OUTPUT) {
            let rows = RowWriter::new(BufWriter::new(io::stdout()), &columns).map_err(failed_output)?;
            self.writer = Some(Writer::Output(rows));
            return Ok(());
        }
        if let Some(folder) = self.path.parent().filter(|p| !p.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|source| CliError::Write { file: folder.to_owned(), source })?;
        }
        let joints: Vec<String> = graph.joints.iter().map(|j| j.name.clone()).collect();
        let writer = RecordingWriter::create(&self.path, &columns, &joints).map_err(failed_write)?;
        self.writer = Some(Writer::File(writer));
        Ok(())
    }

    pub fn frame(&mut self, frame: &Frame) -> Result<(), CliError> {
        self.rows += 1;
        match &mut self.writer {
            None => Ok(()),
            Some(Writer::File(writer)) => {
                writer.row(frame.time_s, &frame.channels, &frame.joint_positions).map_err(failed_write)
            }
            Some(Writer::Output(rows)) => unless_closed(rows.row(frame.time_s, &frame.channels)),
        }
    }

    /// Puts what was computed before a failure beside the file's place, and says where; a former file stays.
    pub fn finish_as_part(self) -> Result<(), CliError> {
        let path = match self.writer.filter(|_| self.rows > 0) {
            None => return Ok(()),
            Some(Writer::File(writer)) => writer.finish_as_part().map_err(failed_write)?,
            Some(Writer::Output(rows)) => return unless_closed(rows.finish().map(drop)),
        };
        eprintln!("what was computed until then: {}", path.display());
        Ok(())
    }

    /// Puts the file in its place, complete or interrupted.
    pub fn finish(self) -> Result<(), CliError> {
        match self.writer {
            None => Ok(()),
            Some(Writer::File(writer)) => writer.finish().map_err(failed_write),
            Some(Writer::Output(rows)) => unless_closed(rows.finish().map(drop)),
        }
    }
}

/// A reader that has seen enough (`| head`) is no failure.
fn unless_closed(written: io::Result<()>) -> Result<(), CliError> {
    match written {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(failed_output(e)),
        _ => Ok(()),
    }
}

fn failed_output(error: io::Error) -> CliError {
    let remedy = "is the disk full that it goes to?";
    CliError::Failed(format!("--output -: the standard output cannot be written: {error}\n  remedy: {remedy}"))
}

/// A full disk or a closed folder is a failure, not wrong usage.
fn failed_write(error: RecordingError) -> CliError {
    CliError::Failed(error.to_string())
}
