//! `smam proof`.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Args, ValueEnum};
use rayon::prelude::*;
use smam::conceal::Hiding;
use smam::diagnose::{Step, Verdict};
use smam::proof::{Folders, Plan, Planned, ProofError, Row, answer_case, conceal_case, decide, open, row, settle};

use super::ceiling::{write_ceiling, write_law_ceiling, write_settling};
use super::score::{read_rows, read_seals, write_rows, write_score, write_seals};
use crate::cli::CliError;
use crate::cli::diagnose::StepName;
use crate::cli::files::take_folder;

/// Arguments of `smam proof`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam proof --cases 20 --seed 42                 your own seed; goes on where it was when started again
  smam proof --cases 20 --seed 42 --without pressure
  smam proof --cases 20 --laws --seed 42          laws that nobody chose, at ports that nobody chose")]
pub struct ProofArguments {
    /// Cases in which something is missing
    #[arg(long, default_value_t = 20)]
    cases: usize,
    /// Cases in which nothing is [default: as many]
    #[arg(long)]
    nothing: Option<usize>,
    /// Hide laws that nobody chose: port, variable, form and size are drawn, on the three rigs in turn; none that hide nothing
    #[arg(long)]
    laws: bool,
    /// With --laws: where an answer is not certain of the place, add runs as it proposes, up to two, and as many drawn ones
    #[arg(long, requires = "laws")]
    experiments: bool,
    /// Of everything that is drawn
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Diagnose with a step left out; answers and score go to DIR/without_STEP
    #[arg(long, value_enum, value_name = "STEP")]
    without: Option<StepName>,
    /// Compute as well what could be known at best of so many visible cases that hide one thing, and what the proposed
    /// experiments could decide at best (ceiling.jsonl, settling.jsonl); with --laws, chi² of the hidden law itself beside
    /// that of the answer (law_ceiling.jsonl)
    #[arg(long, value_name = "COUNT", default_value_t = 0)]
    ceiling: usize,
    /// Where cases, answers and score go; what is there already is kept
    #[arg(long, value_name = "DIR", default_value = "out/proof")]
    out: PathBuf,
}

/// Runs the command: conceals every case, publishes the seals, then case after case diagnoses, opens the seal and, of an
/// ambiguous answer, plays the experiment that it proposes. Rows that are there already, with their seals, are kept.
pub fn proof(arguments: &ProofArguments) -> Result<ExitCode, CliError> {
    let nothing = arguments.nothing.unwrap_or(arguments.cases);
    if arguments.cases + nothing == 0 {
        return Err(CliError::Usage(
            "--cases 0: there is nothing to prove\n  remedy: ask for one case or more".to_owned(),
        ));
    }
    let plan = if arguments.laws {
        Plan { hiding: 0, nothing: arguments.nothing.unwrap_or(0), laws: arguments.cases, seed: arguments.seed }
    } else {
        Plan { hiding: arguments.cases, nothing, laws: 0, seed: arguments.seed }
    };
    let planned = plan.cases();
    let folders = Folders::below(&arguments.out);
    let (folders, out) = match arguments.without.and_then(|s| s.to_possible_value()) {
        Some(step) => {
            let out = arguments.out.join(format!("without_{}", step.get_name()));
            (folders.with_answers(out.join("answers")), out)
        }
        None => (folders, arguments.out.clone()),
    };
    let _held = take_folder(&out)?;
    let journal = out.join("rows.jsonl");
    let former = former_rows(&journal, &planned)?;
    let seals = conceal_all(&planned, &former, &folders)?;
    let run = Run {
        planned: &planned,
        seals: &seals,
        folders: &folders,
        without: arguments.without.map(StepName::step),
        experiments: arguments.experiments,
    };
    let (rows, failed) = run.answer_all(former, &out, &journal)?;
    write_score(&rows, &out)?;
    if arguments.ceiling > 0 && arguments.laws {
        write_law_ceiling(&rows, arguments.ceiling, &seals, &folders, &out)?;
    } else if arguments.ceiling > 0 {
        write_ceiling(&rows, arguments.ceiling, &seals, &folders, &out)?;
        write_settling(&rows, &seals, &folders, &out)?;
    }
    if !failed.is_empty() {
        return Err(CliError::Failed(format!(
            "{} of {} cases could not be answered, and are not in the figures: {}\n  remedy: run `smam diagnose` on the case alone",
            failed.len(),
            planned.len(),
            failed.join(", ")
        )));
    }
    Ok(ExitCode::SUCCESS)
}

