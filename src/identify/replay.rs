//! Simulating what was recorded.

use crate::recording::{Channel, Recording, RecordingError, RecordingSet, Role, Run, SET_FILE_NAME, parse_column};
use crate::scene::{Override, Scene, SceneError};
use crate::system::{InputSource, Schedule, Simulation, SystemError, record};

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
        let data = set.load_run(run)?;
        let mut found = crate::recording::survey(&data.recording);
        found.missing.retain(|m| !run.not_recorded.contains(&m.column));
        let notes = data.notes.into_iter().chain(found.notes());
        notes.for_each(|n| note(format!("{}: {n}", run.file)));
        loaded.push(RecordedRun { run: run.clone(), recording: data.recording });
    }
    Ok(loaded)
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

/// Simulates a run at its sample times with its recorded inputs and known conditions.
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
    let conditions = condition_overrides(&plain, &run.run)?;
    let scene = match conditions.is_empty() {
        true => plain,
        false => Scene::load(scene, &[overrides, &conditions].concat())?,
    };
    let mut simulation = Simulation::new(scene)?;
    let inputs: Vec<String> = simulation.scene().file.input.iter().map(|i| i.channel.clone()).collect();
    for input in &inputs {
        let line = run.recording.piecewise_si(input).map_err(|e| e.in_file(&run.run.file))?;
        simulation.set_input(input, InputSource::Recorded(line));
    }
    let times = run.recording.time_s().iter().copied().step_by(every.max(1)).collect();
    let recorded = record(&mut simulation, &Schedule::at(times))?;
    Ok(begin_where_recorded(simulation.scene(), &recorded, &run.recording, every.max(1))?)
}

/// Shifts the outputs that count from the start of a recording to the recording's first sample.
fn begin_where_recorded(
    scene: &Scene,
    simulated: &Recording,
    measured: &Recording,
    every: usize,
) -> Result<Recording, RecordingError> {
    let shifted = simulated.channels().iter().map(|channel| {
        let spec = scene.file.output.iter().find(|o| o.channel == channel.column);
        let known = spec.filter(|s| s.counts_from_start).and_then(|_| measured.find(&channel.column));
        // Both at one instant: the first at which something was measured and is simulated.
        let pairs = known.into_iter().flat_map(|m| m.values.iter().step_by(every).zip(&channel.values));
        let shift = pairs.map(|(m, s)| m - s).find(|d| d.is_finite()).unwrap_or(0.0);
        Channel::new(channel.column.clone(), channel.values.iter().map(|v| v + shift).collect())
    });
    Recording::new(simulated.time_s().to_vec(), shifted.collect())
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
            format!("the scene's outputs are {}", outputs.join(", ")),
        ));
    }
    match scene.file.input.iter().find(|i| !set.of_role(Role::Input).any(|c| c.column == i.channel)) {
        Some(missing) => Err(refuse(
            format!("the scene {} needs the input `{}`, which is not declared", scene.file.name, missing.channel),
            "declare it as a [[channel]] with role = \"input\"".to_owned(),
        )),
        None => Ok(()),
    }
}
