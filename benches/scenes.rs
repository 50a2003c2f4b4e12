//! CPU time of one simulated second of the stock scenes, at steps whose error stays under 0.1 % of each channel's
//! range (`docs/performance.md`), and the same with one fine step per engine step: the difference is the plant's part.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use smam::scene::{Override, Scene};
use smam::system::Simulation;

/// Scene, engine step, fine steps within it; the first accurate to 0.1 %.
const CASES: [(&str, f64, usize); 4] = [
    ("muscle_bench", 0.01, 40),
    ("antagonistic_pulley", 0.01, 50),
    ("bending_catheter", 0.01, 25),
    ("grip_and_release", 1.0e-3, 5),
];

fn simulation(name: &str, step_s: f64, substeps: usize) -> Simulation {
    let substeps = Override { key: "simulation.substeps".to_owned(), value: (substeps as i64).into() };
    let overrides = [Override::number("simulation.step_s", step_s), substeps];
    let scene = Scene::load(name, &overrides).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"));
    // Into the motion: the ball is held from 2 s on.
    simulation.advance_to(2.0).unwrap_or_else(|e| panic!("{e}"));
    simulation
}

fn one_second(mut simulation: Simulation) -> f64 {
    let start = simulation.time_s();
    for i in 1..=100 {
        simulation.advance_to(start + 0.01 * f64::from(i)).unwrap_or_else(|e| panic!("{e}"));
    }
    simulation.time_s()
}

fn scenes(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("one simulated second");
    group.sample_size(10);
    for (name, step_s, substeps) in CASES {
        for (part, substeps) in [("whole", substeps), ("one fine step per engine step", 1)] {
            group.bench_function(format!("{name}/{part}"), |b| {
                b.iter_batched(
                    || simulation(name, step_s, substeps),
                    |s| black_box(one_second(s)),
                    BatchSize::PerIteration,
                );
            });
        }
    }
    group.finish();
}

criterion_group!(benches, scenes);
criterion_main!(benches);
