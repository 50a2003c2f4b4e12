//! Effects of the catalogue are screened, refitted and exchanged until nothing explains the open runs
//! better.
//!
//! May import `grammar`, for laws that the scene proposes, `fit` and `case`.

pub(super) mod candidates;
pub(super) mod creep;
pub(super) mod detection_limit;
pub(super) mod discrepancy;
mod exchange;
mod refits;
pub(super) mod reweight;
mod screening;
mod stepwise;
mod way;

pub(super) use creep::is_broad;
pub(super) use refits::{below, beside, cross_validates, cross_validates_halves, cross_validates_runs};
pub(super) use screening::{Screened, least_gain};
pub(super) use stepwise::{Begun, Found, converged};
pub(super) use way::{Bound, MOST_EFFECTS, leaves_much};
