//! What the plungers do in a trial: a slow sine, held levels, and a chirp, over the stroke of the scene's own programme.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::recording::{Channel, Recording, RecordingError, parse_column};
use crate::scene::Scene;

/// Sampling interval, s, and the time over which the plungers go from rest into the programme.
const INTERVAL_S: f64 = 0.01;
const ENTRY_S: f64 = 2.0;
/// Speed between held levels, in strokes per second.
const STROKES_PER_S: f64 = 0.4;

/// Stroke of one input: where it goes, and whether it moves with the first one (1), against it (-1), or by itself (0).
struct Stroke {
    column: String,
    low: f64,
    high: f64,
    with_first: f64,
}

/// Runs (file name, inputs) for a scene.
///
/// # Errors
/// Columns without a known unit.
pub fn programmes(scene: &Scene, random: &mut ChaCha8Rng) -> Result<Vec<(&'static str, Recording)>, RecordingError> {
    let strokes = strokes(scene);
    let sine = |t: f64, own: usize| 0.5 - 0.5 * (2.0 * std::f64::consts::PI * [0.1, 0.07][own] * t).cos();
    let (low, high, over) = (0.04, 1.0, 50.0);
    let chirp = |t: f64, own: usize| {
        let phase = low * t + (high - low) * t * t / (2.0 * over);
        0.5 - 0.5 * (2.0 * std::f64::consts::PI * phase * [1.0, 0.7][own]).cos()
    };
    let levels: [Vec<f64>; 2] = std::array::from_fn(|_| (0..12).map(|_| random.random_range(0.05..0.95)).collect());
    let steps = |t: f64, own: usize| held(&levels[own], t);
    Ok(vec![
        ("sine.csv", run(&strokes, 42.0, sine)?),
        ("steps.csv", run(&strokes, 72.0, steps)?),
        ("chirp.csv", run(&strokes, 52.0, chirp)?),
    ])
}

fn strokes(scene: &Scene) -> Vec<Stroke> {
    let duration_s = scene.file.simulation.duration_s;
    let series: Vec<Vec<f64>> = scene
        .programs
        .iter()
        .map(|p| (0..=1000).map(|i| p.value(duration_s * f64::from(i) / 1000.0)).collect())
        .collect();
    let middle = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
    let product = |a: &[f64], b: &[f64]| -> f64 {
        let (ma, mb) = (middle(a), middle(b));
        a.iter().zip(b).map(|(x, y)| (x - ma) * (y - mb)).sum()
    };
    let stroke = |(x, input): (&Vec<f64>, &crate::scene::InputSpec)| {
        let alike = product(x, &series[0]) / (product(x, x) * product(&series[0], &series[0])).sqrt();
        let (low, high) = x.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        let with_first = if alike.abs() > 0.9 { alike.signum() } else { 0.0 };
        Stroke { column: input.channel.clone(), low, high, with_first }
    };
    series.iter().zip(&scene.file.input).map(stroke).collect()
}

/// Levels held for six seconds each, with ramps between them.
fn held(levels: &[f64], t: f64) -> f64 {
    let index = ((t / 6.0) as usize).min(levels.len() - 1);
    let from = if index == 0 { 0.5 } else { levels[index - 1] };
    let way = levels[index] - from;
    let gone = STROKES_PER_S * (t - 6.0 * index as f64);
    from + way.signum() * gone.min(way.abs())
}

/// Samples a wave between 0 and 1, of the first input and of one that moves by itself, over every stroke.
fn run(strokes: &[Stroke], duration_s: f64, wave: impl Fn(f64, usize) -> f64) -> Result<Recording, RecordingError> {
    let times_s: Vec<f64> = (0..(duration_s / INTERVAL_S) as usize).map(|i| i as f64 * INTERVAL_S).collect();
    let mut channels = Vec::new();
    for stroke in strokes {
        let unit = parse_column(&stroke.column)?.unit;
        let value = |t: f64| {
            let w = wave(t, usize::from(stroke.with_first == 0.0));
            let share = if stroke.with_first < 0.0 { 1.0 - w } else { w };
            let entered = (t / ENTRY_S).min(1.0);
            unit.from_si(entered * (stroke.low + share * (stroke.high - stroke.low)))
        };
        channels.push(Channel::new(stroke.column.clone(), times_s.iter().map(|&t| value(t)).collect()));
    }
    Recording::new(times_s, channels)
}
