//! `smam run`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::Args;
use smam::identify::LeadIn;
use smam::recording::{LoadedRun, Recording, survey};
use smam::scene::{Scene, ViewSpec};
use smam::system::{InputSource, RunError, Schedule, Simulation, run as run_simulation, with_half_steps};

use super::CliError;
use super::angles::Angles;
use super::changes::Changes;
use super::files::read_input;
use super::interrupt::{interrupted, stop_flag};
use super::observers::{Clock, Observers, Progress, Recorder};
use super::run_file::RunFile;
use super::steps::check_steps;

mod judged;
mod outputs;

use judged::{check, print_energy};
use outputs::{check_outputs, file_path, rrd_path, say_what_to_open};

/// Arguments of `smam run`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam run bending_catheter                                    writes out/bending_catheter.csv and .rrd
  smam run muscle_bench --set hydraulics.line.length_m=2       one key changed for this run
  smam run muscle_bench --law 'line.outflow adds 1e-16*pressure_pa'   a law of your own (smam laws)
  smam run muscle_bench --input measured.csv --output sim.csv  driven by a recording
  smam run bending_catheter --angles --output c.csv            prints every notch's angle and the tip's place
  smam run muscle_bench --check --junit checks.xml             the scene's own expectations, for CI")]
pub struct RunArguments {
    /// Path of a scene file, or a name that `smam scenes` lists
    scene: String,
    /// Drive the scene's inputs from this recording (CSV, .xlsx, .parquet or .mcap), at its sample times; read as a recordings.toml
    /// beside it declares
    #[arg(long, value_name = "FILE")]
    input: Option<PathBuf>,
    /// Write the recording here instead of out/NAME.csv; .parquet and .mcap are written as such, - is the standard output (CSV)
    #[arg(long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Write the Rerun stream here instead of out/NAME.rrd
    #[arg(long, value_name = "FILE")]
    rrd: Option<PathBuf>,
    /// Open the Rerun viewer and watch the run
    #[arg(long)]
    view: bool,
    /// Serve the Rerun stream on the loopback interface and wait for viewers
    #[arg(long)]
    serve: bool,
    /// Go no faster than the clock: for watching with --view or --serve
    #[arg(long)]
    real_time: bool,
    #[command(flatten)]
    changes: Changes,
    /// Length of the run, s, instead of the scene's
    #[arg(long, value_name = "S")]
    duration: Option<f64>,
    /// Print the position of every joint and of the tip: at the end, least and greatest on the way
    #[arg(long)]
    angles: bool,
    /// Print where the plunger's work went
    #[arg(long)]
    energy: bool,
    /// Play the run once more with half the steps and print how far each channel moves
    #[arg(long)]
    check_steps: bool,
    /// Print each [[expect]] of the scene with its figure; exit 1 when one fails
    #[arg(long)]
    check: bool,
    /// Write the results of --check for a CI system
    #[arg(long, value_name = "XML", requires = "check")]
    junit: Option<PathBuf>,
}

