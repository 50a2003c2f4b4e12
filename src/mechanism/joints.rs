//! Every URDF joint with the scene's values: what moves, how, and from where.

use std::path::Path;

use urdf_rs::{Joint, JointType, Robot};

use super::coordinate::{CoordinateKind, Stop};
use super::error::{MechanismError, known_names};
use super::joint_values::apply;
use super::remarks::Remarks;
use super::spec::JointSpec;

/// q = multiplier · q_leader + offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mimic {
    pub leader: usize,
    pub multiplier: f64,
    pub offset: f64,
}

/// A joint ready for assembly. Units by `kind`, as in [`super::Coordinate`].
#[derive(Clone, Debug)]
pub(super) struct JointModel {
    pub name: String,
    pub kind: CoordinateKind,
    /// False for fixed and locked joints.
    pub moves: bool,
    /// Unit vector in the joint's frame.
    pub axis: [f64; 3],
    /// Initial or locked position.
    pub position: f64,
    /// Whether the scene gave `position`.
    pub position_given: bool,
    pub stiffness: f64,
    pub damping: f64,
    pub rest: f64,
    pub lower_stop: Option<Stop>,
    pub upper_stop: Option<Stop>,
    /// The URDF's limits, which nothing enforces.
    pub limits: Option<[f64; 2]>,
    pub mimic: Option<Mimic>,
}

impl JointModel {
    /// Whether a position is beyond a limit of the URDF, by more than a thousandth of their distance, and no stop of the scene is there.
    pub fn is_beyond_limits(&self, position: f64) -> bool {
        self.limits.is_some_and(|[lower, upper]| {
            let tolerance = 1e-3 * (upper - lower);
            let below = self.lower_stop.is_none() && position < lower - tolerance;
            below || (self.upper_stop.is_none() && position > upper + tolerance)
        })
    }
}

/// Time goes with the cube of their number: with so many, a step takes seconds.
const MOST_MOVING: usize = 1000;

/// All joints in the URDF's order.
pub(super) fn resolve(
    file: &Path,
    robot: &Robot,
    specs: &[JointSpec],
    remarks: &mut Remarks,
) -> Result<Vec<JointModel>, MechanismError> {
    let mut joints = robot.joints.iter().map(|joint| from_urdf(file, joint, remarks)).collect::<Result<Vec<_>, _>>()?;
    let mut mentioned = vec![false; joints.len()];
    for spec in specs {
        for name in &spec.joints {
            let index = find(&joints, name)?;
            if std::mem::replace(&mut mentioned[index], true) {
                let remedy = "give each joint once";
                return Err(MechanismError::spec("joint", name, "appears twice", remedy));
            }
            apply(spec, &mut joints[index])?;
        }
    }
    attach_mimics(file, robot, &mut joints)?;
    let moving = joints.iter().filter(|j| j.moves).count();
    if moving > MOST_MOVING {
        let problem = format!("has {moving} joints that move, which is more than {MOST_MOVING}");
        let remedy = "make those that matter little `type=\"fixed\"`, or simulate a part of it";
        return Err(MechanismError::urdf(file, "robot", &robot.name, problem, remedy));
    }
    Ok(joints)
}

fn find(joints: &[JointModel], name: &str) -> Result<usize, MechanismError> {
    joints.iter().position(|j| j.name == name).ok_or_else(|| {
        let remedy = known_names(joints.iter().map(|j| j.name.as_str()));
        MechanismError::spec("joint", name, "the URDF has no such joint", remedy)
    })
}

fn from_urdf(file: &Path, joint: &Joint, remarks: &mut Remarks) -> Result<JointModel, MechanismError> {
    let (kind, moves) = kind_of(file, joint)?;
    check_numbers(file, joint)?;
    let dynamics = joint.dynamics.clone().unwrap_or_default();
    if dynamics.friction != 0.0 {
        let about = format!("joint \"{}\"", joint.name);
        remarks.add("<dynamics friction> is not read; use the effect bearing_friction", about);
    }
    Ok(JointModel {
        name: joint.name.clone(),
        kind,
        moves,
        axis: if moves { unit_axis(file, joint)? } else { [1.0, 0.0, 0.0] },
        position: 0.0,
        position_given: false,
        stiffness: 0.0,
        damping: if moves { dynamics.damping } else { 0.0 },
        rest: 0.0,
        lower_stop: None,
        upper_stop: None,
        limits: limits(joint),
        mimic: None,
    })
}

/// Limits of a joint that has some; equal ones, as drawing programs write them, are none.
fn limits(joint: &Joint) -> Option<[f64; 2]> {
    let has_limits = matches!(joint.joint_type, JointType::Revolute | JointType::Prismatic);
    let [lower, upper] = [joint.limit.lower, joint.limit.upper];
    (has_limits && lower < upper && (upper - lower).is_finite()).then_some([lower, upper])
}

