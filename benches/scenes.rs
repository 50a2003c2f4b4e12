//! CPU time of one simulated second of the stock scenes, at steps whose error stays under 0.1 % of each channel's
//! range, and the same with twice the fine steps: the difference is what the fine steps cost.
//!
//! The error of each step is measured first, against a quarter of the engine step and a sixteenth of the fine step,
//! and printed. Times are CPU times of this process: another program on the machine does not change them much.
//! Figures and what they mean: `docs/performance.md`.

use std::hint::black_box;
use std::time::Duration;

use cpu_time::ProcessTime;
use criterion::{Criterion, criterion_group, criterion_main};
use smam::recording::Recording;
use smam::scene::{Override, Scene};
use smam::system::{Schedule, Simulation, record};

/// A scene at a step that is accurate enough.
struct Case {
    scene: &'static str,
    step_s: f64,
    substeps: usize,
    /// The part of the stock programme over which the error is taken, s.
    until_s: f64,
}

const CASES: [Case; 4] = [
    Case { scene: "muscle_bench", step_s: 0.01, substeps: 40, until_s: 15.0 },
    Case { scene: "antagonistic_pulley", step_s: 0.01, substeps: 50, until_s: 15.0 },
    Case { scene: "bending_catheter", step_s: 0.01, substeps: 12, until_s: 13.0 },
    // Until the ball is let go: where it first touches the dish is a matter of micrometres.
    Case { scene: "grip_and_release", step_s: 1.0e-3, substeps: 5, until_s: 7.4 },
];

fn simulation(name: &str, step_s: f64, substeps: usize) -> Simulation {
    let substeps = Override { key: "simulation.substeps".to_owned(), value: (substeps as i64).into() };
    let overrides = [Override::number("simulation.step_s", step_s), substeps];
    let scene = Scene::load(name, &overrides).unwrap_or_else(|e| panic!("{e}"));
    Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"))
}

fn recorded(case: &Case, finer_engine: f64, finer_plant: usize) -> Recording {
    let mut simulation = simulation(case.scene, case.step_s / finer_engine, case.substeps * finer_plant);
    record(&mut simulation, &Schedule::even(case.until_s, 0.01)).unwrap_or_else(|e| panic!("{e}"))
}

/// Prints the greatest error of each output, in percent of its range. A held ball is judged in micrometres: its range
/// in the jaws is nothing.
fn print_errors(case: &Case) {
    let (run, reference) = (recorded(case, 1.0, 1), recorded(case, 4.0, 4));
    for (x, r) in run.channels().iter().zip(reference.channels()) {
        let (low, high) = r.values.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        let pairs = x.values.iter().zip(&r.values);
        if x.column.starts_with("ball_in_jaws") || (x.column.starts_with("ball_") && high - low < 0.1) {
            let held = pairs.zip(reference.time_s()).filter(|(_, t)| (2.5..7.4).contains(*t));
            let error_um = held.map(|((x, r), _)| (x - r).abs() * 1e3).fold(0.0, f64::max);
            println!("  {:<20} {error_um:>9.3} µm while held", x.column);
        } else if high > low && !x.column.starts_with("plunger") {
            let error = pairs.map(|(x, r)| (x - r).abs()).fold(0.0, f64::max);
            println!("  {:<20} {:>9.5} % of the range", x.column, 100.0 * error / (high - low));
        }
    }
}

fn one_second(mut simulation: Simulation) -> Duration {
    let start = simulation.time_s();
    let begun = ProcessTime::now();
    for i in 1..=100 {
        simulation.advance_to(start + 0.01 * f64::from(i)).unwrap_or_else(|e| panic!("{e}"));
    }
    let taken = begun.elapsed();
    black_box(simulation.time_s());
    taken
}

fn scenes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("one simulated second");
    group.sample_size(10);
    for case in &CASES {
        println!("{}, engine step {} s, {} fine steps in it: error", case.scene, case.step_s, case.substeps);
        print_errors(case);
        for (part, substeps) in [("whole", case.substeps), ("twice the fine steps", 2 * case.substeps)] {
            group.bench_function(format!("{}/{part}", case.scene), |b| {
                b.iter_custom(|count| {
                    let one = |_| {
                        let mut simulation = simulation(case.scene, case.step_s, substeps);
                        // Into the motion: the ball is held from 2 s on.
                        simulation.advance_to(2.0).unwrap_or_else(|e| panic!("{e}"));
                        one_second(simulation)
                    };
                    (0..count).map(one).sum()
                });
            });
        }
    }
    group.finish();
}

criterion_group!(benches, scenes);
criterion_main!(benches);
