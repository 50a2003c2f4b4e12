//! From joints to independent coordinates: qᵢ = mᵢ q + oᵢ for a joint that mimics another.

use super::coordinate::{Coordinate, Stop};
use super::error::MechanismError;
use super::joints::JointModel;

/// How a moving joint hangs on its coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Share {
    pub coordinate: usize,
    pub multiplier: f64,
    pub offset: f64,
    /// Whether the coordinate is this joint's own position.
    pub leads: bool,
}

/// The coordinates, and each joint's share (`None` where the joint does not move).
pub(super) fn reduce(joints: &[JointModel]) -> Result<(Vec<Coordinate>, Vec<Option<Share>>), MechanismError> {
    let shares = shares(joints);
    let leaders = joints.iter().filter(|j| j.moves && j.mimic.is_none());
    let mut coordinates: Vec<Coordinate> = leaders.map(empty_coordinate).collect();
    for (joint, share) in joints.iter().zip(&shares) {
        if let Some(share) = share {
            add(joint, share, &mut coordinates[share.coordinate])?;
        }
    }
    for coordinate in &mut coordinates {
        // `rest` has gathered Σ m k (r − o) so far.
        if coordinate.stiffness > 0.0 {
            coordinate.rest /= coordinate.stiffness;
        }
    }
    Ok((coordinates, shares))
}

fn shares(joints: &[JointModel]) -> Vec<Option<Share>> {
    let mut number = vec![None; joints.len()];
    let leaders = (0..joints.len()).filter(|&i| joints[i].moves && joints[i].mimic.is_none());
    for (coordinate, joint) in leaders.enumerate() {
        number[joint] = Some(coordinate);
    }
    let share = |(index, joint): (usize, &JointModel)| {
        let (leader, multiplier, offset) = match joint.mimic {
            Some(m) => (m.leader, m.multiplier, m.offset),
            None => (index, 1.0, 0.0),
        };
        number[leader].filter(|_| joint.moves).map(|coordinate| Share {
            coordinate,
            multiplier,
            offset,
            leads: joint.mimic.is_none(),
        })
    };
    joints.iter().enumerate().map(share).collect()
}

fn empty_coordinate(leader: &JointModel) -> Coordinate {
    Coordinate {
        name: leader.name.clone(),
        kind: leader.kind,
        stiffness: 0.0,
        damping: 0.0,
        rest: 0.0,
        initial: leader.position,
        lower_stop: None,
        upper_stop: None,
    }
}

fn add(joint: &JointModel, share: &Share, coordinate: &mut Coordinate) -> Result<(), MechanismError> {
    let m = share.multiplier;
    coordinate.stiffness += m * m * joint.stiffness;
    coordinate.damping += m * m * joint.damping;
    coordinate.rest += m * joint.stiffness * (joint.rest - share.offset);
    let reduced = |stop: Stop| Stop {
        position: (stop.position - share.offset) / m,
        stiffness: m * m * stop.stiffness,
        damping: m * m * stop.damping,
    };
    let (mut lower, mut upper) = (joint.lower_stop.map(reduced), joint.upper_stop.map(reduced));
    if m < 0.0 {
        std::mem::swap(&mut lower, &mut upper);
    }
    add_stop(&joint.name, lower, &mut coordinate.lower_stop)?;
    add_stop(&joint.name, upper, &mut coordinate.upper_stop)
}

fn add_stop(joint: &str, stop: Option<Stop>, sum: &mut Option<Stop>) -> Result<(), MechanismError> {
    let (Some(stop), Some(have)) = (stop, sum.as_mut()) else {
        *sum = sum.or(stop);
        return Ok(());
    };
    if (stop.position - have.position).abs() > 1e-9 * (1.0 + have.position.abs()) {
        let problem = "its stop and its leader's are at different positions";
        let remedy = "put the stop on the leader alone";
        return Err(MechanismError::spec("joint", joint, problem, remedy));
    }
    have.stiffness += stop.stiffness;
    have.damping += stop.damping;
    Ok(())
}
