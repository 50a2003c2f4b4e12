//! One point: scene, run, measures.

use std::panic::{AssertUnwindSafe, catch_unwind};

use super::SweepError;
use super::measure::Ran;
use super::plan::Plan;
use crate::system::{ConcernsS, Simulation, record_watched};

/// A row of the table.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    pub index: u64,
    pub values: Vec<f64>,
    /// Measures, or why there are none.
    pub outcome: Result<Vec<f64>, String>,
    /// How long the run was in each kind of trouble, s.
    pub concerns_s: ConcernsS,
}

impl Row {
    /// Numbers of the columns after the index: keys, measures, times in trouble; no number where there are none.
    #[doc(hidden)]
    pub fn numbers(&self, measures: usize) -> impl Iterator<Item = f64> {
        let own = self.outcome.as_deref().unwrap_or(&[]);
        let ran = self.outcome.is_ok();
        let measured = (0..measures).map(|i| own.get(i).copied().unwrap_or(f64::NAN));
        let concerns = self.concerns_s.iter().map(move |s| if ran { *s } else { f64::NAN });
        self.values.iter().copied().chain(measured).chain(concerns)
    }
}

/// Runs a point at values of the keys. What fails there is its outcome; nothing of it depends on other points.
///
/// ```
/// use smam::sweep::{Plan, SweepFile, evaluate};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let file: SweepFile = toml::from_str(r#"
/// format = 1
/// name = "stiffness"
/// scene = "muscle_bench"
/// duration_s = 1.0
/// vary = [{ key = "tube_c1_pa", values = [0.2e6, 0.3e6] }]
/// measure = [{ name = "longest_mm", of = "max(elongation_mm)" }]
/// "#)?;
/// let plan = Plan::new(file)?;
/// let longest_mm = |i: u64| plan.measured(&evaluate(&plan, i, plan.point(i)), "longest_mm");
/// // Half as stiff again: a tenth shorter.
/// assert!((longest_mm(1) / longest_mm(0) - 0.9).abs() < 0.02);
/// # Ok(())
/// # }
/// ```
pub fn evaluate(plan: &Plan, index: u64, values: Vec<f64>) -> Row {
    // A point that breaks the engine must not end the sweep.
    let outcome = catch_unwind(AssertUnwindSafe(|| measured(plan, &values)))
        .map_err(|_| "the engine broke off".to_owned())
        .and_then(|outcome| outcome.map_err(|e| e.to_string()));
    let (outcome, concerns_s) = match outcome {
        Ok((measures, concerns_s)) => (Ok(measures), concerns_s),
        Err(error) => (Err(error), ConcernsS::default()),
    };
    Row { index, values, outcome, concerns_s }
}

fn measured(plan: &Plan, values: &[f64]) -> Result<(Vec<f64>, ConcernsS), SweepError> {
    let mut simulation = Simulation::new(plan.scene(values)?)?;
    let (recording, concerns_s) = record_watched(&mut simulation, &plan.schedule)?;
    let ran = Ran { scene: simulation.scene(), recording: &recording };
    let measures = plan.measures.iter().map(|m| m.of(ran)).collect::<Result<_, _>>()?;
    Ok((measures, concerns_s))
}
