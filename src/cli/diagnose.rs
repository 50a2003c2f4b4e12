//! `smam diagnose`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::builder::RangedU64ValueParser;
use clap::{Args, ValueEnum};
use smam::diagnose::{
    Case, Diagnosis, Estimate, Options, Outcome, Step, Verdict, diagnose as run_diagnosis, write_answer_with,
};
use smam::recording::RecordingSet;
use smam::report::{FIGURES, diagnosis_page};

use super::CliError;
use super::changes::Changes;
use super::diagnose_view::Shown;
use super::files::{Files, make_folder, recorded_files, scene_files, take_folder};
use super::import::recordings;
use super::results::Results;

/// Arguments of `smam diagnose`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam diagnose rig/monday                   answer on the screen; page, scene and next experiment in out/
  smam diagnose rig/monday rig/tuesday       two folders of the same rig together
  smam diagnose sine.csv --scene muscle_bench   one file whose columns have telling names
  smam diagnose rig/monday --rrd --seed 3    with a side-by-side recording for the viewer")]
pub struct DiagnoseArguments {
    /// Folders with a recordings.toml, all of one rig; or a file, which is described as `smam import` does
    #[arg(required = true)]
    dirs: Vec<PathBuf>,
    /// Use this scene instead of the one that recordings.toml names
    #[arg(long)]
    scene: Option<String>,
    #[command(flatten)]
    changes: Changes,
    /// Where to write diagnosis.json, report.html, scene.toml and baseline.toml [default: out/diagnose_DIR]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Write diagnosis.rrd beside them: measured, calibrated and corrected scene side by side, for the Rerun viewer
    #[arg(long)]
    rrd: bool,
    /// Open the Rerun viewer on the same
    #[arg(long)]
    view: bool,
    /// Predict this specimen from the others alone: all its runs are held back, their stated conditions kept
    #[arg(long, value_name = "SPECIMEN")]
    transfer: Option<String>,
    /// Leave a step out, to see what it is worth
    #[arg(long, value_enum, value_name = "STEP")]
    without: Option<StepName>,
    /// Search to the end, whatever it costs: else steps that it can do without do not begin after some two minutes, which a warning says
    #[arg(long)]
    thorough: bool,
    /// Of the bootstrap's draws; the same seed gives the same answer
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads [default: all cores]; the answer does not depend on it
    #[arg(long, value_parser = threads())]
    threads: Option<usize>,
    /// Say at each step how many seconds have gone by, and how many million time steps have been simulated
    #[arg(long)]
    timings: bool,
}

/// Steps that can be left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
#[value(rename_all = "snake_case")]
pub enum StepName {
    /// Do not look at recorded pressures
    Pressure,
    /// Keep the scene's calibration as it is
    Refit,
    /// Keep effects that do not predict runs they were not fitted to
    CrossValidation,
    /// Answer with something of the catalogue always
    OpenSet,
}

impl StepName {
    pub fn step(self) -> Step {
        match self {
            Self::Pressure => Step::Pressure,
            Self::Refit => Step::Refit,
            Self::CrossValidation => Step::CrossValidation,
            Self::OpenSet => Step::OpenSet,
        }
    }
}

