//! Least squares of a model, calibration and effects, against runs; and the first of all fits, that of the calibration alone.
//!
//! May import `case` and `error`.

pub(super) mod baseline;
mod calibrated;
mod coarse;
mod descent;
mod folds;
pub(super) mod intervals;
#[cfg(test)]
pub(super) mod made;
mod model;
mod normal;
mod problem;

pub use calibrated::{Calibrated, chi2_beyond};
pub use model::{Model, Placed};
pub use problem::Fit;

pub(super) use coarse::{difference, shifted};
pub(super) use descent::Underway;
pub(super) use model::{Probe, Sides, Variant, respond, simulate, simulate_many};
pub(super) use normal::{FitParameter, Normal, Rows, orthogonal};
pub(super) use problem::{Problem, probe, probes};
