//! The stock scenes, at steps whose error is known.

use super::{BenchError, simulations_s};
use crate::recording::Recording;
use crate::scene::{Override, Scene};
use crate::system::{Schedule, Simulation, record};

/// A scene at a step that is accurate enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneCase {
    pub scene: &'static str,
    pub step_s: f64,
    pub substeps: usize,
    /// The part of the stock programme over which the error is taken, s.
    pub until_s: f64,
    /// What is asked of it, times real time.
    pub goal: f64,
}

/// The scenes, each at steps that keep every output within 0.1 % of its range. Where all cables have fixed levers an
/// engine step may be long: joints and cables move in the fine steps, and what an engine step brings up to date, inertia
/// and weights, is nearly the same at its end.
pub const CASES: [SceneCase; 4] = [
    SceneCase { scene: "muscle_bench", step_s: 0.02, substeps: 80, until_s: 15.0, goal: 200.0 },
    SceneCase { scene: "antagonistic_pulley", step_s: 0.02, substeps: 100, until_s: 15.0, goal: 100.0 },
    SceneCase { scene: "bending_catheter", step_s: 0.04, substeps: 32, until_s: 13.0, goal: 25.0 },
    // Until the ball is let go: where it first touches the dish is a matter of micrometres.
    SceneCase { scene: "grip_and_release", step_s: 1.25e-3, substeps: 5, until_s: 7.4, goal: 4.0 },
];

/// A scene's cost.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneSpeed {
    /// Simulated seconds per second of CPU time.
    pub times_real_time: f64,
    /// CPU time of a fine step, and of an engine step apart from its fine steps, s; from runs with as many and twice as
    /// many fine steps.
    pub fine_step_s: f64,
    pub engine_step_s: f64,
}

impl SceneCase {
    /// The scene at this case's steps, finer by whole factors.
    ///
    /// # Errors
    /// As for loading a stock scene: none that is to be expected.
    pub fn simulation(&self, finer_engine: f64, finer_plant: usize) -> Result<Simulation, BenchError> {
        let substeps = (self.substeps * finer_plant) as i64;
        let overrides = [
            Override::number("simulation.step_s", self.step_s / finer_engine),
            Override { key: "simulation.substeps".to_owned(), value: substeps.into() },
        ];
        Ok(Simulation::new(Scene::load(self.scene, &overrides)?)?)
    }

    /// The run over which the error is taken, at finer steps by whole factors; as often as an engine step of this case
    /// ends, since a row in its midst would cut it.
    ///
    /// # Errors
    /// A run that diverges.
    pub fn recorded(&self, finer_engine: f64, finer_plant: usize) -> Result<Recording, BenchError> {
        Ok(record(
            &mut self.simulation(finer_engine, finer_plant)?,
            &Schedule::even(self.until_s, self.step_s.max(0.01)),
        )?)
    }

    /// Measures, each figure the median of so many runs.
    ///
    /// # Errors
    /// A run that diverges.
    pub fn speed(&self, times: usize) -> Result<SceneSpeed, BenchError> {
        let [plain_s, doubled_s] = [self.cost_s(1, times)?, self.cost_s(2, times)?];
        let (engine_steps, fine) = (1.0 / self.step_s, self.substeps as f64);
        let fine_step_s = (doubled_s - plain_s) / (engine_steps * fine);
        let engine_step_s = plain_s / engine_steps - fine * fine_step_s;
        Ok(SceneSpeed { times_real_time: 1.0 / plain_s, fine_step_s, engine_step_s })
    }

    /// CPU time of one simulated second.
    fn cost_s(&self, finer_plant: usize, times: usize) -> Result<f64, BenchError> {
        Ok(simulations_s(times, self.until_s, || self.simulation(1.0, finer_plant))? / self.until_s)
    }
}

/// Greatest difference of each channel from a finer run at the same times, %: of its range there.
pub fn worst_errors(run: &Recording, reference: &Recording) -> Vec<(String, f64)> {
    let compared = |channel: &crate::recording::Channel| {
        let other = reference.find(&channel.column)?;
        let range = crate::recording::figures::range(&other.values);
        let error = channel.values.iter().zip(&other.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        (range > 0.0).then(|| (channel.column.clone(), 100.0 * error / range))
    };
    run.channels().iter().filter_map(compared).collect()
}
