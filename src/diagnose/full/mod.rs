//! The full scene with fitted parameters: as a file, compared with the reduced-order model, and for the final
//! refinement.
//!
//! May import `fit`, `case`, `diagnosis` and `error`.

mod play;
pub(super) mod refine;
mod scene;

pub(super) use play::{FullRun, agreement, full_simulation, play_full};
pub(super) use scene::fitted_scene;
