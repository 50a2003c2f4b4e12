//! Reading a recording from a ROS 2 bag.

use std::io::{Read, Seek};
use std::path::Path;

use super::one_clock::{Sampled, on_one_clock};
use super::source::open_file;
use super::{Channel, ChannelSpec, LoadedRun, Recording, RecordingError, Role, Unit, parse_column};
use crate::bag::{self, Clock, FLOAT64, Pick, Series, Topic};

/// Absolute by definition, where the pressures of scenes are gauge pressures.
const FLUID_PRESSURE: &str = "sensor_msgs/msg/FluidPressure";

/// Reads the file of a bag, as [`read_bag_from`].
pub(super) fn read_bag(path: &Path, declared: &[ChannelSpec]) -> Result<LoadedRun, RecordingError> {
    let source = open_file(path)?;
    read_bag_from(source, path, declared)
}

/// The first of some channels that a bag has samples of.
pub(super) fn found_in_bag(path: &Path, channels: &[ChannelSpec]) -> Result<Option<String>, RecordingError> {
    let bag = bag::read(open_file(path)?, &|topic| picks(topic, channels))
        .map_err(|problem| RecordingError::Format { file: path.to_owned(), problem })?;
    let found = bag.series.into_iter().find(|series| series.values.iter().any(|v| v.is_finite()));
    Ok(found.map(|series| series.column))
}

/// Reads the declared channels of a bag from anywhere; `path` stands for the file in errors. With none declared, every
/// Float64 topic whose name ends as a column's (`/smam/force_n`) is one.
///
/// # Errors
/// What [`bag::read`] says; a declared channel that the bag does not have; units that do not go together.
pub fn read_bag_from(
    source: impl Read + Seek,
    path: &Path,
    declared: &[ChannelSpec],
) -> Result<LoadedRun, RecordingError> {
    let refuse = |problem: String| RecordingError::Format { file: path.to_owned(), problem };
    let bag = bag::read(source, &|topic| picks(topic, declared)).map_err(refuse)?;
    let sampled = match declared.is_empty() {
        true => undeclared(&bag),
        false => declared.iter().map(|spec| one(spec, &bag)).collect(),
    };
    let sampled: Vec<Sampled> = sampled.map_err(refuse)?;
    let mut notes = gauge_notes(declared, &bag);
    let (time_s, values, note) = on_one_clock(&sampled);
    notes.extend(note);
    let channels = sampled.into_iter().zip(values).map(|(s, values)| Channel::new(s.column, values)).collect();
    let recording = Recording::new(time_s, channels).map_err(|e| refuse(e.to_string()))?;
    Ok(LoadedRun { recording, notes })
}

/// What to take of a topic.
fn picks(topic: &Topic, declared: &[ChannelSpec]) -> Vec<Pick> {
    let plain =
        |column: &str| Pick { column: column.to_owned(), field: "data".to_owned(), joint: None, clock: Clock::Stamp };
    let by_name = column_of(topic);
    if declared.is_empty() {
        return by_name.into_iter().map(plain).collect();
    }
    let wanted = declared.iter().filter_map(|spec| match &spec.bag {
        None => by_name.filter(|name| *name == spec.column).map(plain),
        Some(source) => (source.topic == topic.name).then(|| Pick {
            column: spec.column.clone(),
            field: source.field.clone(),
            joint: source.joint.clone(),
            clock: source.clock,
        }),
    });
    wanted.collect()
}

/// The column that a Float64 topic is called after: the last part of its name, if that ends in a unit.
fn column_of(topic: &Topic) -> Option<&str> {
    let last = topic.name.rsplit('/').next().unwrap_or("");
    (topic.message_type == FLOAT64 && parse_column(last).is_ok()).then_some(last)
}

