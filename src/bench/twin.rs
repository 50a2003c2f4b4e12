//! The fast model: one setting after the other, and side by side.

use super::{BenchError, cpu_time, median_cpu_s};
use crate::laws::LawTable;
use crate::scene::Scene;
use crate::system::{Schedule, Twin, TwinRun, TwinSetting};

/// Stock scenes with a fast model, and what is asked of it, times real time.
pub const TWINS: [(&str, f64); 3] =
    [("muscle_bench", 10_000.0), ("antagonistic_pulley", 2_000.0), ("bending_catheter", 2_000.0)];

/// A law without memory that the bench's fast model must carry at no more than 1.5 times the cost.
pub const LAW: &str = "muscle.friction scales 1 + 0.4*exp(-abs(speed_m_s)/2e-3)";

/// Length of the run, s, and parameter sets that are compared.
const LENGTH_S: f64 = 60.0;
const SETS: usize = 16;

/// Cost of the fast model of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct TwinSpeed {
    /// Greatest step, s.
    pub step_s: f64,
    /// Simulated seconds per second of CPU time, sets one after the other and side by side.
    pub singly: f64,
    pub side_by_side: f64,
}

impl TwinSpeed {
    /// Measures with sets that differ by a per mille, as those of a fit do.
    ///
    /// # Errors
    /// Scenes without a fast model.
    pub fn of(scene: &str, times: usize) -> Result<Self, BenchError> {
        Self::of_scene(&Scene::load(scene, &[])?, times)
    }

    /// The same with [`LAW`] in the scene.
    ///
    /// # Errors
    /// As for [`TwinSpeed::of`].
    pub fn with_law(scene: &str, times: usize) -> Result<Self, BenchError> {
        let mut scene = Scene::load(scene, &[])?;
        scene.file.law.extend(LawTable::parse(LAW, "law"));
        Self::of_scene(&Scene::from_file(scene.file, &scene.path)?, times)
    }

    fn of_scene(scene: &Scene, times: usize) -> Result<Self, BenchError> {
        let twin = Twin::new(scene)?;
        let run = TwinRun::of_programs(scene, &Schedule::even(LENGTH_S, 0.01));
        let c1 = twin.parameter("tube_c1_pa").into_iter();
        let set = |i: usize| TwinSetting {
            parameters: c1.clone().map(|c1| (c1, 0.255e6 * (1.0 + 1e-3 * i as f64))).collect(),
            effects: Vec::new(),
        };
        let sets: Vec<TwinSetting<f64>> = (0..SETS).map(set).collect();
        let speed = |seconds: f64| LENGTH_S * SETS as f64 / seconds;
        let one_by_one = || sets.iter().map(|set| twin.simulate(&run, set)).collect::<Vec<_>>();
        Ok(Self {
            step_s: twin.step_s,
            singly: speed(median_cpu_s(times, || Ok(cpu_time(one_by_one).1))?),
            side_by_side: speed(median_cpu_s(times, || Ok(cpu_time(|| twin.simulate_many(&run, &sets)).1))?),
        })
    }
}
