//! `smam trial`.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;

use clap::Args;
use rayon::prelude::*;
use smam::effects::names;
use smam::nearest::did_you_mean;
use smam::report::HtmlPage;
use smam::trial::{Judgement, Row, TrialCase, plan, table, try_case, try_case_in};

use super::markdown_page::add_markdown;
use crate::cli::CliError;
use crate::cli::files::{Together, take_folder};

/// The stock scenes that together can have every effect of the catalogue.
const SCENES: [&str; 6] =
    ["muscle_bench", "antagonistic_pulley", "bending_catheter", "pressure_muscle", "tendon_sheath", "driven_axis"];

/// Arguments of `smam trial`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam trial --scene muscle_bench --nulls 10           every effect of the bench at three sizes, ten benches without any
  smam trial --scene muscle_bench --only-nulls --nulls 200 --seed 2")]
pub struct TrialArguments {
    /// Scenes to hold it on
    #[arg(long = "scene", value_name = "SCENE", default_values = SCENES)]
    scenes: Vec<String>,
    /// Only this effect
    #[arg(long)]
    effect: Option<String>,
    /// Cases per scene in which nothing is missing
    #[arg(long, default_value_t = 5)]
    nulls: usize,
    /// Only nothing: no effects
    #[arg(long, conflicts_with = "effect")]
    only_nulls: bool,
    /// Of everything that is drawn
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Where rows (trial.jsonl, kept from an earlier run) and table (trial.md, trial.html) go
    #[arg(long, value_name = "DIR", default_value = "out/trial")]
    out: PathBuf,
    /// Keep the recordings of each case too, in a folder of its name under DIR
    #[arg(long)]
    keep: bool,
}

/// Runs the command; cases that a former run has finished are not tried again.
pub fn trial(arguments: &TrialArguments) -> Result<ExitCode, CliError> {
    check_effect(arguments.effect.as_deref())?;
    if arguments.only_nulls && arguments.nulls == 0 {
        return Err(no_case("--nulls 0 with --only-nulls"));
    }
    let path = arguments.out.join("trial.jsonl");
    let done = read_rows(&path)?;
    let mut cases = Vec::new();
    for scene in &arguments.scenes {
        eprintln!("{scene}: what could be seen");
        let mut own = plan(scene, arguments.nulls, arguments.effect.as_deref(), arguments.seed)?;
        own.retain(|c| !arguments.only_nulls || c.effect.is_none());
        cases.extend(own);
    }
    if cases.is_empty() {
        return Err(no_case(&arguments.scenes.join(", ")));
    }
    let missing: Vec<&TrialCase> = cases.iter().filter(|c| row_of(c, &done).is_none()).collect();
    eprintln!("{} cases, {} of them known already", cases.len(), cases.len() - missing.len());
    let _held = take_folder(&arguments.out)?;
    let file = Mutex::new(open(&path)?);
    let failed = |source: std::io::Error| CliError::Write { file: path.clone(), source };
    missing.par_iter().try_for_each(|case| -> Result<(), CliError> {
        let row = if arguments.keep {
            try_case_in(case, &arguments.out.join(case.name.replace(' ', "_")))?
        } else {
            try_case(case)?
        };
        eprintln!("{:<70} {:?} {:?} {:.0} s", row.name, row.judgement, row.answer, row.seconds);
        let line = serde_json::to_string(&row).map_err(|e| CliError::Failed(e.to_string()))?;
        let mut file = file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.write_all(format!("{line}\n").as_bytes()).map_err(failed)
    })?;
    let all = read_rows(&path)?;
    let mut rows: Vec<Row> = cases.iter().filter_map(|c| row_of(c, &all)).cloned().collect();
    rows.sort_by(|a, b| a.scene.cmp(&b.scene));
    let text = table(&rows);
    let mut files = Together::default();
    files.text(&arguments.out.join("trial.md"), &text)?;
    let mut page = HtmlPage::new(&format!("Trial of {} cases", rows.len()));
    add_markdown(&mut page, &text);
    files.page(&arguments.out, "trial.html", &page)?;
    files.place()?;
    let wrong = rows.iter().filter(|r| r.judgement == Judgement::Wrong).count();
    let right = rows.iter().filter(|r| r.judgement == Judgement::Right).count();
    say!("{} cases: {right} right, {wrong} wrong; {}", rows.len(), arguments.out.join("trial.md").display());
    Ok(ExitCode::SUCCESS)
}

/// A case of another seed is another case.
fn row_of<'a>(case: &TrialCase, rows: &'a [Row]) -> Option<&'a Row> {
    rows.iter().find(|r| r.name == case.name && r.seed == case.seed)
}

fn no_case(place: &str) -> CliError {
    let remedy = "give --nulls 1 or more, or an --effect that the scene can have";
    CliError::Usage(format!("{place}: there is no case to try\n  remedy: {remedy}"))
}

fn check_effect(name: Option<&str>) -> Result<(), CliError> {
    let known = names();
    match name.filter(|n| !known.contains(n)) {
        Some(odd) => {
            let near = did_you_mean(odd, &known);
            Err(CliError::Usage(format!("--effect {odd}: no such effect{near}\n  remedy: `smam effects` lists them")))
        }
        None => Ok(()),
    }
}

fn read_rows(path: &Path) -> Result<Vec<Row>, CliError> {
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(e) => {
            let remedy = "give another folder with --out";
            return Err(CliError::Failed(format!("{}: cannot be read: {e}\n  remedy: {remedy}", path.display())));
        }
    };
    // The last line of a run that was killed may be half a line: that case is tried again.
    Ok(text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect())
}

fn open(path: &Path) -> Result<fs::File, CliError> {
    let failed = |source: std::io::Error| CliError::Write { file: path.to_owned(), source };
    let mut file = OpenOptions::new().create(true).append(true).read(true).open(path).map_err(failed)?;
    let ends_well = fs::read(path).map_err(failed)?.last().is_none_or(|b| *b == b'\n');
    if !ends_well {
        writeln!(file).map_err(failed)?;
    }
    Ok(file)
}
