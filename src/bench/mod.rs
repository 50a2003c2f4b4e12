//! What simulating costs: the stock scenes, the reduced-order model, and how cost grows with a scene's parts.
//!
//! Times are CPU times of this process, medians of several runs, so that another program on the machine changes them
//! little. Figures and what they mean: `docs/performance.md`.

mod growth;
mod made;
mod rom;
mod scenes;

use std::path::PathBuf;
use std::time::Duration;

use cpu_time::ProcessTime;

use crate::recording::median;
use crate::scene::SceneError;
use crate::system::{Simulation, SystemError};

pub use growth::{Growth, grow};
pub use rom::{LAW, ROMS, RomSpeed};
pub use scenes::{CASES, SceneCase, SceneSpeed, worst_errors};

/// What can keep a figure from being taken.
#[derive(Debug, thiserror::Error)]
pub enum BenchError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    System(#[from] SystemError),
    #[error("{}: cannot be read: {source}", file.display())]
    Read { file: PathBuf, source: std::io::Error },
    #[error("{}: cannot be written: {source}\n  remedy: set TMPDIR to a folder that can be written to", file.display())]
    Write { file: PathBuf, source: std::io::Error },
}

/// CPU time of one call.
fn cpu_time<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let begun = ProcessTime::now();
    let done = work();
    (done, begun.elapsed())
}

/// Median of the CPU times of several calls, s.
fn median_cpu_s(times: usize, mut run: impl FnMut() -> Result<Duration, BenchError>) -> Result<f64, BenchError> {
    let runs = (0..times.max(1)).map(|_| Ok(run()?.as_secs_f64()));
    let mut seconds = runs.collect::<Result<Vec<_>, BenchError>>()?;
    Ok(median(&mut seconds).unwrap_or(f64::NAN))
}

/// Median CPU time of simulations from their start to `until_s`, s.
fn simulations_s(
    times: usize,
    until_s: f64,
    make: impl Fn() -> Result<Simulation, BenchError>,
) -> Result<f64, BenchError> {
    median_cpu_s(times, || {
        let mut simulation = make()?;
        let (done, took) = cpu_time(|| simulation.advance_to(until_s));
        done?;
        Ok(took)
    })
}
