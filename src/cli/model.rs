//! `smam model`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Subcommand};

use super::CliError;

/// Arguments of `smam model`.
#[derive(Args)]
pub struct ModelArguments {
    #[command(subcommand)]
    kind: Kind,
}

#[derive(Subcommand)]
enum Kind {
    /// A tube with cutouts on one side, each a hinge
    NotchedTube(NotchedTube),
}

#[derive(Args)]
struct NotchedTube {
    /// Write the URDF here instead of on the standard output
    #[arg(long, value_name = "URDF")]
    output: Option<PathBuf>,
}

/// Generates the model.
pub fn model(arguments: &ModelArguments) -> Result<ExitCode, CliError> {
    let Kind::NotchedTube(tube) = &arguments.kind;
    let _ = tube.output.as_ref();
    Err(CliError::Usage("the generator is not there yet".to_owned()))
}
