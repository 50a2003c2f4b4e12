//! Whether a proposed experiment settles what was ambiguous: played on the concealing plant, diagnosed anew with it.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::ProofError;
use super::campaign::Folders;
use super::row::{Row, read, row_of_answer};
use crate::conceal::{Hiding, Truth, record_asked, record_drawn};
use crate::diagnose::{Case, Options, Verdict, diagnose, write_answer};
use crate::files::write_whole;
use crate::recording::{Recording, read_csv};

/// What one more run made of an ambiguous answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settled {
    pub name: String,
    /// Standard errors by which the proposal was said to set the rivals apart.
    pub promised_sigma: f64,
    pub proposed: After,
    /// With a waveform that was drawn, of the same length.
    pub random: After,
}

/// An answer with one run more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct After {
    pub verdict: Verdict,
    /// No longer ambiguous, and every effect named is one that was hidden; of what is not listed, that it is unknown.
    pub is_right: bool,
}

/// Name of the added run's file.
const ADDED: &str = "added.csv";

/// Adds the proposed run, and a drawn one, to a case that was answered ambiguously; none where nothing was proposed.
///
/// # Errors
/// Files that cannot be read or written, a plant that cannot be integrated.
pub fn settle(truth: &Truth, folders: &Folders, out: &Path) -> Result<Option<Settled>, ProofError> {
    let answer = folders.answers.join(&truth.name);
    let proposal = answer.join("next_experiment.csv");
    if !proposal.is_file() {
        return Ok(None);
    }
    let asked = read_csv(&proposal)?;
    let duration_s = asked.time_s().last().copied().unwrap_or(0.0);
    let diagnosis: crate::diagnose::Diagnosis = parse(&answer.join("diagnosis.json"))?;
    let proposed = after(truth, folders, &out.join("proposed"), || Ok(record_asked(truth, &asked)?))?;
    let random = after(truth, folders, &out.join("random"), || Ok(record_drawn(truth, duration_s)?))?;
    let promised_sigma = diagnosis.next_experiment.separation_sigma;
    Ok(Some(Settled { name: truth.name.clone(), promised_sigma, proposed, random }))
}

/// Diagnoses a case again with one run more; what is there already is kept.
fn after(
    truth: &Truth,
    folders: &Folders,
    out: &Path,
    added: impl FnOnce() -> Result<Recording, ProofError>,
) -> Result<After, ProofError> {
    let own = Folders::below(out);
    if !own.answers.join(&truth.name).join("diagnosis.json").is_file() {
        let case = own.cases.join(&truth.name);
        add_run(&folders.cases.join(&truth.name), &case, &added()?)?;
        let outcome = diagnose(Case::load(&[case.as_path()], None, &[])?, Options { seed: 1 }, &|_| {})?;
        write_answer(&outcome, &own.answers.join(&truth.name))?;
    }
    let row = row_of_answer(truth, &own)?;
    Ok(After { verdict: row.verdict, is_right: is_right(&row) })
}

/// Copies the recordings of a case and puts one more run before the others: the last one stays the sealed one.
fn add_run(from: &Path, to: &Path, added: &Recording) -> Result<(), ProofError> {
    let failed = |file: PathBuf| move |source| ProofError::Write { file, source };
    fs::create_dir_all(to).map_err(failed(to.to_path_buf()))?;
    let entries = fs::read_dir(from).map_err(|source| ProofError::Read { file: from.to_path_buf(), source })?;
    for entry in entries.flatten().filter(|e| e.path().extension().is_some_and(|x| x == "csv")) {
        fs::copy(entry.path(), to.join(entry.file_name())).map_err(failed(entry.path()))?;
    }
    added.write_csv(&to.join(ADDED))?;
    let text = read(&from.join("recordings.toml"))?;
    let with_run = text.replacen("[[run]]", &format!("[[run]]\nfile = \"{ADDED}\"\n\n[[run]]"), 1);
    let path = to.join("recordings.toml");
    write_whole(&path, &with_run).map_err(failed(path.clone()))
}

fn is_right(row: &Row) -> bool {
    if row.hiding == Hiding::Unlisted {
        return row.verdict == Verdict::UnknownPhysics;
    }
    row.verdict == Verdict::MissingPhysics
        && row.effects.iter().filter(|e| e.probability > 0.5).all(|e| row.secrets.iter().any(|s| e.is(s)))
}

fn parse<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, ProofError> {
    serde_json::from_str(&read(path)?)
        .map_err(|e| ProofError::Format { file: path.to_path_buf(), message: e.to_string() })
}
