//! Writing whole files.

use std::path::{Path, PathBuf};

use smam::files::{Held, Staged, hold_folder, place_all, still_there, write_whole};
use smam::recording::{LoadedRun, RecordingSet, SET_FILE_NAME, read_recording};
use smam::report::HtmlPage;
use smam::scene::Scene;
use smam::stock;

use super::CliError;

/// Makes a folder for results before the work: that it cannot be made is better said now than after it.
pub fn make_folder(path: &Path) -> Result<(), CliError> {
    std::fs::create_dir_all(path).map_err(|source| CliError::Write { file: path.to_owned(), source })
}

/// Makes a folder and takes it for this program alone, as long as what is returned lives: two that write into one folder
/// would mix their results.
pub fn take_folder(path: &Path) -> Result<Held, CliError> {
    make_folder(path)?;
    match hold_folder(path) {
        Held::Taken => Err(CliError::Usage(format!(
            "{}: another smam is writing here\n  remedy: wait for it, or give another folder with --out",
            path.display()
        ))),
        ours => Ok(ours),
    }
}

/// Writes a file that appears under its name whole or not at all; its folder is made.
pub fn write(path: &Path, text: &str) -> Result<(), CliError> {
    write_whole(path, text).map_err(|source| CliError::Write { file: path.to_owned(), source })
}

/// Files of one result: none appears before all are on the disk. Nothing is taken away: a folder that a user names may hold figures of
/// their own.
#[derive(Default)]
pub struct Together(Vec<Staged>);

impl Together {
    /// Adds a text.
    pub fn text(&mut self, path: &Path, text: &str) -> Result<(), CliError> {
        let staged = Staged::write(path, text.as_bytes());
        self.0.push(staged.map_err(|source| CliError::Write { file: path.to_owned(), source })?);
        Ok(())
    }

    /// Adds a page, and beside it the files of what it shows in part.
    pub fn page(&mut self, folder: &Path, name: &str, page: &HtmlPage) -> Result<(), CliError> {
        page.files().iter().try_for_each(|(path, text)| self.text(&folder.join(path), text))?;
        self.text(&folder.join(name), &page.finish())
    }

    /// Gives all their names.
    pub fn place(self) -> Result<(), CliError> {
        place_all(self.0).map_err(|(file, source)| CliError::Write { file, source })
    }
}

/// That what was written on the way stands there at the end.
pub fn see_there(paths: &[PathBuf]) -> Result<(), CliError> {
    paths
        .iter()
        .try_for_each(|path| still_there(path).map_err(|source| CliError::Write { file: path.to_owned(), source }))
}

/// Files that a command reads: no result may take the place of one.
#[derive(Default)]
pub struct Files(Vec<PathBuf>);

impl Files {
    /// Adds files.
    pub fn extend(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        self.0.extend(files);
    }

    /// Whether a path leads to one of them.
    pub fn holds(&self, path: &Path) -> bool {
        self.0.iter().any(|file| is_same_file(file, path))
    }

    /// Refuses a result in the place of one of them.
    pub fn refuse_over(&self, option: &str, path: &Path) -> Result<(), CliError> {
        match self.holds(path) {
            true => Err(CliError::Usage(format!(
                "{option} {}: this file is read, it would be lost\n  remedy: name another file",
                path.display()
            ))),
            false => Ok(()),
        }
    }

    /// Refuses a folder in which results of these names would take the place of one of them.
    pub fn refuse_in(&self, folder: &Path, is_written: impl Fn(&str) -> bool) -> Result<(), CliError> {
        let name = |file: &PathBuf| Some(file.canonicalize().ok()?.file_name()?.to_string_lossy().into_owned());
        let mut names = self.0.iter().filter_map(name).filter(|name| is_written(name));
        match names.find(|name| self.holds(&folder.join(name))) {
            Some(name) => Err(CliError::Usage(format!(
                "--out {}: {name} there is read, it would be lost\n  remedy: give the results a folder of their own with --out",
                folder.display()
            ))),
            None => Ok(()),
        }
    }
}

/// Refuses `-` where nothing goes to the standard output: it would be a file of that name.
pub fn refuse_dash(option: &str, path: &Path, remedy: &str) -> Result<(), CliError> {
    match path == Path::new("-") {
        true => Err(CliError::Usage(format!("{option} -: this goes into a file\n  remedy: {remedy}"))),
        false => Ok(()),
    }
}

/// A scene's file and what it names: its model, and the references of its checks.
pub fn scene_files(scene: &Scene) -> Vec<PathBuf> {
    let model = scene.file.mechanism.as_ref().map(|m| &m.urdf);
    let references = scene.file.expect.iter().filter_map(|e| e.file.as_ref());
    let named = model.into_iter().chain(references).map(|file| stock::join(scene.folder(), file));
    std::iter::once(scene.path.clone()).chain(named).collect()
}

/// The files of a folder of recordings, and the scene that it names where that is a file.
pub fn recorded_files(set: &RecordingSet) -> Vec<PathBuf> {
    let runs = set.runs.iter().flat_map(|run| run.files()).map(|file| set.dir.join(file));
    runs.chain([set.dir.join(SET_FILE_NAME), PathBuf::from(set.scene_path())]).collect()
}

/// A recording that drives a simulation: as the recordings.toml beside it declares it, or as it stands.
pub fn read_input(path: &Path) -> Result<LoadedRun, CliError> {
    let Some((set, run)) = RecordingSet::declaring(path)? else {
        return Ok(LoadedRun { recording: read_recording(path)?, notes: Vec::new() });
    };
    let mut loaded = set.load_run(&run)?;
    let mut read = format!("read as {} declares it", set.dir.join(SET_FILE_NAME).display());
    if !run.conditions.is_empty() {
        let known =
            run.conditions.iter().map(|(name, value)| format!("{name} = {value}")).collect::<Vec<_>>().join(", ");
        read.push_str(&format!(", but its conditions ({known}) are the scene's own here: --set changes them"));
    }
    loaded.notes.insert(0, read);
    Ok(loaded)
}

/// Whether two paths lead to one file, which is there or will be.
fn is_same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        // What goes into a device or a pipe takes nothing's place.
        (Ok(a), Ok(b)) => a == b && a.is_file(),
        (Err(_), Err(_)) => a == b,
        _ => false,
    }
}
