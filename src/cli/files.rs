//! Writing whole files.

use std::path::Path;

use super::CliError;

/// Writes a file that appears under its name whole or not at all; its folder is made.
pub fn write(path: &Path, text: &str) -> Result<(), CliError> {
    let failed = |source| CliError::Write { file: path.to_owned(), source };
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    let temporary = tempfile::NamedTempFile::new_in(folder).map_err(failed)?;
    std::fs::write(temporary.path(), text).map_err(failed)?;
    temporary.persist(path).map_err(|e| failed(e.error))?;
    Ok(())
}
