//! Displacement-form hysteresis: what comes out at the muscle's end for a plunger that moved so and so.
//!
//! Lengths are in **mm**, as in Thai et al. 2021, whose parameters carry these units. All laws here are
//! rate-independent: they follow the path of the input, not its speed. The one exception is a Prandtl-Ishlinskii
//! sum that is told to widen with speed.

mod asymmetric;
mod branch;
mod dahl;
mod error;
mod family;
mod lanes;
mod model;
mod paper;
mod play;
mod power;
mod slip;
mod symmetric;

#[cfg(test)]
mod loop_tests;
#[cfg(test)]
mod passivity_tests;
#[cfg(test)]
mod path_tests;

pub use error::HysteresisError;
pub use family::HysteresisModel;
pub use model::DisplacementModel;

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    asymmetric::AsymmetricBoucWen,
    dahl::DahlGrowing,
    lanes::{LANES, mean_squares},
    paper::{Gate, PaperModel},
    play::{Play, PlayElement, PrandtlIshlinskii},
    slip::{MaxwellSlip, SlipElement},
    symmetric::SymmetricBoucWen,
};

/// What a parameter is that a scene does not name.
fn zero<D: crate::scalar::Scalar>() -> D {
    D::constant(0.0)
}
