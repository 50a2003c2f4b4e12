//! What follows the pose in the reduced-order model: levers of cables on via points, and weights.
//!
//! Over one fine step levers and weights stand still, as they do over one engine step in the full scene; at its end they are taken anew, and
//! cables go on from the stretch that they have. What a number of a derivative, or of a lane, changes of a lever is put in as a force, so
//! that sensitivities go through.

use std::sync::Arc;

use crate::mechanism::{LinkPoint, Linkage};
use crate::scalar::Scalar;

use super::plant::{InputSpan, Plant};
use super::state::PlantState;

/// How a mechanism's coordinates hang on a plant's: each is a share of one.
#[derive(Clone, Debug)]
pub(super) struct Posture {
    pub linkage: Linkage,
    /// Of each coordinate of the mechanism: the plant's, and the share of it.
    pub shares: Vec<(usize, f64)>,
    /// How many of the plant's coordinates are joints.
    pub joints: usize,
    /// Cables on via points.
    pub via: Vec<(usize, Vec<LinkPoint>)>,
    /// Forces on the joints that do not depend on the pose.
    pub loads: Vec<f64>,
}

impl Posture {
    /// Coordinates of the mechanism.
    pub fn positions<D: Scalar>(&self, y: &[D]) -> Vec<D> {
        self.shares.iter().map(|&(at, share)| y[at] * share).collect()
    }

    /// Forces along the mechanism's coordinates as forces along the plant's.
    fn gathered<D: Scalar>(&self, forces: &[D]) -> Vec<D> {
        let mut sum = vec![D::constant(0.0); self.joints];
        for (force, &(at, share)) in forces.iter().zip(&self.shares) {
            sum[at] += *force * share;
        }
        sum
    }
}

/// The same with what each cable's stretch is counted from.
#[derive(Clone, Debug)]
pub struct Posed<D> {
    posture: Arc<Posture>,
    /// Of each cable on via points: its stretch less its length, m.
    slack_m: Vec<D>,
}

impl Posed<f64> {
    pub(super) fn new(posture: Arc<Posture>) -> Self {
        Self { slack_m: vec![0.0; posture.via.len()], posture }
    }

    /// The same over another number type; [`begin`] comes after.
    pub(super) fn lift<D: Scalar>(&self) -> Posed<D> {
        Posed { posture: self.posture.clone(), slack_m: self.slack_m.iter().map(|x| D::constant(*x)).collect() }
    }
}

/// Levers less their plain values, by joint, and the positions from which they count.
#[derive(Clone, Debug)]
pub struct Lean<D> {
    pub levers: Vec<D>,
    pub from: Vec<D>,
}

impl<D: Scalar> Lean<D> {
    /// What they add to stretch and stretching rate.
    pub(super) fn stretch_and_rate(&self, y: &[D], w: &[D]) -> (D, D) {
        let each = self.levers.iter().zip(&self.from).zip(y.iter().zip(w));
        let zero = D::constant(0.0);
        each.fold((zero, zero), |(s, r), ((lever, from), (y, w))| (s + *lever * (*y - *from), r + *lever * *w))
    }
}

/// At a plant's start, where cables have the stretch that they begin with.
pub(super) fn begin<D: Scalar>(plant: &mut Plant<D>, state: &PlantState<D>) {
    let Some(mut posed) = plant.posed.take() else { return };
    let posture = posed.posture.clone();
    let here = posture.positions(state.y());
    let placement = posture.linkage.at(&here);
    let mut slope = vec![D::constant(0.0); posture.shares.len()];
    for ((cable, points), slack) in posture.via.iter().zip(&mut posed.slack_m) {
        let own = &plant.cables[*cable];
        let stretch = own.stretch_0_m + along(&own.jacobian, state.y(), posture.joints);
        *slack = stretch - placement.path_length(points, &mut slope);
    }
    plant.posed = Some(posed);
}

/// Takes levers and weights anew where the state is; whether there are any.
pub(super) fn renew<D: Scalar>(plant: &mut Plant<D>, state: &PlantState<D>, inputs: &[InputSpan]) -> bool {
    let Some(posed) = plant.posed.take() else { return false };
    let posture = &posed.posture;
    let here = posture.positions(state.y());
    let placement = posture.linkage.at(&here);
    let mut full = vec![D::constant(0.0); posture.shares.len()];
    placement.weight(&mut full);
    let mut forces = posture.gathered(&full);
    for ((cable, points), slack) in posture.via.iter().zip(&posed.slack_m) {
        let length = placement.path_length(points, &mut full);
        let levers = posture.gathered(&full);
        let own = &mut plant.cables[*cable];
        own.jacobian.iter_mut().zip(&levers).for_each(|(plain, lever)| *plain = lever.value());
        own.stretch_0_m = *slack + length - along(&own.jacobian, state.y(), posture.joints);
        let lean: Vec<D> = levers.iter().map(|lever| *lever - lever.value()).collect();
        let is_lean = D::DERIVATIVES > 0 || lean.iter().any(|lever| *lever != D::constant(0.0));
        own.lean = None;
        let (_, _, tension) = plant.cable(*cable, state, inputs, 0.0);
        if is_lean {
            forces.iter_mut().zip(&lean).for_each(|(force, lever)| *force -= *lever * tension);
            let from = state.y()[..posture.joints].to_vec();
            plant.cables[*cable].lean = Some(Box::new(Lean { levers: lean, from }));
        }
    }
    for ((force, own), load) in plant.coordinates.force.iter_mut().zip(forces).zip(&posture.loads) {
        *force = own + *load;
    }
    plant.posed = Some(posed);
    true
}

/// `sum j y` over the joints.
fn along<D: Scalar>(jacobian: &[f64], y: &[D], joints: usize) -> D {
    jacobian.iter().zip(y).take(joints).map(|(j, y)| *y * *j).sum()
}
