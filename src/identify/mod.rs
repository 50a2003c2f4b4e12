//! From recordings to parameters: replaying what was recorded, fitting the numbers a rig does not tell, and identifying
//! displacement-form hysteresis from loops ([`loops`]).

mod fit;
mod lead_in;
mod levenberg_marquardt;
pub mod loops;
mod own_start;
mod replay;

pub use fit::{FitReport, FittedParameter, fit_rig_parameters};
pub use lead_in::LeadIn;
pub use levenberg_marquardt::{Bounds, LmOptions, LmResult, minimise, minimise_with_slopes};
pub use own_start::own_start;
pub use replay::{IdentifyError, RecordedRun, check_channels, condition_overrides, lead_in, load_runs, replay};
