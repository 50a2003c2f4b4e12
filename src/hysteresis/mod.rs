//! Displacement-form hysteresis: what comes out at the muscle's end for a plunger that moved so and so.
//!
//! Lengths are in **mm**, as in Thai et al. 2021, whose parameters carry these units. All laws here are
//! rate-independent: they follow the path of the input, not its speed.

mod asymmetric;
mod branch;
mod error;
mod model;
mod paper;
mod play;
mod symmetric;

#[cfg(test)]
mod loop_tests;
#[cfg(test)]
mod path_tests;

pub use asymmetric::AsymmetricBoucWen;
pub use error::HysteresisError;
pub use model::DisplacementModel;
pub use paper::{Gate, PaperModel};
pub use play::{MaxwellSlip, Play, PlayElement, PrandtlIshlinskii, SlipElement};
pub use symmetric::SymmetricBoucWen;
