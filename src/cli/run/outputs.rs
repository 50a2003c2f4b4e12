//! The files that a run writes.

use std::path::{Path, PathBuf};

use smam::scene::Scene;

use super::RunArguments;
use crate::cli::CliError;
use crate::cli::files::{Files, scene_files};
use crate::cli::run_file::STANDARD_OUTPUT;
use crate::cli::words::quoted;

/// Refuses files that would take the place of what is read or of each other, before the work.
pub(super) fn check_outputs(arguments: &RunArguments, scene: &Scene) -> Result<(), CliError> {
    refuse_folder(arguments.junit.as_deref())?;
    refuse_mixed_output(arguments)?;
    let mut read = Files::default();
    read.extend(scene_files(scene));
    read.extend(arguments.input.clone());
    let name = &scene.file.name;
    let written = [
        ("--output", file_path(arguments, name)),
        ("--rrd", arguments.rrd.clone()),
        ("--junit", arguments.junit.clone()),
    ];
    let mut before = Files::default();
    for (option, path) in written.iter().filter_map(|(option, path)| Some((*option, path.as_deref()?))) {
        read.refuse_over(option, path)?;
        if before.holds(path) {
            let message = format!("{option} {}: another result of this run goes there", path.display());
            return Err(CliError::Usage(format!("{message}\n  remedy: give each result a name of its own")));
        }
        before.extend([path.to_owned()]);
    }
    Ok(())
}

/// A name that a folder has is refused before the work, not after it.
fn refuse_folder(file: Option<&Path>) -> Result<(), CliError> {
    match file.filter(|path| path.is_dir()) {
        Some(path) => Err(CliError::Write { file: path.to_owned(), source: std::io::ErrorKind::IsADirectory.into() }),
        None => Ok(()),
    }
}

/// On the standard output the recording stands alone, so that what reads it finds CSV and nothing else.
fn refuse_mixed_output(arguments: &RunArguments) -> Result<(), CliError> {
    let is_dash = |path: &Option<PathBuf>| path.as_deref() == Some(Path::new(STANDARD_OUTPUT));
    if let Some((option, _)) =
        [("--rrd", &arguments.rrd), ("--junit", &arguments.junit)].into_iter().find(|(_, path)| is_dash(path))
    {
        let message = format!("{option} -: only the recording goes to the standard output");
        return Err(CliError::Usage(format!("{message}\n  remedy: name a file, or /dev/stdout")));
    }
    let printed = [
        ("--angles", arguments.angles),
        ("--energy", arguments.energy),
        ("--check-steps", arguments.check_steps),
        ("--check", arguments.check),
    ];
    match printed.into_iter().find(|(_, asked)| *asked && is_dash(&arguments.output)) {
        Some((option, _)) => Err(CliError::Usage(format!(
            "--output -: {option} prints on the standard output too\n  remedy: name a file with --output, or leave {option} out"
        ))),
        None => Ok(()),
    }
}

/// Neither file was named: both go to `out/`.
fn writes_defaults(arguments: &RunArguments) -> bool {
    arguments.output.is_none() && arguments.rrd.is_none() && !arguments.view && !arguments.serve && !arguments.check
}

pub(super) fn file_path(arguments: &RunArguments, name: &str) -> Option<PathBuf> {
    let default = || writes_defaults(arguments).then(|| Path::new("out").join(format!("{name}.csv")));
    arguments.output.clone().or_else(default)
}

pub(super) fn rrd_path(arguments: &RunArguments, name: &str) -> Option<PathBuf> {
    let default =
        || (cfg!(feature = "viz") && writes_defaults(arguments)).then(|| Path::new("out").join(format!("{name}.rrd")));
    arguments.rrd.clone().or_else(default)
}

pub(super) fn say_what_to_open(arguments: &RunArguments, name: &str) {
    if let Some(path) = file_path(arguments, name).filter(|path| path != Path::new(STANDARD_OUTPUT)) {
        eprintln!("recording: {}", path.display());
    }
    if let Some(path) = rrd_path(arguments, name) {
        eprintln!("to look at it: rerun {}    (the viewer: pip install rerun-sdk==0.36.3)", quoted(&path));
    }
}
