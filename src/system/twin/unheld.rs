//! When a joint is held by nothing: no cable on it is taut, and it has no spring.

use super::output::TwinOutput;
use super::{Twin, TwinRun, TwinSetting};
use crate::system::PlantState;
use crate::system::plant::{InputSpan, Plant};

impl Twin {
    /// By output, the samples of a run at which what it shows depends on a joint that nothing holds.
    ///
    /// Such a joint lies where its last swing left it: the smallest difference decides, and no model can foretell it.
    /// `None` when the simulation diverges.
    pub fn unheld(&self, run: &TwinRun, setting: &TwinSetting<f64>) -> Option<Vec<Vec<bool>>> {
        let mut unheld = vec![vec![false; run.times_s.len()]; self.outputs.len()];
        if self.axis.is_some() {
            return Some(unheld);
        }
        self.watch(run, setting, |k, plant, state, spans| {
            let free = free_coordinates(plant, state, spans);
            for (output, unheld) in self.outputs.iter().zip(&mut unheld) {
                unheld[k] = reads_any(output, &free);
            }
        })?;
        Some(unheld)
    }
}

fn free_coordinates(plant: &Plant<f64>, state: &PlantState<f64>, spans: &[InputSpan]) -> Vec<bool> {
    let taut: Vec<bool> = (0..plant.cables.len()).map(|c| plant.cable(c, state, spans, 0.0).2 > 0.0).collect();
    let is_free = |i: usize| {
        let mut cables = plant.cables.iter().zip(&taut).filter(|(c, _)| c.jacobian[i] != 0.0).peekable();
        plant.coordinates.stiffness[i] == 0.0 && cables.peek().is_some() && cables.all(|(_, taut)| !taut)
    };
    (0..plant.dim()).map(is_free).collect()
}

fn reads_any(output: &TwinOutput, free: &[bool]) -> bool {
    output.joints().iter().any(|(i, _)| free[*i])
}
