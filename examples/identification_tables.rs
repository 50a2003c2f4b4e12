//! The tables of docs/validation/identification.md: every model on loops of the first-principles rig, and every model on its own data.
//!
//! ```text
//! cargo run --release --no-default-features --example identification_tables -- [rig | recovery [TRIALS]]
//! ```

use std::error::Error;
use std::f64::consts::TAU;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use smam::hysteresis::HysteresisModel;
use smam::identify::loops::{Form, Identification, LoopRun, LoopScale, SearchOptions, identify, mean_square_on};
use smam::recording::PiecewiseLinear;
use smam::scene::Scene;
use smam::system::{InputSource, Schedule, Simulation, record};

/// A thousandth of the elongation's 27 mm.
const NOISE_MM: f64 = 0.027;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    match words.first().map(String::as_str) {
        None | Some("rig") => rig(),
        Some("recovery") => recovery(words.get(1).map_or(Ok(100), |n| n.parse())?),
        Some(other) => Err(format!("no table `{other}`; there are rig and recovery").into()),
    }
}

/// A plunger programme, mm over s.
type Programme = fn(f64) -> f64;

const SINE: Programme = |t| 1.5 - 1.5 * (TAU * 0.1 * t).cos();
/// 0.1 and 0.2 Hz together; 0.1 and 0.1 sqrt(3) Hz, which never repeats: the paper's Fig. 6.
const TWO_SINES: Programme = |t| 1.5 - 0.75 * (TAU * 0.1 * t).cos() - 0.75 * (TAU * 0.2 * t).cos();
const NON_HARMONIC: Programme = |t| 1.5 - 0.75 * (TAU * 0.1 * t).cos() - 0.75 * (TAU * 0.1 * 3f64.sqrt() * t).cos();
const FASTER: Programme = |t| 1.5 - 1.5 * (TAU * 0.2 * t).cos();

fn made(name: &str, programme: Programme, seconds: f64, seed: u64) -> Result<LoopRun, Box<dyn Error>> {
    let time_s = Schedule::even(seconds, 0.01).times();
    let input_mm: Vec<f64> = time_s.iter().map(|&t| programme(t)).collect();
    let input_m: Vec<f64> = input_mm.iter().map(|x| x * 1e-3).collect();
    let mut simulation = Simulation::new(Scene::load("muscle_bench", &[])?)?;
    let source = PiecewiseLinear::new(&time_s, &input_m).ok_or("an empty programme")?;
    simulation.set_input("plunger_mm", InputSource::Recorded(source));
    let recorded = record(&mut simulation, &Schedule::at(time_s.clone()))?;
    let mut output_mm = recorded.channel("elongation_mm")?.values.clone();
    add_noise(&mut output_mm, seed);
    Ok(LoopRun { name: name.to_owned(), time_s, input_mm, output_mm })
}

fn add_noise(values: &mut [f64], seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    for value in values {
        let noise: f64 = StandardNormal.sample(&mut random);
        *value += NOISE_MM * noise;
    }
}

fn rig() -> Result<(), Box<dyn Error>> {
    let fit = [made("0.1 Hz", SINE, 30.0, 1)?];
    let wide = [made("0.1 Hz", SINE, 30.0, 1)?, made("0.1 + 0.2 Hz", TWO_SINES, 30.0, 5)?];
    let unseen = [
        [made("0.1 + 0.2 Hz", TWO_SINES, 30.0, 2)?],
        [made("0.1 + 0.173 Hz", NON_HARMONIC, 60.0, 3)?],
        [made("0.2 Hz", FASTER, 30.0, 4)?],
    ];
    for (what, fit) in [("one sine of 0.1 Hz", &fit[..]), ("that and 0.1 + 0.2 Hz", &wide[..])] {
        println!("fitted to {what}; F in mm², noise {:.6}", NOISE_MM * NOISE_MM);
        println!(
            "{:<24} {:>5} {:>10} {:>13} {:>15} {:>10}",
            "model", "free", "fit", "0.1 + 0.2 Hz", "0.1 + 0.173 Hz", "0.2 Hz"
        );
        for form in Form::ALL {
            let found = identify(fit, form, &SearchOptions::default())?;
            let [a, b, c] = unseen.each_ref().map(|runs| mean_square_on(&found.model, runs));
            let (name, free) = (form.name(), found.free.len());
            println!("{name:<24} {free:>5} {:>10.5} {a:>13.5} {b:>15.5} {c:>10.5}", found.mean_square_mm2);
        }
    }
    Ok(())
}

fn recovery(trials: u64) -> Result<(), Box<dyn Error>> {
    // Strokes of changing depth: inner loops, without which several of these parameters are not told apart.
    let programme: Programme = |t| 1.5 - 1.1 * (TAU * 0.1 * t).cos() - 0.4 * (TAU * 0.3 * t).cos();
    let time_s = Schedule::even(30.0, 0.01).times();
    let input_mm: Vec<f64> = time_s.iter().map(|&t| programme(t)).collect();
    println!("truth inside its 95 % interval, of {trials} trials");
    for form in Form::ALL {
        let truth = form.typical();
        let model: HysteresisModel<f64> =
            form.blank(&LoopScale { input_mm: [0.0, 3.0], slope: 9.0 }).with_parameters(&truth)?;
        let clean = model.follow(&time_s, &input_mm);
        let trial = |seed: u64| -> Option<Identification> {
            let mut output_mm = clean.clone();
            add_noise(&mut output_mm, 1_000 + seed);
            let run = LoopRun { name: String::new(), time_s: time_s.clone(), input_mm: input_mm.clone(), output_mm };
            identify(&[run], form, &SearchOptions::default()).ok()
        };
        let found: Vec<Identification> = (0..trials).into_par_iter().filter_map(trial).collect();
        let mut line = format!("{:<24}", form.name());
        let (mut sum, mut count) = (0, 0);
        for (i, truth) in truth.iter().enumerate() {
            let Some(name) = found.first().map(|f| &f.parameters[i]).filter(|p| p.half_width.is_some()) else {
                continue;
            };
            let holds = |f: &&Identification| {
                let p = &f.parameters[i];
                p.half_width.is_some_and(|h| (p.value - truth).abs() <= h)
            };
            let inside = found.iter().filter(holds).count();
            line.push_str(&format!("  {} {inside}", name.spec.name));
            (sum, count) = (sum + inside, count + 1);
        }
        println!("{line}  | mean {:.1} %", 100.0 * sum as f64 / (count as f64 * trials as f64));
    }
    Ok(())
}
