//! `smam proof`.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use clap::Args;
use rayon::prelude::*;
use smam::proof::{Folders, Plan, Planned, ProofError, answer_case, conceal_case};

use super::CliError;
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
    /// Where cases, answers and score go; what is there already is kept
    #[arg(long, value_name = "DIR", default_value = "out/proof")]
    out: PathBuf,
}

/// Runs the command: conceals every case, publishes the seals, diagnoses case after case, opens the seals.
pub fn proof(arguments: &ProofArguments) -> Result<ExitCode, CliError> {
    let nothing = arguments.nothing.unwrap_or(arguments.cases);
    let planned = Plan { hiding: arguments.cases, nothing, seed: arguments.seed }.cases();
    let folders = Folders::below(&arguments.out);
    let seals = conceal_all(&planned, &folders)?;
    answer_all(&planned, &folders)?;
    write_score(&open_all(&seals, &folders)?, &arguments.out)?;
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

fn answer_all(planned: &[Planned], folders: &Folders) -> Result<(), CliError> {
    let missing: Vec<&Planned> = planned.iter().filter(|c| !folders.is_answered(&c.name)).collect();
    eprintln!("{} cases, {} of them answered already", planned.len(), planned.len() - missing.len());
    let begun = Instant::now();
    for (i, case) in missing.iter().enumerate() {
        answer_case(&case.name, folders)?;
        let took_s = begun.elapsed().as_secs_f64();
        let left_s = took_s / (i + 1) as f64 * (missing.len() - i - 1) as f64;
        let seconds = folders.seconds(&case.name).unwrap_or(f64::NAN);
        eprintln!("{}/{} {} {seconds:.1} s; about {:.0} min left", i + 1, missing.len(), case.name, left_s / 60.0);
    }
    Ok(())
}
