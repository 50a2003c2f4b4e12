//! What the catalogue does not explain, as laws of the grammar.
//!
//! May import `verdict`, `search`, `latent`, `grammar`, `fit`, `case` and `diagnosis`.

pub(super) mod by_run;
mod by_run_search;
mod elsewhere;
mod forms;
mod freed;
pub(super) mod freehand;
mod grown;
pub(super) mod hypothesis;
mod linear_range;
mod listed;
pub(super) mod misplaced;
pub(super) mod one_law;
pub(super) mod pair;
mod pieces;
mod shape_refits;
mod shown;
mod simpler;
mod span;
pub(super) mod stand_ins;
mod stead;
mod sums;
pub(super) mod tried;
mod unlisted;

pub(super) use forms::{SAME, equally_good, leaves_something};
pub(super) use unlisted::propose;
