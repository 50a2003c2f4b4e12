//! `smam score`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;
use smam::proof::{Folders, ProofError, Row, metrics, open, page, row};

use super::CliError;
use super::files::write;
use super::proof_figure::proof_svg;

/// Arguments of `smam score`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam diagnose out/blind/case_7 --out out/answers/case_7
  smam score out/blind --answers out/answers")]
pub struct ScoreArguments {
    /// Folder that `smam conceal` wrote: cases, seals.txt and sealed answers
    cases: PathBuf,
    /// Folder with one NAME/ of `smam diagnose --out` for each case
    #[arg(long, value_name = "DIR")]
    answers: PathBuf,
    /// Where to write rows.jsonl, score.json and table.md
    #[arg(long, value_name = "DIR", default_value = "out/score")]
    out: PathBuf,
}

/// Runs the command: opens every seal whose case was answered.
pub fn score(arguments: &ScoreArguments) -> Result<ExitCode, CliError> {
    let folders = Folders { cases: arguments.cases.clone(), answers: arguments.answers.clone() };
    let seals = read_seals(&arguments.cases.join("seals.txt"))?;
    let is_answered = |name: &str| arguments.answers.join(name).join("diagnosis.json").is_file();
    let answered: Vec<_> = seals.iter().filter(|(name, _)| is_answered(name)).collect();
    if answered.is_empty() {
        let (cases, answers) = (arguments.cases.display(), arguments.answers.display());
        return Err(CliError::Usage(format!(
            "{answers}: there is no answer to any of the {} cases of {cases}\n  \
             remedy: smam diagnose {cases}/NAME --out {answers}/NAME, for each NAME in {cases}/seals.txt",
            seals.len()
        )));
    }
    let rows = open_all(answered, &folders)?;
    eprintln!("{} of {} cases were answered", rows.len(), seals.len());
    write_score(&rows, &arguments.out)?;
    Ok(ExitCode::SUCCESS)
}

/// Names and seals, as they were published.
pub fn read_seals(path: &Path) -> Result<Vec<(String, String)>, CliError> {
    let text = std::fs::read_to_string(path).map_err(|e| {
        CliError::Usage(format!(
            "{}: cannot be read: {e}\n  remedy: name a folder that `smam conceal` wrote",
            path.display()
        ))
    })?;
    let pair = |line: &str| line.split_once(' ').map(|(name, seal)| (name.to_owned(), seal.trim().to_owned()));
    Ok(text.lines().filter_map(pair).collect())
}

/// Publishes names and seals.
pub fn write_seals(path: &Path, seals: &[(String, String)]) -> Result<(), CliError> {
    let text: String = seals.iter().map(|(name, seal)| format!("{name} {seal}\n")).collect();
    write(path, &text)
}

/// The rows of cases that were answered; each corrected scene is played on what was kept back.
pub fn open_all<'a>(
    seals: impl IntoParallelIterator<Item = &'a (String, String)>,
    folders: &Folders,
) -> Result<Vec<Row>, ProofError> {
    seals.into_par_iter().map(|(name, seal)| row(&open(name, seal, folders)?, folders)).collect()
}

fn not_json(error: serde_json::Error) -> CliError {
    CliError::Failed(format!("the score cannot be written as JSON: {error}"))
}

/// Writes opened cases, one a line.
pub fn write_rows(rows: &[Row], path: &Path) -> Result<(), CliError> {
    let lines: Vec<String> = rows.iter().map(serde_json::to_string).collect::<Result<_, _>>().map_err(not_json)?;
    write(path, &format!("{}\n", lines.join("\n")))
}

/// Reads what [`write_rows`] wrote.
pub fn read_rows(path: &Path) -> Result<Vec<Row>, CliError> {
    let refuse = |why: String| {
        CliError::Usage(format!("{}: {why}\n  remedy: move it away; the cases are then answered again", path.display()))
    };
    let text = std::fs::read_to_string(path).map_err(|e| refuse(format!("cannot be read: {e}")))?;
    let row = |(i, line): (usize, &str)| {
        serde_json::from_str(line).map_err(|e| refuse(format!("line {}: not a row of a proof: {e}", i + 1)))
    };
    text.lines().enumerate().map(row).collect()
}

/// Writes rows, figures, picture and table, and prints the table.
pub fn write_score(rows: &[Row], out: &Path) -> Result<(), CliError> {
    let figures = metrics(rows);
    write_rows(rows, &out.join("rows.jsonl"))?;
    write(&out.join("score.json"), &format!("{}\n", serde_json::to_string_pretty(&figures).map_err(not_json)?))?;
    let page = page(rows, &figures);
    write(&out.join("table.md"), &page)?;
    write(&out.join("proof.svg"), &proof_svg(rows))?;
    super::print_text(&page)
}
