//! Scene files: TOML to a validated [`Scene`].
//!
//! Raw text becomes a [`SceneFile`] (unknown keys refused, every key with its unit), `--set` and the known conditions
//! of a run change it by key, [`Scene::from_file`] checks the numbers and the names. Errors name file, table, key,
//! value and remedy.

mod check;
mod check_effects;
mod check_muscles;
mod error;
mod file;
mod load;
mod overrides;
mod program;
mod schema;

pub use error::SceneError;
pub use file::*;
pub use load::{STOCK_SCENES, Scene, find_scene};
pub use overrides::{Override, calibration_key};
pub use program::Program;
pub use schema::scene_schema;
