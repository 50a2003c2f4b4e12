//! Every way these commands can fail besides those of all.

use smam::bench::BenchError;
use smam::conceal::ConcealError;
use smam::proof::ProofError;
use smam::reproduce::ReproduceError;
use smam::trial::TrialError;

use crate::cli::CliError;

/// Why a command that tests the program stopped.
#[derive(Debug, thiserror::Error)]
pub enum ValidationError {
    #[error(transparent)]
    Trial(#[from] TrialError),
    #[error(transparent)]
    Proof(#[from] ProofError),
    #[error(transparent)]
    Conceal(#[from] ConcealError),
    #[error(transparent)]
    Reproduce(#[from] ReproduceError),
    #[error(transparent)]
    Bench(#[from] BenchError),
}

impl ValidationError {
    /// Whether a file could not be written; everything else was asked wrongly.
    pub fn is_unwritten(&self) -> bool {
        matches!(
            self,
            Self::Trial(TrialError::Write { .. })
                | Self::Proof(ProofError::Write { .. } | ProofError::Conceal(ConcealError::Write { .. }))
                | Self::Conceal(ConcealError::Write { .. })
        )
    }
}

macro_rules! through_validation {
    ($($error:ident),*) => {$(
        impl From<$error> for CliError {
            fn from(error: $error) -> Self {
                Self::Validation(error.into())
            }
        }
    )*};
}

through_validation!(TrialError, ProofError, ConcealError, ReproduceError, BenchError);
