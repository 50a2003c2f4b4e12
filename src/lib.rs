//! Hydraulic soft microtubule artificial muscles (SMAMs) in rigid-body scenes.
//!
//! The chain is `plunger -> syringe -> line -> muscle -> cable -> mechanism`. Everything left of the
//! mechanism is written here; the mechanism is a rapier multibody. See `ARCHITECTURE.md` for the map.

pub mod bag;
pub mod columns;
pub mod conceal;
pub mod diagnose;
pub mod effects;
pub mod feedforward;
pub mod hydraulics;
pub mod hysteresis;
pub mod identify;
pub mod mechanism;
pub mod muscle;
pub mod proof;
pub mod recording;
pub mod report;
pub mod reproduce;
pub mod scalar;
pub mod scene;
pub mod stock;
pub mod sweep;
pub mod system;
pub mod trial;
#[cfg(feature = "viz")]
pub mod view;
