//! Files that appear under their name complete or not at all.

use std::io::{self, Write};
use std::path::Path;

use tempfile::NamedTempFile;

/// Writes a text under `path`, making its folder where it is missing. A former file of that name stays until the new
/// one is complete.
///
/// ```
/// use smam::recording::write_whole;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("out/wanted.csv");
/// write_whole(&path, "time_s,elongation_mm\n0,0\n")?;
/// assert_eq!(std::fs::read_to_string(&path)?.lines().count(), 2);
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The folder cannot be made or written to, or there is no room.
pub fn write_whole(path: &Path, text: &str) -> io::Result<()> {
    write_whole_bytes(path, text.as_bytes())
}

/// The same for a file that is no text.
pub fn write_whole_bytes(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder)?;
    }
    let mut file = temporary_beside(path)?;
    file.write_all(bytes)?;
    put_in_place(file, path)
}

/// An empty file in the folder where `path` shall stand; gone when dropped.
pub(super) fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    // The parent of a bare file name is the empty path.
    let folder = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".smam-").suffix(".partial");
    #[cfg(unix)]
    {
        // Temporary files are private by default; a result gets the permissions any new file has.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// Gives a temporary file its name.
pub(super) fn put_in_place(file: NamedTempFile, path: &Path) -> io::Result<()> {
    // On the disk before it gets its name: a crash never leaves a named file without its content.
    file.as_file().sync_all()?;
    file.persist(path).map_err(|e| e.error)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folder_is_made_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("new/text.json");
        write_whole(&path, "one").unwrap();
        write_whole(&path, "two").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }
}
