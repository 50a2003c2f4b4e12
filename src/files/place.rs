//! Where a file's content goes: to a name in a folder, to the end of a symbolic link, into a device or pipe that is there.

use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempPath;

/// As many links as an operating system follows.
const MOST_LINKS: usize = 40;

/// What a path leads to.
#[derive(Debug, PartialEq)]
pub(super) enum Place {
    /// A file, or nothing yet: what is written takes this name. Symbolic links are followed.
    Name(PathBuf),
    /// A device, a pipe or a stream of this program: what is written goes into it, nothing is replaced.
    Stream(PathBuf),
}

impl Place {
    /// Follows the links of a path, to what is there or shall be.
    pub(super) fn of(path: &Path) -> Self {
        if std::fs::metadata(path).is_ok_and(|kind| !kind.is_file() && !kind.is_dir()) {
            return Self::Stream(path.to_owned());
        }
        let mut end = path.to_owned();
        for _ in 0..MOST_LINKS {
            let Ok(next) = std::fs::read_link(&end) else { break };
            // /dev/stdout leads here: a file that the shell has open must not be replaced beneath it.
            if next.starts_with("/proc") {
                return Self::Stream(path.to_owned());
            }
            end = end.parent().map_or_else(|| next.clone(), |folder| folder.join(&next));
        }
        Self::Name(end)
    }

    /// The folder for what is not complete yet: beside the name, so that giving it the name is one step.
    pub(super) fn folder(&self) -> PathBuf {
        match self {
            Self::Stream(_) => std::env::temp_dir(),
            // The parent of a bare file name is the empty path.
            Self::Name(path) => match path.parent() {
                Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
                _ => PathBuf::from("."),
            },
        }
    }

    /// Gives a complete file its name, or its content to the stream.
    pub(super) fn take(self, file: TempPath) -> io::Result<()> {
        match self {
            Self::Name(path) => file.persist(path).map_err(|e| e.error),
            Self::Stream(path) => pour(&file, &path),
        }
    }

    /// Where a part goes: into the same stream, or beside the name.
    pub(super) fn for_part(self) -> PathBuf {
        match self {
            Self::Name(path) => super::part_name(&path),
            Self::Stream(path) => path,
        }
    }
}

/// A reader that has seen enough (`| head`) is no failure.
fn pour(file: &Path, stream: &Path) -> io::Result<()> {
    let mut to = OpenOptions::new().append(true).open(stream)?;
    match io::copy(&mut File::open(file)?, &mut to) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => Err(e),
        _ => Ok(()),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use crate::files::{Staged, Unfinished, place_all, write_whole};
    use std::os::unix::fs::symlink;

    #[test]
    fn a_link_stays_and_its_end_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let [data, link, second] = ["data/run.csv", "run.csv", "other.csv"].map(|n| folder.path().join(n));
        std::fs::create_dir(folder.path().join("data")).unwrap();
        // To a file that is not there yet, and by way of another link.
        symlink("data/run.csv", &link).unwrap();
        symlink("run.csv", &second).unwrap();
        for (path, text) in [(&link, "one"), (&second, "two")] {
            write_whole(path, text).unwrap();
            assert!(path.is_symlink() && !data.is_symlink());
            assert_eq!(std::fs::read_to_string(&data).unwrap(), text);
        }
        let part = Unfinished::beside(&link).unwrap().as_part();
        assert_eq!(part.path(), folder.path().join("data/run.partial.csv"));
    }

    #[test]
    fn a_device_stays_one() {
        let device = Path::new("/dev/null");
        place_all(vec![Staged::write(device, b"text").unwrap()]).unwrap();
        assert!(std::fs::metadata(device).is_ok_and(|kind| !kind.is_file()));
        assert_eq!(Place::of(device).for_part(), device);
        assert!(write_whole(Path::new("/dev/full"), "text").is_err());
    }

    #[test]
    fn links_in_a_circle_end() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("round");
        symlink("round", &link).unwrap();
        assert!(matches!(Place::of(&link), Place::Name(_)));
    }
}
