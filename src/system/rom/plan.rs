//! Plans the number of steps between samples from the required accuracy.

use std::sync::Arc;

use crate::system::plant::Plant;

use super::course::Course;
use super::{Rom, RomRun, RomSetting};

/// Steps in each interval of a [`RomRun`]; the first entry is that of the first interval.
pub type StepPlan = Arc<[u16]>;

/// Longest step, s: longer ones flutter about zero speed at rest, and friction creeps.
const LONGEST_S: f64 = 2.5e-3;
/// Longest step without friction, s.
const LONGEST_SMOOTH_S: f64 = 2.0e-2;

/// For this time after a corner of an input, s, steps are shorter by this factor: friction decides there when motion
/// stops.
const CORNER_S: f64 = 0.3;
const CORNER_STEPS: f64 = 4.0;
/// A corner: the slope of an input changes by this share of the greatest slope it ever has.
const CORNER_SHARE: f64 = 0.25;

/// Most steps in one interval.
const MOST: u16 = 256;

impl Rom {
    /// Plans the steps of a run so that twice as many would change no output by more than its tolerance (in its
    /// column's unit, by output; outputs with none are not looked at) over any one interval.
    ///
    /// The plan is made at one setting and then kept for others nearby: a response that is planned anew at every
    /// setting would not be smooth. `None` when the simulation diverges.
    pub fn plan(&self, run: &RomRun, setting: &RomSetting<f64>, tolerance: &[Option<f64>]) -> Option<StepPlan> {
        if self.standalone.is_some() {
            return Some(Arc::from(vec![1; run.times_s.len().saturating_sub(1)]));
        }
        let (mut plant, state) = self.prepare(setting);
        let mut course = Course::new(&mut plant, state, run);
        let shown = |plant: &Plant<f64>, course: &Course<f64>| -> Vec<f64> {
            self.outputs.iter().map(|o| o.read(plant, &course.state, &course.spans, &mut None)).collect()
        };
        let mut plan = Vec::with_capacity(run.times_s.len());
        let mut steps: u16 = 1;
        let longest_s = if plant.may_rub() { LONGEST_S } else { LONGEST_SMOOTH_S };
        let greatest: Vec<f64> = run.inputs.iter().map(|x| greatest_slope(x, &run.times_s)).collect();
        let mut corner_s = run.times_s.first().copied().unwrap_or(0.0);
        for k in 1..run.times_s.len() {
            // What was enough before may be more than enough now.
            steps = (steps / 2).max(fewest_steps(run, k, longest_s, &greatest, &mut corner_s));
            let mut coarse = course.clone();
            coarse.advance(&mut plant, run, k, steps);
            let mut of_coarse = shown(&plant, &coarse);
            loop {
                let mut fine = course.clone();
                fine.advance(&mut plant, run, k, 2 * steps);
                let of_fine = shown(&plant, &fine);
                if !fine.is_sound(&plant) {
                    return None;
                }
                let pairs = of_coarse.iter().zip(&of_fine);
                let is_enough = pairs.zip(tolerance).all(|((a, b), t)| t.is_none_or(|t| (a - b).abs() <= t));
                if is_enough || steps >= MOST {
                    break;
                }
                (coarse, of_coarse) = (fine, of_fine);
                steps *= 2;
            }
            plan.push(steps);
            course = coarse;
        }
        Some(Arc::from(plan))
    }

    /// Steps of the interval that ends at sample `k`.
    pub(super) fn steps_in(&self, run: &RomRun, k: usize) -> u16 {
        run.plan.as_ref().map_or_else(|| self.steps_by_rule(run, k), |plan| plan[k - 1])
    }

    /// Those of an interval without a plan.
    fn steps_by_rule(&self, run: &RomRun, k: usize) -> u16 {
        let (from, to) = (run.times_s[k - 1], run.times_s[k]);
        let shorter = if from - run.times_s[0] < super::RINGING_S { super::RINGING_STEPS } else { 1.0 };
        let steps = ((to - from) * shorter / self.step_s - 1e-6).ceil();
        steps.clamp(1.0, f64::from(u16::MAX)) as u16
    }
}

/// Fewest steps of the interval that ends at sample `k`; keeps the time of the last corner.
fn fewest_steps(run: &RomRun, k: usize, longest_s: f64, greatest: &[f64], corner_s: &mut f64) -> u16 {
    let length_s = |k: usize| run.times_s[k] - run.times_s[k - 1];
    let slope = |x: &[f64], k: usize| (x[k] - x[k - 1]) / length_s(k);
    let turns =
        |(x, greatest): (&Vec<f64>, &f64)| k > 1 && (slope(x, k) - slope(x, k - 1)).abs() > CORNER_SHARE * greatest;
    if run.inputs.iter().zip(greatest).any(turns) {
        *corner_s = run.times_s[k - 1];
    }
    let shorter = if run.times_s[k - 1] - *corner_s < CORNER_S { CORNER_STEPS } else { 1.0 };
    (length_s(k) * shorter / longest_s - 1e-6).ceil().clamp(1.0, f64::from(MOST)) as u16
}

fn greatest_slope(x: &[f64], times_s: &[f64]) -> f64 {
    x.windows(2).zip(times_s.windows(2)).map(|(x, t)| ((x[1] - x[0]) / (t[1] - t[0])).abs()).fold(0.0, f64::max)
}