/// Runs the command.
pub fn run(arguments: &RunArguments) -> Result<ExitCode, CliError> {
    let overrides = arguments.changes.overrides()?;
    let scene = Scene::load(&arguments.scene, &overrides)?;
    check_outputs(arguments, &scene)?;
    let name = scene.file.name.clone();
    let mut simulation = Simulation::new(scene)?;
    simulation.warnings().iter().for_each(|w| eprintln!("note: {w}"));
    let schedule = schedule(arguments, &mut simulation)?;
    if arguments.energy {
        simulation.keep_energy_balance();
    }
    let end_s = schedule.last_s().unwrap_or(0.0);
    let view = simulation.scene().file.view.clone();
    let mut observers = observers(arguments, &name, &view, end_s)?;
    let begun = Instant::now();
    let outcome = run_simulation(&mut simulation, &schedule, stop_flag(), &mut observers);
    let wall_s = begun.elapsed().as_secs_f64();
    let reached_s = simulation.time_s();
    if let Some(progress) = observers.progress.take() {
        progress.finish();
    }
    let angles = observers.angles.take();
    // What could not be computed or written leaves nothing under its name: half a file looks like a whole one.
    let recording = match &outcome {
        Err(RunError::Observer(_)) => None,
        Err(RunError::System(_)) => finish_as_part(&mut observers).map(|()| None)?,
        Ok(_) => finish(&mut observers)?,
    };
    let mut warnings = outcome?;
    eprintln!("{name}: {:.3} s simulated in {wall_s:.3} s", reached_s - schedule.first_s().unwrap_or(0.0));
    warnings.summary(reached_s).iter().for_each(|w| eprintln!("warning: {w}"));
    say_what_to_open(arguments, &name);
    if let Some(angles) = angles {
        super::print_text(&angles.table())?;
    }
    if let Some(balance) = simulation.energy_balance() {
        print_energy(balance);
    }
    // Ctrl-C is how serving ends: only one that came before cut the run short.
    let cut_short = interrupted();
    hold_server(arguments);
    if cut_short {
        eprintln!("interrupted at {reached_s:.3} s: what was computed is written");
        return Ok(ExitCode::from(1));
    }
    let Some(recording) = recording else { return Ok(ExitCode::SUCCESS) };
    if arguments.check_steps {
        let mut halved = Simulation::new(with_half_steps(simulation.scene())?)?;
        drive_from_input(arguments, &mut halved)?;
        check_steps(&recording, &mut halved, &schedule)?;
    }
    if arguments.check { check(arguments, &simulation, &recording) } else { Ok(ExitCode::SUCCESS) }
}

/// Drives a further simulation from the recording of `--input`, which has been looked at already.
fn drive_from_input(arguments: &RunArguments, simulation: &mut Simulation) -> Result<(), CliError> {
    let Some(path) = &arguments.input else { return Ok(()) };
    drive(simulation, &read_input(path)?.recording, path).map(|_| ())
}

fn schedule(arguments: &RunArguments, simulation: &mut Simulation) -> Result<Schedule, CliError> {
    let spec = simulation.scene().file.simulation;
    let limit = arguments.duration;
    if let Some(d) = limit.filter(|d| !(*d > 0.0 && d.is_finite())) {
        return Err(CliError::Usage(format!(
            "--duration {d}: must be > 0\n  remedy: give the length of the run in seconds"
        )));
    }
    if let Some(d) = limit.filter(|d| d / spec.output_interval_s > MOST_SAMPLES) {
        return Err(CliError::Usage(format!(
            "--duration {d}: more than {MOST_SAMPLES:e} samples of {} s\n  remedy: run shorter, or set simulation.output_interval_s",
            spec.output_interval_s
        )));
    }
    let Some(path) = &arguments.input else {
        return Ok(Schedule::even(limit.unwrap_or(spec.duration_s), spec.output_interval_s));
    };
    let LoadedRun { recording, notes } = read_input(path)?;
    notes.iter().for_each(|n| eprintln!("note: {}: {n}", path.display()));
    survey(&recording).notes().iter().for_each(|n| eprintln!("note: {}: {n}", path.display()));
    let others = drive(simulation, &recording, path)?;
    if begins_away(simulation.scene(), &recording) {
        eprintln!(
            "note: {}: begins with a plunger away from zero: the run begins at rest there, as if it were zero (`smam compare` leads it there)",
            path.display()
        );
    }
    if !others.is_empty() {
        eprintln!("note: {}: no input of the scene, left alone: {}", path.display(), others.join(", "));
    }
    let first = recording.time_s().first().copied().unwrap_or(0.0);
    let within = recording.time_s().iter().copied().filter(|t| limit.is_none_or(|l| t - first <= l));
    Ok(Schedule::at(within.collect()))
}

/// As many as a scene may ask for.
const MOST_SAMPLES: f64 = 1e8;

/// Whether a plunger's first value is not the scene's zero.
fn begins_away(scene: &Scene, recording: &Recording) -> bool {
    let start_s = recording.time_s().first().copied().unwrap_or(0.0);
    let first = scene.file.input.iter().filter_map(|i| recording.piecewise_si(&i.channel).ok());
    LeadIn::before(scene, start_s, &first.map(|line| line.value(start_s)).collect::<Vec<_>>()).is_some()
}

