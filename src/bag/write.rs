//! A bag from numbers: one topic of `std_msgs/msg/Float64` for each column, and the joints as one of
//! `sensor_msgs/msg/JointState`.

use std::collections::BTreeMap;
use std::io::{Cursor, Write};

use mcap::records::{MessageHeader, op};
use mcap::{MAGIC, McapError, WriteOptions};

use super::cdr::CdrWriter;

/// Message type of a column's topic.
pub const FLOAT64: &str = "std_msgs/msg/Float64";

const JOINT_STATE: &str = "sensor_msgs/msg/JointState";
const FLOAT64_TEXT: &str = "float64 data\n";
const JOINT_STATE_TEXT: &str = "\
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
";

/// Where the joints were.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointPositions {
    /// Names of the joints.
    pub names: Vec<String>,
    /// At each instant one position per joint, rad (m for sliders).
    pub positions: Vec<Vec<f64>>,
}

/// The bytes of an MCAP file: each column on the topic `/smam/COLUMN`, and the joints, if any, on `/smam/joint_states`.
/// A clock that begins before zero is moved to begin there: bags know no negative time.
///
/// # Errors
/// What the MCAP library says.
pub fn encode(time_s: &[f64], columns: &[(&str, &[f64])], joints: &JointPositions) -> Result<Vec<u8>, String> {
    written(time_s, columns, joints).map_err(|e| e.to_string())
}

fn written(time_s: &[f64], columns: &[(&str, &[f64])], joints: &JointPositions) -> Result<Vec<u8>, McapError> {
    let options = WriteOptions::new().compression(None).profile("ros2").library("smam");
    let mut file = options.create(Cursor::new(Vec::new()))?;
    let metadata = BTreeMap::new();
    let float64 = file.add_schema(FLOAT64, "ros2msg", FLOAT64_TEXT.as_bytes())?;
    let topics = columns.iter().map(|(name, _)| file.add_channel(float64, &format!("/smam/{name}"), "cdr", &metadata));
    let topics: Vec<u16> = topics.collect::<Result<_, _>>()?;
    let joint_topic = match joints.names.is_empty() {
        true => None,
        false => {
            let schema = file.add_schema(JOINT_STATE, "ros2msg", JOINT_STATE_TEXT.as_bytes())?;
            Some(file.add_channel(schema, "/smam/joint_states", "cdr", &metadata)?)
        }
    };
    let shift_s = time_s.first().map_or(0.0, |first| first.min(0.0));
    for (index, time_s) in time_s.iter().enumerate() {
        let time_ns = ((time_s - shift_s) * 1e9).round() as u64;
        let header = |channel_id| MessageHeader {
            channel_id,
            sequence: u32::try_from(index).unwrap_or(u32::MAX),
            log_time: time_ns,
            publish_time: time_ns,
        };
        for (topic, (_, values)) in topics.iter().zip(columns) {
            file.write_to_known_channel(&header(*topic), &float64_message(values[index]))?;
        }
        if let (Some(topic), Some(positions)) = (joint_topic, joints.positions.get(index)) {
            file.write_to_known_channel(&header(topic), &joint_state_message(time_ns, &joints.names, positions))?;
        }
    }
    file.finish()?;
    let mut target = file.into_inner();
    target.flush()?;
    let mut bytes = target.into_inner();
    put_summary_in_order(&mut bytes);
    Ok(bytes)
}

/// Schemas and channels of the summary by their numbers. The library writes them in the order of a hash map, another in
/// every run; the same recording shall be the same bytes.
fn put_summary_in_order(bytes: &mut [u8]) {
    // Footer: opcode, length, start of the summary, start of its offsets, checksum; then the mark of eight bytes.
    let Some(footer) = bytes.len().checked_sub(MAGIC.len() + 20) else { return };
    let number = |at: usize| bytes.get(at..at + 8)?.try_into().ok().map(u64::from_le_bytes).map(|v| v as usize);
    let (Some(start), Some(end)) = (number(footer), number(footer + 8)) else { return };
    let Some(summary) = bytes.get(start..end) else { return };
    let mut records: Vec<&[u8]> = Vec::new();
    let mut rest = summary;
    while let Some(length) = rest.get(1..9).and_then(|l| l.try_into().ok()).map(u64::from_le_bytes) {
        let Some((record, after)) = rest.split_at_checked(9 + length as usize) else { return };
        records.push(record);
        rest = after;
    }
    for group in records.chunk_by_mut(|a, b| a[0] == b[0]).filter(|g| matches!(g[0][0], op::SCHEMA | op::CHANNEL)) {
        // The number is the first field of both.
        group.sort_by_key(|record| [record[10], record[9]]);
    }
    let ordered = records.concat();
    bytes[start..end].copy_from_slice(&ordered);
    let checksum = crc32fast::hash(&bytes[start..footer + 16]);
    bytes[footer + 16..footer + 20].copy_from_slice(&checksum.to_le_bytes());
}

fn float64_message(value: f64) -> Vec<u8> {
    let mut message = CdrWriter::new();
    message.put(value.to_le_bytes());
    message.finish()
}

fn joint_state_message(time_ns: u64, names: &[String], positions: &[f64]) -> Vec<u8> {
    let mut message = CdrWriter::new();
    let whole_s = i32::try_from(time_ns / 1_000_000_000).unwrap_or(i32::MAX);
    message.put(whole_s.to_le_bytes());
    message.put(((time_ns % 1_000_000_000) as u32).to_le_bytes());
    message.text("");
    message.length(names.len());
    names.iter().for_each(|name| message.text(name));
    message.numbers(positions);
    message.numbers(&[]);
    message.numbers(&[]);
    message.finish()
}
