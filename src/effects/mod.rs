//! Physics that a scene may leave out: the catalogue, and each law in a file of its own.
//!
//! A scene switches an effect on with one table,
//! `[[effect]] name = "trapped_air" element = "line" free_volume_m3 = 1e-9`; a diagnosis answers with the same names.
//! Laws are pure and generic over [`crate::scalar::Scalar`]; `system` puts them into the equations. An effect of zero
//! size gives the same bytes as one that is absent.
//!
//! ```
//! use smam::effects::EffectTable;
//! use smam::scene::Scene;
//! use smam::system::Simulation;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let elongation_m = |effects: Vec<EffectTable>| -> Result<f64, Box<dyn std::error::Error>> {
//!     let mut scene = Scene::load("muscle_bench", &[])?;
//!     scene.file.effect = effects;
//!     let mut simulation = Simulation::new(Scene::from_file(scene.file, &scene.path)?)?;
//!     simulation.advance_to(1.0)?;
//!     Ok(simulation.joint_position("slide").ok_or("the carriage slides")?)
//! };
//! let leak = |g: f64| -> Result<EffectTable, toml::de::Error> {
//!     toml::from_str(&format!("name = 'leak'\nelement = 'line'\nconductance_m3_s_pa = {g:e}"))
//! };
//! // At zero to the bit as without; else the muscle lacks what is lost.
//! assert_eq!(elongation_m(vec![leak(0.0)?])?, elongation_m(Vec::new())?);
//! assert!(elongation_m(vec![leak(1e-14)?])? < elongation_m(Vec::new())?);
//! # Ok(())
//! # }
//! ```

mod backlash;
mod contact;
mod element;
mod entry;
mod line;
mod mullins;
mod native;
mod plastic;
mod preload;
mod registry;
mod sensor;
mod smooth;
mod spectrum;
mod table;
mod tendon;
mod viscoelasticity;
mod written;

pub use entry::{Entry, ParameterSpec, Range};
pub use registry::{catalogue, find, names};
pub use table::{Effect, EffectError, EffectTable};

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    backlash::Backlash,
    contact::Wall,
    element::{Element, ElementKind},
    entry::{Levels, Need, Part, Trying},
    line::TrappedAir,
    mullins::Mullins,
    native::Native,
    plastic::PlasticSet,
    preload::CoilPreload,
    registry::EntryId,
    sensor::{Sensor, SensorHistory},
    spectrum::logarithmic_creep,
    tendon::TendonFriction,
    viscoelasticity::MaxwellBranch,
    written::{Fitted, WrittenLaw},
};
