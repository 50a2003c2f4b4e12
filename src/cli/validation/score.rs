//! `smam score`.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use smam::proof::{Folders, ProofError, Row, metrics, open, page, row};
use smam::report::HtmlPage;

use super::markdown_page::add_markdown;
use super::proof_figure::{proof_panels, proof_svg};
use crate::cli::CliError;
use crate::cli::files::{Together, write};
use crate::cli::words::quoted;

/// Arguments of `smam score`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam diagnose out/blind/case_7 --out out/answers/case_7
  smam score out/blind --answers out/answers
  smam score --rows proof/rows.jsonl --out out/again       the figures of cases that are open already")]
pub struct ScoreArguments {
    /// Folder that `smam conceal` wrote: cases, seals.txt and sealed answers
    #[arg(required_unless_present = "rows", conflicts_with = "rows")]
    cases: Option<PathBuf>,
    /// Folder with one NAME/ of `smam diagnose --out` for each case
    #[arg(long, value_name = "DIR", required_unless_present = "rows", conflicts_with = "rows")]
    answers: Option<PathBuf>,
    /// Opened cases, as rows.jsonl holds them, in the place of cases and answers: those of another method, say
    #[arg(long, value_name = "FILE")]
    rows: Option<PathBuf>,
    /// Where to write rows.jsonl, score.json, score.html and table.md
    #[arg(long, value_name = "DIR", default_value = "out/score")]
    out: PathBuf,
}

/// Runs the command: opens every seal whose case was answered.
pub fn score(arguments: &ScoreArguments) -> Result<ExitCode, CliError> {
    let rows = match (&arguments.cases, &arguments.answers, &arguments.rows) {
        (Some(cases), Some(answers), None) => open_answered(cases, answers)?,
        (_, _, Some(rows)) => read_rows(rows, "give a rows.jsonl of `smam proof` or `smam score`")?,
        // clap asks for the one or the other.
        _ => return Err(CliError::Usage("nothing to score\n  remedy: name cases and answers, or rows".to_owned())),
    };
    write_score(&rows, &arguments.out)?;
    Ok(ExitCode::SUCCESS)
}

/// Opens the seal of every case that was answered.
fn open_answered(cases: &Path, answers: &Path) -> Result<Vec<Row>, CliError> {
    let folders = Folders { cases: cases.to_owned(), answers: answers.to_owned() };
    let seals = read_seals(&cases.join("seals.txt"))?;
    let is_answered = |name: &str| answers.join(name).join("diagnosis.json").is_file();
    let answered: Vec<_> = seals.iter().filter(|(name, _)| is_answered(name)).collect();
    if answered.is_empty() {
        let (shown_cases, shown_answers) = (quoted(cases), quoted(answers));
        return Err(CliError::Usage(format!(
            "{}: there is no answer to any of the {} cases of {}\n  remedy: smam diagnose {shown_cases}/NAME --out \
             {shown_answers}/NAME, for each NAME in {shown_cases}/seals.txt",
            answers.display(),
            seals.len(),
            cases.display()
        )));
    }
    answered.iter().try_for_each(|(name, _)| refuse_answer_to_another(name, &folders))?;
    let rows = open_all(answered, &folders)?;
    eprintln!("{} of {} cases were answered", rows.len(), seals.len());
    Ok(rows)
}

/// What an answer says of its recordings.
#[derive(Deserialize)]
struct AnswersTo {
    recordings: Vec<PathBuf>,
}

