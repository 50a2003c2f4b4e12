//! Integrates a plant with diffsol: implicit, of variable step; nothing of our own integrator.

use std::sync::Arc;

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason, VectorCommon};

use super::ConcealError;
use super::plant::{Plant, Plunger};
use super::programme::{Drive, SAMPLE_S};

type Matrix = NalgebraMat<f64>;

const RELATIVE_TOLERANCE: f64 = 1e-7;
/// In scaled states, whose unit is about their range.
const ABSOLUTE_TOLERANCE: f64 = 1e-7;
/// Step of the differences that stand for the Jacobian, in scaled states.
const DIFFERENCE: f64 = 1e-6;
/// First step of an interval, s: a corner of the inputs lies before it.
const FIRST_STEP_S: f64 = 2e-4;

/// Rates of the scaled states over one interval between samples.
struct Interval {
    plant: Arc<Plant>,
    scales: Arc<[f64]>,
    drives: Arc<[Drive]>,
    begins_at: usize,
}

impl Interval {
    fn rates(&self, since_s: f64, scaled: &[f64]) -> Vec<f64> {
        let x: Vec<f64> = scaled.iter().zip(self.scales.iter()).map(|(x, s)| x * s).collect();
        let plungers: Vec<Plunger> = self.drives.iter().map(|d| d.after(self.begins_at, since_s)).collect();
        let mut dx = vec![0.0; x.len()];
        self.plant.rates(self.begins_at as f64 * SAMPLE_S + since_s, &x, &plungers, &mut dx);
        dx.iter_mut().zip(self.scales.iter()).for_each(|(d, s)| *d /= s);
        dx
    }

    fn directional(&self, since_s: f64, scaled: &[f64], along: &[f64]) -> Vec<f64> {
        let longest = along.iter().fold(0.0f64, |l, v| l.max(v.abs()));
        if longest == 0.0 {
            return vec![0.0; along.len()];
        }
        let step = DIFFERENCE / longest;
        let at = |sign: f64| -> Vec<f64> {
            let moved: Vec<f64> = scaled.iter().zip(along).map(|(x, v)| x + sign * step * v).collect();
            self.rates(since_s, &moved)
        };
        at(1.0).iter().zip(at(-1.0)).map(|(a, b)| (a - b) / (2.0 * step)).collect()
    }

    /// The scaled states at the interval's end.
    fn solve(self, start: Vec<f64>) -> Result<Vec<f64>, ConcealError> {
        let failed = |e: diffsol::error::DiffsolError| ConcealError::Solver(e.to_string());
        let states = start.len();
        let (here, there) = (Arc::new(self), start);
        let slope = Arc::clone(&here);
        let problem = OdeBuilder::<Matrix>::new()
            .rtol(RELATIVE_TOLERANCE)
            .atol(vec![ABSOLUTE_TOLERANCE; states])
            .h0(FIRST_STEP_S)
            .rhs_implicit(
                move |x: &[f64], _: &[f64], t: f64, y: &mut [f64]| y.copy_from_slice(&here.rates(t, x)),
                move |x: &[f64], _: &[f64], t: f64, v: &[f64], y: &mut [f64]| {
                    y.copy_from_slice(&slope.directional(t, x, v));
                },
            )
            .init(move |_: &[f64], _: f64, y: &mut [f64]| y.copy_from_slice(&there), states)
            .build()
            .map_err(failed)?;
        let mut solver = problem.tr_bdf2::<NalgebraLU<f64>>().map_err(failed)?;
        solver.set_stop_time(SAMPLE_S).map_err(failed)?;
        while !matches!(solver.step().map_err(failed)?, OdeSolverStopReason::TstopReached) {}
        Ok(solver.state().y.inner().iter().copied().collect())
    }
}

/// Outputs of a plant at every sample of its drives, by channel: those that its rig shows, then those of the sensors that it could
/// be given.
///
/// Inputs have their corners at the samples: each interval is solved by itself, from where the one before has ended.
///
/// # Errors
/// A plant that the solver cannot follow.
pub fn solve(plant: &Plant, drives: &[Drive]) -> Result<Vec<Vec<f64>>, ConcealError> {
    let (plant, drives): (Arc<Plant>, Arc<[Drive]>) = (Arc::new(plant.clone()), drives.into());
    let scales: Arc<[f64]> = plant.scales().into();
    let mut scaled: Vec<f64> = plant.start().iter().zip(scales.iter()).map(|(x, s)| x / s).collect();
    let count = drives[0].positions_m.len();
    let mut channels: Vec<Vec<f64>> = Vec::new();
    for k in 0..count {
        let x: Vec<f64> = scaled.iter().zip(scales.iter()).map(|(x, s)| x * s).collect();
        let values = [plant.outputs(&x), plant.more_outputs(k as f64 * SAMPLE_S, &x)].concat();
        channels.resize_with(values.len(), || Vec::with_capacity(count));
        channels.iter_mut().zip(values).for_each(|(channel, value)| channel.push(value));
        if k + 1 < count {
            let interval = Interval {
                plant: Arc::clone(&plant),
                scales: Arc::clone(&scales),
                drives: Arc::clone(&drives),
                begins_at: k,
            };
            scaled = interval.solve(scaled)?;
        }
    }
    Ok(channels)
}
