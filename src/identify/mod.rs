//! From recordings to parameters: replaying what was recorded, fitting the numbers a rig does not tell, and identifying
//! displacement-form hysteresis from loops ([`loops`]).

mod fit;
mod lead_in;
mod levenberg_marquardt;
pub mod loops;
mod own_settings;
mod replay;

pub use fit::{FitReport, FittedParameter, fit_rig_parameters};
pub use replay::{IdentifyError, RecordedRun, load_runs, replay};

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    lead_in::LeadIn,
    levenberg_marquardt::{Bounds, LmOptions, LmResult, minimise, minimise_with_jacobian},
    own_settings::own_settings,
    replay::{check_channels, condition_overrides, lead_in},
};
