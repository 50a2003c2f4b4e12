//! How many steps the fast model takes between two samples: as many as what is looked at needs.

use std::sync::Arc;

use crate::system::plant::Plant;

use super::course::Course;
use super::{Twin, TwinRun, TwinSetting};

/// Steps in each interval of a [`TwinRun`]; the first entry is that of the first interval.
pub type StepPlan = Arc<[u16]>;

/// Longest steps, s: the first that does over the whole run, the last wherever nothing else does. At rest long ones can flutter about
/// zero speed, and what is held by friction creeps, by less in one interval than any tolerance.
const LONGEST_S: [f64; 2] = [5.0e-3, 2.5e-3];
/// What a plan may leave out over a whole run, root mean square, in tolerances over one interval.
const WHOLE: f64 = 5.0;
/// Where nothing rubs, nothing does.
const LONGEST_SMOOTH_S: f64 = 2.0e-2;

/// And for so long after a corner of an input, s, so much shorter: where friction stops a motion is decided there.
const CORNER_S: f64 = 0.3;
const CORNER_STEPS: f64 = 4.0;
/// A corner: the slope of an input changes by this share of the greatest slope it ever has.
const CORNER_SHARE: f64 = 0.25;

/// Most steps in one interval.
const MOST: u16 = 256;

impl Twin {
    /// Plans the steps of a run so that twice as many would change no output by more than its tolerance (in its
    /// column's unit, by output; outputs with none are not looked at) over any one interval, and by more than a few over the whole run
    /// unless that would take steps that are shorter than is ever needed.
    ///
    /// The plan is made at one setting and then kept for others nearby: a response that is planned anew at every
    /// setting would not be smooth. `None` when the simulation diverges.
    pub fn plan(&self, run: &TwinRun, setting: &TwinSetting<f64>, tolerance: &[Option<f64>]) -> Option<StepPlan> {
        if self.standalone.is_some() {
            return Some(Arc::from(vec![1; run.times_s.len().saturating_sub(1)]));
        }
        let (longer, shortest) = match self.prepare(setting).0.may_rub() {
            true => LONGEST_S.split_at(LONGEST_S.len() - 1),
            false => (&[][..], &[LONGEST_SMOOTH_S][..]),
        };
        let plan = |longest_s: &f64| self.plan_with(*longest_s, run, setting, tolerance);
        let holds = |plan: &StepPlan| self.holds(plan, run, setting, tolerance);
        longer.iter().find_map(|longest_s| plan(longest_s).filter(holds)).or_else(|| shortest.iter().find_map(plan))
    }

    /// Whether twice as many steps would change little over the whole run.
    fn holds(&self, plan: &StepPlan, run: &TwinRun, setting: &TwinSetting<f64>, tolerance: &[Option<f64>]) -> bool {
        let play = |plan: StepPlan| self.simulate(&TwinRun { plan: Some(plan), ..run.clone() }, setting);
        let doubled = plan.iter().map(|steps| 2 * steps).collect();
        let (Some(coarse), Some(fine)) = (play(plan.clone()), play(doubled)) else { return false };
        coarse.iter().zip(&fine).zip(tolerance).all(|((coarse, fine), tolerance)| {
            let sum: f64 = coarse.iter().zip(fine).map(|(a, b)| (a - b).powi(2)).sum();
            tolerance.is_none_or(|t| sum <= coarse.len() as f64 * (WHOLE * t).powi(2))
        })
    }

    /// The plan whose steps are nowhere longer than this.
    fn plan_with(
        &self,
        longest_s: f64,
        run: &TwinRun,
        setting: &TwinSetting<f64>,
        tolerance: &[Option<f64>],
    ) -> Option<StepPlan> {
        let (mut plant, state) = self.prepare(setting);
        let mut course = Course::new(&mut plant, state, run);
        let shown = |plant: &Plant<f64>, course: &Course<f64>| -> Vec<f64> {
            self.outputs.iter().map(|o| o.read(plant, &course.state, &course.spans, &mut None)).collect()
        };
        let mut plan = Vec::with_capacity(run.times_s.len());
        let mut steps: u16 = 1;
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
    pub(super) fn steps_in(&self, run: &TwinRun, k: usize) -> u16 {
        run.plan.as_ref().map_or_else(|| self.steps_by_rule(run, k), |plan| plan[k - 1])
    }

    /// Those of an interval without a plan.
    fn steps_by_rule(&self, run: &TwinRun, k: usize) -> u16 {
        let (from, to) = (run.times_s[k - 1], run.times_s[k]);
        let shorter = if from - run.times_s[0] < super::RINGING_S { super::RINGING_STEPS } else { 1.0 };
        let steps = ((to - from) * shorter / self.step_s - 1e-6).ceil();
        steps.clamp(1.0, f64::from(u16::MAX)) as u16
    }
}

/// Fewest steps of the interval that ends at sample `k`; keeps the time of the last corner.
fn fewest_steps(run: &TwinRun, k: usize, longest_s: f64, greatest: &[f64], corner_s: &mut f64) -> u16 {
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
