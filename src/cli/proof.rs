//! `smam proof`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, ValueEnum};
use rayon::prelude::*;
use smam::conceal::Hiding;
use smam::diagnose::{Step, Verdict};
use smam::proof::{Folders, Plan, Planned, ProofError, Row, answer_case, conceal_case, open, settle};

use super::CliError;
use super::ceiling::write_ceiling;
use super::diagnose::StepName;
use super::score::{open_all, read_seals, write_score, write_seals};

/// Arguments of `smam proof`.
#[derive(Args)]
pub struct ProofArguments {
    /// Cases in which something is missing
    #[arg(long, default_value_t = 20)]
    cases: usize,
    /// Cases in which nothing is [default: as many]
    #[arg(long)]
    nothing: Option<usize>,
    /// Of everything that is drawn
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Diagnose with a step left out; answers and score go to DIR/without_STEP
    #[arg(long, value_enum, value_name = "STEP")]
    without: Option<StepName>,
    /// Compute as well what could be known at best of so many visible cases that hide one thing: ceiling.jsonl
    #[arg(long, value_name = "COUNT", default_value_t = 0)]
    ceiling: usize,
    /// Where cases, answers and score go; what is there already is kept
    #[arg(long, value_name = "DIR", default_value = "out/proof")]
    out: PathBuf,
}

/// Runs the command: conceals every case, publishes the seals, diagnoses case after case, opens the seals,
/// plays the experiments that ambiguous answers propose.
pub fn proof(arguments: &ProofArguments) -> Result<ExitCode, CliError> {
    let nothing = arguments.nothing.unwrap_or(arguments.cases);
    let planned = Plan { hiding: arguments.cases, nothing, seed: arguments.seed }.cases();
    let folders = Folders::below(&arguments.out);
    let seals = conceal_all(&planned, &folders)?;
    let (folders, out) = match arguments.without.and_then(|s| s.to_possible_value()) {
        Some(step) => {
            let out = arguments.out.join(format!("without_{}", step.get_name()));
            (folders.with_answers(out.join("answers")), out)
        }
        None => (folders, arguments.out.clone()),
    };
    answer_all(&planned, &folders, arguments.without.map(StepName::step))?;
    let mut rows = open_all(&seals, &folders)?;
    settle_all(&mut rows, &seals, &folders, &out)?;
    write_score(&rows, &out)?;
    if arguments.ceiling > 0 {
        write_ceiling(&rows, arguments.ceiling, &seals, &folders, &out)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Makes what is not there yet; the seals stand in cases/seals.txt before anything is diagnosed.
fn conceal_all(planned: &[Planned], folders: &Folders) -> Result<Vec<(String, String)>, CliError> {
    let path = folders.cases.join("seals.txt");
    let known = if path.is_file() { read_seals(&path)? } else { Vec::new() };
    let seal = |case: &Planned| -> Result<(String, String), ProofError> {
        let there = folders.seal_of(&case.name);
        // What was published counts, should the answer have been changed since.
        let published = known.iter().find(|(name, _)| there.is_some() && *name == case.name);
        if let Some(seal) = published.map(|(_, seal)| seal.clone()).or(there) {
            return Ok((case.name.clone(), seal));
        }
        let seal = conceal_case(case, folders)?;
        eprintln!("concealed {}", case.name);
        Ok((case.name.clone(), seal))
    };
    let seals = planned.par_iter().map(seal).collect::<Result<Vec<_>, _>>()?;
    write_seals(&path, &seals)?;
    Ok(seals)
}

fn answer_all(planned: &[Planned], folders: &Folders, without: Option<Step>) -> Result<(), CliError> {
    let missing: Vec<&Planned> = planned.iter().filter(|c| !folders.is_answered(&c.name)).collect();
    eprintln!("{} cases, {} of them answered already", planned.len(), planned.len() - missing.len());
    let begun = Instant::now();
    for (i, case) in missing.iter().enumerate() {
        answer_case(&case.name, folders, without)?;
        let took_s = begun.elapsed().as_secs_f64();
        let left_s = took_s / (i + 1) as f64 * (missing.len() - i - 1) as f64;
        let seconds = folders.seconds(&case.name).unwrap_or(f64::NAN);
        eprintln!("{}/{} {} {seconds:.1} s; about {:.0} min left", i + 1, missing.len(), case.name, left_s / 60.0);
    }
    Ok(())
}

/// Plays what ambiguous answers propose, and a random programme beside it; what was diagnosed already is kept.
fn settle_all(rows: &mut [Row], seals: &[(String, String)], folders: &Folders, out: &Path) -> Result<(), CliError> {
    let is_open = |r: &Row| r.verdict == Verdict::Ambiguous && r.hiding != Hiding::Nothing;
    let count = rows.iter().filter(|r| is_open(r)).count();
    for (i, row) in rows.iter_mut().filter(|r| is_open(r)).enumerate() {
        eprintln!("experiment {}/{count} for {}", i + 1, row.name);
        let Some((_, seal)) = seals.iter().find(|(name, _)| *name == row.name) else { continue };
        row.settled = settle(&open(&row.name, seal, folders)?, folders, &out.join("experiments"))?;
    }
    Ok(())
}
