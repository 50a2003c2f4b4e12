//! Step 8: the next experiment, whose recording would tell best what stays open.
//!
//! May import `verdict`, `fit`, `case` and `diagnosis`.

mod ambiguous;
mod design;
mod discrimination;
pub mod programme;

pub(super) use ambiguous::settle;
pub(super) use design::{Experiment, confirm};
