//! The files that `smam import` looks at, and which of a folder belong together.

use std::path::{Path, PathBuf};

use smam::recording::{Guess, GuessedColumn, RecordingError, SET_FILE_NAME, Wanted, guess_sheet};

use super::CliError;

/// Files by their endings, where a folder is given.
const ENDINGS: [&str; 9] = ["csv", "txt", "tsv", "tab", "dat", "asc", "lvm", "xlsx", "parquet"];

/// A file to look at.
pub struct Given {
    pub path: PathBuf,
    /// It was named itself, not found in a folder: what is wrong with it is an error.
    is_named: bool,
}

impl Given {
    /// The sheet that is meant, if this is a workbook or shall be one.
    pub fn sheet<'a>(&self, sheet: Option<&'a str>) -> Option<&'a str> {
        let is_workbook = self.path.extension().is_some_and(|e| e.eq_ignore_ascii_case("xlsx"));
        sheet.filter(|_| is_workbook || self.is_named)
    }
}

/// A file of a folder that is none of the recordings.
pub struct LeftOut {
    path: PathBuf,
    /// File, reason and remedy.
    pub why: String,
}

impl LeftOut {
    /// As a comment of recordings.toml.
    pub fn comment(&self) -> String {
        format!("\n# Left out: {}\n", self.why.lines().next().unwrap_or_default())
    }
}

/// What the files look like.
pub struct Described {
    pub guesses: Vec<Guess>,
    pub left_out: Vec<LeftOut>,
}

/// The files that are named and those of the folders that are.
pub fn files(given: &[PathBuf]) -> Result<Vec<Given>, CliError> {
    let mut files = Vec::new();
    for path in given {
        if !path.is_dir() {
            files.push(Given { path: path.clone(), is_named: true });
            continue;
        }
        let entries = std::fs::read_dir(path).map_err(|source| RecordingError::Read { file: path.clone(), source })?;
        let is_table = |path: &PathBuf| {
            path.extension().is_some_and(|e| ENDINGS.iter().any(|known| e.eq_ignore_ascii_case(known)))
        };
        let mut found: Vec<PathBuf> = entries.filter_map(|e| Some(e.ok()?.path())).filter(is_table).collect();
        found.sort();
        if found.is_empty() {
            let endings = ENDINGS.join(", .");
            return Err(CliError::Usage(format!(
                "{}: holds no table\n  remedy: name a file, or a folder with files that end in .{endings}",
                path.display()
            )));
        }
        files.extend(found.into_iter().map(|path| Given { path, is_named: false }));
    }
    Ok(files)
}

/// Looks at every file; one of a folder that is no table, or has not the columns of the others, is left out.
pub fn describe(files: &[Given], sheet: Option<&str>, channels: &[Wanted]) -> Result<Described, CliError> {
    let (mut looked_at, mut left_out) = (Vec::new(), Vec::new());
    let mut first_error = None;
    for file in files {
        match guess_sheet(&file.path, file.sheet(sheet), channels) {
            Ok(guess) => looked_at.push((file, guess)),
            Err(error) if file.is_named => return Err(error.into()),
            Err(error) => {
                left_out.push(LeftOut { path: file.path.clone(), why: error.to_string() });
                first_error.get_or_insert(error);
            }
        }
    }
    let found = |guess: &Guess| guess.columns.iter().filter(|c| c.channel.is_some()).count();
    let most = looked_at.iter().map(|(_, guess)| found(guess)).max().unwrap_or(0);
    let model = looked_at.iter().find(|(_, guess)| found(guess) == most).map(|(_, guess)| guess.clone());
    let Some(model) = model else {
        // Without a file there is no error: `files` refuses that.
        return Err(first_error.map_or_else(|| CliError::Usage("no file is given".to_owned()), CliError::from));
    };
    let mut guesses = Vec::new();
    for (file, guess) in looked_at {
        if let Some(why) = in_other_units(&guess, &model) {
            if file.is_named {
                return Err(CliError::Usage(why));
            }
            left_out.push(LeftOut { path: file.path.clone(), why });
            continue;
        }
        match lacking(&guess, &model).filter(|_| !file.is_named) {
            None => guesses.push(guess),
            Some(column) => {
                left_out.push(LeftOut { path: file.path.clone(), why: without(&file.path, &column, &model) })
            }
        }
    }
    left_out.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(Described { guesses, left_out })
}

/// A column that is a channel of the model's, or its time, and that a file has not.
fn lacking(guess: &Guess, model: &Guess) -> Option<String> {
    let of_channels = model.columns.iter().filter(|c| c.channel.is_some()).map(|c| &c.name);
    let has = |name: &String| guess.time.as_ref() == Some(name) || guess.columns.iter().any(|c| c.name == *name);
    model.time.iter().chain(of_channels).find(|name| !has(name)).cloned()
}

/// A column that is in another unit than in the model: the channels of a recordings.toml have one unit for all its files.
fn in_other_units(guess: &Guess, model: &Guess) -> Option<String> {
    let said = |column: &GuessedColumn| match (&column.unread_unit, column.unit) {
        (Some(text), _) => format!("in \"{text}\""),
        (None, Some(unit)) => format!("in {}", unit.name),
        (None, None) => "without a unit".to_owned(),
    };
    let pairs = guess.columns.iter().filter_map(|c| Some((c, model.columns.iter().find(|m| m.name == c.name)?)));
    let mut of_channels = pairs.filter(|(_, m)| m.channel.is_some());
    let (own, other) = of_channels.find(|(c, m)| said(c) != said(m))?;
    Some(format!(
        "{}: the column \"{}\" is {}, and {} in {}\n  remedy: import it by itself with --out: the channels of a {SET_FILE_NAME} have one \
         unit for all its files",
        guess.file.display(),
        own.name,
        said(own),
        said(other),
        model.file.display()
    ))
}

fn without(path: &Path, column: &str, model: &Guess) -> String {
    format!(
        "{}: no column \"{column}\", which {} has\n  remedy: if it is a recording all the same, import it by itself with --out, or add it \
         as a [[run]] that lists what it lacks under not_recorded",
        path.display(),
        model.file.display()
    )
}
