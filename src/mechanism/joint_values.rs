//! The scene's values for one joint, each in the unit that fits the joint's kind.

use super::coordinate::{CoordinateKind, Stop};
use super::error::MechanismError;
use super::joints::JointModel;
use super::spec::{JointSpec, StopSpec};

/// The two spellings of one value: key and value for revolute joints, then for prismatic ones.
type Pair = [(&'static str, Option<f64>); 2];

/// Writes what the spec gives into the joint.
pub(super) fn apply(spec: &JointSpec, joint: &mut JointModel) -> Result<(), MechanismError> {
    if !joint.moves {
        let remedy = "leave it out, or make it revolute or prismatic in the URDF";
        return Err(error(&joint.name, "the URDF makes this joint fixed".into(), remedy));
    }
    let pick = |pair| pick(&joint.name, joint.kind, pair);
    let stiffness = pick(stiffness_pair(spec.stiffness_n_m_rad, spec.stiffness_n_m))?;
    let damping = pick(damping_pair(spec.damping_n_m_s_rad, spec.damping_n_s_m))?;
    let rest = pick([("rest_rad", spec.rest_rad), ("rest_m", spec.rest_m)])?;
    let initial = pick([("initial_rad", spec.initial_rad), ("initial_m", spec.initial_m)])?;
    let locked = pick([("locked_rad", spec.locked_rad), ("locked_m", spec.locked_m)])?;
    let stop = |stop: &Option<StopSpec>| stop.as_ref().map(|s| resolve_stop(&joint.name, joint.kind, s)).transpose();
    let (lower_stop, upper_stop) = (stop(&spec.lower_stop)?, stop(&spec.upper_stop)?);
    if initial.is_some() && locked.is_some() {
        let problem = "has both an initial and a locked position".into();
        return Err(error(&joint.name, problem, "keep one"));
    }
    joint.stiffness = not_negative(&joint.name, "stiffness", stiffness.unwrap_or(0.0))?;
    joint.damping = not_negative(&joint.name, "damping", damping.unwrap_or(joint.damping))?;
    joint.rest = rest.unwrap_or(0.0);
    joint.position = locked.or(initial).unwrap_or(0.0);
    joint.position_given = locked.or(initial).is_some();
    joint.moves = locked.is_none();
    joint.lower_stop = lower_stop;
    joint.upper_stop = upper_stop;
    check_room(joint)
}

/// Stops must leave room between them, and a joint that moves begins there: where not, a sign or a unit is wrong.
fn check_room(joint: &JointModel) -> Result<(), MechanismError> {
    let lower = joint.lower_stop.map_or(f64::NEG_INFINITY, |s| s.position);
    let upper = joint.upper_stop.map_or(f64::INFINITY, |s| s.position);
    if lower >= upper {
        let problem = format!("its lower stop at {lower} is not below its upper stop at {upper}");
        return Err(error(&joint.name, problem, "exchange them; angles are in rad, lengths in m"));
    }
    let is_given = joint.position_given && joint.moves;
    if is_given && !(lower..=upper).contains(&joint.position) {
        let problem = format!("begins at {}, outside its stops ({lower} to {upper})", joint.position);
        return Err(error(&joint.name, problem, "begin between them; angles are in rad, lengths in m"));
    }
    Ok(())
}

fn resolve_stop(name: &str, kind: CoordinateKind, stop: &StopSpec) -> Result<Stop, MechanismError> {
    let pick = |pair| pick(name, kind, pair);
    let position = pick([("position_rad", stop.position_rad), ("position_m", stop.position_m)])?;
    let stiffness = pick(stiffness_pair(stop.stiffness_n_m_rad, stop.stiffness_n_m))?;
    let damping = pick(damping_pair(stop.damping_n_m_s_rad, stop.damping_n_s_m))?;
    let (Some(position), Some(stiffness)) = (position, stiffness) else {
        let problem = "a stop lacks its position or stiffness".into();
        return Err(error(name, problem, "give both"));
    };
    Ok(Stop {
        position,
        stiffness: not_negative(name, "a stop's stiffness", stiffness)?,
        damping: not_negative(name, "a stop's damping", damping.unwrap_or(0.0))?,
    })
}

fn stiffness_pair(angle: Option<f64>, length: Option<f64>) -> Pair {
    [("stiffness_n_m_rad", angle), ("stiffness_n_m", length)]
}

fn damping_pair(angle: Option<f64>, length: Option<f64>) -> Pair {
    [("damping_n_m_s_rad", angle), ("damping_n_s_m", length)]
}

fn pick(name: &str, kind: CoordinateKind, pair: Pair) -> Result<Option<f64>, MechanismError> {
    let [angle, length] = pair;
    let (right, wrong, joint_kind) = match kind {
        CoordinateKind::Angle => (angle, length, "revolute"),
        CoordinateKind::Length => (length, angle, "prismatic"),
    };
    if wrong.1.is_some() {
        let problem = format!("{} does not fit a {joint_kind} joint", wrong.0);
        return Err(error(name, problem, &format!("use {}", right.0)));
    }
    match right.1 {
        Some(v) if !v.is_finite() => Err(error(name, format!("{} = {v} is not finite", right.0), "give a number")),
        value => Ok(value),
    }
}

fn not_negative(name: &str, what: &str, value: f64) -> Result<f64, MechanismError> {
    if value >= 0.0 {
        return Ok(value);
    }
    Err(error(name, format!("{what} = {value} must be >= 0"), "give a number that is not negative, in SI units"))
}

fn error(name: &str, problem: String, remedy: &str) -> MechanismError {
    MechanismError::spec("joint", name, problem, remedy)
}
