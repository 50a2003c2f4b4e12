//! Which effects are named, with what probability and in which words, and whether more than noise is left.
//!
//! May import `search`, `fit`, `case` and `diagnosis`.

mod known_as;
pub(super) mod misfit;
mod named;
mod parameters;
mod written;

pub(super) use misfit::{Excess, Residuals, misfit};
pub(super) use named::{
    Confirmed, LITTLE_OF_NOISE, Open, doubt, is_approximate, is_loud, is_said, is_unknown, leaves_a_part, lost, named,
    open, unit, verdict,
};
pub(super) use parameters::discrepancy;
pub(super) use written::{curve, name_forms, name_over, port, together};
