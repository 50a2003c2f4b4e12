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

/// Refuses a quantity that is not finite and above zero.
pub(super) fn positive(model: &'static str, quantity: &'static str, value: f64) -> Result<(), HysteresisError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(HysteresisError::Parameter { model, quantity, value, rule: "> 0" })
}
