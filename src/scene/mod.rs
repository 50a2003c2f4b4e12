//! Scene files: TOML to a validated [`Scene`].
//!
//! Raw text becomes a [`SceneFile`] (unknown keys refused, every key with its unit), `--set` and the known conditions
//! of a run change it by key, [`Scene::from_file`] checks the numbers and the names. Errors name file, table, key,
//! value and remedy.
//!
//! ```
//! use smam::scene::{Override, Scene};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::load("muscle_bench", &[Override::parse("muscles.friction.m0_n=0.2")?])?;
//! let friction = scene.file.muscles.as_ref().and_then(|m| m.friction.as_ref()).ok_or("the bench has friction")?;
//! assert_eq!(friction.m0_n, 0.2);
//! // Every key that may be set, with its value.
//! assert!(scene.keys().contains(&("simulation.step_s".to_owned(), "0.01".to_owned())));
//! # Ok(())
//! # }
//! ```

mod check;
mod check_effects;
mod check_keys;
mod check_laws;
mod check_muscles;
mod check_names;
mod check_standalone;
mod differs;
mod error;
mod file;
mod file_channels;
mod file_muscles;
mod file_standalone;
mod from_table;
mod load;
mod overrides;
mod program;
mod schema;

pub(crate) use differs::{muscles_set_by, set_the_same};
pub use error::SceneError;
pub use file::*;
pub use file_channels::*;
pub use file_muscles::*;
pub use file_standalone::*;
pub use load::{Scene, find_scene};
pub use overrides::{Override, calibration_key};
pub use program::Program;
pub use schema::scene_schema;

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use check_laws::{Candidate, on_channel};
