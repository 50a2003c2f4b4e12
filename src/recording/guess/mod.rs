//! Looking at a file nobody has described: layout, time, units, and which channel of a scene each column may be.
//!
//! Every guess carries how it came about ([`Sureness`]); [`Guess::to_toml`] writes it as a `recordings.toml`, with what stayed open as
//! comments. Nothing here reads a recording: that is done by what was written, through the same reader as ever.

mod columns;
mod footer;
mod layout;
mod likeness;
mod open;
mod preview;
mod sizes;
mod written;

use std::path::{Path, PathBuf};

use super::table::FileUnit;
use super::{FileOptions, RecordingError, Role};

/// A channel that a scene has.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// Its column, with its unit.
    pub column: String,
    /// Whether it drives the scene.
    pub role: Role,
}

/// How a guess came about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sureness {
    /// Nothing speaks for it but that something must be taken.
    Assumed,
    /// The size of the numbers, or a likeness of names.
    Likely,
    /// The file says so.
    Sure,
}

impl Sureness {
    /// As it is printed behind a guess.
    pub fn word(self) -> &'static str {
        match self {
            Self::Assumed => "assumed",
            Self::Likely => "likely",
            Self::Sure => "sure",
        }
    }
}

/// A guess and how it came about.
#[derive(Clone, Debug, PartialEq)]
pub struct Said {
    /// What was guessed, in words.
    pub what: String,
    /// How.
    pub sureness: Sureness,
}

/// A column of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct GuessedColumn {
    /// Its name in the file.
    pub name: String,
    /// The unit that its name or the row of units states.
    pub unit: Option<&'static FileUnit>,
    /// What stands in the place of its unit, if it is none that is known.
    #[doc(hidden)]
    pub unread_unit: Option<String>,
    /// The channel of the scene that it may be.
    pub channel: Option<(Wanted, Sureness)>,
    /// Whether it holds texts or dates.
    pub is_text: bool,
    /// The greatest of its first numbers, without their signs.
    pub greatest: Option<f64>,
}

/// What a file looks like.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess {
    /// The file.
    pub file: PathBuf,
    /// Its layout, as far as it is not the plain one.
    pub options: FileOptions,
    /// Its columns but the time.
    pub columns: Vec<GuessedColumn>,
    /// Name of the time column; `None` where the rows have no time.
    pub time: Option<String>,
    /// The guesses in words.
    pub said: Vec<Said>,
    /// The first rows below the names, as they stand in the file: names, then cells.
    pub first_rows: Vec<Vec<String>>,
}

/// Looks at a file and at the channels that a scene has.
///
/// ```
/// use smam::recording::{Role, Wanted, guess};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("sine.txt");
/// std::fs::write(&path, "Zeit [ms];Kolben [cm]\n0;0,1\n10;0,2\n20;0,3\n")?;
/// let wanted = [Wanted { column: "plunger_mm".to_owned(), role: Role::Input }];
/// let guess = guess(&path, &wanted)?;
/// assert_eq!((guess.options.decimal, guess.time.as_deref()), (Some(','), Some("Zeit [ms]")));
/// assert_eq!(guess.columns[0].unit.map(|u| u.name), Some("cm"));
/// assert_eq!(guess.columns[0].channel.as_ref().map(|(w, _)| w.column.as_str()), Some("plunger_mm"));
/// # Ok(())
/// # }
/// ```
///
/// # Errors
/// A file that cannot be read, or that holds no table.
pub fn guess(file: &Path, wanted: &[Wanted]) -> Result<Guess, RecordingError> {
    guess_sheet(file, None, wanted)
}

/// As [`guess`], of a sheet of a workbook.
///
/// # Errors
/// As [`guess`]; a file that is no workbook or has no such sheet.
pub fn guess_sheet(file: &Path, sheet: Option<&str>, wanted: &[Wanted]) -> Result<Guess, RecordingError> {
    let table = preview::preview(file, sheet)?;
    let found = layout::layout(&table)
        .ok_or_else(|| RecordingError::Format { file: file.to_owned(), problem: no_table(&table).to_owned() })?;
    Ok(columns::guessed(file, found, wanted))
}

fn no_table(table: &preview::Preview) -> &'static str {
    match table.has_formulas() {
        true => {
            "its formulas have no saved values, so no table of numbers is found in it\n  remedy: open the file in a spreadsheet program, let \
             it calculate, and save it"
        }
        false => {
            "no table of numbers is found in it\n  remedy: a row of names with rows of numbers below is what is looked for; save the \
             columns so"
        }
    }
}

pub(super) use open::TO_FILL_IN;
pub use written::{AlsoGuess, OpenScene, to_toml};
