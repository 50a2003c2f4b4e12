//! Opening and reading.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// No scene, model, sweep or description of recordings is longer; what is, is something else.
const LONGEST_TEXT_BYTES: u64 = 1 << 24;

/// Opens a file. A pipe would be waited for, a device may never end: they are refused as
/// [`io::ErrorKind::InvalidInput`].
///
/// # Errors
/// What the system says; a pipe or a device.
pub fn open(path: &Path) -> io::Result<File> {
    let kind = std::fs::metadata(path)?;
    if kind.is_file() || kind.is_dir() {
        return File::open(path);
    }
    Err(io::Error::new(io::ErrorKind::InvalidInput, "it is a pipe or a device, not a file"))
}

/// The text of a file that somebody wrote.
///
/// ```
/// use smam::files::read_text;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("bench.toml");
/// std::fs::write(&path, "format = 1\n")?;
/// assert_eq!(read_text(&path)?, "format = 1\n");
/// std::fs::write(&path, [0xff, 0xfe])?;
/// assert_eq!(read_text(&path).map_err(|e| e.kind()), Err(std::io::ErrorKind::InvalidData));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// As [`open`]; a file that is no UTF-8, or longer than 16 MiB.
pub fn read_text(path: &Path) -> io::Result<String> {
    let mut bytes = Vec::new();
    open(path)?.take(LONGEST_TEXT_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LONGEST_TEXT_BYTES {
        return Err(io::Error::other(format!("it has more than the {LONGEST_TEXT_BYTES} bytes that are read")));
    }
    String::from_utf8(bytes)
        .map_err(|e| io::Error::new(io::ErrorKind::InvalidData, format!("it is no UTF-8 text: {e}")))
}
