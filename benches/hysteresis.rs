//! What many parameter sets cost side by side and one at a time, and what an identification costs.
//!
//! A 30 s loop at 100 Hz (3000 samples) of the paper's model with noise. Times are for the sets named.

use std::f64::consts::TAU;
use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use smam::hysteresis::PaperModel;
use smam::identify::loops::{Form, LoopRun, LoopScale, Method, Problem, SearchOptions, identify};

/// Sets evaluated together; a swarm's worth.
const SETS: usize = 64;

fn run() -> LoopRun {
    let time_s: Vec<f64> = (0..3_000).map(|i| f64::from(i) * 0.01).collect();
    let input_mm: Vec<f64> = time_s.iter().map(|t| 1.5 - 1.5 * (TAU * 0.1 * t).cos()).collect();
    let model = smam::hysteresis::HysteresisModel::Paper(PaperModel::printed());
    let mut output_mm = model.follow(&time_s, &input_mm);
    // Uncorrelated enough for a bench, and the same everywhere.
    output_mm.iter_mut().enumerate().for_each(|(i, y)| *y += 0.027 * (((i * 7_919) % 1_000) as f64 / 500.0 - 1.0));
    LoopRun { name: "bench".to_owned(), time_s, input_mm, output_mm }
}

fn sets(problem: &Problem<'_>) -> Vec<Vec<f64>> {
    let middle = |s: &&smam::identify::loops::ParameterSpec| 0.5 * (s.min + s.max);
    let base: Vec<f64> = problem.free().iter().map(middle).collect();
    (0..SETS).map(|i| base.iter().map(|p| p * (1.0 - 0.005 * i as f64)).collect()).collect()
}

fn many_sets(criterion: &mut Criterion) {
    let runs = [run()];
    let scale = LoopScale::of(&runs);
    let mut group = criterion.benchmark_group("64 parameter sets");
    group.throughput(Throughput::Elements(SETS as u64)).sample_size(10);
    for form in Form::ALL {
        let problem = Problem::new(&runs, form, &scale);
        let sets = sets(&problem);
        group.bench_function(BenchmarkId::new("one at a time", form.name()), |b| {
            b.iter(|| sets.iter().map(|set| problem.mean_square(black_box(set))).sum::<f64>());
        });
        group.bench_function(BenchmarkId::new("side by side", form.name()), |b| {
            b.iter(|| problem.mean_squares(black_box(&sets)));
        });
    }
}

fn identification(criterion: &mut Criterion) {
    let runs = [run()];
    let mut group = criterion.benchmark_group("identification of 30 s at 100 Hz");
    group.sample_size(10);
    for form in Form::ALL {
        group.bench_function(BenchmarkId::new("hybrid", form.name()), |b| {
            b.iter(|| identify(&runs, form, &SearchOptions::default()).map(|f| f.mean_square_mm2));
        });
    }
    let swarm = SearchOptions { method: Method::Pso, starts: 1, ..SearchOptions::default() };
    group.bench_function(BenchmarkId::new("swarm", "paper"), |b| {
        b.iter(|| identify(&runs, Form::Paper, &swarm).map(|f| f.mean_square_mm2));
    });
}

criterion_group!(benches, many_sets, identification);
criterion_main!(benches);
