//! Writing whole files.

use std::path::Path;

use smam::recording::write_whole;

use super::CliError;

/// Makes a folder for results before the work: that it cannot be made is better said now than after it.
pub fn make_folder(path: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(path).map_err(|source| CliError::Write { file: path.to_owned(), source })
}

/// Writes a file that appears under its name whole or not at all; its folder is made.
pub fn write(path: &Path, text: &str) -> Result<(), CliError> {
    write_whole(path, text).map_err(|source| CliError::Write { file: path.to_owned(), source })
}
