//! The next experiment, which would best discriminate between open alternatives.
//!
//! May import `verdict`, `fit`, `case` and `diagnosis`.

mod ambiguous;
mod design;
mod discrimination;
pub mod programme;

pub(super) use ambiguous::settle;
pub(super) use design::{Experiment, confirm};
