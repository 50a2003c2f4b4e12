//! Writing whole files.

use std::path::{Path, PathBuf};

use smam::files::{Held, Staged, hold_folder, place_all, still_there, write_whole};
use smam::report::HtmlPage;

use super::CliError;

/// Makes a folder for results before the work: that it cannot be made is better said now than after it.
pub fn make_folder(path: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(path).map_err(|source| CliError::Write { file: path.to_owned(), source })
}

/// Makes a folder and takes it for this program alone, as long as what is returned lives: two that write into one folder
/// would mix their results.
pub fn take_folder(path: &Path) -> Result<Held, CliError> {
    make_folder(path)?;
    match hold_folder(path) {
        Held::Taken => Err(CliError::Usage(format!(
            "{}: another smam is writing here\n  remedy: wait for it, or give another folder with --out",
            path.display()
        ))),
        ours => Ok(ours),
    }
}

/// Writes a file that appears under its name whole or not at all; its folder is made.
pub fn write(path: &Path, text: &str) -> Result<(), CliError> {
    write_whole(path, text).map_err(|source| CliError::Write { file: path.to_owned(), source })
}

/// Files of one result: none appears before all are on the disk. Nothing is taken away: a folder that a user names may hold figures of
/// their own.
#[derive(Default)]
pub struct Together(Vec<Staged>);

impl Together {
    /// Adds a text.
    pub fn text(&mut self, path: &Path, text: &str) -> Result<(), CliError> {
        let staged = Staged::write(path, text.as_bytes());
        self.0.push(staged.map_err(|source| CliError::Write { file: path.to_owned(), source })?);
        Ok(())
    }

    /// Adds a page, and beside it the files of what it shows in part.
    pub fn page(&mut self, folder: &Path, name: &str, page: &HtmlPage) -> Result<(), CliError> {
        page.files().iter().try_for_each(|(path, text)| self.text(&folder.join(path), text))?;
        self.text(&folder.join(name), &page.finish())
    }

    /// Gives all their names.
    pub fn place(self) -> Result<(), CliError> {
        place_all(self.0).map_err(|(file, source)| CliError::Write { file, source })
    }
}

/// That what was written on the way stands there at the end.
pub fn see_there(paths: &[PathBuf]) -> Result<(), CliError> {
    paths
        .iter()
        .try_for_each(|path| still_there(path).map_err(|source| CliError::Write { file: path.to_owned(), source }))
}

/// Whether two paths lead to one file that is there.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}
