//! What can be wrong with a hysteresis model's numbers.

use thiserror::Error;

/// A parameter set outside its law's range.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum HysteresisError {
    #[error("{model}: {quantity} = {value} must be {rule}")]
    Parameter { model: &'static str, quantity: &'static str, value: f64, rule: &'static str },
    #[error("{model}: {given} parameters given, it has {expected}")]
    Count { model: &'static str, given: usize, expected: usize },
}

/// Refuses a quantity that is not finite.
pub(super) fn finite(model: &'static str, quantity: &'static str, value: f64) -> Result<(), HysteresisError> {
    held(value.is_finite(), model, quantity, value, "finite")
}

/// Refuses a quantity that is not finite and above zero.
pub(super) fn positive(model: &'static str, quantity: &'static str, value: f64) -> Result<(), HysteresisError> {
    held(value.is_finite() && value > 0.0, model, quantity, value, "> 0")
}

/// Refuses a quantity that is not finite or below zero.
pub(super) fn not_negative(model: &'static str, quantity: &'static str, value: f64) -> Result<(), HysteresisError> {
    held(value.is_finite() && value >= 0.0, model, quantity, value, ">= 0")
}

/// Refuses the first value whose sign is not that of those before it.
pub(super) fn all_of_one_sign(
    model: &'static str,
    quantity: &'static str,
    values: impl Iterator<Item = f64>,
) -> Result<(), HysteresisError> {
    let mut sign = 0.0;
    for value in values {
        held(value.is_finite() && value * sign >= 0.0, model, quantity, value, "of one sign with the others")?;
        sign = if value == 0.0 { sign } else { value.signum() };
    }
    Ok(())
}

fn held(
    holds: bool,
    model: &'static str,
    quantity: &'static str,
    value: f64,
    rule: &'static str,
) -> Result<(), HysteresisError> {
    if holds { Ok(()) } else { Err(HysteresisError::Parameter { model, quantity, value, rule }) }
}
