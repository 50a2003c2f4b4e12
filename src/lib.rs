//! Hydraulic soft microtubule artificial muscles (SMAMs) in rigid-body scenes.
//!
//! The chain is `plunger -> syringe -> line -> muscle -> cable -> mechanism`. Everything left of the
//! mechanism is written here; the mechanism is a rapier multibody. See `ARCHITECTURE.md` for the map.
//!
//! These pages show what others build on: [`scene`]s, their simulation ([`system`]) and [`laws`], [`recording`]s, fits
//! ([`identify`]), [`diagnose`] and [`sweep`]. What is public and not shown belongs to the program `smam`, and may change with any release.
//!
//! A stock scene with one key changed, and its first second:
//!
//! ```
//! use smam::scene::{Override, Scene};
//! use smam::system::{Schedule, Simulation, record};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::load("muscle_bench", &[Override::number("hydraulics.line.length_m", 2.0)])?;
//! let recording = record(&mut Simulation::new(scene)?, &Schedule::even(1.0, 0.01))?;
//! let plunger_mm = recording.value_at("plunger_mm", 1.0)?;
//! let elongation_mm = recording.value_at("elongation_mm", 1.0)?;
//! // A syringe and a line that did not yield would give the ratio of the areas, 18.4 mm for each mm of the plunger.
//! let stiff_mm = plunger_mm * (4.5_f64 / 1.05).powi(2);
//! assert!(elongation_mm > 0.4 * stiff_mm && elongation_mm < stiff_mm);
//! # Ok(())
//! # }
//! ```

#[doc(hidden)]
pub mod bag;
#[cfg(feature = "validation")]
pub mod bench;
#[doc(hidden)]
pub mod columns;
#[cfg(feature = "validation")]
pub mod conceal;
pub mod diagnose;
pub mod effects;
pub mod feedforward;
#[doc(hidden)]
pub mod files;
pub mod hydraulics;
pub mod hysteresis;
pub mod identify;
pub mod laws;
pub mod mechanism;
pub mod muscle;
#[doc(hidden)]
pub mod nearest;
mod parallel;
#[cfg(feature = "validation")]
pub mod proof;
pub mod recording;
#[doc(hidden)]
pub mod report;
#[cfg(feature = "validation")]
pub mod reproduce;
pub mod scalar;
pub mod scene;
#[doc(hidden)]
pub mod stock;
pub mod sweep;
pub mod system;
#[cfg(feature = "validation")]
pub mod trial;
#[cfg(feature = "viz")]
pub mod view;
