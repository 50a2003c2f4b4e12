//! Where in a bag a channel is found: the keys `topic`, `field`, `joint`, `unit`, `zero` and `time` of a `[[channel]]`.

use super::folder_keys::Keys;
use super::table::file_unit;
use super::unit::known_suffixes;
use super::{KNOWN_UNITS, RecordingError, Unit};
use crate::bag::Clock;

/// The keys of a `[[channel]]` that only bags need.
pub(super) const BAG_KEYS: [&str; 4] = ["topic", "field", "joint", "time"];

/// Where a bag has a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct BagSource {
    /// `/syringe/position`
    pub topic: String,
    /// Path of the number in the message: `data`, `wrench.force.z`.
    pub field: String,
    /// Which joint of a list.
    pub joint: Option<String>,
    /// Unit of the number in the bag, if stated.
    pub unit: Option<Unit>,
    /// Reading, in the bag's unit, that counts as zero.
    pub zero: Option<f64>,
    /// Which time a sample has.
    pub clock: Clock,
}

/// Reads the keys; `None` where there are none. `column` is the unit that the channel's name ends in.
pub(super) fn bag_source(keys: &Keys<'_>, column: Unit) -> Result<Option<BagSource>, RecordingError> {
    let Some(topic) = keys.text("topic")? else {
        let without = BAG_KEYS.iter().find(|key| keys.has(key));
        return match without {
            None => Ok(None),
            Some(key) => {
                Err(keys.error(format!(
                    "{key} is for a channel of a bag\n  remedy: add topic = \"/NAME\" too; a table has its channel by name, unit, scale and zero"
                )))
            }
        };
    };
    if !topic.starts_with('/') {
        return Err(
            keys.error(format!("topic = \"{topic}\" must begin with a slash\n  remedy: write topic = \"/{topic}\""))
        );
    }
    if keys.has("scale") {
        return Err(keys.error(
            "scale is for tables, topic for bags\n  remedy: remove scale, and publish the channel in its unit",
        ));
    }
    let clock = keys.word("time", &[("stamp", Clock::Stamp), ("log", Clock::Log)])?.unwrap_or(Clock::Stamp);
    Ok(Some(BagSource {
        topic: topic.to_owned(),
        field: keys.text("field")?.unwrap_or("data").to_owned(),
        joint: keys.text("joint")?.map(str::to_owned),
        unit: unit(keys, column)?,
        zero: keys.number("zero")?,
        clock,
    }))
}

fn unit(keys: &Keys<'_>, column: Unit) -> Result<Option<Unit>, RecordingError> {
    let Some(text) = keys.text("unit")? else { return Ok(None) };
    let suffix = text.trim_start_matches('_');
    let named = file_unit(suffix);
    let is_named = |u: &&Unit| named.is_some_and(|n| n.si_suffix == u.si_suffix && n.factor == u.factor);
    let Some(unit) = KNOWN_UNITS.iter().find(|u| u.suffix == suffix).or_else(|| KNOWN_UNITS.iter().find(is_named))
    else {
        return Err(keys.error(format!("unit = \"{text}\" is not known\n  remedy: write one of {}", known_suffixes())));
    };
    if unit.si_suffix != column.si_suffix {
        return Err(keys.error(format!(
            "unit = \"{text}\" cannot become the column's, {}\n  remedy: give the unit of the bag's numbers, or rename the column",
            column.symbol
        )));
    }
    Ok(Some(*unit))
}
