//! A scene as a system in time: wiring, stepping order, energy book, channels.
//!
//! [`Simulation`] is the full scene with its rigid-body engine; [`Plant`] the equations it integrates.

mod axis;
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
mod influence;
mod inputs;
mod install;
mod ldl;
mod lift;
mod measured_pose;
pub mod observe;
mod plant;
mod rates;
mod rosenbrock;
mod run;
mod simulation;
mod state;
mod switching;
mod tangents;
mod twin;

pub use axis::AxisNumber;
pub use elastic::{Elastic, ElasticPoint};
pub use energy::EnergyBook;
pub use error::SystemError;
pub use events::Warnings;
pub use expect::{Verdict, judge};
pub use extras::{AngleWall, CableFriction, ConstantLoad, Coupling, JointFriction, MechanismExtras, MuscleExtras};
pub use influence::{Influence, Influenced, influence};
pub use inputs::InputSource;
pub use measured_pose::measured_poses;
pub use plant::{
    CablePlant, ContactSpring, CoordinateStop, Coordinates, Drive, InputSpan, MuscleForces, MusclePlant, Plant,
};
pub use rosenbrock::Stepper;
pub use run::{Driver, RunError, Schedule, record, record_driven, run};
pub use simulation::Simulation;
pub use state::PlantState;
pub use twin::{StepPlan, Twin, TwinParameter, TwinRun, TwinSetting};
