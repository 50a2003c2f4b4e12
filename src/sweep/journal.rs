//! What is done of a sweep: one line per point, appended as it ends. A kill loses the points that were running.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use serde::{Deserialize, Serialize};

use super::SweepError;
use super::plan::Plan;
use super::point::Row;
use crate::files::{Held, hold_folder};
use crate::system::ConcernsS;

/// Name of the journal in a sweep's folder.
const NAME: &str = "journal.jsonl";

/// One line: the first says which sweep it is, the others are points.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum JournalLine {
    Head {
        sweep: String,
    },
    Point {
        index: u64,
        values: Vec<f64>,
        /// A number that is none is written as null.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        measures: Option<Vec<Option<f64>>>,
        #[serde(default, skip_serializing_if = "Option::is_none")]
        error: Option<String>,
        /// Times in trouble, s, in the order of [`Concern::ALL`](crate::system::Concern::ALL).
        concerns_s: ConcernsS,
    },
}

/// The journal of a folder, open for more.
///
/// ```
/// use smam::sweep::{Journal, Plan, Row};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let plan = Plan::new(toml::from_str(
///     "format = 1\nname = 'friction'\nscene = 'muscle_bench'\n\
///      vary = [{ key = 'muscles.friction.m0_n', values = [0.1, 0.2] }]\n\
///      measure = [{ name = 'range_mm', of = 'range(elongation_mm)' }]",
/// )?)?;
/// let folder = tempfile::tempdir()?;
/// let journal = Journal::open(folder.path(), &plan, false)?;
/// journal.add(&Row { index: 1, values: plan.point(1), outcome: Ok(vec![26.2]), concerns_s: [0.0; 5] })?;
/// drop(journal);
/// // Begun is begun: anew only in another folder, else it goes on with what is done.
/// assert!(Journal::open(folder.path(), &plan, false).is_err());
/// assert!(Journal::open(folder.path(), &plan, true)?.done.keys().eq([&1_u64]));
/// # Ok(())
/// # }
/// ```
pub struct Journal {
    /// Held while the sweep runs; a kill lets go of it.
    _folder: Option<File>,
    path: PathBuf,
    file: Mutex<File>,
    /// Points that were done when it was opened.
    pub done: BTreeMap<u64, Row>,
}

impl Journal {
    /// Opens the journal of `folder`: a new one, or with `resume` the one that is there.
    ///
    /// # Errors
    /// One that is there without `resume`, one of another sweep, a folder that cannot be written.
    pub fn open(folder: &Path, plan: &Plan, resume: bool) -> Result<Self, SweepError> {
        let path = folder.join(NAME);
        let write = |source: io::Error| SweepError::Write { file: path.clone(), source };
        std::fs::create_dir_all(folder).map_err(write)?;
        let held = hold(folder)?;
        if path.is_file() && !resume {
            return Err(SweepError::Journal {
                file: path,
                message: "a sweep was begun here".to_owned(),
                remedy: "go on with --resume, or give another folder with --out".to_owned(),
            });
        }
        let done = if path.is_file() { read(folder, &plan.fingerprint)? } else { BTreeMap::new() };
        let text = lines(plan, done.values());
        // Written anew: a line that a kill cut off is gone, and what follows starts on a line of its own.
        crate::files::write_whole(&path, &text).map_err(write)?;
        let file = OpenOptions::new().append(true).open(&path).map_err(write)?;
        Ok(Self { _folder: held, path, file: Mutex::new(file), done })
    }

    /// Appends a point; it is on its way to the disk when this returns.
    ///
    /// # Errors
    /// A disk that is full.
    pub fn add(&self, row: &Row) -> Result<(), SweepError> {
        let write = |source: io::Error| SweepError::Write { file: self.path.clone(), source };
        // A poisoned lock means that another thread panicked while writing; its line may be cut, ours is whole.
        let mut file = self.file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.write_all(line(row).as_bytes()).map_err(write)
    }
}

