//! The grammar of laws: ports, variables and shapes, as variants for a fit.
//!
//! May import `fit` and `case`.

mod acting;
mod addresses;
mod pieces;
mod reach;
mod reading;
mod shaped;
mod shapes;
mod slots;

pub(super) use acting::{Action, injected};
pub(super) use pieces::{drawn, in_pieces, is_in_pieces, is_size, pieces};
pub(super) use reach::{Reach, constants, slots, steady};
pub(super) use reading::Reading;
pub(super) use shaped::{SECOND_SIZE, Term, candidate, curve, is_sum, scales_of_sum, sum, variant};
pub(super) use shapes::{MORE_SHAPES, SHAPES, Shape};
pub(super) use slots::{Place, SCALE, Slot, places};
