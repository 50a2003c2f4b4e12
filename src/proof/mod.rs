//! The proof: concealed cases, answered by the diagnosis, opened and scored.
//!
//! This is the only place that sees both sides. The answer is sought from the recordings alone; the seal is published
//! before and opened after.

mod campaign;
mod curves;
mod decide;
mod found_law;
mod holdout;
mod law_ceiling;
mod law_metrics;
mod metrics;
mod row;
mod settle;
mod table;

use std::path::PathBuf;

pub use campaign::{Folders, Plan, Planned, answer_case, conceal_case};
pub use curves::{Share, detection, naming, reliability};
pub use decide::{Decided, decide};
pub use found_law::FoundLaw;
pub use law_ceiling::{LawCeiling, Told, law_ceiling};
pub use metrics::{Metric, VISIBLE, metrics};
pub use row::{Answered, Row, open, row};
pub use settle::{After, Settled, settle};
pub use table::page;

use crate::conceal::ConcealError;
use crate::diagnose::DiagnoseError;
use crate::identify::IdentifyError;
use crate::recording::RecordingError;

/// Why a proof cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum ProofError {
    #[error(transparent)]
    Conceal(#[from] ConcealError),
    #[error(transparent)]
    Diagnose(#[from] DiagnoseError),
    #[error(transparent)]
    Identify(#[from] IdentifyError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error("{file}: cannot be written: {source}\n  remedy: give another folder with --out")]
    Write { file: PathBuf, source: std::io::Error },
    #[error("{file}: cannot be read: {source}\n  remedy: let `smam conceal` and `smam diagnose` make it again")]
    Read { file: PathBuf, source: std::io::Error },
    #[error("{file}: {message}\n  remedy: let it be made again")]
    Format { file: PathBuf, message: String },
    #[error(
        "{file}: this is not the answer that was sealed for {name}\n  remedy: none; somebody changed it after the seal was published"
    )]
    Broken { file: PathBuf, name: String },
}
