//! `smam check`.

use std::process::ExitCode;

use clap::Args;
use smam::scene::Scene;
use smam::system::{Schedule, Simulation, record};

use super::CliError;
use super::changes::Changes;

/// Arguments of `smam check`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam check muscle_bench --keys     every key with its value, defaults included
  smam check my_scene.toml           what is wrong with it, and what to do")]
pub struct CheckArguments {
    /// Path of a scene file, or a name that `smam scenes` lists
    scene: String,
    #[command(flatten)]
    changes: Changes,
    /// List every key that --set can change, with its value
    #[arg(long)]
    keys: bool,
}

/// Reads, validates and builds the scene without running it.
pub fn check(arguments: &CheckArguments) -> Result<ExitCode, CliError> {
    let overrides = arguments.changes.overrides()?;
    let scene = Scene::load(&arguments.scene, &overrides)?;
    if arguments.keys {
        let lines: String = scene.keys().iter().map(|(key, value)| format!("{key} = {value}\n")).collect();
        super::print_text(&lines)?;
        return Ok(ExitCode::SUCCESS);
    }
    let path = scene.path.display().to_string();
    let mut simulation = Simulation::new(scene)?;
    // What an output names is looked up when a run begins: one without an instant.
    record(&mut simulation, &Schedule::at(Vec::new()))?;
    simulation.warnings().iter().for_each(|w| eprintln!("note: {w}"));
    let file = &simulation.scene().file;
    say!(
        "{path}: right; {} muscles, {} cables, {} inputs, {} outputs, {} checks{}",
        file.muscle.len(),
        file.cable.len(),
        file.input.len(),
        file.output.len(),
        file.expect.len(),
        count_of_laws(file.law.len())
    );
    for law in &simulation.scene().laws {
        say!("  law {}: {}", law.name, law.text());
    }
    for law in file.law.iter().filter(|law| law.candidate) {
        say!("  law {}: a candidate, left to a diagnosis", law.name);
    }
    Ok(ExitCode::SUCCESS)
}

fn count_of_laws(count: usize) -> String {
    match count {
        0 => String::new(),
        1 => ", 1 law".to_owned(),
        n => format!(", {n} laws"),
    }
}
