//! Further files of the runs that `smam import` describes: what a camera or a second logger wrote.

use std::path::{Path, PathBuf};

use smam::recording::{AlsoGuess, Guess, LinedUp, RecordingSet, Start, Wanted, guess_sheet};

use super::CliError;

/// Refuses further files beside a folder, whose order nobody has given: a file would go to another's run.
pub fn refuse_folders(also: &[PathBuf], given: &[PathBuf]) -> Result<(), CliError> {
    match given.iter().find(|path| path.is_dir()).filter(|_| !also.is_empty()) {
        None => Ok(()),
        Some(folder) => Err(CliError::Usage(format!(
            "--also: {} is a folder, and further files go to runs in their order\n  remedy: name the files of the runs, then --also and \
             theirs",
            folder.display()
        ))),
    }
}

/// One further file for each run, in their order.
pub fn also_guesses(also: &[PathBuf], runs: &[Guess], channels: &[Wanted]) -> Result<Vec<AlsoGuess>, CliError> {
    if !also.is_empty() && also.len() != runs.len() {
        let names: Vec<String> = runs.iter().map(|run| run.file.display().to_string()).collect();
        return Err(CliError::Usage(format!(
            "--also names {} files, and there are {} runs ({})\n  remedy: name one for each run, in their order",
            also.len(),
            runs.len(),
            names.join(", ")
        )));
    }
    let guessed = |path: &PathBuf| Ok(AlsoGuess { guess: guess_sheet(path, None, channels)?, starts_s: None });
    also.iter().map(guessed).collect()
}

/// Fills in where each begins, as far as its motion tells one place; what is in the way of reading it, or that there are several, will be
/// said when it is read.
pub fn fill_in_starts(also: &mut [AlsoGuess], text: &str, written: &Path) {
    let Ok(set) = RecordingSet::parse(text, written) else { return };
    for (file, run) in also.iter_mut().zip(&set.runs) {
        let start = set.starts(run).ok().and_then(|starts| starts.first().copied());
        if let Some(Start::Likely(LinedUp { starts_s, likeness, or_s: None })) = start {
            let said = format!(
                "    # likely: there it moves when the run's file does (likeness {likeness:.2} of 1; what lags counts as late)"
            );
            file.starts_s = Some((starts_s, said));
        }
    }
}
