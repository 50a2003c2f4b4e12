//! Where the results of one input go when no folder is given.

use std::path::{Path, PathBuf};

use super::CliError;
use super::files::write;
use super::words::quoted;

/// Says in a folder that was not named by the user what its results are of.
const MADE_FROM: &str = "made_from.txt";

/// A folder for results. `out/COMMAND_NAME` is named after the input alone, and inputs in different places can have one name: the folder
/// notes which one it belongs to.
pub struct Results {
    pub folder: PathBuf,
    /// The input, where the folder says what it belongs to.
    input: Option<String>,
}

impl Results {
    /// The folder that is given, else `out/COMMAND_NAME`.
    ///
    /// # Errors
    /// That folder holds the results of another input, which is still there.
    pub fn of(input: &Path, command: &str, given: Option<&Path>) -> Result<Self, CliError> {
        let whole = input.canonicalize().unwrap_or_else(|_| input.to_owned());
        let input_named = || whole.display().to_string();
        if let Some(folder) = given {
            let input = folder.join(MADE_FROM).exists().then(input_named);
            return Ok(Self { folder: folder.to_owned(), input });
        }
        let folder = Path::new("out").join(format!("{command}_{}", name_of(input)));
        let before = std::fs::read_to_string(folder.join(MADE_FROM)).unwrap_or_default();
        let before = Path::new(before.trim_end_matches('\n'));
        if before != whole && before.exists() {
            return Err(CliError::Usage(format!(
                "{}: holds the results of {}\n  remedy: give another folder, for example --out {}",
                folder.display(),
                before.display(),
                quoted(&another(&whole, command))
            )));
        }
        Ok(Self { folder, input: Some(input_named()) })
    }

    /// Writes down what the folder, which is there by now, belongs to.
    pub fn note_input(&self) -> Result<(), CliError> {
        let Some(input) = &self.input else { return Ok(()) };
        write(&self.folder.join(MADE_FROM), &format!("{input}\n"))
    }
}

/// A name that tells its folder as well: `out/compare_MONDAY_rig`.
fn another(input: &Path, command: &str) -> PathBuf {
    let parent = input.parent().map_or_else(|| "other".to_owned(), name_of);
    Path::new("out").join(format!("{command}_{parent}_{}", name_of(input)))
}

/// Name of a folder or file of recordings.
pub fn name_of(input: &Path) -> String {
    let whole = input.canonicalize();
    let name = whole.ok().and_then(|whole| {
        let name = if whole.is_file() { whole.file_stem() } else { whole.file_name() };
        name.map(|name| name.to_string_lossy().into_owned())
    });
    name.unwrap_or_else(|| "recordings".to_owned())
}
