//! What can be wrong with a scene.

use std::path::PathBuf;

use crate::mechanism::MechanismError;
use crate::muscle::MuscleError;

/// A scene that cannot be used: place, cause and remedy.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    #[error("{}: cannot be read: {source}\n  remedy: give the path of a scene file, or one of the names that `smam scenes` lists", file.display())]
    Unreadable { file: PathBuf, source: std::io::Error },
    #[error(
        "no scene named \"{name}\"{nearest}; known are {known}\n  remedy: use one of these names, or the path of a scene file"
    )]
    UnknownName { name: String, nearest: String, known: String },
    #[error("{}: {message}\n  remedy: correct this line; `smam check` tells whether the file is right", file.display())]
    Syntax { file: PathBuf, message: String },
    #[error("{}: {table}: {message}\n  remedy: {remedy}", file.display())]
    Value { file: PathBuf, table: String, message: String, remedy: String },
    #[error("--set {key}: {message}\n  remedy: {remedy}")]
    Override { key: String, message: String, remedy: String },
    #[error("--law '{text}': {message}\n  remedy: {remedy}")]
    Law { text: String, message: String, remedy: String },
    #[error("{}: {source}", file.display())]
    Mechanism { file: PathBuf, source: MechanismError },
    #[error("{}: [muscles]: {source}\n  remedy: give a number in that range, in SI units", file.display())]
    Muscle { file: PathBuf, source: MuscleError },
}
