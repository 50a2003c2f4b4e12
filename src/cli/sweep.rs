//! `smam sweep`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Subcommand};
use indicatif::{ProgressBar, ProgressStyle};
use smam::scene::Override;
use smam::sweep::{
    Journal, MeasureSpec, Plan, SamplingSpec, Shard, SweepFile, Table, VarySpec, Watch, check_shard, sensitivity,
    write_best,
};
use smam::system::Concern;

use super::CliError;
use super::changes::laws;
use super::diagnose::{threads, use_threads};
use super::files::see_there;
use super::interrupt::stop_flag;
use super::sweep_page::write_page;
use super::sweep_trouble::said_of_trouble;

/// Arguments of `smam sweep`.
#[derive(Args)]
#[command(
    args_conflicts_with_subcommands = true,
    after_help = "Examples:
  smam sweep antagonistic_pulley --vary muscles.pre_elongation_ratio=0.2:1.0:17 --measure 'range_deg=range(angle_deg)'
  smam sweep my_sweep.toml --resume                      goes on after a kill
  smam sweep my_sweep.toml --shard 1/4 --out out/a       a part of it, for another machine
  smam sweep merge my_sweep.toml out/a out/b --out out/whole"
)]
pub struct SweepArguments {
    #[command(subcommand)]
    command: Option<SweepCommand>,
    #[command(flatten)]
    run: RunSweep,
}

#[derive(Subcommand)]
enum SweepCommand {
    /// Put the shards of a sweep together: table.csv, table.parquet, sweep.html
    Merge {
        /// Sweep file, as given to the shards
        sweep: PathBuf,
        /// Folders that the shards wrote
        #[arg(required = true)]
        folders: Vec<PathBuf>,
        /// Where to write
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
    /// Draw a sweep's page again from its journal or its table
    Plot {
        /// Sweep file
        sweep: PathBuf,
        /// Folder that the sweep wrote, or its table.parquet: the page goes beside it
        folder: PathBuf,
    },
}

#[derive(Args)]
struct RunSweep {
    /// A sweep file, or with --vary the path or name of a scene
    #[arg(required = true)]
    what: Option<String>,
    /// Vary a key over a range: KEY=FROM:TO:COUNT, or KEY=A,B,C; a grid with several
    #[arg(long, value_name = "KEY=RANGE")]
    vary: Vec<String>,
    /// Measure of each run: max(angle_deg) - min(angle_deg), or NAME=...
    #[arg(long, value_name = "FIGURES")]
    measure: Vec<String>,
    /// Add a law of your own to the scene of --vary: 'PORT adds|scales EXPRESSION'; may be given several times
    #[arg(long, value_name = "LAW")]
    law: Vec<String>,
    /// Trouble that a point may be in and still count: slack, cavitation, yield, penetration, joint_limit; may be given several times
    #[arg(long, value_name = "TROUBLE", value_parser = concern)]
    allow: Vec<Concern>,
    /// Length of each run, s, instead of the scene's
    #[arg(long, value_name = "S")]
    duration: Option<f64>,
    /// Where journal, tables and page go [default: out/sweep_NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Go on with what a run before has left there
    #[arg(long)]
    resume: bool,
    /// Only this part of the points, as 2/7; put parts together with `smam sweep merge`
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    /// Threads [default: all cores]; the table does not depend on it
    #[arg(long, value_parser = threads())]
    threads: Option<usize>,
}

/// Runs the command.
pub fn sweep(arguments: &SweepArguments) -> Result<ExitCode, CliError> {
    match &arguments.command {
        Some(SweepCommand::Merge { sweep, folders, out }) => merge(sweep, folders, out),
        Some(SweepCommand::Plot { sweep, folder }) => plot(sweep, folder),
        None => run(&arguments.run),
    }
}

fn run(arguments: &RunSweep) -> Result<ExitCode, CliError> {
    use_threads(arguments.threads)?;
    let plan = Plan::new(file(arguments)?)?;
    let out = arguments.out.clone().unwrap_or_else(|| Path::new("out").join(format!("sweep_{}", plan.file.name)));
    let shard = arguments.shard.unwrap_or(Shard::WHOLE);
    check_shard(&plan, shard)?;
    Table::check_place(&plan, &out)?;
    let journal = Journal::open(&out, &plan, arguments.resume)?;
    run_points(&plan, &journal, shard)?;
    let table = Table::of_folders(&plan, &[&out])?;
    finish(&plan, &table, &out, shard)
}

fn run_points(plan: &Plan, journal: &Journal, shard: Shard) -> Result<(), CliError> {
    let pending = shard.points(plan.count()).filter(|i| !journal.done.contains_key(i)).count();
    eprintln!("{}: {} points, {pending} of them to do", plan.file.name, plan.count());
    let bar = ProgressBar::new(pending as u64);
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} points, {eta} left");
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let stop = stop_flag();
    smam::sweep::run(plan, journal, shard, &Watch { stop, point_done: &|| bar.inc(1) })?;
    bar.finish_and_clear();
    Ok(())
}

fn finish(plan: &Plan, table: &Table, out: &Path, shard: Shard) -> Result<ExitCode, CliError> {
    table.write(out)?;
    write_best(plan, table, out)?;
    if let Some(found) = sensitivity(plan, table) {
        found.write(out)?;
    }
    write_page(plan, table, out)?;
    see_there(&["table.csv", "table.parquet"].map(|name| out.join(name)))?;
    for (index, error) in table.failed().take(5) {
        eprintln!("point {index} failed: {}", error.lines().next().unwrap_or(""));
    }
    say_without_number(plan, table);
    let failed = table.failed().count();
    let missing = shard.points(plan.count()).filter(|i| !table.has(*i)).count();
    eprintln!("{} rows, {failed} of them failed: {}", table.rows.len(), out.join("table.csv").display());
    if let Some(words) = said_of_trouble(plan, table) {
        eprintln!("warning: {words}");
    }
    if failed > 0 && failed == table.rows.len() {
        eprintln!("every point failed: the first says why");
        return Ok(ExitCode::from(1));
    }
    if missing > 0 {
        eprintln!("{missing} points are not done: go on with --resume, or name the folders of all shards");
        return Ok(ExitCode::from(1));
    }
    Ok(ExitCode::SUCCESS)
}

