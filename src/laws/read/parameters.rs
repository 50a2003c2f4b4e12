//! The numbers of a law: `parameter.NAME` with its value, range and unit.

use super::{LawError, refuse};
use crate::laws::Dimension;
use crate::laws::law::Parameter;
use crate::laws::table::ParameterTable;

/// A parameter as its table says; its unit as its name ends, where none is said.
pub(super) fn parameter(name: &str, table: &ParameterTable) -> Result<Parameter, LawError> {
    let at = |message: String, remedy: &str| refuse(format!("parameter.{name}: {message}"), remedy);
    let dimension = match &table.unit {
        Some(unit) => Dimension::parse(unit).map_err(|e| at(format!("unit: {e}"), "use SI units"))?,
        None => match Dimension::with_prefix(name) {
            Some((ending, own)) => {
                let message = format!("a number's name ends in its SI unit, and _{ending} is none");
                return Err(at(message, &format!("name it {own}, with its value in that unit, or say unit = \"1\"")));
            }
            None => Dimension::of_name(name).unwrap_or(Dimension::NONE),
        },
    };
    let (min, max) = (table.min.unwrap_or(f64::NEG_INFINITY), table.max.unwrap_or(f64::INFINITY));
    if !table.value.is_finite() {
        return Err(at(format!("value = {} must be finite", table.value), "give a number in SI units"));
    }
    if min.is_nan() || max.is_nan() || min >= max {
        return Err(at(format!("min = {min} must be < max = {max}"), "give the smaller number as min"));
    }
    if table.value < min || table.value > max {
        return Err(at(
            format!("value = {} is outside {min} to {max}", table.value),
            "move the value, or widen the range",
        ));
    }
    Ok(Parameter { name: name.to_owned(), value: table.value, min, max, dimension })
}
