//! Rigid mechanisms: a URDF becomes a rapier multibody behind independent joint coordinates.
//!
//! This folder is the only user of rapier and of the URDF reader, and none of their types leaves it.
//! Muscles, cables, springs and stops are integrated elsewhere on the coordinates; the engine is
//! told where that integration arrived ([`Mechanism::advance`]) and answers with contact reactions.

mod advance;
mod assembly;
mod contacts;
mod convert;
mod coordinate;
mod error;
mod forceps;
mod free_bodies;
pub mod geometry;
mod inertia;
mod joint_values;
mod joints;
mod kinematics;
mod linkage;
mod mesh;
mod model;
mod notch;
mod notch_mesh;
mod notched_tube;
mod place;
mod reduce;
mod remarks;
mod route;
mod shapes;
mod spec;
mod stl;
mod tree;
mod urdf_file;
mod urdf_text;
mod world;
mod xml_scan;

pub use error::MechanismError;
pub use geometry::Pose;
pub(crate) use geometry::PoseComponent;
pub use spec::{
    BodyMotion, BodyShapeSpec, ContactSpec, FreeBodySpec, JointSpec, LeverSpec, LinkMassSpec, MechanismSpec, PointSpec,
    RouteSpec, StopSpec,
};

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    coordinate::{Coordinate, CoordinateKind, Stop},
    forceps::Forceps,
    geometry::{Contact, Shape, Visual},
    linkage::{Linkage, Placement},
    model::{Mechanism, Moved},
    notch::NotchGeometry,
    notched_tube::{NotchedTube, notched_tube_meshes, notched_tube_urdf},
    route::{Arm, LinkPoint, Route},
};
