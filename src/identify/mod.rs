//! From recordings to parameters: replaying what was recorded, and fitting the numbers a rig does not tell.

mod fit;
mod levenberg_marquardt;
mod replay;

pub use fit::{FitReport, FittedParameter, fit_rig_parameters};
pub use levenberg_marquardt::{Bounds, LmOptions, LmResult, minimise};
pub use replay::{IdentifyError, RecordedRun, check_channels, condition_overrides, load_runs, replay};
