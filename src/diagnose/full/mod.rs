//! The full scene with the parameters of a fit: as text, played beside the reduced-order model, and with the last word on the parameters.
//!
//! May import `fit`, `case`, `diagnosis` and `error`.

mod play;
pub(super) mod refine;
mod scene;

pub(super) use play::{FullRun, agreement, full_simulation, play_full};
pub(super) use scene::fitted_scene;
