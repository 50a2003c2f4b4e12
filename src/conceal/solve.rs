//! Integrates a plant with diffsol: implicit, of variable step; nothing of our own integrator.

use std::sync::Arc;

use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, VectorCommon};

use super::ConcealError;
use super::plant::Plant;
use super::programme::{Drive, SAMPLE_S};

type Matrix = NalgebraMat<f64>;

const RELATIVE_TOLERANCE: f64 = 1e-6;
/// In scaled states, whose unit is about their range.
const ABSOLUTE_TOLERANCE: f64 = 1e-6;
/// Step of the differences that stand for the Jacobian, in scaled states.
const DIFFERENCE: f64 = 1e-6;

/// Rates of the scaled states.
struct Scaled {
    plant: Plant,
    drives: Vec<Drive>,
    scales: Vec<f64>,
}

impl Scaled {
    fn rates(&self, t: f64, scaled: &[f64]) -> Vec<f64> {
        let x: Vec<f64> = scaled.iter().zip(&self.scales).map(|(x, s)| x * s).collect();
        let mut dx = vec![0.0; x.len()];
        self.plant.rates(t, &x, &self.drives, &mut dx);
        dx.iter_mut().zip(&self.scales).for_each(|(d, s)| *d /= s);
        dx
    }

    fn directional(&self, t: f64, scaled: &[f64], along: &[f64]) -> Vec<f64> {
        let longest = along.iter().fold(0.0f64, |l, v| l.max(v.abs()));
        if longest == 0.0 {
            return vec![0.0; along.len()];
        }
        let step = DIFFERENCE / longest;
        let at = |sign: f64| -> Vec<f64> {
            let moved: Vec<f64> = scaled.iter().zip(along).map(|(x, v)| x + sign * step * v).collect();
            self.rates(t, &moved)
        };
        at(1.0).iter().zip(at(-1.0)).map(|(a, b)| (a - b) / (2.0 * step)).collect()
    }
}

/// Outputs of a plant at every sample of its drives, by channel.
///
/// # Errors
/// A plant that the solver cannot follow.
pub fn solve(plant: &Plant, drives: &[Drive]) -> Result<Vec<Vec<f64>>, ConcealError> {
    let scaled = Arc::new(Scaled { plant: plant.clone(), drives: drives.to_vec(), scales: plant.scales() });
    let start: Vec<f64> = plant.start().iter().zip(&scaled.scales).map(|(x, s)| x / s).collect();
    let failed = |e: diffsol::error::DiffsolError| ConcealError::Solver(e.to_string());
    let (states, count) = (start.len(), drives[0].positions_m.len());
    let (rhs, slope) = (Arc::clone(&scaled), Arc::clone(&scaled));
    let mut problem = OdeBuilder::<Matrix>::new()
        .rtol(RELATIVE_TOLERANCE)
        .atol(vec![ABSOLUTE_TOLERANCE; states])
        .h0(1e-6)
        .rhs_implicit(
            move |x: &[f64], _: &[f64], t: f64, y: &mut [f64]| y.copy_from_slice(&rhs.rates(t, x)),
            move |x: &[f64], _: &[f64], t: f64, v: &[f64], y: &mut [f64]| {
                y.copy_from_slice(&slope.directional(t, x, v));
            },
        )
        .init(move |_: &[f64], _: f64, y: &mut [f64]| y.copy_from_slice(&start), states)
        .build()
        .map_err(failed)?;
    // Counted over the whole run: every corner of an input costs some.
    problem.ode_options.max_nonlinear_solver_failures = usize::MAX;
    let mut solver = problem.tr_bdf2::<NalgebraLU<f64>>().map_err(failed)?;
    let mut channels = vec![Vec::with_capacity(count); plant.rig.outputs().len()];
    for k in 0..count {
        let sample_s = k as f64 * SAMPLE_S;
        while solver.state().t < sample_s {
            solver.step().map_err(failed)?;
        }
        let there = solver.interpolate(sample_s).map_err(failed)?;
        let x: Vec<f64> = there.inner().iter().zip(&scaled.scales).map(|(x, s)| x * s).collect();
        channels.iter_mut().zip(plant.outputs(&x)).for_each(|(channel, value)| channel.push(value));
    }
    Ok(channels)
}
