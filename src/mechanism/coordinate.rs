//! Independent joint coordinates and what acts on them.

use serde::{Deserialize, Serialize};

/// What a coordinate measures: its positions are rad or m.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum CoordinateKind {
    /// rad; forces are N m.
    Angle,
    /// m; forces are N.
    Length,
}

/// A one-sided spring and damper: engaged only beyond `position`, and never pulling.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// rad or m.
    pub position: f64,
    /// N m/rad or N/m.
    pub stiffness: f64,
    /// N m s/rad or N s/m.
    pub damping: f64,
}

/// One independent joint coordinate q, named after its joint.
///
/// Joints that mimic it (qᵢ = mᵢ q + oᵢ) are summed in: k = Σ mᵢ² kᵢ, and so the damping, the stops and the mass matrix.
/// Spring force: −stiffness (q − rest); damping force: −damping q̇. Units: SI, by [`Self::kind`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Coordinate {
    pub name: String,
    pub kind: CoordinateKind,
    /// N m/rad or N/m.
    pub stiffness: f64,
    /// N m s/rad or N s/m.
    pub damping: f64,
    /// Position of the relaxed spring, rad or m.
    pub rest: f64,
    /// rad or m.
    pub initial: f64,
    /// Pushes up below its position.
    pub lower_stop: Option<Stop>,
    /// Pushes down above its position.
    pub upper_stop: Option<Stop>,
}
