//! One point: scene, run, measures.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::SweepError;
use super::measure::Ran;
use super::plan::Plan;
use crate::system::{Simulation, record};

/// A row of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub index: u64,
    pub values: Vec<f64>,
    /// Measures, or why there are none.
    pub outcome: Result<Vec<f64>, String>,
}

/// Runs a point at values of the keys. What fails there is its outcome; nothing of it depends on other points.
pub fn evaluate(plan: &Plan, index: u64, values: Vec<f64>) -> Row {
    // A point that breaks the engine must not end the sweep.
    let outcome = catch_unwind(AssertUnwindSafe(|| measured(plan, &values)))
        .map_err(|_| "the engine broke off".to_owned())
        .and_then(|outcome| outcome.map_err(|e| e.to_string()));
    Row { index, values, outcome }
}

fn measured(plan: &Plan, values: &[f64]) -> Result<Vec<f64>, SweepError> {
    let mut simulation = Simulation::new(plan.scene(values)?)?;
    let recording = record(&mut simulation, &plan.schedule)?;
    let ran = Ran { scene: simulation.scene(), recording: &recording };
    plan.measures.iter().map(|m| m.of(ran)).collect()
}
