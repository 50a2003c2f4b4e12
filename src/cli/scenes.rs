//! `smam scenes`.

use std::process::ExitCode;

use smam::scene::{STOCK_SCENES, Scene};

use super::CliError;

/// Lists the stock scenes with their titles.
pub fn scenes() -> Result<ExitCode, CliError> {
    for name in STOCK_SCENES {
        let scene = Scene::load(name, &[])?;
        say!("{name:<24} {}", scene.file.title);
    }
    say!("\nRun one: smam run {}", STOCK_SCENES[0]);
    Ok(ExitCode::SUCCESS)
}
