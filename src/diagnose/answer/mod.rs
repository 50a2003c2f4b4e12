//! The answer: its parts in words and figures, its files, and its runs beside the full scene.
//!
//! May import `verdict`, `search`, `latent`, `full`, `fit`, `case`, `diagnosis` and `error`.

pub(super) mod caveats;
pub(super) mod figures;
mod files;
pub(super) mod location;
mod outcome;
mod side_by_side;
pub(super) mod specimens;
pub(super) mod summary;
pub(super) mod warnings;

pub use files::{write_answer, write_answer_with};
pub use outcome::{Outcome, calibrated_scene};
pub use side_by_side::side_by_side;
