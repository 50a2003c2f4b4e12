//! A bag from numbers: one topic of `std_msgs/msg/Float64` for each column, and the joints as one of
//! `sensor_msgs/msg/JointState`.

use std::collections::BTreeMap;
use std::io::{self, BufWriter, IntoInnerError, Read, Seek, SeekFrom, Write};

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

/// Writes a bag instant by instant: each column on the topic `/smam/COLUMN`, and the joints, if any, on
/// `/smam/joint_states`. Memory does not grow with the instants. A clock that begins before zero is moved to begin there:
/// bags know no negative time.
///
/// ```
/// use std::io::Cursor;
///
/// use smam::bag::BagWriter;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut bag = BagWriter::new(Cursor::new(Vec::new()), &["force_n"], &["tip".to_owned()])?;
/// bag.instant(0.0, &[0.05], &[0.0])?;
/// bag.instant(0.01, &[0.06], &[0.1])?;
/// let bytes = bag.finish()?.into_inner();
/// assert!(bytes.ends_with(b"MCAP0\r\n"));
/// # Ok(())
/// # }
/// ```
pub struct BagWriter<W: Write + Seek> {
    file: mcap::Writer<BufWriter<W>>,
    topics: Vec<u16>,
    joint_topic: Option<u16>,
    joint_names: Vec<String>,
    instants: u32,
    shift_s: f64,
}

impl<W: Read + Write + Seek> BagWriter<W> {
    /// Begins a bag with these columns and joints.
    ///
    /// # Errors
    /// What the target says.
    pub fn new(target: W, columns: &[&str], joint_names: &[String]) -> io::Result<Self> {
        Self::begin(target, columns, joint_names).map_err(io_error)
    }

    fn begin(target: W, columns: &[&str], joint_names: &[String]) -> Result<Self, McapError> {
        let options = WriteOptions::new().compression(None).profile("ros2").library("smam");
        let mut file = options.create(BufWriter::new(target))?;
        let metadata = BTreeMap::new();
        let float64 = file.add_schema(FLOAT64, "ros2msg", FLOAT64_TEXT.as_bytes())?;
        let topics = columns.iter().map(|name| file.add_channel(float64, &format!("/smam/{name}"), "cdr", &metadata));
        let topics: Vec<u16> = topics.collect::<Result<_, _>>()?;
        let joint_topic = match joint_names.is_empty() {
            true => None,
            false => {
                let schema = file.add_schema(JOINT_STATE, "ros2msg", JOINT_STATE_TEXT.as_bytes())?;
                Some(file.add_channel(schema, "/smam/joint_states", "cdr", &metadata)?)
            }
        };
        Ok(Self { file, topics, joint_topic, joint_names: joint_names.to_vec(), instants: 0, shift_s: 0.0 })
    }

    /// One value for each column, and one position for each joint, rad (m for sliders).
    ///
    /// # Errors
    /// What the target says.
    pub fn instant(&mut self, time_s: f64, values: &[f64], positions: &[f64]) -> io::Result<()> {
        self.put(time_s, values, positions).map_err(io_error)
    }

    fn put(&mut self, time_s: f64, values: &[f64], positions: &[f64]) -> Result<(), McapError> {
        if self.instants == 0 {
            self.shift_s = time_s.min(0.0);
        }
        let time_ns = ((time_s - self.shift_s) * 1e9).round() as u64;
        let sequence = self.instants;
        let header = |channel_id| MessageHeader { channel_id, sequence, log_time: time_ns, publish_time: time_ns };
        for (topic, value) in self.topics.iter().zip(values) {
            self.file.write_to_known_channel(&header(*topic), &float64_message(*value))?;
        }
        if let Some(topic) = self.joint_topic {
            let message = joint_state_message(time_ns, &self.joint_names, positions);
            self.file.write_to_known_channel(&header(topic), &message)?;
        }
        self.instants = self.instants.saturating_add(1);
        Ok(())
    }

    /// Ends the bag and gives the target back.
    ///
    /// # Errors
    /// What the target says.
    pub fn finish(mut self) -> io::Result<W> {
        self.file.finish().map_err(io_error)?;
        let mut target = self.file.into_inner().into_inner().map_err(IntoInnerError::into_error)?;
        put_summary_in_order(&mut target)?;
        target.flush()?;
        Ok(target)
    }
}

/// A full disk stays one.
fn io_error(error: McapError) -> io::Error {
    match error {
        McapError::Io(source) => source,
        other => io::Error::other(other),
    }
}

/// Opcode, length, start of the summary, start of its offsets, checksum.
const FOOTER_BYTES: usize = 29;

/// Schemas and channels of the summary by their numbers. The library writes them in the order of a hash map, another in
/// every run; the same recording shall be the same bytes.
fn put_summary_in_order<W: Read + Write + Seek>(file: &mut W) -> io::Result<()> {
    let end = file.seek(SeekFrom::End(-((FOOTER_BYTES + MAGIC.len()) as i64)))?;
    let mut footer = [0; FOOTER_BYTES];
    file.read_exact(&mut footer)?;
    let number = |at: usize| footer[at..].first_chunk().copied().map_or(0, u64::from_le_bytes);
    let (start, offsets) = (number(9), number(17));
    if start == 0 || start > offsets || offsets > end {
        return Ok(());
    }
    file.seek(SeekFrom::Start(start))?;
    let mut summary = vec![0; (end - start) as usize];
    file.read_exact(&mut summary)?;
    let ordered = in_order(&summary[..(offsets - start) as usize]);
    summary[..ordered.len()].copy_from_slice(&ordered);
    let mut checksum = crc32fast::Hasher::new();
    checksum.update(&summary);
    checksum.update(&footer[..FOOTER_BYTES - 4]);
    file.seek(SeekFrom::Start(start))?;
    file.write_all(&summary)?;
    file.write_all(&footer[..FOOTER_BYTES - 4])?;
    file.write_all(&checksum.finalize().to_le_bytes())
}

/// Records of a summary, schemas and channels sorted.
fn in_order(summary: &[u8]) -> Vec<u8> {
    let mut records: Vec<&[u8]> = Vec::new();
    let mut rest = summary;
    while let Some(length) = rest.get(1..).and_then(<[u8]>::first_chunk).copied().map(u64::from_le_bytes) {
        let Some((record, after)) = rest.split_at_checked(9 + length as usize) else { return summary.to_vec() };
        records.push(record);
        rest = after;
    }
    for group in records.chunk_by_mut(|a, b| a[0] == b[0]).filter(|g| matches!(g[0][0], op::SCHEMA | op::CHANNEL)) {
        // The number is the first field of both.
        group.sort_by_key(|record| [record[10], record[9]]);
    }
    records.concat()
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
