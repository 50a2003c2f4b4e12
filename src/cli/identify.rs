//! `smam identify`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use clap::builder::RangedU64ValueParser;
use serde_json::{Value, json};
use smam::identify::load_runs;
use smam::identify::loops::{
    Form, Identification, LoopError, LoopRun, Method, SearchOptions, identify as identify_loops, mean_square_on,
};
use smam::recording::{RecordingSet, Role, RunUse, read_recording};

use super::CliError;
use super::files::{Together, take_folder};
use super::identify_page::page;
use super::results::Results;

/// Arguments of `smam identify`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam identify rig/loop --model paper --model asymmetric
  smam identify loop.csv --model maxwell-slip --method hybrid")]
pub struct IdentifyArguments {
    /// Folder with a recordings.toml, or a CSV or Parquet file
    recordings: PathBuf,
    /// symmetric, asymmetric, paper, prandtl-ishlinskii, prandtl-ishlinskii-rate, maxwell-slip, maxwell-slip-growing or dahl-growing; may be given several times
    #[arg(long, value_name = "NAME", default_value = "paper")]
    model: Vec<Form>,
    /// pso (as in the paper), cma, lm or hybrid
    #[arg(long, default_value = "hybrid")]
    method: Method,
    /// Seed of what is drawn
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Descents from places of their own, or repetitions of a swarm
    #[arg(long, default_value_t = SearchOptions::default().starts, value_parser = starts())]
    starts: usize,
    /// Column of the input, a length [default: the first declared one, or plunger_mm]
    #[arg(long, value_name = "COLUMN")]
    input: Option<String>,
    /// Column of the output, a length [default: the first declared one, or elongation_mm]
    #[arg(long, value_name = "COLUMN")]
    output: Option<String>,
    /// Seconds at the start of each run that drive the model but do not count
    #[arg(long, value_name = "S", default_value_t = 0.0)]
    skip: f64,
    /// Where to write [default: out/identify_NAME]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// What --starts takes: none would be a search that begins nowhere, millions one that never ends.
fn starts() -> RangedU64ValueParser<usize> {
    RangedU64ValueParser::new().range(1..=10_000)
}

/// Runs to fit and runs held out.
pub struct Loops {
    pub name: String,
    pub fit: Vec<LoopRun>,
    pub holdout: Vec<LoopRun>,
}

/// Runs the command.
pub fn identify(arguments: &IdentifyArguments) -> Result<ExitCode, CliError> {
    if !(arguments.skip >= 0.0 && arguments.skip.is_finite()) {
        let message = format!("--skip {}: must be 0 or more, and finite", arguments.skip);
        return Err(CliError::Usage(format!("{message}\n  remedy: give seconds, or leave --skip out")));
    }
    let loops = load(arguments)?;
    let results = Results::of(&arguments.recordings, "identify", arguments.out.as_deref())?;
    let out = &results.folder;
    let _held = take_folder(out)?;
    results.note_input()?;
    let options = SearchOptions {
        method: arguments.method,
        seed: arguments.seed,
        starts: arguments.starts,
        ..SearchOptions::default()
    };
    let found: Vec<Identification> =
        arguments.model.iter().map(|&form| identify_loops(&loops.fit, form, &options)).collect::<Result<_, _>>()?;
    let answers: Vec<Value> = found.iter().map(|f| answer(f, &loops)).collect();
    let whole = json!({ "format": 1, "recordings": loops.name, "seed": arguments.seed, "identified": answers });
    let mut files = Together::default();
    for identification in &found {
        let file = out.join(format!("{}.toml", identification.form.name()));
        files.text(&file, &scene_table(identification)?)?;
    }
    files.page(out, "identify.html", &page(&found, &loops))?;
    files.text(&out.join("identify.json"), &format!("{whole:#}\n"))?;
    files.place()?;
    found.iter().for_each(|identification| say(identification, &loops));
    say!("page: {}    figures: {}", out.join("identify.html").display(), out.join("identify.json").display());
    Ok(ExitCode::SUCCESS)
}

fn load(arguments: &IdentifyArguments) -> Result<Loops, CliError> {
    let path = &arguments.recordings;
    let name = path.file_stem().map_or_else(|| "loops".to_owned(), |n| n.to_string_lossy().into_owned());
    let column = |given: &Option<String>, else_: &str| given.clone().unwrap_or_else(|| else_.to_owned());
    if path.extension().is_some_and(|e| ["csv", "parquet"].iter().any(|known| e.eq_ignore_ascii_case(known))) {
        let columns = [column(&arguments.input, "plunger_mm"), column(&arguments.output, "elongation_mm")];
        let file = path.display().to_string();
        let run = LoopRun::of(&file, &read_recording(path)?, [&columns[0], &columns[1]], arguments.skip)?;
        return Ok(Loops { name, fit: vec![run], holdout: Vec::new() });
    }
    let set = RecordingSet::load(path)?;
    let declared = |role: Role, usual: &str| {
        let mut columns = set.of_role(role).map(|c| c.column.clone());
        columns.next().unwrap_or_else(|| usual.to_owned())
    };
    let input = column(&arguments.input, &declared(Role::Input, "plunger_mm"));
    let output = column(&arguments.output, &declared(Role::Output, "elongation_mm"));
    let mut loops = Loops { name, fit: Vec::new(), holdout: Vec::new() };
    for run in load_runs(&set, &set.runs, &mut |n| eprintln!("note: {n}"))? {
        if run.run.not_recorded.contains(&output) {
            eprintln!("note: {}: recorded without {output}, left out", run.run.file);
            continue;
        }
        let read = LoopRun::of(&run.run.file, &run.recording, [&input, &output], arguments.skip)?;
        match run.run.run_use {
            Some(RunUse::Holdout) => loops.holdout.push(read),
            _ => loops.fit.push(read),
        }
    }
    Ok(loops)
}

/// F of the runs held out, if any.
pub fn unseen(found: &Identification, loops: &Loops) -> Option<f64> {
    (!loops.holdout.is_empty()).then(|| mean_square_on(&found.model, &loops.holdout))
}

fn say(found: &Identification, loops: &Loops) {
    say!(
        "{}: F = {:.6} mm² over {} samples, {} evaluations ({:?})",
        found.form.name(),
        found.mean_square_mm2,
        found.samples,
        found.evaluations,
        found.method
    );
    if let Some(f) = unseen(found, loops) {
        say!("  F of the runs held out: {f:.6} mm²");
    }
    for p in &found.parameters {
        let interval = p.half_width.map_or_else(|| "fixed".to_owned(), |h| format!("± {h:.2e}"));
        say!("  {:<12} {:>12.6}  {interval}", p.spec.name, p.value);
    }
    found.warnings.iter().for_each(|w| say!("  note: {w}"));
}

fn answer(found: &Identification, loops: &Loops) -> Value {
    let parameters: Vec<Value> = found
        .parameters
        .iter()
        .map(|p| {
            json!({
                "name": p.spec.name, "value": p.value, "half_width_95": p.half_width, "fixed": p.half_width.is_none(),
                "min": p.spec.min, "max": p.spec.max, "on_bound": p.on_bound, "bounds_because": p.spec.why,
            })
        })
        .collect();
    let p = found.free.len();
    let correlation: Vec<Vec<f64>> =
        (0..p).map(|i| (0..p).map(|j| found.certainty.correlation[(i, j)]).collect()).collect();
    json!({
        "model": found.form.name(),
        "method": found.method,
        "f_mm2": found.mean_square_mm2,
        "f_holdout_mm2": unseen(found, loops),
        "samples": found.samples,
        "evaluations": found.evaluations,
        "noise_mm": found.noise_mm,
        "parameters": parameters,
        "free": found.free,
        "correlation": correlation,
        "condition": found.certainty.condition,
        "residual_lag_1": found.certainty.colour,
        "residual_memory_samples": found.certainty.memory,
        "warnings": found.warnings,
    })
}

/// The model as a scene takes it.
fn scene_table(found: &Identification) -> Result<String, CliError> {
    let table = json!({ "muscles": { "displacement": found.model } });
    let text = toml::to_string(&table)
        .map_err(|e| CliError::Failed(format!("{}: the model cannot be written as TOML: {e}", found.form.name())))?;
    Ok(format!("# Goes into a scene as it stands; lengths in mm.\n{text}"))
}

impl From<LoopError> for CliError {
    fn from(error: LoopError) -> Self {
        match error {
            LoopError::Recording(e) => Self::Recording(e),
            other => Self::Usage(other.to_string()),
        }
    }
}
