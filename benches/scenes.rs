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
use smam::bench::{CASES, SceneCase};
use smam::system::Simulation;

/// Prints the greatest error of each output, in percent of its range. A held ball is judged in micrometres: its range
/// in the jaws is nothing.
fn print_errors(case: &SceneCase) {
    let [run, reference] =
        [(1.0, 1), (4.0, 4)].map(|(engine, plant)| case.recorded(engine, plant).unwrap_or_else(|e| panic!("{e}")));
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
    simulation.advance_to(start + 1.0).unwrap_or_else(|e| panic!("{e}"));
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
        for (part, finer) in [("whole", 1), ("twice the fine steps", 2)] {
            group.bench_function(format!("{}/{part}", case.scene), |b| {
                b.iter_custom(|count| {
                    let one = |_| {
                        let mut simulation = case.simulation(1.0, finer).unwrap_or_else(|e| panic!("{e}"));
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