/// A measure that is no number leaves its cell empty: said, because the run itself did not fail.
fn say_without_number(plan: &Plan, table: &Table) {
    for measure in &plan.measures {
        let ran = table.rows.iter().filter(|r| r.outcome.is_ok());
        let missing = ran.filter(|r| !plan.measured(r, &measure.name).is_finite()).count();
        if missing > 0 {
            eprintln!("warning: {} is no number at {missing} of {} points", measure.name, table.rows.len());
        }
    }
}

fn merge(sweep: &Path, folders: &[PathBuf], out: &Path) -> Result<ExitCode, CliError> {
    let plan = Plan::new(SweepFile::load(sweep)?)?;
    Table::check_place(&plan, out)?;
    let folders: Vec<&Path> = folders.iter().map(PathBuf::as_path).collect();
    let table = Table::of_folders(&plan, &folders)?;
    finish(&plan, &table, out, Shard::WHOLE)
}

fn plot(sweep: &Path, folder: &Path) -> Result<ExitCode, CliError> {
    let plan = Plan::new(SweepFile::load(sweep)?)?;
    let (table, out) = match folder.extension() {
        Some(e) if e == "parquet" => (Table::of_parquet(&plan, folder)?, folder.parent().unwrap_or(Path::new("."))),
        _ => (Table::of_folders(&plan, &[folder])?, folder),
    };
    write_page(&plan, &table, out)?;
    Ok(ExitCode::SUCCESS)
}

/// The sweep that the arguments describe: a file, or a scene with --vary and --measure.
fn file(arguments: &RunSweep) -> Result<SweepFile, CliError> {
    let what = arguments.what.as_deref().unwrap_or_default();
    if arguments.vary.is_empty() {
        let of_scenes = [!arguments.measure.is_empty(), !arguments.law.is_empty(), !arguments.allow.is_empty()];
        if of_scenes.contains(&true) || arguments.duration.is_some() {
            let message = "--measure, --law, --allow and --duration need --vary and the name of a scene";
            let remedy =
                "a sweep file holds its own measures, and laws as set = ['law.NAME={port=\"...\", adds=\"...\"}']";
            return Err(CliError::Usage(format!("{message}\n  remedy: {remedy}")));
        }
        if !Path::new(what).is_file() {
            let remedy = "give a sweep file (docs/sweeps.md), or a scene with --vary KEY=FROM:TO:COUNT and --measure";
            return Err(CliError::Usage(format!("{what}: there is no such sweep file\n  remedy: {remedy}")));
        }
        return Ok(SweepFile::load(Path::new(what))?);
    }
    let stem = Path::new(what).file_stem().map_or_else(|| what.to_owned(), |s| s.to_string_lossy().into_owned());
    Ok(SweepFile {
        format: 1,
        name: stem,
        title: String::new(),
        scene: what.to_owned(),
        duration_s: arguments.duration,
        sampling: SamplingSpec::Grid,
        vary: arguments.vary.iter().map(|v| vary(v)).collect::<Result<_, _>>()?,
        measure: arguments.measure.iter().map(|m| measure(m)).collect(),
        objective: Vec::new(),
        limit: Vec::new(),
        allow: arguments.allow.clone(),
        output: Vec::new(),
        set: laws(&arguments.law)?.iter().map(Override::text).collect(),
    })
}

/// Reads a kind of trouble.
fn concern(text: &str) -> Result<Concern, String> {
    let words = Concern::ALL.map(Concern::word).join(", ");
    Concern::ALL.into_iter().find(|c| c.word() == text).ok_or_else(|| format!("one of {words} is wanted"))
}

/// Reads `KEY=0.2:0.8:25` or `KEY=0.2,0.5,0.8`.
fn vary(text: &str) -> Result<VarySpec, CliError> {
    let wrong =
        |what: &str| CliError::Usage(format!("--vary {text}: {what}\n  remedy: write KEY=FROM:TO:COUNT or KEY=A,B,C"));
    let (key, range) = text.split_once('=').ok_or_else(|| wrong("there is no `=`"))?;
    let key = key.trim().to_owned();
    let numbers =
        |separator: char| -> Option<Vec<f64>> { range.split(separator).map(|n| n.trim().parse().ok()).collect() };
    if !range.contains(':') {
        let values = numbers(',').ok_or_else(|| wrong("not all of its values are numbers"))?;
        return Ok(VarySpec { key, values, ..VarySpec::default() });
    }
    match numbers(':').as_deref() {
        Some([from, to, count]) if (1.0..=1e8).contains(count) && count.fract() == 0.0 => {
            Ok(VarySpec { key, from: Some(*from), to: Some(*to), count: Some(*count as u64), ..VarySpec::default() })
        }
        Some([_, _, count]) => Err(wrong(&format!("COUNT = {count:?} must be a whole number, 1 to 1e8"))),
        Some(_) => Err(wrong("a range takes three numbers")),
        None => Err(wrong("not all of FROM, TO and COUNT are numbers")),
    }
}

fn measure(text: &str) -> MeasureSpec {
    match text.split_once('=') {
        Some((name, of)) => MeasureSpec { name: name.trim().to_owned(), of: of.trim().to_owned() },
        None => MeasureSpec { name: text.to_owned(), of: text.to_owned() },
    }
}
