//! Scenes and models that come with the program, carried inside it.
//!
//! They are named by paths that begin with [`PREFIX`], `builtin:scenes/muscle_bench.toml`, so that a program without its
//! sources at hand (an installed one) reads and names them like files.
//!
//! ```
//! use std::path::Path;
//!
//! use smam::stock;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = stock::builtin("scenes/muscle_bench.toml").ok_or("it is carried")?;
//! let folder = scene.parent().ok_or("it has one")?;
//! let urdf = stock::join(folder, Path::new("../models/muscle_bench.urdf"));
//! assert_eq!(urdf, Path::new("builtin:models/muscle_bench.urdf"));
//! assert!(stock::read_text(&urdf)?.contains("<joint name=\"slide\" type=\"prismatic\">"));
//! assert!(stock::builtin("scenes/mine.toml").is_none());
//! # Ok(())
//! # }
//! ```

use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use crate::files;

/// Begins the path of a file that the program carries.
pub const PREFIX: &str = "builtin:";

macro_rules! carried {
    ($($path:literal),* $(,)?) => {
        &[$(($path, include_bytes!(concat!("../", $path)) as &[u8])),*]
    };
}

/// Path and content of every file that the program carries.
pub const FILES: &[(&str, &[u8])] = carried![
    "scenes/muscle_bench.toml",
    "scenes/muscle_free.toml",
    "scenes/muscle_lift.toml",
    "scenes/muscle_blocked.toml",
    "scenes/muscle_printed_model.toml",
    "scenes/antagonistic_pulley.toml",
    "scenes/bending_catheter.toml",
    "scenes/grip_and_release.toml",
    "scenes/pressure_muscle.toml",
    "scenes/tendon_sheath.toml",
    "scenes/driven_axis.toml",
    "scenes/tensile_test.toml",
    "scenes/closed_chamber.toml",
    "scenes/tendon_catheter.toml",
    "scenes/scene.schema.json",
    "models/antagonistic_pulley.urdf",
    "models/bending_catheter.urdf",
    "models/bending_catheter_strip.stl",
    "models/bending_catheter_tube.stl",
    "models/muscle_bench.urdf",
    "models/tendon_catheter.urdf",
];

/// Names of the stock scenes, `muscle_bench` first.
pub fn scenes() -> impl Iterator<Item = &'static str> {
    FILES.iter().filter_map(|(path, _)| path.strip_prefix("scenes/")?.strip_suffix(".toml"))
}

/// The path of a file that the program carries; none of one that it does not.
pub fn builtin(path: &str) -> Option<PathBuf> {
    FILES.iter().any(|(known, _)| *known == path).then(|| PathBuf::from(format!("{PREFIX}{path}")))
}

/// `file` as seen from `folder`, as [`Path::join`] does; a file that the program carries stands on its own.
pub fn join(folder: &Path, file: &Path) -> PathBuf {
    if inside(file).is_some() { tidy(file) } else { tidy(&folder.join(file)) }
}

/// The content of a file, of this machine or carried.
///
/// # Errors
/// A file that cannot be read, or is not carried.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let Some(name) = inside(path) else { return read_all(path) };
    let found = FILES.iter().find(|(known, _)| Path::new(known) == without_parents(&name));
    found.map(|(_, content)| content.to_vec()).ok_or_else(|| {
        let known: Vec<&str> = FILES.iter().map(|(known, _)| *known).collect();
        io::Error::new(
            io::ErrorKind::NotFound,
            format!("the program carries no such file; it has {}", known.join(", ")),
        )
    })
}

fn read_all(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    files::open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The text of a file, as [`read`].
///
/// # Errors
/// As [`read`] and [`files::read_text`].
pub fn read_text(path: &Path) -> io::Result<String> {
    if inside(path).is_none() {
        return files::read_text(path);
    }
    String::from_utf8(read(path)?)
        .map_err(|e| io::Error::new(io::ErrorKind::InvalidData, format!("it is no UTF-8 text: {e}")))
}

/// What stands behind the prefix.
fn inside(path: &Path) -> Option<PathBuf> {
    path.to_str()?.strip_prefix(PREFIX).map(PathBuf::from)
}

/// A carried file's path without `..`; other paths as they are: links in them may lead elsewhere.
fn tidy(path: &Path) -> PathBuf {
    match inside(path) {
        Some(name) => PathBuf::from(format!("{PREFIX}{}", without_parents(&name).display())),
        None => path.to_owned(),
    }
}

fn without_parents(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut so_far, part| {
        match part {
            Component::ParentDir => {
                so_far.pop();
            }
            Component::CurDir => {}
            other => so_far.push(other),
        }
        so_far
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_of_scenes_and_models_is_carried() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        for (folder, ending) in [("scenes", "toml"), ("models", "urdf"), ("models", "stl")] {
            for entry in std::fs::read_dir(root.join(folder)).expect("a folder of the project") {
                let path = entry.expect("an entry").path();
                if path.extension().is_some_and(|e| e == ending) {
                    let name = format!("{folder}/{}", path.file_name().expect("a name").to_string_lossy());
                    assert!(builtin(&name).is_some(), "{name} is not in FILES");
                }
            }
        }
    }

    #[test]
    fn a_carried_file_is_found_from_a_carried_folder_and_from_any_other() {
        let from_scene = join(Path::new("builtin:scenes"), Path::new("../models/muscle_bench.urdf"));
        assert_eq!(from_scene, Path::new("builtin:models/muscle_bench.urdf"));
        let from_elsewhere = join(Path::new("/somewhere"), Path::new("builtin:models/muscle_bench.urdf"));
        assert_eq!(from_elsewhere, from_scene);
        assert!(read_text(&from_scene).expect("carried").contains("<robot"));
        let message = read_text(Path::new("builtin:models/none.urdf")).expect_err("not carried").to_string();
        assert!(message.contains("models/muscle_bench.urdf"), "{message}");
    }

    #[test]
    fn other_paths_stay_as_they_are() {
        let path = join(Path::new("a/../b"), Path::new("../c.urdf"));
        assert_eq!(path, Path::new("a/../b/../c.urdf"));
    }
}