/// Takes a folder for this sweep alone. Where folders cannot be locked (some file systems) it goes on without.
fn hold(folder: &Path) -> Result<Option<File>, SweepError> {
    match hold_folder(folder) {
        Held::Ours(held) => Ok(held),
        Held::Taken => Err(SweepError::Journal {
            file: folder.to_owned(),
            message: "another sweep is writing here".to_owned(),
            remedy: "wait for it, or give another folder with --out".to_owned(),
        }),
    }
}

/// The points that a folder's journal holds.
///
/// # Errors
/// No journal, or that of another sweep.
pub fn read(folder: &Path, fingerprint: &str) -> Result<BTreeMap<u64, Row>, SweepError> {
    let path = folder.join(NAME);
    let refuse =
        |message: String, remedy: &str| SweepError::Journal { file: path.clone(), message, remedy: remedy.to_owned() };
    let text = std::fs::read_to_string(&path)
        .map_err(|e| refuse(format!("cannot be read: {e}"), "name the folder that `smam sweep --out` wrote"))?;
    let mut parsed = text.lines().map(serde_json::from_str::<JournalLine>);
    match parsed.next() {
        Some(Ok(JournalLine::Head { sweep })) if sweep == fingerprint => {}
        Some(Ok(JournalLine::Head { .. })) => {
            return Err(refuse(
                "it belongs to another sweep, or the scene was changed since".to_owned(),
                "give another folder with --out",
            ));
        }
        _ => {
            return Err(refuse(
                "it does not begin as a journal does".to_owned(),
                "delete it, or give another folder with --out",
            ));
        }
    }
    // A line that a kill cut off is a point that is not done.
    Ok(parsed.filter_map(Result::ok).filter_map(row).map(|r| (r.index, r)).collect())
}

fn row(line: JournalLine) -> Option<Row> {
    let JournalLine::Point { index, values, measures, error, concerns_s } = line else { return None };
    let numbers = |m: Vec<Option<f64>>| m.into_iter().map(|v| v.unwrap_or(f64::NAN)).collect();
    let outcome = match (measures, error) {
        (Some(measures), None) => Ok(numbers(measures)),
        (_, Some(error)) => Err(error),
        (None, None) => return None,
    };
    Some(Row { index, values, outcome, concerns_s })
}

fn lines<'a>(plan: &Plan, rows: impl Iterator<Item = &'a Row>) -> String {
    let head = JournalLine::Head { sweep: plan.fingerprint.clone() };
    let head = serde_json::to_string(&head).unwrap_or_default();
    rows.fold(format!("{head}\n"), |text, row| text + &line(row))
}

fn line(row: &Row) -> String {
    let finite = |v: &f64| v.is_finite().then_some(*v);
    let line = JournalLine::Point {
        index: row.index,
        values: row.values.clone(),
        measures: row.outcome.as_ref().ok().map(|m| m.iter().map(finite).collect()),
        error: row.outcome.as_ref().err().cloned(),
        concerns_s: row.concerns_s,
    };
    // Numbers and text only: nothing in it that JSON could refuse.
    serde_json::to_string(&line).unwrap_or_default() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_for_one_sweep_at_a_time() {
        let folder = tempfile::tempdir().expect("a folder");
        let held = hold(folder.path()).expect("free").expect("a file system with locks");
        assert!(hold(folder.path()).unwrap_err().to_string().contains("another sweep"));
        drop(held);
        assert!(hold(folder.path()).is_ok());
    }

    #[test]
    fn a_line_comes_back_as_it_was() {
        for outcome in [Ok(vec![1.0 / 3.0, -2e-300]), Err("it \"broke\"\nhere".to_owned())] {
            let before = Row { index: 7, values: vec![0.1, 5e17], outcome, concerns_s: [0.0, 1.5, 0.0, 0.25, 0.0] };
            let text = line(&before);
            assert_eq!(text.matches('\n').count(), 1);
            let after = serde_json::from_str(&text).ok().and_then(row);
            assert_eq!(after, Some(before));
        }
        let cut = line(&Row { index: 1, values: vec![], outcome: Ok(vec![2.5]), concerns_s: [0.0; 5] });
        assert!(serde_json::from_str::<JournalLine>(&cut[..cut.len() - 4]).is_err());
    }
}
