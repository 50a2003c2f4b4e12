//! `smam schema`.

use std::process::ExitCode;

use clap::{Args, ValueEnum};
use smam::recording::recordings_schema;
use smam::scene::scene_schema;

use super::CliError;

/// Arguments of `smam schema`.
#[derive(Args)]
pub struct SchemaArguments {
    /// Which kind of file
    #[arg(value_enum)]
    kind: Kind,
}

#[derive(Clone, Copy, ValueEnum)]
enum Kind {
    /// Scene files
    Scene,
    /// recordings.toml
    Recordings,
}

/// Prints the JSON Schema.
pub fn schema(arguments: &SchemaArguments) -> Result<ExitCode, CliError> {
    let text = match arguments.kind {
        Kind::Scene => scene_schema(),
        Kind::Recordings => recordings_schema(),
    };
    super::print_text(&text)?;
    Ok(ExitCode::SUCCESS)
}
