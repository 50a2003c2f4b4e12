//! From recordings to parameters: replaying what was recorded, fitting the numbers a rig does not tell, and identifying
//! displacement-form hysteresis from loops ([`loops`]).

mod fit;
mod lead_in;
mod levenberg_marquardt;
pub mod loops;
mod own_start;
mod replay;

pub use fit::{FitReport, FittedParameter, fit_rig_parameters};
#[doc(hidden)]
pub use lead_in::LeadIn;
#[doc(hidden)]
pub use levenberg_marquardt::{Bounds, LmOptions, LmResult, minimise, minimise_with_slopes};
#[doc(hidden)]
pub use own_start::own_start;
pub use replay::{IdentifyError, RecordedRun, load_runs, replay};
#[doc(hidden)]
pub use replay::{check_channels, condition_overrides, lead_in};
