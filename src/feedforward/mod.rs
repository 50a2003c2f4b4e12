//! Feedforward compensation: the plunger's programme for a wanted output, from an identified hysteresis model.
//!
//! The inverse is found numerically, sample by sample, along the model's own path: it holds for every form behind
//! [`HysteresisModel`](crate::hysteresis::HysteresisModel), whether or not that form has an inverse in closed form.
//! [`Trim`] adds feedback on top where the output is measured.

mod inverse;
mod trim;

pub use inverse::{Inverse, Limits, Programme, programme};
pub use trim::Trim;
