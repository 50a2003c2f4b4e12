//! A stream's file: it has another name until the stream has ended as it should.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use rerun::RecordingStream;

use super::error::ViewError;
use crate::files::Unfinished;

/// The last bytes of a stream that has ended: this, and how many footers there are (four bytes).
const END: &[u8; 8] = b"RRF2FOOT";
const END_LENGTH: i64 = 12;

/// A file on its way.
pub(super) struct StreamFile(Unfinished);

impl StreamFile {
    pub(super) fn beside(path: &Path) -> Result<Self, ViewError> {
        let file = Unfinished::beside(path);
        file.map(Self).map_err(|source| ViewError::CannotWrite { path: path.to_owned(), source })
    }

    /// Where the stream goes.
    pub(super) fn temporary(&self) -> &Path {
        self.0.temporary()
    }

    /// The same file, to stand beside its place as a part.
    pub(super) fn as_part(self) -> Self {
        Self(self.0.as_part())
    }

    /// Gives the stream up; what was said of it, with the name of the file.
    pub(super) fn failed(&self, stream: &RecordingStream, error: ViewError) -> ViewError {
        abandon(stream);
        match error {
            ViewError::Unsent { detail, .. } => self.cannot_write(io::Error::other(detail)),
            other => other,
        }
    }

    /// Gives the file its name if the stream's end stands in it: of a disk that is full the stream itself says nothing.
    pub(super) fn place(self) -> Result<(), ViewError> {
        if let Err(source) = check_end(self.temporary()) {
            return Err(self.cannot_write(source));
        }
        let path = self.0.path().to_owned();
        self.0.place().map_err(|source| ViewError::CannotWrite { path, source })
    }

    fn cannot_write(&self, source: io::Error) -> ViewError {
        ViewError::CannotWrite { path: self.0.path().to_owned(), source }
    }
}

/// Leaves a stream to the end of the program. Dropped, it would wait for its writer, and where a full disk has ended that
/// thread, for ever.
pub(super) fn abandon(stream: &RecordingStream) {
    std::mem::forget(stream.clone());
}

fn check_end(path: &Path) -> io::Result<()> {
    let mut file = File::open(path)?;
    let mut end = [0; END.len()];
    let found = file.seek(SeekFrom::End(-END_LENGTH)).and_then(|_| file.read_exact(&mut end));
    match found {
        Ok(()) if &end == END => Ok(()),
        _ => Err(io::Error::other("the end of the stream could not be written")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stream_without_its_end_gets_no_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.rrd");
        for half in [&b""[..], b"RRF2", b"RRF2 and much more, but no end"] {
            let file = StreamFile::beside(&path).unwrap();
            std::fs::write(file.temporary(), half).unwrap();
            let said = file.place().unwrap_err().to_string();
            assert!(
                said.contains("run.rrd: cannot write: the end of the stream") && said.contains("free space"),
                "{said}"
            );
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        let file = StreamFile::beside(&path).unwrap();
        std::fs::write(file.temporary(), b"RRF2 ... RRF2FOOT\x01\0\0\0").unwrap();
        file.place().unwrap();
        assert!(path.is_file());
    }
}
