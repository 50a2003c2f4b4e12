//! `smam scenes`.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use smam::files::write_whole_bytes;
use smam::nearest::did_you_mean;
use smam::scene::Scene;
use smam::stock;

use super::CliError;

/// Arguments of `smam scenes`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam scenes                                  what there is
  smam scenes muscle_bench --copy-to my_rig    my_rig/scenes/muscle_bench.toml and its model, to be changed")]
pub struct ScenesArguments {
    /// One of them: its title, or a copy of it
    name: Option<String>,
    /// Copy the scene (all of them if none is named) and its model to DIR/scenes and DIR/models
    #[arg(long, value_name = "DIR")]
    copy_to: Option<PathBuf>,
}

/// Lists the stock scenes with their titles, or copies them.
pub fn scenes(arguments: &ScenesArguments) -> Result<ExitCode, CliError> {
    let names = match &arguments.name {
        Some(name) => vec![known(name)?],
        None => stock::scenes().collect(),
    };
    for name in &names {
        let scene = carried(name)?;
        match &arguments.copy_to {
            Some(folder) => copy(&scene, folder)?,
            None => say!("{name:<24} {}", scene.file.title),
        }
    }
    if arguments.copy_to.is_none() {
        say!("\nRun one: smam run {}", names[0]);
    }
    Ok(ExitCode::SUCCESS)
}

fn known(name: &str) -> Result<&'static str, CliError> {
    stock::scenes().find(|known| *known == name).ok_or_else(|| {
        let nearest = did_you_mean(name, &stock::scenes().collect::<Vec<_>>());
        CliError::Usage(format!("{name}: no stock scene{nearest}\n  remedy: `smam scenes` lists them"))
    })
}

/// The scene as the program carries it, whatever stands in `scenes/` here.
fn carried(name: &str) -> Result<Scene, CliError> {
    let path = stock::builtin(&format!("scenes/{name}.toml")).unwrap_or_default();
    Ok(Scene::load(&path.to_string_lossy(), &[])?)
}

/// Writes the scene, its schema, its model and the model's meshes; a file that is there with another content stays.
fn copy(scene: &Scene, folder: &Path) -> Result<(), CliError> {
    let model = scene.file.mechanism.as_ref().map(|m| stock::join(scene.folder(), &m.urdf));
    let stem = model.as_deref().and_then(Path::file_stem).and_then(OsStr::to_str);
    let is_of_model = |name: &str| stem.is_some_and(|s| name.starts_with(&format!("models/{s}")));
    let own = scene.path.to_string_lossy();
    let own = own.trim_start_matches(stock::PREFIX);
    // The schema that the scene's first line points to goes with it.
    let is_wanted = |name: &str| name == own || name == "scenes/scene.schema.json" || is_of_model(name);
    for (name, content) in stock::FILES.iter().filter(|(name, _)| is_wanted(name)) {
        let to = folder.join(name);
        let there = std::fs::read(&to).ok();
        if there.as_ref().is_some_and(|t| t != content) {
            return Err(CliError::Usage(format!(
                "{}: is there already, with other content\n  remedy: name another folder, or move it away",
                to.display()
            )));
        }
        if there.is_none() {
            write_whole_bytes(&to, content).map_err(|source| CliError::Write { file: to.clone(), source })?;
        }
        say!("{}", to.display());
    }
    Ok(())
}
