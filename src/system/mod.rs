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
mod coordinates;
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
mod joint_kinds;
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

pub use energy::EnergyBalance;
pub use error::SystemError;
pub use events::{Concern, Warnings};
pub use expect::{Verdict, judge};
pub use inputs::InputSource;
pub use laws::LawFault;
pub use run::{Driver, RunError, record, record_driven, record_watched, run};
pub use schedule::Schedule;
pub use simulation::Simulation;

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    coordinates::{ContactSpring, CoordinateStop, Coordinates},
    elastic::{Elastic, ElasticPoint},
    events::ConcernsS,
    extras::{AngleWall, CableFriction, ConstantLoad, Coupling, JointFriction, MechanismExtras, MuscleExtras},
    halving::{StepError, step_errors, with_half_steps},
    influence::{Influence, Influenced, influence},
    laws::PlantLaws,
    measured_pose::measured_poses,
    plant::{CablePlant, Drive, InputSpan, MuscleForces, MusclePlant, Plant},
    posed::Posed,
    rom::{Block, Change, Linear, MuscleNumber, Rom, RomParameter, RomRun, RomSetting, Signals, StepPlan},
    rosenbrock::Stepper,
    standalone::{AxisNumber, ChamberNumber, StandaloneNumber, StripNumber},
    state::PlantState,
};
