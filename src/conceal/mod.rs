//! Concealed cases: recordings of rigs that hide something, with the answer under seal.
//!
//! The plant is a second program for the same rigs: its own equations and numbers, another integrator, other forms of
//! the laws, noise with colour. It imports nothing of the simulation or the diagnosis, and the diagnosis imports nothing
//! of it.

mod acting;
mod begin;
mod case;
mod ceiling;
mod drawn;
mod form;
mod hidden;
mod laws;
mod more;
mod noise;
mod plant;
mod programme;
mod seal;
mod secrets;
mod settling;
mod size;
mod solve;
mod stock;
mod tube;
mod write;
mod writings;

use std::path::PathBuf;

pub use case::{Decoy, Drawn, Hiding, Truth, draw, sensor_noise};
pub use ceiling::{Ceiling, ceiling};
pub use drawn::{DrawnLaw, Place, Reads, Remembers};
pub use form::Form;
pub use more::{Further, record_asked, record_drawn};
pub use noise::ChannelNoise;
pub use seal::seal;
pub use secrets::Secret;
pub use settling::{Settling, settling};
pub use stock::{Calibration, Output, Rig};
#[doc(hidden)]
pub use write::is_another_there;
pub use write::{SEALED, write_case};
pub use writings::Writing;

use crate::recording::RecordingError;

/// Why a case cannot be concealed.
#[derive(Debug, thiserror::Error)]
pub enum ConcealError {
    #[error("the concealing plant cannot be integrated: {0}\n  remedy: another seed")]
    Solver(String),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error("{file}: cannot be written: {source}\n  remedy: give another folder with --out")]
    Write { file: PathBuf, source: std::io::Error },
}

#[cfg(test)]
mod tests;
