//! Files that are read, opened with care: what is no file, never ends or changes meanwhile is refused.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::RecordingError;
use crate::files;

/// No line of a text is longer, header included: ten thousand columns with names of a hundred letters.
const LONGEST_LINE_BYTES: usize = 1 << 20;

/// No workbook is longer: a million rows of ten columns have half of it.
const LONGEST_BOOK_BYTES: u64 = 1 << 28;

/// Opens a file, as [`files::open`].
pub(super) fn open_file(path: &Path) -> Result<File, RecordingError> {
    files::open(path).map_err(|source| unopened(path, source))
}

/// Why a file cannot be opened, in a recording's words.
pub(super) fn unopened(path: &Path, source: io::Error) -> RecordingError {
    let file = path.to_owned();
    match source.kind() {
        io::ErrorKind::InvalidInput => RecordingError::Format {
            file,
            problem: format!("{source}\n  remedy: save its content as a file, and name that"),
        },
        _ => RecordingError::Read { file, source },
    }
}

/// The bytes of a text file that stays as it is while it is read: half a number is a number too.
pub(super) fn read_settled(path: &Path) -> Result<Vec<u8>, RecordingError> {
    let failed = |source| RecordingError::Read { file: path.to_owned(), source };
    let mut file = open_file(path)?;
    let before = file.metadata().map_err(failed)?.len();
    let bytes = read_lines(&mut file).map_err(|e| e.in_reading(path))?;
    let after = file.metadata().map_err(failed)?.len();
    match before == after && bytes.len() as u64 == after {
        true => Ok(bytes),
        false => Err(RecordingError::Format { file: path.to_owned(), problem: changed(before, after) }),
    }
}

/// The bytes of a file that is no text; of no more than [`LONGEST_BOOK_BYTES`].
pub(super) fn read_whole(path: &Path) -> Result<Vec<u8>, RecordingError> {
    let failed = |source| RecordingError::Read { file: path.to_owned(), source };
    let mut bytes = Vec::new();
    open_file(path)?.take(LONGEST_BOOK_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 <= LONGEST_BOOK_BYTES {
        return Ok(bytes);
    }
    let problem = format!("has more than {LONGEST_BOOK_BYTES} bytes\n  remedy: save its sheet as CSV");
    Err(RecordingError::Format { file: path.to_owned(), problem })
}

fn changed(before: u64, after: u64) -> String {
    format!(
        "it changed while it was read, from {before} to {after} bytes\n  remedy: wait until it is written, then start again"
    )
}

/// Why lines cannot be read.
#[derive(Debug)]
pub(super) enum Unread {
    Source(io::Error),
    /// Line, from 1.
    Long(u64),
}

impl Unread {
    pub(super) fn in_reading(self, path: &Path) -> RecordingError {
        match self {
            Self::Source(source) => RecordingError::Read { file: path.to_owned(), source },
            Self::Long(line) => {
                let problem = format!(
                    "has more than {LONGEST_LINE_BYTES} bytes\n  remedy: save the file as CSV, with one line for each sample"
                );
                RecordingError::Line { file: path.display().to_string(), line, problem }
            }
        }
    }
}

/// Everything that a source gives, unless a line does not end: so a file without lines is not read to its end.
pub(super) fn read_lines(mut source: impl Read) -> Result<Vec<u8>, Unread> {
    let mut bytes = Vec::new();
    let mut line_start = 0;
    loop {
        let before = bytes.len();
        let part = LONGEST_LINE_BYTES as u64;
        let read = source.by_ref().take(part).read_to_end(&mut bytes).map_err(Unread::Source)?;
        if read == 0 {
            return Ok(bytes);
        }
        if let Some(last) = bytes[before..].iter().rposition(|byte| matches!(byte, b'\n' | b'\r')) {
            line_start = before + last + 1;
        }
        if bytes.len() - line_start > LONGEST_LINE_BYTES {
            let ended = bytes[..line_start].iter().filter(|byte| **byte == b'\n').count();
            return Err(Unread::Long(ended as u64 + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_does_not_end_is_left_soon() {
        let endless = b"time_s,a_mm\n0,".as_slice().chain(io::repeat(b'1'));
        assert!(matches!(read_lines(endless), Err(Unread::Long(2))));
        let text = "0,1\n".repeat(LONGEST_LINE_BYTES);
        assert!(read_lines(text.as_bytes()).is_ok_and(|bytes| bytes == text.as_bytes()));
        let said = Unread::Long(2).in_reading(Path::new("a.csv")).to_string();
        assert!(said.starts_with("a.csv: line 2: has more than 1048576 bytes\n  remedy: "), "{said}");
    }

    #[test]
    fn what_is_no_file_is_refused() {
        #[cfg(unix)]
        {
            let said = read_settled(Path::new("/dev/zero")).unwrap_err().to_string();
            assert!(said.starts_with("/dev/zero: it is a pipe or a device") && said.contains("remedy: "), "{said}");
        }
        let folder = tempfile::tempdir().unwrap();
        let said = read_settled(folder.path()).unwrap_err().to_string();
        assert!(said.contains("cannot be read: "), "{said}");
        let said = changed(7, 9);
        assert!(said.contains("from 7 to 9 bytes") && said.contains("remedy: "), "{said}");
    }
}