fn undeclared(bag: &bag::Bag) -> Result<Vec<Sampled>, String> {
    if bag.series.is_empty() {
        return Err(format!(
            "no topic of {FLOAT64} is called as a column is, like /smam/force_n; say in a recordings.toml which topics \
             are the channels (topics: {})",
            names(bag)
        ));
    }
    bag.series.iter().map(|series| sampled(series, true, |v| v)).collect()
}

/// A declared channel in its own unit.
fn one(spec: &ChannelSpec, bag: &bag::Bag) -> Result<Sampled, String> {
    let Some(series) = bag.series.iter().find(|s| s.column == spec.column) else {
        let wanted = match &spec.bag {
            Some(source) => format!("no topic {}", source.topic),
            None => format!("no topic of {FLOAT64} ends in /{}", spec.column),
        };
        let remedy = format!("fix the topic of the [[channel]] \"{}\" in recordings.toml", spec.column);
        return Err(format!("{wanted} (topics: {}); {remedy}", names(bag)));
    };
    let column = parse_column(&spec.column).map_err(|e| e.to_string())?.unit;
    let from = bag_unit(spec, series, column)?;
    let zero = spec.bag.as_ref().and_then(|source| source.zero).unwrap_or(0.0);
    sampled(series, spec.role == Role::Output, |value| match from.suffix == column.suffix {
        // No detour, so that the number stays the bag's to the last bit.
        true => value - zero,
        false => column.from_si(from.to_si(value - zero)),
    })
}

/// The unit of a bag's numbers: as stated, else as the topic is called, else SI.
fn bag_unit(spec: &ChannelSpec, series: &Series, column: Unit) -> Result<Unit, String> {
    if let Some(unit) = spec.bag.as_ref().and_then(|source| source.unit) {
        return Ok(unit);
    }
    let named = column_of(&series.topic).map(parse_column).transpose().map_err(|e| e.to_string())?;
    match named {
        Some(name) if name.unit.si_suffix == column.si_suffix => Ok(name.unit),
        Some(name) => Err(format!(
            "topic {}: its name ends in {}, which cannot become the {} of the column \"{}\"; if its numbers are of another \
             unit, say so in the [[channel]]: unit = \"{}\"",
            series.topic.name, name.unit.symbol, column.symbol, spec.column, column.si_suffix
        )),
        None => {
            Ok(Unit { suffix: column.si_suffix, symbol: column.si_suffix, si_suffix: column.si_suffix, factor: 1.0 })
        }
    }
}

fn sampled(series: &Series, is_output: bool, convert: impl Fn(f64) -> f64) -> Result<Sampled, String> {
    if series.time_s.is_empty() {
        return Err(format!(
            "topic {}: no message has the field and the joint of the column \"{}\"; fix its [[channel]]",
            series.topic.name, series.column
        ));
    }
    Ok(Sampled {
        column: series.column.clone(),
        topic: series.topic.name.clone(),
        is_output,
        time_s: series.time_s.clone(),
        // Drivers write infinity for «out of range»: no sample either.
        values: series.values.iter().map(|v| if v.is_finite() { convert(*v) } else { f64::NAN }).collect(),
    })
}

fn names(bag: &bag::Bag) -> String {
    let topics = bag.topics.iter().map(|t| format!("{} ({})", t.name, t.message_type));
    topics.collect::<Vec<_>>().join(", ")
}

fn gauge_notes(declared: &[ChannelSpec], bag: &bag::Bag) -> Vec<String> {
    let without_zero = declared.iter().filter(|spec| spec.bag.as_ref().is_some_and(|source| source.zero.is_none()));
    let series = without_zero.filter_map(|spec| bag.series.iter().find(|s| s.column == spec.column));
    series
        .filter(|s| s.topic.message_type == FLUID_PRESSURE)
        .map(|s| {
            format!(
                "column \"{}\": FluidPressure is an absolute pressure by definition, the scene's is a gauge pressure; add \
                 zero = 101325 to the [[channel]] (zero = 0 if your driver publishes gauge pressure)",
                s.column
            )
        })
        .collect()
}
