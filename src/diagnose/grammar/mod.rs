//! Laws that may be tried: at which ports, over which variables, in which shapes, as variants that a fit can hold.
//!
//! May import `fit` and `case`.

mod acting;
mod reading;
mod shaped;
mod shapes;
mod slots;

pub(super) use acting::{Action, injected};
pub(super) use reading::Reading;
pub(super) use shaped::{candidate, curve, variant};
pub(super) use shapes::Shape;
pub(super) use slots::{Place, Reach, Slot, places, slots};
