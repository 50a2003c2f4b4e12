//! Contract: parameters come back from their own noisy data, inside their intervals as often as these say.

use super::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

fn truths() -> impl Iterator<Item = (Form, Vec<f64>)> {
    Form::ALL.into_iter().map(|form| (form, form.typical()))
}

/// Thirty seconds at 100 Hz: 3 mm strokes at 0.1 Hz whose depth changes, so that there are inner loops.
fn programme() -> (Vec<f64>, Vec<f64>) {
    let time_s: Vec<f64> = (0..3_000).map(|i| f64::from(i) * 0.01).collect();
    let place = |t: f64| 1.5 - 1.1 * (TAU * 0.1 * t).cos() - 0.4 * (TAU * 0.3 * t).cos();
    let input_mm = time_s.iter().map(|&t| place(t)).collect();
    (time_s, input_mm)
}

fn noisy(form: Form, truth: &[f64], sd_mm: f64, seed: u64) -> LoopRun {
    let (time_s, input_mm) = programme();
    let mut run = LoopRun { name: "made".to_owned(), output_mm: vec![0.0; time_s.len()], time_s, input_mm };
    let blank = form.blank(&LoopScale { input_mm: [0.0, 3.0], slope: 9.0 });
    let model: HysteresisModel<f64> = blank.with_parameters(truth).unwrap();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    run.output_mm = model.follow(&run.time_s, &run.input_mm);
    for y in &mut run.output_mm {
        let noise: f64 = StandardNormal.sample(&mut random);
        *y += sd_mm * noise;
    }
    run
}

#[test]
fn val_parameters_come_back_inside_their_intervals() {
    const TRIALS: u64 = 12;
    for (form, truth) in truths() {
        let (mut inside, mut all) = (0, 0);
        for trial in 0..TRIALS {
            let run = noisy(form, &truth, 0.027, 100 + trial);
            let found = identify(&[run], form, &SearchOptions::default()).unwrap();
            for (parameter, truth) in found.parameters.iter().zip(&truth) {
                if let Some(half_width) = parameter.half_width {
                    all += 1;
                    inside += u64::from((parameter.value - truth).abs() <= half_width);
                }
            }
        }
        println!("{}: {inside} of {all}", form.name());
        // 95 % are expected. The parameters of one trial go together: four standard deviations of twelve trials.
        assert!(inside as f64 > 0.7 * all as f64, "{}: {inside} of {all}", form.name());
    }
}

#[test]
fn val_without_noise_the_truth_comes_back() {
    for (form, truth) in truths() {
        let found = identify(&[noisy(form, &truth, 0.0, 1)], form, &SearchOptions::default()).unwrap();
        println!("{}: F = {:.2e}, {} evaluations", form.name(), found.mean_square_mm2, found.evaluations);
        for (parameter, truth) in found.parameters.iter().zip(&truth) {
            let size = 1e-3 * (1.0 + truth.abs());
            assert!((parameter.value - truth).abs() < size, "{}: {} for {truth}", form.name(), parameter.value);
        }
    }
}

#[test]
fn val_hybrid_needs_a_twentieth_of_the_swarm() {
    let (form, truth) = (Form::Paper, &Form::Paper.typical());
    let run = [noisy(form, truth, 0.027, 7)];
    let cma = CmaOptions { most_evaluations: 8_000, ..CmaOptions::default() };
    let by =
        |method| identify(&run, form, &SearchOptions { method, starts: 1, cma, ..SearchOptions::default() }).unwrap();
    let (swarm, hybrid, cma, lm) = (by(Method::Pso), by(Method::Hybrid), by(Method::Cma), by(Method::Lm));
    for found in [&swarm, &hybrid, &cma, &lm] {
        println!("{:?}: F = {:.9}, {} evaluations", found.method, found.mean_square_mm2, found.evaluations);
    }
    assert!(hybrid.mean_square_mm2 <= swarm.mean_square_mm2 * (1.0 + 1e-9));
    assert!(20 * hybrid.evaluations <= swarm.evaluations);
    assert!(cma.mean_square_mm2 < 1.01 * hybrid.mean_square_mm2);
}

#[test]
fn redundant_and_misfitting_numbers_are_warned_of() {
    let (form, truth) = (Form::Paper, &Form::Paper.typical());
    let run = [noisy(form, truth, 0.027, 7)];
    let own = identify(&run, form, &SearchOptions::default()).unwrap();
    assert!(own.warnings.iter().any(|w| w.starts_with("a is fixed at 1")), "{:?}", own.warnings);
    assert!(!own.warnings.iter().any(|w| w.contains("whole truth")), "{:?}", own.warnings);
    let other = identify(&run, Form::Symmetric, &SearchOptions::default()).unwrap();
    assert!(other.warnings.iter().any(|w| w.contains("whole truth")), "{:?}", other.warnings);
    assert!(other.mean_square_mm2 > 4.0 * own.mean_square_mm2);
    assert!(other.certainty.memory > 0);
}

#[test]
fn the_scale_of_the_state_is_in_no_data() {
    let printed = crate::hysteresis::PaperModel::printed();
    let (time, path) = programme();
    let follow = |model| HysteresisModel::Paper(model).follow(&time, &path);
    let (as_printed, rescaled) = (follow(printed), follow(printed.with_drive(1.0)));
    assert!(as_printed.iter().zip(&rescaled).all(|(a, b): (&f64, &f64)| (a - b).abs() < 1e-9));
}