/// Drives every input of the scene from the recording; returns the columns that are no input.
fn drive(simulation: &mut Simulation, recording: &Recording, path: &Path) -> Result<Vec<String>, CliError> {
    let inputs: Vec<String> = simulation.scene().file.input.iter().map(|i| i.channel.clone()).collect();
    for input in &inputs {
        if recording.find(input).is_none() {
            return Err(CliError::Usage(format!(
                "{}: the input column \"{input}\" is missing; found: {}\n  remedy: add the column; the scene's inputs are {}",
                path.display(),
                recording.columns().join(", "),
                inputs.join(", ")
            )));
        }
        simulation.set_input(
            input,
            InputSource::Recorded(recording.piecewise_si(input).map_err(|e| e.in_file(path.display().to_string()))?),
        );
    }
    let is_other = |column: &&str| !inputs.iter().any(|i| i == column);
    Ok(recording.columns().into_iter().filter(is_other).map(str::to_owned).collect())
}

fn observers(arguments: &RunArguments, name: &str, view: &ViewSpec, end_s: f64) -> Result<Observers, CliError> {
    let mut observers = Observers {
        file: file_path(arguments, name).map(|path| RunFile::new(&path)).transpose()?,
        recorder: (arguments.check || arguments.check_steps).then(Recorder::default),
        angles: arguments.angles.then(Angles::default),
        progress: Some(Progress::new(end_s)),
        clock: arguments.real_time.then(Clock::default),
        #[cfg(feature = "viz")]
        viewers: Vec::new(),
    };
    add_viewers(arguments, name, view, &mut observers)?;
    Ok(observers)
}

#[cfg(feature = "viz")]
fn add_viewers(
    arguments: &RunArguments,
    name: &str,
    view: &ViewSpec,
    observers: &mut Observers,
) -> Result<(), CliError> {
    use smam::view::{DEFAULT_PORT, ViewOptions, ViewSink, Viewer};
    let mut sinks = Vec::new();
    if let Some(path) = rrd_path(arguments, name) {
        if let Some(folder) = path.parent().filter(|p| !p.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|source| CliError::Write { file: folder.to_owned(), source })?;
        }
        sinks.push(ViewSink::File(path));
    }
    if arguments.view {
        sinks.push(ViewSink::Window);
    }
    if arguments.serve {
        sinks.push(ViewSink::Serve { port: DEFAULT_PORT });
    }
    let options = ViewOptions {
        tension_scale_n: view.tension_scale_n,
        pressure_scale_pa: view.pressure_scale_pa,
        ..ViewOptions::default()
    };
    for sink in sinks {
        let viewer = Viewer::open(&sink, options.clone())?;
        // A file is named when it is complete.
        if !matches!(sink, ViewSink::File(_)) {
            eprintln!("{}", viewer.announcement());
        }
        observers.viewers.push(viewer);
    }
    Ok(())
}

#[cfg(not(feature = "viz"))]
fn add_viewers(arguments: &RunArguments, name: &str, _: &ViewSpec, _: &mut Observers) -> Result<(), CliError> {
    if arguments.view || arguments.serve || rrd_path(arguments, name).is_some() {
        return Err(CliError::Usage(
            "--rrd, --view and --serve need the viewer, which this build leaves out\n  remedy: build with the default features".to_owned(),
        ));
    }
    Ok(())
}

fn finish(observers: &mut Observers) -> Result<Option<Recording>, CliError> {
    if let Some(file) = observers.file.take() {
        file.finish()?;
    }
    #[cfg(feature = "viz")]
    for viewer in &mut observers.viewers {
        viewer.finish()?;
    }
    observers.recorder.take().map(Recorder::finish).transpose()
}

/// Ends what was written before the run failed beside its place.
fn finish_as_part(observers: &mut Observers) -> Result<(), CliError> {
    #[cfg(feature = "viz")]
    for viewer in &mut observers.viewers {
        viewer.finish_as_part()?;
    }
    observers.file.take().map_or(Ok(()), RunFile::finish_as_part)
}

/// A server goes on until it is interrupted.
fn hold_server(arguments: &RunArguments) {
    if arguments.serve {
        eprintln!("serving until Ctrl-C");
        while !interrupted() {
            std::thread::sleep(std::time::Duration::from_millis(100));
        }
    }
}
