//! What can be wrong with a muscle's numbers.

use thiserror::Error;

/// A muscle parameter outside its law's range.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MuscleError {
    /// One parameter alone is out of range.
    #[error("{name} = {value} must be {rule}")]
    Parameter { name: &'static str, value: f64, rule: &'static str },
    /// The bore is as wide as the wall's outer radius, or wider.
    #[error("inner_radius_m = {inner_m} must be smaller than outer_radius_m = {outer_m}")]
    NoWall { inner_m: f64, outer_m: f64 },
    /// The friction state would not settle between two limits of opposite sign.
    #[error("friction: |rho| = {rho} must be smaller than a = {a}, or the force does not follow the motion")]
    OneSidedFriction { rho: f64, a: f64 },
}

/// Refuses a number that is not finite and above zero.
pub(super) fn positive(name: &'static str, value: f64) -> Result<(), MuscleError> {
    above(name, value, 0.0, "> 0")
}

/// Refuses a number that is not finite and at least zero.
pub(super) fn not_negative(name: &'static str, value: f64) -> Result<(), MuscleError> {
    if value == 0.0 {
        return Ok(());
    }
    above(name, value, 0.0, ">= 0")
}

fn above(name: &'static str, value: f64, floor: f64, rule: &'static str) -> Result<(), MuscleError> {
    if value.is_finite() && value > floor {
        return Ok(());
    }
    Err(MuscleError::Parameter { name, value, rule })
}
