//! Why a sweep cannot be planned, run or written.

use std::path::PathBuf;

use crate::recording::RecordingError;
use crate::scene::SceneError;
use crate::system::SystemError;

#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    System(#[from] SystemError),
    #[error(transparent)]
    Recording(#[from] RecordingError),
    #[error("{file}: cannot be read: {source}\n  remedy: give the path of a sweep file; docs/sweeps.md shows one")]
    Read { file: PathBuf, source: std::io::Error },
    #[error("{file}: {message}\n  remedy: docs/sweeps.md shows every key of a sweep")]
    Syntax { file: PathBuf, message: String },
    #[error(
        "{file}: this is a scene, not a sweep of one\n  remedy: vary its keys: smam sweep {file} --vary KEY=FROM:TO:COUNT --measure FIGURES"
    )]
    IsScene { file: PathBuf },
    #[error("[[vary]] {key}: {message}\n  remedy: {remedy}")]
    Vary { key: String, message: String, remedy: String },
    #[error("[[measure]] {measure}: {message}\n  remedy: {remedy}")]
    Measure { measure: String, message: String, remedy: String },
    #[error("[[{table}]] {measure}: {message}\n  remedy: {remedy}")]
    Goal { table: String, measure: String, message: String, remedy: String },
    #[error("[sampling] {message}\n  remedy: {remedy}")]
    Sampling { message: String, remedy: String },
    #[error("{file}: {message}\n  remedy: {remedy}")]
    Journal { file: PathBuf, message: String, remedy: String },
    #[error("{file}: {message}\n  remedy: {remedy}")]
    Table { file: PathBuf, message: String, remedy: String },
    #[error("{file}: cannot be written: {source}\n  remedy: give another folder with --out")]
    Write { file: PathBuf, source: std::io::Error },
}
