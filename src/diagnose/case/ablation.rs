//! Ablation: a diagnosis without one of its steps, to see what the step is worth.

use super::Case;
use crate::recording::parse_column;

/// A step that is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    /// Ignore recorded pressures.
    Pressure,
    /// Keep the scene's calibration: nothing is refitted before or beside the effects.
    Refit,
    /// Skip cross-validation and held-out runs.
    CrossValidation,
    /// Closed set: the answer is always of the catalogue.
    OpenSet,
}

impl Case {
    /// Whether a step is left out of the diagnosis of this case.
    pub(in crate::diagnose) fn is_without(&self, step: Step) -> bool {
        self.without == Some(step)
    }

    /// Leaves a step out. Pressures stay where nothing else was recorded.
    #[doc(hidden)]
    pub fn leave_out(&mut self, step: Step) {
        self.without = Some(step);
        match step {
            Step::Pressure => self.drop_pressures(),
            Step::Refit => self.parameters.clear(),
            Step::CrossValidation | Step::OpenSet => {}
        }
    }

    fn drop_pressures(&mut self) {
        let is_kept: Vec<bool> = self.channels.iter().map(|c| !is_pressure(&c.column)).collect();
        if !is_kept.contains(&true) {
            return;
        }
        keep(&mut self.channels, &is_kept);
        for run in &mut self.runs {
            keep(&mut run.measured, &is_kept);
            run.open_part.iter_mut().for_each(|part| keep(part, &is_kept));
        }
    }
}

fn is_pressure(column: &str) -> bool {
    parse_column(column).is_ok_and(|c| c.unit.si_suffix == "pa")
}

fn keep<T>(items: &mut Vec<T>, is_kept: &[bool]) {
    let mut flags = is_kept.iter();
    items.retain(|_| flags.next().copied().unwrap_or(true));
}
