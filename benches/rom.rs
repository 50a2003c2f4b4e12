//! How many times faster than the rig the reduced-order model runs, on one core, and what each step costs in accuracy.
//!
//! Every stock scene that has a reduced-order model, over its own programme. The error is the greatest difference from the
//! smallest step, in percent of the channel's range, after the start has rung out.

use std::time::Duration;

use cpu_time::ProcessTime;
use smam::bench::RomSpeed;
use smam::scene::Scene;
use smam::system::{Rom, RomRun, RomSetting, Schedule};

const SCENES: [&str; 3] = ["muscle_bench", "antagonistic_pulley", "bending_catheter"];
/// Shares of the step that the reduced-order model chooses by itself; errors are counted from the first.
const STEPS: [f64; 6] = [0.125, 0.25, 0.5, 1.0, 2.0, 4.0];

fn run(rom: &Rom, run: &RomRun) -> (Option<Vec<Vec<f64>>>, Duration) {
    let begun = ProcessTime::now();
    let series = rom.simulate(run, &RomSetting::default());
    (series, begun.elapsed())
}

fn error_percent(reference: &[f64], series: &[f64]) -> f64 {
    let (low, high) = reference.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    let pairs = reference[50..].iter().zip(&series[50..]);
    100.0 * pairs.map(|(r, s)| (r - s).abs()).fold(0.0, f64::max) / (high - low).max(f64::MIN_POSITIVE)
}

fn main() {
    for name in SCENES {
        let scene = Scene::load(name, &[]).unwrap_or_else(|e| panic!("{e}"));
        let mut rom = Rom::new(&scene).unwrap_or_else(|e| panic!("{e}"));
        let drive = RomRun::of_programs(&scene, &Schedule::even(60.0, 0.01));
        let chosen_s = rom.step_s;
        let mut reference: Option<Vec<Vec<f64>>> = None;
        for share in STEPS {
            rom.step_s = share * chosen_s;
            let (series, took) = run(&rom, &drive);
            let Some(series) = series else {
                println!("{name:<20} step {:.3} ms: diverges", 1e3 * rom.step_s);
                continue;
            };
            let finest = reference.get_or_insert_with(|| series.clone());
            let worst = finest.iter().zip(&series).map(|(r, s)| error_percent(r, s)).fold(0.0, f64::max);
            let speed = 60.0 / took.as_secs_f64();
            println!("{name:<20} step {:.3} ms: {speed:>6.0} x real time, error {worst:.4} %", 1e3 * rom.step_s);
        }
        let RomSpeed { singly, side_by_side, .. } = RomSpeed::of(name, 3).unwrap_or_else(|e| panic!("{e}"));
        println!("{name:<20} sets one by one {singly:.0} x real time, side by side {side_by_side:.0}");
    }
}