/// Rows that a former run has written, of the cases that are planned.
fn former_rows(journal: &Path, planned: &[Planned]) -> Result<Vec<Row>, CliError> {
    let rows = if journal.is_file() {
        read_rows(journal, "move it away; the cases are then answered again")?
    } else {
        Vec::new()
    };
    let is_planned = |r: &Row| planned.iter().any(|c| c.name == r.name && c.rig == r.rig && c.hiding == r.hiding);
    Ok(rows.into_iter().filter(is_planned).collect())
}

/// Makes what is not there yet; the seals stand in cases/seals.txt before anything is diagnosed. Of a case with a row
/// only the seal is wanted.
fn conceal_all(planned: &[Planned], former: &[Row], folders: &Folders) -> Result<Vec<(String, String)>, CliError> {
    let path = folders.cases.join("seals.txt");
    let published: HashMap<String, String> =
        if path.is_file() { read_seals(&path)?.into_iter().collect() } else { HashMap::new() };
    let has_row: HashSet<&str> = former.iter().map(|r| r.name.as_str()).collect();
    let seal = |case: &Planned| -> Result<(String, String), ProofError> {
        let there = folders.seal_of(&case.name);
        // What was published counts, should the answer have been changed since.
        let is_done = there.is_some() || has_row.contains(case.name.as_str());
        if let Some(seal) = published.get(&case.name).filter(|_| is_done).cloned().or(there) {
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

/// What is to be answered, and how.
struct Run<'a> {
    planned: &'a [Planned],
    /// In the order of the plan.
    seals: &'a [(String, String)],
    folders: &'a Folders,
    without: Option<Step>,
    /// Whether runs are added where the place of a drawn law is open.
    experiments: bool,
}

impl Run<'_> {
    /// The rows of all cases, in the order of the plan, and the cases that cannot be answered; each row is on disk before the next case
    /// is begun.
    fn answer_all(&self, mut rows: Vec<Row>, out: &Path, journal: &Path) -> Result<(Vec<Row>, Vec<String>), CliError> {
        // A row whose runs are to be added now is written again, from the answer that is there.
        rows.retain(|r| !(self.experiments && r.decided.is_none() && r.is_open_of_a_law()));
        let done: HashSet<String> = rows.iter().map(|r| r.name.clone()).collect();
        let seals = self.seals.iter().filter(|(name, _)| !done.contains(name));
        let missing: Vec<&(String, String)> = seals.collect();
        eprintln!("{} cases, {} of them done already", self.planned.len(), done.len());
        let (begun, mut failed) = (Instant::now(), Vec::new());
        for (i, (name, seal)) in missing.iter().enumerate() {
            match self.answer(name, seal, out) {
                Ok(row) => rows.push(row),
                // The hours of the others are not to be lost by it.
                Err(ProofError::Diagnose(error)) => {
                    eprintln!("{name} cannot be answered: {error}");
                    failed.push(name.clone());
                    continue;
                }
                Err(error) => return Err(error.into()),
            }
            write_rows(&rows, journal)?;
            let took_s = begun.elapsed().as_secs_f64();
            let left_s = took_s / (i + 1) as f64 * (missing.len() - i - 1) as f64;
            let seconds = self.folders.seconds(name).unwrap_or(f64::NAN);
            eprintln!("{}/{} {name} {seconds:.1} s; about {:.0} min left", i + 1, missing.len(), left_s / 60.0);
        }
        let place: HashMap<&str, usize> = self.planned.iter().enumerate().map(|(i, c)| (c.name.as_str(), i)).collect();
        rows.sort_by_key(|r| place.get(r.name.as_str()).copied());
        Ok((rows, failed))
    }

    /// Whether the experiment that an answer proposes is tried. Of drawn laws it is not: that asks for time that their search needs.
    fn is_tried(&self, hiding: Hiding) -> bool {
        !matches!(hiding, Hiding::Nothing | Hiding::Law | Hiding::Laws) && self.without.is_none()
    }

    /// Diagnoses a case unless its answer is there, opens its seal, and tries the experiment of an ambiguous answer.
    fn answer(&self, name: &str, seal: &str, out: &Path) -> Result<Row, ProofError> {
        if !self.folders.is_answered(name) {
            answer_case(name, self.folders, self.without)?;
        }
        let truth = open(name, seal, self.folders)?;
        let mut row = row(&truth, self.folders)?;
        if row.verdict == Verdict::Ambiguous && self.is_tried(row.hiding) {
            eprintln!("the proposed experiment, and a random one, for {name}");
            row.settled = settle(&truth, self.folders, &out.join("experiments"))?;
        }
        if self.experiments && row.is_open_of_a_law() {
            eprintln!("runs that {name} proposes, and drawn ones");
            row.decided = decide(&truth, self.folders, &out.join("experiments"))?;
        }
        Ok(row)
    }
}
