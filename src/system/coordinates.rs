//! The mechanism as equations see it over one step: inertia, springs, one-sided stops and what it touches.

use crate::scalar::Scalar;

use super::plant::dot;

/// The mechanism as the plant sees it over one step: `M y'' + D y' + K (y - rest) = ...`.
#[derive(Clone, Debug)]
pub struct Coordinates<D> {
    /// Inertia matrix, row by row, kg or kg m²; symmetric, positive definite.
    pub inertia: Vec<D>,
    /// Viscous damping of each coordinate, N s/m or N m s/rad.
    pub damping: Vec<D>,
    /// Spring of each coordinate, N/m or N m/rad, and where it rests.
    pub stiffness: Vec<D>,
    pub rest: Vec<f64>,
    /// Constant generalised force over the step: weights, loads, contact reactions.
    pub force: Vec<D>,
    pub stops: Vec<CoordinateStop>,
    /// What the mechanism touched at the end of the last engine step.
    pub contact: Option<ContactSpring>,
}

/// A contact as the plant foresees it over one engine step: a stiff spring where it was touched last.
///
/// The engine owns contacts; without this the plant would, for one step, drive a gripping jaw through what it holds
/// and take its tension away. Reaction `n max(0, f + k (offset - n . y) - c n . y')`, `f` that of the last step.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSpring {
    /// Direction of the reaction in the coordinates, of unit length.
    pub direction: Vec<f64>,
    pub preload: f64,
    pub offset: f64,
    pub stiffness: f64,
    pub damping: f64,
}

impl ContactSpring {
    /// Push along the direction, never negative.
    pub(super) fn push<D: Scalar>(&self, y: &[D], w: &[D]) -> D {
        let depth = -dot::<_, 0>(&self.direction, y) + self.offset;
        let push = depth * self.stiffness - dot::<_, 0>(&self.direction, w) * self.damping + self.preload;
        let zero = D::constant(0.0);
        push.select_above(zero, push, zero)
    }
}

/// A one-sided spring on a coordinate: a closed jaw, a closed notch, a coil on its turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoordinateStop {
    pub coordinate: usize,
    pub position: f64,
    /// +1: acts below `position`; -1: acts above it.
    pub side: f64,
    pub stiffness: f64,
    pub damping: f64,
}

impl CoordinateStop {
    /// Depth into the stop, and the force it answers with along the coordinate.
    pub(super) fn force<D: Scalar>(&self, y: D, w: D) -> (D, D) {
        let depth = (-y + self.position) * self.side;
        if !depth.is_above(0.0) {
            return (depth, D::constant(0.0));
        }
        let push = depth * self.stiffness - w * (self.side * self.damping);
        if push.is_above(0.0) { (depth, push * self.side) } else { (depth, D::constant(0.0)) }
    }
}