/// Runs the command. Exit code 0 whatever the verdict, but 1 when the recordings cannot be diagnosed.
pub fn diagnose(arguments: &DiagnoseArguments) -> Result<ExitCode, CliError> {
    let shown = Shown { in_file: arguments.rrd, in_window: arguments.view };
    shown.check()?;
    use_threads(arguments.threads)?;
    let overrides = arguments.changes.overrides()?;
    let folders: Vec<&Path> = arguments.dirs.iter().map(PathBuf::as_path).collect();
    let scene = arguments.scene.as_deref();
    let sets = folders.iter().map(|path| recordings(path, scene)).collect::<Result<Vec<_>, _>>()?;
    let mut case = Case::of_sets(&sets, &folders, scene, &overrides)?;
    if let Some(specimen) = &arguments.transfer {
        case.transfer(specimen)?;
    }
    if let Some(step) = arguments.without {
        case.leave_out(step.step());
    }
    if arguments.thorough {
        case.search_thoroughly();
    }
    let results = Results::of(&arguments.dirs[0], "diagnose", arguments.out.as_deref())?;
    let out = &results.folder;
    refuse_read_files(&case, &sets, out)?;
    let _held = take_folder(out)?;
    results.note_input()?;
    let (start, effort) = (Instant::now(), case.effort.watched());
    let progress = |line: String| match arguments.timings {
        true => {
            let [seconds, millions] = [start.elapsed().as_secs_f64(), effort.time_steps() as f64 * 1e-6];
            eprintln!("{seconds:7.1} s {millions:7.1} M  {line}");
        }
        false => eprintln!("{line}"),
    };
    let outcome = run_diagnosis(case, Options { seed: arguments.seed }, &progress)?;
    if arguments.timings {
        progress("done".to_owned());
    }
    write_all(&outcome, out)?;
    print_diagnosis(&outcome.diagnosis);
    eprintln!("written: {}", out.display());
    shown.show(&outcome, out)?;
    let usable = outcome.diagnosis.verdict != Verdict::UnusableData;
    Ok(if usable { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// Writes the answer with its page, and beside the page the samples of long runs.
fn write_all(outcome: &Outcome, out: &Path) -> Result<(), CliError> {
    let page = diagnosis_page(outcome);
    let text = page.finish();
    if !page.files().is_empty() {
        make_folder(&out.join(FIGURES))?;
    }
    let beside = page.files().iter().map(|(path, text)| (path.as_str(), text.as_str()));
    let more: Vec<(&str, &str)> = beside.chain([("report.html", text.as_str())]).collect();
    Ok(write_answer_with(outcome, &more, out)?)
}

/// Files of an answer, but one for each further specimen.
const ANSWER: [&str; 6] =
    ["diagnosis.json", "report.html", "diagnosis.rrd", "next_experiment.csv", "scene.toml", "baseline.toml"];

/// An answer must not take the place of what is diagnosed: a recorded next_experiment.csv, say, or a scene.toml.
fn refuse_read_files(case: &Case, sets: &[RecordingSet], out: &Path) -> Result<(), CliError> {
    let mut read = Files::default();
    read.extend(scene_files(&case.scene));
    sets.iter().for_each(|set| read.extend(recorded_files(set)));
    let is_of_specimen = |name: &str| name.starts_with("scene_") && name.ends_with(".toml");
    read.refuse_in(out, |name| ANSWER.contains(&name) || is_of_specimen(name))
}

/// What --threads takes: 0 would mean all cores, and a slip of the finger would start threads until the machine stands.
pub fn threads() -> RangedU64ValueParser<usize> {
    RangedU64ValueParser::new().range(1..=1024)
}

/// Works on so many threads from now on; on all cores if none is given.
pub fn use_threads(threads: Option<usize>) -> Result<(), CliError> {
    let Some(threads) = threads else { return Ok(()) };
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global().map_err(|e| {
        CliError::Usage(format!("--threads {threads}: {e}\n  remedy: give fewer threads, or leave --threads out"))
    })
}

fn print_parameters(parameters: &BTreeMap<String, Estimate>) {
    for (key, p) in parameters {
        match p.ci95 {
            [low, high] if low == high => say!("           {key} = {:.4e}  (not fitted)", p.value),
            [low, high] => say!("           {key} = {:.4e}  [{low:.4e}, {high:.4e}]", p.value),
        }
    }
}

fn print_diagnosis(d: &Diagnosis) {
    say!("{}", d.summary);
    for e in &d.effects {
        let on = e.channel.as_ref().map_or(String::new(), |c| format!(" ({c})"));
        say!("  {:.3}  {} in {}{on}: {}", e.probability, e.name, e.element, e.law);
        print_parameters(&e.parameters);
    }
    if !d.discrepancy.is_empty() {
        say!("  what that leaves is described in scene.toml by");
    }
    for term in &d.discrepancy {
        let on = term.channel.as_ref().map_or(String::new(), |c| format!(" ({c})"));
        say!("         {} in {}{on}: {}", term.name, term.element, term.law);
        print_parameters(&term.parameters);
    }
    say!(
        "  misfit per sample {:.4} -> {:.4} of the noise's variance",
        d.detection.excess_chi2_per_sample,
        d.detection.excess_chi2_per_sample_corrected
    );
    for (channel, p) in &d.fit.channels {
        say!(
            "  held out {}: {channel} rmse {:.4} -> {:.4} (noise {:.4})",
            d.fit.holdout.join(", "),
            p.rmse_baseline,
            p.rmse_corrected,
            p.noise_sd
        );
    }
    for (channel, difference) in &d.fit.full_scene.rms_difference_over_noise {
        say!("  reduced-order model against the full scene: {channel} {difference:.3} of the noise");
    }
    say!("  next: {}", d.next_experiment.why);
    d.warnings.iter().for_each(|w| eprintln!("warning: {w}"));
}
