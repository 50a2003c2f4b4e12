//! Feedforward: a model identified from one recorded run, turned round, makes the muscle follow a motion it never saw.
//!
//! ```text
//! cargo run --release --example feedforward
//! ```

use std::error::Error;
use std::f64::consts::TAU;

use smam::feedforward::{Limits, programme};
use smam::identify::loops::{Form, LoopRun, SearchOptions, identify};
use smam::recording::PiecewiseLinear;
use smam::scene::Scene;
use smam::system::{InputSource, Schedule, Simulation, record};

/// Elongation (mm) of the bench for a plunger (mm) over time (s).
fn play(time_s: &[f64], plunger_mm: &[f64]) -> Result<Vec<f64>, Box<dyn Error>> {
    let mut simulation = Simulation::new(Scene::load("muscle_bench", &[])?)?;
    let plunger_m: Vec<f64> = plunger_mm.iter().map(|x| 1e-3 * x).collect();
    let line = PiecewiseLinear::new(time_s, &plunger_m).ok_or("times must increase")?;
    simulation.set_input("plunger_mm", InputSource::Recorded(line));
    Ok(record(&mut simulation, &Schedule::at(time_s.to_vec()))?.channel("elongation_mm")?.values.clone())
}

/// Root mean square of the difference from 3 s on: before, the muscle is led from rest into the motion.
fn rms_apart(time_s: &[f64], a: &[f64], b: &[f64]) -> f64 {
    let squares: Vec<f64> =
        time_s.iter().zip(a.iter().zip(b)).filter(|(t, _)| **t > 3.0).map(|(_, (a, b))| (a - b).powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

fn main() -> Result<(), Box<dyn Error>> {
    let times = |duration_s: f64, interval_s: f64| -> Vec<f64> { Schedule::even(duration_s, interval_s).times() };
    // Training: loops of many depths.
    let train_s = times(70.0, 0.05);
    let input_mm: Vec<f64> = train_s
        .iter()
        .map(|t| {
            1.4 + (t / 3.0).min(1.0) * (0.8 * (TAU * 0.13 * t).sin() + 0.6 * (TAU * 0.053 * t).sin())
                - 1.4 * (1.0 - (t / 3.0).min(1.0))
        })
        .collect();
    let output_mm = play(&train_s, &input_mm)?;
    let run = LoopRun { name: "training".to_owned(), time_s: train_s, input_mm, output_mm };
    let found = identify(&[run], Form::DahlGrowing, &SearchOptions::default())?;
    // A wanted motion with other frequencies.
    let time_s = times(30.0, 0.01);
    let wanted_mm: Vec<f64> = time_s
        .iter()
        .map(|t| (t / 3.0).min(1.0) * (13.0 + 6.0 * (TAU * 0.09 * t).sin() + 2.0 * (TAU * 0.17 * t).sin()))
        .collect();
    let limits = Limits { input_mm: [0.0, 3.0], speed_mm_s: 5.0, least_slope: 0.15 };
    let plunger_mm = programme(&found.model, limits, 0.0, &time_s, &wanted_mm).input_mm;
    let with_mm = play(&time_s, &plunger_mm)?;
    // Without a model: a straight line through the same range.
    let straight_mm: Vec<f64> = wanted_mm.iter().map(|y| y / 9.0).collect();
    let without_mm = play(&time_s, &straight_mm)?;
    let (without, with) = (rms_apart(&time_s, &without_mm, &wanted_mm), rms_apart(&time_s, &with_mm, &wanted_mm));
    println!(
        "tracking error, RMS: {without:.3} mm with a straight line, {with:.3} mm with the model ({:.1} times less)",
        without / with
    );
    Ok(())
}
