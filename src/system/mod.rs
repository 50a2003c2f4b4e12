//! A scene as a system in time: wiring, stepping order, energy balance, channels.
//!
//! [`Simulation`] is the full scene with its rigid-body engine; [`Plant`] the equations it integrates.
//!
//! The first second of the bench, and where the fluid went:
//!
//! ```
//! use smam::scene::Scene;
//! use smam::system::{Schedule, Simulation, record};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let recording = record(&mut Simulation::new(Scene::load("muscle_bench", &[])?)?, &Schedule::even(1.0, 0.01))?;
//! let at_end = |column: &str| recording.piecewise_si(column).map(|line| line.value(1.0));
//! let area_m2 = |bore_m: f64| std::f64::consts::PI * bore_m * bore_m / 4.0;
//! // No fluid is lost: what the plunger displaced is in the muscle and in what yields at either end of the line.
//! let displaced_m3 = area_m2(4.5e-3) * at_end("plunger_mm")?;
//! let held_m3 = area_m2(1.05e-3) * at_end("elongation_mm")? + (8.0e-15 + 2.6e-15) * at_end("pressure_kpa")?;
//! assert!((held_m3 / displaced_m3 - 1.0).abs() < 0.01);
//! # Ok(())
//! # }
//! ```

mod arc;
mod build;
mod channels;
mod contact;
mod effect_energy;
mod elastic;
mod energy;
mod error;
mod events;
mod expect;
mod extras;
mod graph;
mod halving;
mod influence;
mod inputs;
mod install;
mod laws;
mod ldl;
mod lift;
mod measured_pose;
pub mod observe;
mod plant;
mod posed;
mod rates;
mod rom;
mod rosenbrock;
mod run;
mod schedule;
mod simulation;
mod standalone;
mod state;
mod switching;
mod tangents;

#[doc(hidden)]
pub use elastic::{Elastic, ElasticPoint};
pub use energy::EnergyBalance;
pub use error::SystemError;
#[doc(hidden)]
pub use events::ConcernsS;
pub use events::{Concern, Warnings};
pub use expect::{Verdict, judge};
#[doc(hidden)]
pub use extras::{AngleWall, CableFriction, ConstantLoad, Coupling, JointFriction, MechanismExtras, MuscleExtras};
#[doc(hidden)]
pub use halving::{StepError, step_errors, with_half_steps};
#[doc(hidden)]
pub use influence::{Influence, Influenced, influence};
pub use inputs::InputSource;
pub use laws::LawFault;
#[doc(hidden)]
pub use laws::PlantLaws;
#[doc(hidden)]
pub use measured_pose::measured_poses;
#[doc(hidden)]
pub use plant::{
    CablePlant, ContactSpring, CoordinateStop, Coordinates, Drive, InputSpan, MuscleForces, MusclePlant, Plant,
};
#[doc(hidden)]
pub use posed::Posed;
#[doc(hidden)]
pub use rom::{Block, Change, Linear, MuscleNumber, Rom, RomParameter, RomRun, RomSetting, Signals, StepPlan};
#[doc(hidden)]
pub use rosenbrock::Stepper;
pub use run::{Driver, RunError, record, record_driven, record_watched, run};
pub use schedule::Schedule;
pub use simulation::Simulation;
#[doc(hidden)]
pub use standalone::{AxisNumber, ChamberNumber, StandaloneNumber, StripNumber};
#[doc(hidden)]
pub use state::PlantState;
