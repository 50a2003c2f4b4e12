//! Recordings of a trial: the full scene played, and noise on what it shows.

use std::fmt::Write as _;
use std::path::Path;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::effects::Effect;
use crate::files::write_whole;
use crate::recording::{Channel, Recording};
use crate::scene::{Override, Scene};
use crate::system::{InputSource, Schedule, Simulation, record};

use super::TrialError;
use super::programme::programmes;

/// Standard deviation of the noise, by how a column begins: what such sensors have.
const NOISE: [(&str, f64); 9] = [
    ("elongation", 0.02),
    ("displacement", 0.05),
    ("pressure", 5.0),
    ("angle", 0.08),
    ("bend", 0.15),
    ("jaw", 0.15),
    ("tip", 0.15),
    ("tension", 0.05),
    ("force", 0.5),
];
/// Calibrated parameters lie within this share of the scene's.
const CALIBRATION_SPREAD: f64 = 0.2;

/// Plays a scene with an effect (or none) and writes the recordings of a rig into `folder`: never the effect itself.
///
/// # Errors
/// A scene that cannot be run, a folder that cannot be written.
pub fn make_specimen(
    scene_name: &str,
    effect: Option<&Effect<f64>>,
    noise: f64,
    seed: u64,
    folder: &Path,
) -> Result<(), TrialError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let stock = Scene::load(scene_name, &[])?;
    let mut scene = Scene::load(scene_name, &calibration(&stock, &mut random))?;
    scene.file.effect.extend(effect.map(Effect::table));
    let scene = Scene::from_file(scene.file, &scene.path)?;
    let outputs: Vec<(&str, f64)> =
        scene.file.output.iter().filter_map(|o| Some((o.channel.as_str(), sd(&o.channel)?))).collect();
    let mut text = format!("format = 1\nscene = \"{scene_name}\"\n");
    for input in &scene.file.input {
        let _ = write!(text, "\n[[channel]]\ncolumn = \"{}\"\nrole = \"input\"\n", input.channel);
    }
    for (column, sd) in &outputs {
        let sd = noise * sd;
        let _ = write!(text, "\n[[channel]]\ncolumn = \"{column}\"\nrole = \"output\"\nnoise_sd = {sd}\n");
    }
    for (file, drive) in programmes(&scene, &mut random)? {
        let _ = write!(text, "\n[[run]]\nfile = \"{file}\"\n");
        play(&scene, &drive, &outputs, noise, &mut random)?.write_csv(&folder.join(file))?;
    }
    let path = folder.join("recordings.toml");
    write_whole(&path, &text).map_err(|source| TrialError::Write { file: path, source })
}

fn sd(column: &str) -> Option<f64> {
    NOISE.iter().find(|(start, _)| column.starts_with(start)).map(|(_, sd)| *sd)
}

/// A rig's own numbers, near those of the scene.
fn calibration(scene: &Scene, random: &mut ChaCha8Rng) -> Vec<Override> {
    let draw = |spec: &crate::scene::CalibrateSpec| {
        let stock = scene.number(&spec.key)?;
        Some(Override::number(&spec.key, stock * (1.0 + random.random_range(-CALIBRATION_SPREAD..CALIBRATION_SPREAD))))
    };
    scene.file.calibrate.iter().filter_map(draw).collect()
}

fn play(
    scene: &Scene,
    drive: &Recording,
    outputs: &[(&str, f64)],
    noise: f64,
    random: &mut ChaCha8Rng,
) -> Result<Recording, TrialError> {
    let mut simulation = Simulation::new(scene.clone())?;
    for column in drive.columns() {
        simulation.set_input(column, InputSource::Recorded(drive.piecewise_si(column)?));
    }
    let shown = record(&mut simulation, &Schedule::at(drive.time_s().to_vec()))?;
    let mut recording = drive.clone();
    for (column, sd) in outputs {
        let mut noisy = |v: &f64| -> f64 {
            let unit: f64 = StandardNormal.sample(random);
            v + noise * sd * unit
        };
        let values = shown.channel(column)?.values.iter().map(&mut noisy).collect();
        recording.push(Channel::new(*column, values))?;
    }
    Ok(recording)
}
