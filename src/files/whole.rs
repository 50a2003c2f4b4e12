//! Files that appear under their name complete or not at all.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempPath};

use super::place::Place;

/// Writes a text under `path`, making its folder where it is missing. A former file of that name stays until the new
/// one is complete. A symbolic link stays, and its end is written; a device or a pipe gets the text.
///
/// ```
/// use smam::files::write_whole;
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
    Staged::write(path, bytes)?.place()
}

/// A file that is written, and has no name yet: of several that belong together none gets its name before all are on
/// the disk.
///
/// ```
/// use smam::files::Staged;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("answer.json");
/// let staged = Staged::write(&path, b"{}")?;
/// assert!(!path.exists());
/// staged.place()?;
/// assert!(path.exists());
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Staged {
    file: NamedTempFile,
    path: PathBuf,
}

impl Staged {
    /// Writes what shall stand under `path`, making its folder where it is missing.
    ///
    /// # Errors
    /// The folder cannot be made or written to, or there is no room.
    pub fn write(path: &Path, bytes: &[u8]) -> io::Result<Self> {
        if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder)?;
        }
        let mut file = temporary_beside(path)?;
        file.write_all(bytes)?;
        file.as_file().sync_all()?;
        Ok(Self { file, path: path.to_owned() })
    }

    /// Where it will stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// The folder is gone, or something that is no file has that name.
    pub fn place(self) -> io::Result<()> {
        Place::of(&self.path).take(self.file.into_temp_path())
    }
}

/// Gives files that belong together their names, in their order, and looks whether all stand there in the end: a folder
/// that somebody takes away meanwhile comes back with a part of them otherwise, and nobody is told.
///
/// ```
/// use smam::files::{Staged, place_all};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let stage = |name: &str| Staged::write(&folder.path().join("out").join(name), b"text");
/// let staged = vec![stage("figures.json")?, stage("page.html")?];
/// std::fs::remove_dir_all(folder.path().join("out"))?;
/// let (file, _) = place_all(staged).unwrap_err();
/// assert_eq!(file.file_name().unwrap(), "figures.json");
///
/// place_all(vec![stage("figures.json")?, stage("page.html")?]).unwrap();
/// assert!(folder.path().join("out/page.html").is_file());
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// The first file that cannot be named, or is not there in the end, and why.
pub fn place_all(files: Vec<Staged>) -> Result<(), (PathBuf, io::Error)> {
    let paths: Vec<PathBuf> = files.iter().map(|f| f.path.clone()).collect();
    for file in files {
        let path = file.path.clone();
        file.place().map_err(|source| (path, source))?;
    }
    paths.into_iter().try_for_each(|path| still_there(&path).map_err(|source| (path, source)))
}

/// That a file stands where it was written.
///
/// # Errors
/// It is gone again.
pub fn still_there(path: &Path) -> io::Result<()> {
    match std::fs::metadata(path).is_ok_and(|kind| !kind.is_dir()) {
        true => Ok(()),
        false => Err(io::Error::new(io::ErrorKind::NotFound, "it was written, and somebody took it away again")),
    }
}

/// A file that somebody else writes, by its path: it has another name until it is complete. Dropped before, it is gone.
#[derive(Debug)]
pub struct Unfinished {
    temporary: TempPath,
    path: PathBuf,
}

impl Unfinished {
    /// An empty file in the folder where `path` shall stand.
    ///
    /// # Errors
    /// The folder does not exist or cannot be written to.
    pub fn beside(path: &Path) -> io::Result<Self> {
        Ok(Self { temporary: temporary_beside(path)?.into_temp_path(), path: path.to_owned() })
    }

    /// Where to write.
    pub fn temporary(&self) -> &Path {
        &self.temporary
    }

    /// Where it will stand.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The same file, to stand beside its place as a part ([`part_name`]).
    pub fn as_part(self) -> Self {
        Self { path: part_place(&self.path), ..self }
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// The file or its folder is gone, or it cannot be brought to the disk.
    pub fn place(self) -> io::Result<()> {
        std::fs::OpenOptions::new().write(true).open(&self.temporary)?.sync_all()?;
        Place::of(&self.path).take(self.temporary)
    }
}

/// The name beside a file's own of what was written before a failure: `sine.partial.csv`.
///
/// ```
/// use std::path::Path;
///
/// assert_eq!(smam::files::part_name(Path::new("out/sine.csv")), Path::new("out/sine.partial.csv"));
/// ```
pub fn part_name(path: &Path) -> PathBuf {
    let ending = path.extension().map_or_else(String::new, |e| format!(".{}", e.to_string_lossy()));
    path.with_extension(format!("partial{ending}"))
}

/// Where what was written before a failure goes.
pub(crate) fn part_place(path: &Path) -> PathBuf {
    Place::of(path).for_part()
}

/// An empty file in the folder where `path` shall stand; gone when dropped.
pub(crate) fn temporary_beside(path: &Path) -> io::Result<NamedTempFile> {
    let folder = Place::of(path).folder();
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
pub(crate) fn put_in_place(file: NamedTempFile, path: &Path) -> io::Result<()> {
    // On the disk before it gets its name: a crash never leaves a named file without its content.
    file.as_file().sync_all()?;
    Place::of(path).take(file.into_temp_path())
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

    #[test]
    fn what_others_write_has_its_name_when_it_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("run.rrd");
        std::fs::write(&path, "former").unwrap();
        let dropped = Unfinished::beside(&path).unwrap();
        std::fs::write(dropped.temporary(), "half").unwrap();
        drop(dropped);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "former");
        let file = Unfinished::beside(&path).unwrap();
        std::fs::write(file.temporary(), "whole").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "former");
        file.place().unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "whole");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let gone = Unfinished::beside(&path).unwrap();
        std::fs::remove_file(gone.temporary()).unwrap();
        assert_eq!(gone.place().unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
