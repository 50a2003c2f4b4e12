//! How cost grows with a scene's parts: a power law through what is measured.

use std::path::Path;

use super::{BenchError, cpu_time, made, median_cpu_s, simulations_s};
use crate::recording::figures::line_of_best_fit;
use crate::scene::{Override, Scene};
use crate::system::{Rom, RomRun, RomSetting, Schedule, Simulation};

/// One kind of part, in growing numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    pub part: &'static str,
    /// What the cost is taken of.
    pub of: &'static str,
    /// Exponent that a count of operations gives for many parts.
    pub expected: f64,
    pub reason: &'static str,
    /// Number of parts, and CPU time, s.
    pub costs: Vec<(f64, f64)>,
}

impl Growth {
    /// Exponent of the power law through the upper half, where what does not grow weighs least.
    pub fn exponent(&self) -> f64 {
        let upper = &self.costs[self.costs.len() / 2 - usize::from(self.costs.len() > 3)..];
        let (n, t): (Vec<f64>, Vec<f64>) = upper.iter().map(|(n, t)| (n.ln(), t.ln())).unzip();
        line_of_best_fit(&n, &t).slope
    }
}

/// Measures every kind of part; scenes that are made for it go to `folder`.
///
/// # Errors
/// Files that cannot be written, runs that diverge.
pub fn grow(folder: &Path, times: usize) -> Result<Vec<Growth>, BenchError> {
    let engine = |scene: Scene| simulations_s(times, 1.0, || Ok(Simulation::new(scene.clone())?));
    Ok(vec![
        Growth {
            part: "segments of the line",
            of: "a second of the bench",
            expected: 1.0,
            reason: "a tridiagonal system",
            costs: costs(&[1, 4, 16, 64, 128], |n| engine(bench_with_segments(n)?))?,
        },
        Growth {
            part: "hinges",
            of: "a second of a bending tube",
            expected: 3.0,
            reason: "a factorisation of the inertia matrix in each step",
            costs: costs(&[8, 16, 32, 64], |n| engine(made::hinges(folder, n)?))?,
        },
        Growth {
            part: "muscles",
            of: "a second of muscles side by side",
            expected: 3.0,
            reason: "the same, of one slider each",
            costs: costs(&[2, 4, 8, 16], |n| engine(made::muscles(folder, n)?))?,
        },
        Growth {
            part: "samples",
            of: "a run of the fast bench",
            expected: 1.0,
            reason: "one after the other",
            costs: costs(&[1_000, 4_000, 16_000], |n| samples_s(n, times))?,
        },
        Growth {
            part: "parameter sets",
            of: "runs of the fast bench side by side",
            expected: 1.0,
            reason: "eight at a time",
            costs: costs(&[8, 32, 128], |n| sets_s(n, times))?,
        },
    ])
}

/// Cost for each number of parts.
fn costs(counts: &[usize], cost_s: impl Fn(usize) -> Result<f64, BenchError>) -> Result<Vec<(f64, f64)>, BenchError> {
    counts.iter().map(|&n| Ok((n as f64, cost_s(n)?))).collect()
}

fn bench_with_segments(segments: usize) -> Result<Scene, BenchError> {
    let segments = Override { key: "hydraulics.line.segments".to_owned(), value: (segments as i64).into() };
    let compliance = Override::number("hydraulics.line.compliance_m3_pa", 1e-15);
    Ok(Scene::load("muscle_bench", &[segments, compliance])?)
}

fn fast_bench(samples: usize) -> Result<(Rom, RomRun), BenchError> {
    let scene = Scene::load("muscle_bench", &[])?;
    let run = RomRun::of_programs(&scene, &Schedule::even(0.01 * samples as f64, 0.01));
    Ok((Rom::new(&scene)?, run))
}

fn samples_s(samples: usize, times: usize) -> Result<f64, BenchError> {
    let (rom, run) = fast_bench(samples)?;
    let setting = RomSetting::<f64>::default();
    median_cpu_s(times, || Ok(cpu_time(|| rom.simulate(&run, &setting)).1))
}

fn sets_s(count: usize, times: usize) -> Result<f64, BenchError> {
    let (rom, run) = fast_bench(1_000)?;
    let c1 = rom.parameter("tube_c1_pa");
    let set = |i: usize| RomSetting {
        parameters: c1.iter().map(|c1| (c1.clone(), 0.255e6 * (1.0 + 1e-4 * i as f64))).collect(),
        effects: Vec::new(),
    };
    let sets: Vec<RomSetting<f64>> = (0..count).map(set).collect();
    median_cpu_s(times, || Ok(cpu_time(|| rom.simulate_many(&run, &sets)).1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponent_is_that_of_many_parts() {
        let costs = [8.0, 16.0, 32.0, 64.0].map(|n: f64| (n, 1e-5 + 1e-6 * n * n)).to_vec();
        let growth = Growth { part: "", of: "", expected: 2.0, reason: "", costs };
        assert!((1.9..2.0).contains(&growth.exponent()), "{}", growth.exponent());
    }

    #[test]
    fn made_scenes_run() {
        let folder = tempfile::tempdir().expect("a folder");
        for scene in [made::hinges(folder.path(), 8), made::muscles(folder.path(), 2), bench_with_segments(4)] {
            let mut simulation = Simulation::new(scene.expect("a valid scene")).expect("it can be built");
            simulation.advance_to(0.2).expect("it runs");
        }
    }
}
