//! Slack joints: joints without a spring whose cables do not pull against each other.

use super::output::RomOutput;
use super::{Rom, RomRun, RomSetting};
use crate::system::PlantState;
use crate::system::plant::{InputSpan, Plant};

/// A one-sided pull below this share of the run's greatest tension does not hold a joint: it follows whichever cable
/// happens to be taut.
const FIRM: f64 = 0.01;

impl Rom {
    /// By output, the samples of a run at which it shows a slack joint.
    ///
    /// Such a joint rests where its last swing left it, or follows one cable through the other's slack. The smallest
    /// difference decides, and no model can predict it. `None` if the simulation diverges.
    pub fn slack_joints(&self, run: &RomRun, setting: &RomSetting<f64>) -> Option<Vec<Vec<bool>>> {
        if self.standalone.is_some() {
            return Some(vec![vec![false; run.times_s.len()]; self.outputs.len()]);
        }
        let mut holds: Vec<Vec<f64>> = Vec::with_capacity(run.times_s.len());
        let mut greatest_n = 0.0_f64;
        self.watch(run, setting, |_, plant, state, spans| {
            let tensions_n = tensions(plant, state, spans);
            greatest_n = tensions_n.iter().copied().fold(greatest_n, f64::max);
            holds.push((0..plant.dim()).map(|i| hold(plant, &tensions_n, i)).collect());
        })?;
        let is_loose = |hold_n: f64| hold_n <= FIRM * greatest_n;
        let at = |output: &RomOutput, holds: &Vec<f64>| output.joints().iter().any(|(i, _)| is_loose(holds[*i]));
        Some(self.outputs.iter().map(|output| holds.iter().map(|holds| at(output, holds)).collect()).collect())
    }
}

fn tensions(plant: &Plant<f64>, state: &PlantState<f64>, spans: &[InputSpan]) -> Vec<f64> {
    (0..plant.cables.len()).map(|c| plant.cable(c, state, spans, 0.0).2).collect()
}

/// The tension that holds a joint, N: infinite with a spring, without cables, or with taut cables on both sides.
fn hold(plant: &Plant<f64>, tensions_n: &[f64], joint: usize) -> f64 {
    let strongest = |sign: f64| {
        let pulls = plant.cables.iter().zip(tensions_n).filter(|(c, _)| sign * c.jacobian[joint] > 0.0);
        pulls.map(|(_, tension_n)| tension_n.max(0.0)).reduce(f64::max)
    };
    let (one, other) = (strongest(1.0), strongest(-1.0));
    let is_between = one.is_some_and(|n| n > 0.0) && other.is_some_and(|n| n > 0.0);
    if plant.coordinates.stiffness[joint] != 0.0 || is_between {
        return f64::INFINITY;
    }
    one.into_iter().chain(other).reduce(f64::max).unwrap_or(f64::INFINITY)
}