/// What its position measures, and whether it moves.
fn kind_of(file: &Path, joint: &Joint) -> Result<(CoordinateKind, bool), MechanismError> {
    Ok(match joint.joint_type {
        JointType::Revolute | JointType::Continuous => (CoordinateKind::Angle, true),
        JointType::Prismatic => (CoordinateKind::Length, true),
        JointType::Fixed => (CoordinateKind::Angle, false),
        JointType::Floating | JointType::Planar | JointType::Spherical => {
            let problem = format!("type {:?} is not simulated", joint.joint_type);
            let remedy = "build it from revolute and prismatic joints";
            return Err(MechanismError::urdf(file, "joint", &joint.name, problem, remedy));
        }
    })
}

const FINITE: &str = "give finite numbers, in m and rad, and a damping of 0 or more";

fn check_numbers(file: &Path, joint: &Joint) -> Result<(), MechanismError> {
    let error = |problem: String| MechanismError::urdf(file, "joint", &joint.name, problem, FINITE);
    let origin = [joint.origin.xyz.0, joint.origin.rpy.0].concat();
    if !origin.iter().all(|v| v.is_finite()) {
        return Err(error(format!("origin = {origin:?} is not finite")));
    }
    let damping = joint.dynamics.as_ref().map_or(0.0, |d| d.damping);
    if !damping.is_finite() || damping < 0.0 {
        return Err(error(format!("damping = {damping} must be >= 0")));
    }
    Ok(())
}

fn unit_axis(file: &Path, joint: &Joint) -> Result<[f64; 3], MechanismError> {
    let xyz = joint.axis.xyz.0;
    let norm = xyz.iter().map(|v| v * v).sum::<f64>().sqrt();
    if norm.is_finite() && norm > 1e-9 {
        return Ok(xyz.map(|v| v / norm));
    }
    let problem = format!("axis = {xyz:?} has no direction");
    let remedy = "give a vector such as \"0 0 1\"";
    Err(MechanismError::urdf(file, "joint", &joint.name, problem, remedy))
}

/// Makes every follower point at its final leader, and takes over that one's position.
fn attach_mimics(file: &Path, robot: &Robot, joints: &mut [JointModel]) -> Result<(), MechanismError> {
    for index in 0..joints.len() {
        if robot.joints[index].mimic.is_none() || robot.joints[index].joint_type == JointType::Fixed {
            continue;
        }
        let mimic = final_leader(file, robot, index)?;
        let leader = joints[mimic.leader].clone();
        follow(&leader, mimic, &mut joints[index])?;
    }
    Ok(())
}

fn final_leader(file: &Path, robot: &Robot, follower: usize) -> Result<Mimic, MechanismError> {
    let name = &robot.joints[follower].name;
    let error = |problem: String, remedy: &str| MechanismError::urdf(file, "joint", name, problem, remedy);
    let mut whole = Mimic { leader: follower, multiplier: 1.0, offset: 0.0 };
    for _ in 0..=robot.joints.len() {
        let Some(mimic) = &robot.joints[whole.leader].mimic else {
            return Ok(whole);
        };
        let multiplier = mimic.multiplier.unwrap_or(1.0);
        let offset = mimic.offset.unwrap_or(0.0);
        if !multiplier.is_finite() || multiplier == 0.0 || !offset.is_finite() {
            let problem = format!("mimic multiplier = {multiplier}, offset = {offset}");
            return Err(error(problem, "give finite values, the multiplier not zero"));
        }
        let leader = robot.joints.iter().position(|j| j.name == mimic.joint);
        let Some(leader) = leader else {
            let problem = format!("mimics joint \"{}\", which does not exist", mimic.joint);
            return Err(error(problem, "name an existing joint"));
        };
        whole = Mimic {
            leader,
            offset: whole.multiplier * offset + whole.offset,
            multiplier: whole.multiplier * multiplier,
        };
        // Followers of followers: numbers that are finite each can multiply to none.
        if !whole.multiplier.is_finite() || whole.multiplier == 0.0 || !whole.offset.is_finite() {
            let problem = format!("follows others with multiplier = {}, offset = {}", whole.multiplier, whole.offset);
            return Err(error(problem, "give multipliers near 1"));
        }
    }
    Err(error("mimics itself through others".into(), "cut the circle"))
}

fn follow(leader: &JointModel, mimic: Mimic, follower: &mut JointModel) -> Result<(), MechanismError> {
    let error = |problem: String, remedy: String| Err(MechanismError::spec("joint", &follower.name, problem, remedy));
    let position = mimic.multiplier * leader.position + mimic.offset;
    let off = (follower.position - position).abs() > 1e-9 * (1.0 + position.abs());
    if follower.position_given && off {
        let problem = format!("stands at {}, but follows \"{}\"", follower.position, leader.name);
        return error(problem, format!("leave its position out or make it {position}"));
    }
    if !follower.moves && leader.moves {
        let problem = format!("is locked, but follows the free joint \"{}\"", leader.name);
        return error(problem, format!("lock \"{}\" instead", leader.name));
    }
    follower.position = position;
    follower.moves = leader.moves;
    follower.mimic = leader.moves.then_some(mimic);
    Ok(())
}
