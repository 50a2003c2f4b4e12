//! Further files of the runs that `smam import` describes: what a camera or a second logger wrote.

use std::path::{Path, PathBuf};

use smam::recording::{AlsoGuess, Guess, LinedUp, RecordingSet, Start, Wanted, guess_sheet};

use super::CliError;

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

/// Fills in where each begins, as far as its motion tells; what is in the way of reading it will be said when it is read.
pub fn fill_in_starts(also: &mut [AlsoGuess], text: &str, written: &Path) {
    let Ok(set) = RecordingSet::parse(text, written) else { return };
    for (file, run) in also.iter_mut().zip(&set.runs) {
        if let Some(Start::Likely(found)) = set.starts(run).ok().and_then(|starts| starts.first().copied()) {
            file.starts_s = Some((found.starts_s, said(found)));
        }
    }
}

fn said(LinedUp { likeness, or_s, .. }: LinedUp) -> String {
    let or = or_s.map_or(String::new(), |s| format!("; {s:.3} is as likely: the motion repeats itself"));
    format!("    # likely: there it moves when the run's file does (likeness {likeness:.2} of 1){or}")
}
