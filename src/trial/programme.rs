//! What the inputs do in a trial: a slow sine, held levels, and a chirp, over the stroke of the scene's own programme.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::diagnose::programme::{Stroke, chirp, held, sample, sine, strokes};
use crate::recording::{Recording, RecordingError};
use crate::scene::Scene;

/// Runs (file name, inputs) for a scene.
///
/// # Errors
/// Columns without a known unit.
pub fn programmes(scene: &Scene, random: &mut ChaCha8Rng) -> Result<Vec<(&'static str, Recording)>, RecordingError> {
    let strokes: Vec<Stroke> = strokes(&stock_inputs(scene)).into_iter().map(moved).collect();
    let levels: [Vec<f64>; 2] = std::array::from_fn(|_| (0..12).map(|_| random.random_range(0.05..0.95)).collect());
    let rate = |own: usize| [1.0, 0.7][own];
    Ok(vec![
        ("sine.csv", sample(&strokes, 42.0, |t, own| sine(t, 0.1 * rate(own)))?),
        ("steps.csv", sample(&strokes, 72.0, |t, own| held(&levels[own], t))?),
        ("chirp.csv", sample(&strokes, 52.0, |t, own| chirp(t, 0.04 * rate(own), rate(own), 50.0))?),
    ])
}

/// What the scene holds at a level goes half of it up and down here, or nothing that depends on it would show.
fn moved(stroke: Stroke) -> Stroke {
    if stroke.low < stroke.high {
        return stroke;
    }
    Stroke { low: 0.5 * stroke.low, high: 1.5 * stroke.high, with_first: 0.0, ..stroke }
}

/// The scene's own programmes, sampled.
fn stock_inputs(scene: &Scene) -> Vec<(String, Vec<f64>)> {
    let duration_s = scene.file.simulation.duration_s;
    let series =
        scene.programs.iter().map(|p| (0..=1000).map(|i| p.value(duration_s * f64::from(i) / 1000.0)).collect());
    scene.file.input.iter().map(|i| i.channel.clone()).zip(series).collect()
}