/// Refuses an answer that says it was found in other recordings than those of the case: under a case's name any answer would score.
fn refuse_answer_to_another(name: &str, folders: &Folders) -> Result<(), CliError> {
    let path = folders.answers.join(name).join("diagnosis.json");
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    // What is no answer is said when it is opened.
    let Ok(AnswersTo { recordings }) = serde_json::from_str(&text) else { return Ok(()) };
    let own = folders.cases.join(name);
    let is_own = |given: &PathBuf| match (given.canonicalize(), own.canonicalize()) {
        (Ok(given), Ok(own)) if given == own => true,
        // Diagnosed elsewhere, or as `.`: its name is all there is to go by, or that it is a copy.
        _ => given.file_name().is_none_or(|folder| folder == OsStr::new(name)) || holds_runs_of(given, &own),
    };
    match recordings.iter().find(|given| !is_own(given)) {
        None => Ok(()),
        Some(other) => Err(CliError::Usage(format!(
            "{}: answers to the recordings {}, not to {}\n  remedy: smam diagnose {} --out {}",
            path.display(),
            other.display(),
            own.display(),
            quoted(&own),
            quoted(&folders.answers.join(name))
        ))),
    }
}

/// Whether every run of a case lies in a folder, byte for byte.
fn holds_runs_of(folder: &Path, case: &Path) -> bool {
    let files = std::fs::read_dir(case).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut runs = files.filter(|path| path.extension().is_some_and(|e| e == "csv")).peekable();
    let is_copied = |run: PathBuf| {
        let copy = run.file_name().map(|name| folder.join(name));
        copy.is_some_and(|copy| matches!((std::fs::read(copy), std::fs::read(run)), (Ok(copy), Ok(run)) if copy == run))
    };
    runs.peek().is_some() && runs.all(is_copied)
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
    CliError::Failed(format!("this cannot be written as JSON: {error}"))
}

/// Writes rows, opened cases say, one a line.
pub fn write_rows<T: Serialize>(rows: &[T], path: &Path) -> Result<(), CliError> {
    let lines: Vec<String> = rows.iter().map(serde_json::to_string).collect::<Result<_, _>>().map_err(not_json)?;
    write(path, &format!("{}\n", lines.join("\n")))
}

/// Reads what [`write_rows`] wrote; `remedy` is for a file that is something else.
pub fn read_rows(path: &Path, remedy: &str) -> Result<Vec<Row>, CliError> {
    let refuse = |why: String| CliError::Usage(format!("{}: {why}\n  remedy: {remedy}", path.display()));
    let text = std::fs::read_to_string(path).map_err(|e| refuse(format!("cannot be read: {e}")))?;
    let row = |(i, line): (usize, &str)| {
        let row: Row = serde_json::from_str(line)
            .map_err(|e| refuse(format!("line {}: not a row of a proof, one a line: {e}", i + 1)))?;
        match row.fault() {
            None => Ok(row),
            Some(fault) => Err(refuse(format!("line {}: {fault}", i + 1))),
        }
    };
    let rows: Vec<Row> = text.lines().enumerate().map(row).collect::<Result<_, _>>()?;
    if let Some(twice) = (1..rows.len()).find(|i| rows[..*i].iter().any(|r| r.name == rows[*i].name)) {
        return Err(refuse(format!("line {}: {} stands twice", twice + 1, rows[twice].name)));
    }
    if rows.is_empty() { Err(refuse("it holds no row".to_owned())) } else { Ok(rows) }
}

/// The picture to explore, and the tables.
fn html_page(rows: &[Row], tables: &str) -> HtmlPage {
    let mut page = HtmlPage::new(&format!("Score of {} cases", rows.len()));
    page.panels(&proof_panels(rows), "Lines through the shares; bars: 95 % interval.");
    add_markdown(&mut page, tables);
    page
}

/// Writes rows, figures, pictures, page and table, and prints the table.
pub fn write_score(rows: &[Row], out: &Path) -> Result<(), CliError> {
    let figures = metrics(rows);
    write_rows(rows, &out.join("rows.jsonl"))?;
    let page = page(rows, &figures);
    let mut files = Together::default();
    files.text(&out.join("score.json"), &format!("{}\n", serde_json::to_string_pretty(&figures).map_err(not_json)?))?;
    files.text(&out.join("table.md"), &page)?;
    files.page(out, "score.html", &html_page(rows, &page))?;
    files.text(&out.join("proof.svg"), &proof_svg(rows))?;
    files.place()?;
    crate::cli::print_text(&page)
}
