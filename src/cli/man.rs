//! `smam man`: manual pages, made of what `--help` says.

use std::io::Error;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Command};
use clap_mangen::Man;
use smam::files::write_whole_bytes;

use super::error::CliError;

#[derive(Args)]
#[command(after_help = "Examples:
  smam man --out ~/.local/share/man/man1            then: man smam, man smam-diagnose")]
pub struct ManArguments {
    /// Folder that the pages are written to
    #[arg(long)]
    out: PathBuf,
}

/// Writes a page for the program and for each of its commands.
pub fn man(program: Command, arguments: &ManArguments) -> Result<ExitCode, CliError> {
    let failed = |e: Error| {
        let remedy = "remedy: name a folder that can be made or written to";
        CliError::Failed(format!("{}: {e}\n  {remedy}", arguments.out.display()))
    };
    std::fs::create_dir_all(&arguments.out).map_err(failed)?;
    let mut program = program.disable_help_subcommand(true);
    program.build();
    let commands = program.get_subcommands().filter(|command| !command.is_hide_set()).cloned();
    for command in commands.chain([program.clone()]) {
        let (page, mut text) = (Man::new(command), Vec::new());
        page.render(&mut text).map_err(failed)?;
        write_whole_bytes(&arguments.out.join(page.get_filename()), &text).map_err(failed)?;
    }
    say!("written: {}", arguments.out.display());
    Ok(ExitCode::SUCCESS)
}
