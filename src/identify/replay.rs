//! Simulating what was recorded.

use crate::recording::figures::mean;
use crate::recording::{
    Channel, PiecewiseLinear, Recording, RecordingError, RecordingSet, Role, Run, SET_FILE_NAME, parse_column, smoothed,
};
use crate::scene::{Override, Scene, SceneError};
use crate::system::{InputSource, Schedule, Simulation, SystemError, record};

use super::{LeadIn, own_settings};

/// Why recordings cannot be replayed.
#[derive(Debug, thiserror::Error)]
pub enum IdentifyError {
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    System(#[from] SystemError),
    #[error("{file}: {message}\n  remedy: {remedy}")]
    Mismatch { file: String, message: String, remedy: String },
}

impl IdentifyError {
    /// Whether a run began and could not go on: see [`SystemError::is_breakdown`].
    #[must_use]
    #[doc(hidden)]
    pub const fn is_breakdown(&self) -> bool {
        matches!(self, Self::System(error) if error.is_breakdown())
    }
}

/// A recorded run with its data.
#[derive(Clone, Debug)]
pub struct RecordedRun {
    pub run: Run,
    pub recording: Recording,
}

/// Loads the runs of a set; the notes go to `note`.
pub fn load_runs(
    set: &RecordingSet,
    runs: &[Run],
    note: &mut dyn FnMut(String),
) -> Result<Vec<RecordedRun>, IdentifyError> {
    let mut loaded = Vec::new();
    for run in runs {
        let parts = set.load_parts(run)?;
        let count = parts.len();
        for (index, data) in parts.into_iter().enumerate() {
            let mut run = run.clone();
            if count > 1 {
                run.file = format!("{} (part {} of {count})", run.file, index + 1);
            }
            let mut found = crate::recording::survey(&data.recording);
            found.missing.retain(|m| !run.not_recorded.contains(&m.column));
            let (recording, smoothed) = without_input_noise(set, data.recording)?;
            let notes = data.notes.into_iter().chain(found.notes()).chain(smoothed);
            notes.for_each(|n| note(format!("{}: {n}", run.file)));
            loaded.push(RecordedRun { run, recording });
        }
    }
    Ok(loaded)
}

/// A recording without the noise of its inputs, and what was done: see [`smoothed`].
fn without_input_noise(set: &RecordingSet, recording: Recording) -> Result<(Recording, Vec<String>), RecordingError> {
    let (mut channels, mut notes) = (recording.channels().to_vec(), Vec::new());
    for spec in set.of_role(Role::Input).filter(|spec| spec.constant.is_none()) {
        let Some(channel) = channels.iter_mut().find(|c| c.column == spec.column) else { continue };
        let Some(smooth) = smoothed(recording.time_s(), &channel.values, spec.noise_sd) else { continue };
        // Without its size, which differs from run to run: one line says it of all.
        notes.push(format!("{} is smoothed by its own noise (as recorded: noise_sd = 0)", spec.column));
        channel.values = smooth.values;
    }
    Ok((Recording::new(recording.time_s().to_vec(), channels)?, notes))
}

/// The scene keys that a run's known conditions set, in the keys' units.
pub fn condition_overrides(scene: &Scene, run: &Run) -> Result<Vec<Override>, IdentifyError> {
    let mut overrides = Vec::new();
    for (name, value) in &run.conditions {
        let Some(spec) = scene.file.condition.iter().find(|c| c.name == *name) else {
            let known: Vec<&str> = scene.file.condition.iter().map(|c| c.name.as_str()).collect();
            return Err(IdentifyError::Mismatch {
                file: format!("{SET_FILE_NAME}: [[run]] \"{}\"", run.file),
                message: format!("the condition `{name}` is unknown to the scene {}", scene.file.name),
                remedy: match known.is_empty() {
                    true => "remove it: the scene has no [[condition]]".to_owned(),
                    false => format!("the scene knows {}", known.join(", ")),
                },
            });
        };
        let si = parse_column(name)?.unit.to_si(*value);
        overrides.extend(spec.keys.iter().map(|key| Override::number(key, si)));
    }
    Ok(overrides)
}

/// A minute of samples further apart than a second takes an hour: clocks that were read in another unit.
const SLOW_S: f64 = 1.0;
const LONG_S: f64 = 3600.0;

/// Refuses a run that lasts for hours with seconds between its samples: it would be simulated for as long.
fn refuse_slow(run: &RecordedRun) -> Result<(), IdentifyError> {
    let found = crate::recording::survey(&run.recording);
    match found.median_interval_s.filter(|dt| *dt > SLOW_S && found.duration_s > LONG_S) {
        None => Ok(()),
        Some(dt) => Err(IdentifyError::Mismatch {
            file: run.run.file.clone(),
            message: format!(
                "one sample in {dt} s, over {:.1} hours: is the time in seconds, not in milliseconds?",
                found.duration_s / 3600.0
            ),
            remedy: "write time_s in seconds, or say time_unit = \"ms\" in recordings.toml; if it truly is that slow, cut it into runs of less than an hour"
                .to_owned(),
        }),
    }
}

/// The way to where a run begins, if it does not begin at rest.
pub fn lead_in(scene: &Scene, run: &RecordedRun) -> Result<Option<LeadIn>, RecordingError> {
    let start_s = run.recording.time_s().first().copied().unwrap_or(0.0);
    let first = |line: PiecewiseLinear| line.value(start_s);
    let columns = scene.file.input.iter().map(|i| run.recording.piecewise_si(&i.channel).map(first));
    Ok(LeadIn::before(scene, start_s, &columns.collect::<Result<Vec<f64>, _>>()?))
}

/// Simulates a run at its sample times with its recorded inputs and known conditions; one that does not begin at rest is led to
/// where it begins ([`LeadIn`]).
///
/// `every` > 1 takes only each so-many-th sample (for fits); the times of the result are those taken.
///
/// ```
/// use smam::identify::{RecordedRun, replay};
/// use smam::recording::{Run, figures};
/// use smam::scene::Scene;
/// use smam::system::{Schedule, Simulation, record};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let recording = record(&mut Simulation::new(Scene::load("muscle_bench", &[])?)?, &Schedule::even(1.0, 0.01))?;
/// let run = Run { file: "sine.csv".to_owned(), ..Default::default() };
/// let again = replay("muscle_bench", &[], &RecordedRun { run, recording: recording.clone() }, 1)?;
/// // The plunger goes straight from sample to sample instead of along the sine: that is all the difference.
/// let [first, second] = [recording.channel("elongation_mm")?, again.channel("elongation_mm")?];
/// let apart_mm: Vec<f64> = first.values.iter().zip(&second.values).map(|(a, b)| a - b).collect();
/// assert!(figures::rms(&apart_mm) < 0.01);
/// # Ok(())
/// # }
/// ```
pub fn replay(
    scene: &str,
    overrides: &[Override],
    run: &RecordedRun,
    every: usize,
) -> Result<Recording, IdentifyError> {
    let plain = Scene::load(scene, overrides)?;
    let mut conditions = condition_overrides(&plain, &run.run)?;
    conditions.extend(own_settings(&plain, &run.recording).map_err(|e| e.in_file(&run.run.file))?);
    let scene = match conditions.is_empty() {
        true => plain,
        false => Scene::load(scene, &[overrides, &conditions].concat())?,
    };
    refuse_slow(run)?;
    let lead_in = lead_in(&scene, run).map_err(|e| e.in_file(&run.run.file))?;
    let mut simulation = Simulation::new(scene)?;
    let inputs: Vec<String> = simulation.scene().file.input.iter().map(|i| i.channel.clone()).collect();
    for input in &inputs {
        let line = run.recording.piecewise_si(input).map_err(|e| e.in_file(&run.run.file))?;
        let led = lead_in.as_ref().and_then(|way| way.lead(&line));
        simulation.set_input(input, InputSource::Recorded(led.unwrap_or(line)));
    }
    let way_s = lead_in.as_ref().map_or(&[][..], LeadIn::times_s);
    let times = way_s.iter().chain(run.recording.time_s().iter().step_by(every.max(1))).copied().collect();
    let played = record(&mut simulation, &Schedule::at(times))?;
    let recorded = without_beginning(&played, way_s.len())?;
    Ok(about_its_own_zero(simulation.scene(), &recorded, &run.recording, every.max(1))?)
}

fn without_beginning(played: &Recording, samples: usize) -> Result<Recording, RecordingError> {
    let rest = |c: &Channel| Channel::new(c.column.clone(), c.values[samples..].to_vec());
    Recording::new(played.time_s()[samples..].to_vec(), played.channels().iter().map(rest).collect())
}

/// Shifts the outputs whose zero is a recording's own by their mean difference from it, as a diagnosis does: one sample alone would
/// carry its noise through the whole run.
fn about_its_own_zero(
    scene: &Scene,
    simulated: &Recording,
    measured: &Recording,
    every: usize,
) -> Result<Recording, RecordingError> {
    let shifted = simulated.channels().iter().map(|channel| {
        let spec = scene.file.output.iter().find(|o| o.channel == channel.column);
        let known = spec.filter(|s| s.counts_from_start).and_then(|_| measured.find(&channel.column));
        let pairs = known.into_iter().flat_map(|m| m.values.iter().step_by(every).zip(&channel.values));
        let apart: Vec<f64> = pairs.map(|(m, s)| m - s).filter(|d| d.is_finite()).collect();
        let shift = if apart.is_empty() { 0.0 } else { mean(&apart) };
        Channel::new(channel.column.clone(), channel.values.iter().map(|v| v + shift).collect())
    });
    Recording::new(simulated.time_s().to_vec(), shifted.collect())
}

/// How to declare an input, which may be there in another unit.
fn wanted_input(set: &RecordingSet, wanted: &str) -> String {
    let in_other = set.of_role(Role::Input).find_map(|c| in_another_unit(&c.column, &[wanted]));
    in_other.unwrap_or_else(|| {
        "declare it as a [[channel]] with role = \"input\"; if it stood still and was not recorded, add constant = 0, or where it stood".to_owned()
    })
}

/// What to do with a column that the scene has in another unit.
fn in_another_unit(column: &str, known: &[&str]) -> Option<String> {
    let is = parse_column(column).ok()?;
    let (other, wanted) =
        known.iter().filter_map(|k| Some((k, parse_column(k).ok()?))).find(|(_, k)| k.si_column() == is.si_column())?;
    Some(format!(
        "multiply it by {} and call it {other}: the scene has it in {}",
        is.unit.factor / wanted.unit.factor,
        wanted.unit.symbol
    ))
}

/// Checks that every declared output is a channel of the scene and every input of the scene was recorded.
pub fn check_channels(set: &RecordingSet, scene: &Scene) -> Result<(), IdentifyError> {
    let outputs: Vec<&str> = scene.file.output.iter().map(|o| o.channel.as_str()).collect();
    let refuse = |message: String, remedy: String| IdentifyError::Mismatch {
        file: set.dir.join(SET_FILE_NAME).display().to_string(),
        message,
        remedy,
    };
    if let Some(odd) = set.of_role(Role::Output).find(|c| !outputs.contains(&c.column.as_str())) {
        return Err(refuse(
            format!("the output `{}` is no channel of the scene {}", odd.column, scene.file.name),
            in_another_unit(&odd.column, &outputs)
                .unwrap_or_else(|| format!("the scene's outputs are {}", outputs.join(", "))),
        ));
    }
    match scene.file.input.iter().find(|i| !set.of_role(Role::Input).any(|c| c.column == i.channel)) {
        Some(missing) => Err(refuse(
            format!("the scene {} needs the input `{}`, which is not declared", scene.file.name, missing.channel),
            wanted_input(set, &missing.channel),
        )),
        None => Ok(()),
    }
}
