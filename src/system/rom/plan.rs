//! Plans the number of steps between samples from the required accuracy.

use std::sync::Arc;

use crate::recording::median;
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
/// But not where a measured input scatters that much: a corner is this many times its usual change.
const CORNER_OVER_NOISE: f64 = 3.0;

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
        let corners: Vec<f64> = run.inputs.iter().map(|x| corner_slope(x, &run.times_s)).collect();
        let mut corner_s = run.times_s.first().copied().unwrap_or(0.0);
        for k in 1..run.times_s.len() {
            // What was enough before may be more than enough now.
            steps = (steps / 2).max(fewest_steps(run, k, longest_s, &corners, &mut corner_s));
            let mut coarse = course.clone();
            coarse.advance(&mut plant, run, k, steps);
            let mut of_coarse = shown(&plant, &coarse);
            loop {
                let mut fine = course.clone();
                fine.advance(&mut plant, run, k, 2 * steps);
                let of_fine = shown(&plant, &fine);
                let pairs = of_coarse.iter().zip(&of_fine);
                let is_near = pairs.zip(tolerance).all(|((a, b), t)| t.is_none_or(|t| (a - b).abs() <= t));
                // What is too fast for these steps may not be for shorter ones.
                if is_near && coarse.is_sound(&plant) && fine.is_sound(&plant) || steps >= MOST {
                    break;
                }
                (coarse, of_coarse) = (fine, of_fine);
                steps *= 2;
            }
            if !coarse.is_sound(&plant) {
                return None;
            }
            plan.push(steps);
            course = coarse;
        }
        Some(Arc::from(plan))
    }

    /// Steps that a simulation of a run takes.
    pub(crate) fn steps(&self, run: &RomRun) -> u64 {
        (1..run.times_s.len()).map(|k| u64::from(self.steps_in(run, k))).sum()
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

/// Fewest steps of the interval that ends at sample `k`; keeps the time of the last corner. `corners` are the changes of slope
/// from which on an input has one.
fn fewest_steps(run: &RomRun, k: usize, longest_s: f64, corners: &[f64], corner_s: &mut f64) -> u16 {
    let length_s = run.times_s[k] - run.times_s[k - 1];
    let turns = |(x, corner): (&Vec<f64>, &f64)| k > 1 && slope_change(x, &run.times_s, k) > *corner;
    if run.inputs.iter().zip(corners).any(turns) {
        *corner_s = run.times_s[k - 1];
    }
    let shorter = if run.times_s[k - 1] - *corner_s < CORNER_S { CORNER_STEPS } else { 1.0 };
    (length_s * shorter / longest_s - 1e-6).ceil().clamp(1.0, f64::from(MOST)) as u16
}

fn slope(x: &[f64], times_s: &[f64], k: usize) -> f64 {
    (x[k] - x[k - 1]) / (times_s[k] - times_s[k - 1])
}

/// Change of slope at sample `k - 1`.
fn slope_change(x: &[f64], times_s: &[f64], k: usize) -> f64 {
    (slope(x, times_s, k) - slope(x, times_s, k - 1)).abs()
}

/// Change of slope that is a corner of an input.
fn corner_slope(x: &[f64], times_s: &[f64]) -> f64 {
    let greatest = (1..x.len()).map(|k| slope(x, times_s, k).abs()).fold(0.0, f64::max);
    let mut changes: Vec<f64> = (2..x.len()).map(|k| slope_change(x, times_s, k)).collect();
    let usual = median(&mut changes).unwrap_or(0.0);
    (CORNER_SHARE * greatest).max(CORNER_OVER_NOISE * usual)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle that turns every 5 s, by the steps of a counter, four at a time, or three to five.
    fn triangle(wavers: bool) -> (Vec<f64>, Vec<f64>) {
        let times_s: Vec<f64> = (0..200).map(|k| f64::from(k) * 0.1).collect();
        let counts = |k: usize| if wavers { [4.0, 5.0, 3.0, 4.0, 3.0, 5.0][k % 6] } else { 4.0 };
        let direction = |k: usize| if k % 100 < 50 { 1.0 } else { -1.0 };
        let x = (0..200).scan(0.0, |x, k| {
            *x += direction(k) * counts(k);
            Some(*x)
        });
        (times_s, x.collect())
    }

    #[test]
    fn a_measured_input_turns_where_it_turns() {
        for wavers in [false, true] {
            let (times_s, x) = triangle(wavers);
            let corner = corner_slope(&x, &times_s);
            let turns: Vec<usize> = (2..x.len()).filter(|&k| slope_change(&x, &times_s, k) > corner).collect();
            assert_eq!(turns, [50, 100, 150], "{wavers}");
        }
    }
}
