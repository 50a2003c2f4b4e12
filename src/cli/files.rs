//! Writing whole files.

use std::path::Path;

use smam::recording::write_whole;

use super::CliError;

/// Writes a file that appears under its name whole or not at all; its folder is made.
pub fn write(path: &Path, text: &str) -> Result<(), CliError> {
    write_whole(path, text).map_err(|source| CliError::Write { file: path.to_owned(), source })
}
