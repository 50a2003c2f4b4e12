//! The reduced-order model: one setting after the other, and side by side.

use super::{BenchError, cpu_time, median_cpu_s};
use crate::laws::LawTable;
use crate::scene::Scene;
use crate::system::{Rom, RomRun, RomSetting, Schedule};

/// Stock scenes with a reduced-order model, and what is asked of it, times real time.
pub const ROMS: [(&str, f64); 3] =
    [("muscle_bench", 10_000.0), ("antagonistic_pulley", 2_000.0), ("bending_catheter", 2_000.0)];

/// A law without memory that the bench's reduced-order model must carry at no more than 1.5 times the cost.
pub const LAW: &str = "muscle.friction scales 1 + 0.4*exp(-abs(speed_m_s)/2e-3)";

/// Length of the run, s, and parameter sets that are compared.
const LENGTH_S: f64 = 60.0;
const SETS: usize = 16;

/// Cost of the reduced-order model of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct RomSpeed {
    /// Greatest step, s.
    pub step_s: f64,
    /// Simulated seconds per second of CPU time, sets one after the other and side by side.
    pub singly: f64,
    pub side_by_side: f64,
}

impl RomSpeed {
    /// Measures with sets that differ by a per mille, as those of a fit do.
    ///
    /// # Errors
    /// Scenes without a reduced-order model.
    pub fn of(scene: &str, times: usize) -> Result<Self, BenchError> {
        Self::of_scene(&Scene::load(scene, &[])?, times)
    }

    /// The same with [`LAW`] in the scene.
    ///
    /// # Errors
    /// As for [`RomSpeed::of`].
    pub fn with_law(scene: &str, times: usize) -> Result<Self, BenchError> {
        let mut scene = Scene::load(scene, &[])?;
        scene.file.law.extend(LawTable::parse(LAW, "law"));
        Self::of_scene(&Scene::from_file(scene.file, &scene.path)?, times)
    }

    fn of_scene(scene: &Scene, times: usize) -> Result<Self, BenchError> {
        let rom = Rom::new(scene)?;
        let run = RomRun::of_programs(scene, &Schedule::even(LENGTH_S, 0.01));
        let c1 = rom.parameter("tube_c1_pa").into_iter();
        let set = |i: usize| RomSetting {
            parameters: c1.clone().map(|c1| (c1, 0.255e6 * (1.0 + 1e-3 * i as f64))).collect(),
            effects: Vec::new(),
        };
        let sets: Vec<RomSetting<f64>> = (0..SETS).map(set).collect();
        let speed = |seconds: f64| LENGTH_S * SETS as f64 / seconds;
        let one_by_one = || sets.iter().map(|set| rom.simulate(&run, set)).collect::<Vec<_>>();
        Ok(Self {
            step_s: rom.step_s,
            singly: speed(median_cpu_s(times, || Ok(cpu_time(one_by_one).1))?),
            side_by_side: speed(median_cpu_s(times, || Ok(cpu_time(|| rom.simulate_many(&run, &sets)).1))?),
        })
    }
}
