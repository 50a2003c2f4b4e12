//! Bags made here, whole, cut, damaged, and with what drivers do wrong.

use std::collections::BTreeMap;
use std::io::Cursor;

use mcap::WriteOptions;
use mcap::records::{ChunkHeader, MessageHeader};

use super::cdr::{CdrWriter, MOST_PARTS};
use super::chunk::unpack;
use super::*;

const STAMPED: &str = "std_msgs/Header header\nstring[] name\nfloat64[] position\nPart[] parts\nint16 count\n===\n\
                       MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n===\n\
                       MSG: lab_msgs/Part\nuint8[2] codes\n";

/// A bag with one topic `/lab` of the type above: times (ns) and messages.
fn bag(messages: &[(u64, Vec<u8>)]) -> Vec<u8> {
    bag_of(STAMPED, messages)
}

/// The same with another type.
fn bag_of(definition: &str, messages: &[(u64, Vec<u8>)]) -> Vec<u8> {
    let mut file = WriteOptions::new().compression(None).create(Cursor::new(Vec::new())).unwrap();
    let schema = file.add_schema("lab_msgs/msg/State", "ros2msg", definition.as_bytes()).unwrap();
    let channel_id = file.add_channel(schema, "/lab", "cdr", &BTreeMap::new()).unwrap();
    for (time_ns, data) in messages {
        let header = MessageHeader { channel_id, sequence: 0, log_time: *time_ns, publish_time: *time_ns };
        file.write_to_known_channel(&header, data).unwrap();
    }
    file.finish().unwrap();
    file.into_inner().into_inner()
}

fn state(stamp_s: i32, names: &[&str], position: &[f64]) -> Vec<u8> {
    let mut message = CdrWriter::new();
    message.put(stamp_s.to_le_bytes());
    message.put(250_000_000u32.to_le_bytes());
    message.text("rig");
    message.length(names.len());
    names.iter().for_each(|n| message.text(n));
    message.numbers(position);
    message.length(2);
    [1u8, 2, 3, 4].iter().for_each(|code| message.put([*code]));
    message.put((-7i16).to_le_bytes());
    message.finish()
}

fn take(bytes: &[u8], field: &str, joint: Option<&str>, clock: Clock) -> Result<Vec<(f64, f64)>, String> {
    let pick = Pick { column: "x_m".to_owned(), field: field.to_owned(), joint: joint.map(str::to_owned), clock };
    let bag = read(Cursor::new(bytes), &|_| vec![pick.clone()])?;
    let series = bag.series.first().ok_or("no topic")?;
    Ok(series.time_s.iter().copied().zip(series.values.iter().copied()).collect())
}

#[test]
fn numbers_are_found_by_path_place_and_joint() {
    let bytes = bag(&[
        (5_000_000_000, state(5, &["a", "b"], &[1.0, 2.0])),
        (6_000_000_000, state(6, &["b"], &[4.0])),
        (7_000_000_000, state(7, &["a", "b"], &[])),
    ]);
    let found = |field, joint, clock| take(&bytes, field, joint, clock).unwrap();
    assert_eq!(found("position", Some("b"), Clock::Stamp), [(0.25, 2.0), (1.25, 4.0)]);
    assert_eq!(found("position", Some("a"), Clock::Log), [(0.0, 1.0)]);
    assert_eq!(found("position[1]", None, Clock::Log), [(0.0, 2.0)]);
    assert_eq!(found("parts[1].codes[0]", None, Clock::Log)[0], (0.0, 3.0));
    assert_eq!(found("count", None, Clock::Log).len(), 3);
    assert_eq!(found("header.stamp.sec", None, Clock::Log)[2], (2.0, 7.0));
    assert_eq!(found("position", Some("c"), Clock::Log), []);
}

#[test]
fn what_is_not_there_is_named_with_what_is() {
    let bytes = bag(&[(5_000_000_000, state(5, &["a"], &[1.0]))]);
    let refusal = |field, joint| take(&bytes, field, joint, Clock::Log).unwrap_err();
    assert_eq!(
        refusal("force", None),
        "topic /lab, message 1: it has no field `force`; its numbers are header.stamp.sec, header.stamp.nanosec, \
         position[], count"
    );
    assert!(refusal("position", None).ends_with("say which: joint = \"NAME\", or field = \"position[0]\""));
    assert!(refusal("count", Some("a")).ends_with("`count` is one number; leave `joint` out"));
    assert!(refusal("header.frame_id", None).contains("`frame_id` is no number"));
    assert!(refusal("position[x]", None).contains("write the place as in data[2]"));
    assert!(refusal("count.more", None).contains("has no field `more`"));
}

#[test]
fn clocks_that_do_not_go_together_are_refused() {
    let unset = bag(&[(1_700_000_000_000_000_000, state(0, &["a"], &[1.0]))]);
    let said = take(&unset, "count", None, Clock::Stamp).unwrap_err();
    assert!(
        said.starts_with("topic /lab, message 1: header.stamp is -1700000000 s off the time of recording"),
        "{said}"
    );
    assert!(said.contains("add time = \"log\""), "{said}");
    assert_eq!(take(&unset, "count", None, Clock::Log).unwrap(), [(0.0, -7.0)]);
    let twice = bag(&[(5_000_000_000, state(5, &["a"], &[1.0])), (5_100_000_000, state(5, &["a"], &[1.0]))]);
    let said = take(&twice, "count", None, Clock::Stamp).unwrap_err();
    assert!(said.starts_with("topic /lab, message 2: it has the time of message 1; "), "{said}");
    let out_of_order = bag(&[(6_000_000_000, state(6, &["a"], &[2.0])), (5_000_000_000, state(5, &["a"], &[1.0]))]);
    let found = take(&out_of_order, "position", Some("a"), Clock::Log).unwrap();
    assert_eq!(found, [(0.0, 1.0), (1.0, 2.0)]);
}

/// A lab's own stamp may be of numbers that hold anything.
#[test]
fn a_stamp_beyond_all_clocks_is_another_clock() {
    let definition = "Head header\nint16 count\n===\nMSG: lab_msgs/Head\nStamp stamp\n===\n\
                      MSG: lab_msgs/Stamp\nfloat64 sec\nfloat64 nanosec\n";
    for sec in [1e300, -1e300, f64::INFINITY] {
        let mut message = CdrWriter::new();
        message.put(sec.to_le_bytes());
        message.put(1e300f64.to_le_bytes());
        message.put(7i16.to_le_bytes());
        let bytes = bag_of(definition, &[(5, message.finish())]);
        let said = take(&bytes, "count", None, Clock::Stamp).unwrap_err();
        assert!(said.contains("s off the time of recording"), "{sec}: {said}");
    }
}

/// A text of no letters has four bytes in the message, and many times that once it is read.
#[test]
fn a_message_of_too_many_parts_is_refused() {
    let texts = |count: usize| {
        let mut message = CdrWriter::new();
        message.length(count);
        (0..count).for_each(|_| message.length(0));
        message.put(7i16.to_le_bytes());
        let bytes = bag_of("string[] notes\nint16 count\n", &[(5, message.finish())]);
        take(&bytes, "count", None, Clock::Log)
    };
    assert_eq!(texts(1000).unwrap(), [(0.0, 7.0)]);
    let said = texts(MOST_PARTS + 1).unwrap_err();
    assert!(said.starts_with("topic /lab, message 1: it holds more than 1000000 texts and messages; record"), "{said}");
}

/// A few kilobytes of zstd unpack to a gigabyte of zeros.
#[test]
fn a_chunk_that_would_fill_the_memory_is_refused() {
    let mut header = ChunkHeader {
        message_start_time: 0,
        message_end_time: 0,
        uncompressed_size: (1 << 28) + 1,
        uncompressed_crc: 0,
        compression: "zstd".to_owned(),
        compressed_size: 0,
    };
    let said = unpack(&header, &[]).unwrap_err();
    assert!(said.starts_with("a chunk of 268435457 bytes is more than the 268435456 that are read; record"), "{said}");
    header.uncompressed_size = 0;
    assert!(unpack(&header, &[]).unwrap().is_empty());
}

#[test]
fn a_message_that_ends_early_is_named() {
    let whole = state(5, &["a"], &[1.0]);
    for length in 0..whole.len() {
        let bytes = bag(&[(5, state(0, &["a"], &[1.0])), (6, whole[..length].to_vec())]);
        let said = take(&bytes, "count", None, Clock::Log).unwrap_err();
        assert!(said.starts_with("topic /lab, message 2: it ends "), "{length}: {said}");
    }
}

/// Every number and the joint "tip", each named after its topic.
fn read_all(bytes: &[u8]) -> Result<Bag, String> {
    let pick = |topic: &Topic| {
        let (field, joint) = match topic.message_type.as_str() {
            FLOAT64 => ("data", None),
            "sensor_msgs/msg/JointState" => ("position", Some("tip".to_owned())),
            _ => return vec![],
        };
        vec![Pick { column: topic.name.clone(), field: field.to_owned(), joint, clock: Clock::Stamp }]
    };
    read(Cursor::new(bytes), &pick)
}

fn small() -> Vec<u8> {
    let mut bag = BagWriter::new(Cursor::new(Vec::new()), &["force_n", "tip_rad"], &["tip".to_owned()]).unwrap();
    bag.instant(-1.0, &[1.0, 3.0], &[0.25]).unwrap();
    bag.instant(-0.5, &[2.0, f64::NAN], &[0.5]).unwrap();
    bag.finish().unwrap().into_inner()
}

#[test]
fn what_is_written_is_read_back_and_is_the_same_every_time() {
    let bytes = small();
    // The library's summary would be in another order each time.
    assert!((0..8).all(|_| bytes == small()));
    let bag = read_all(&bytes).unwrap();
    let names: Vec<(&str, &str)> = bag.topics.iter().map(|t| (t.name.as_str(), t.message_type.as_str())).collect();
    let joint_states = ("/smam/joint_states", "sensor_msgs/msg/JointState");
    assert_eq!(names, [("/smam/force_n", FLOAT64), joint_states, ("/smam/tip_rad", FLOAT64)]);
    let values = |name: &str| bag.series.iter().find(|s| s.column == name).unwrap();
    assert_eq!((&values("/smam/force_n").time_s, &values("/smam/force_n").values), (&vec![0.0, 0.5], &vec![1.0, 2.0]));
    assert_eq!(values("/smam/joint_states").values, [0.25, 0.5]);
    assert!(values("/smam/tip_rad").values[1].is_nan());
}

#[test]
fn every_prefix_of_a_bag_is_refused() {
    let bytes = small();
    for length in 0..bytes.len() {
        let said = read_all(&bytes[..length]).unwrap_err();
        let expected = if length < 8 { "is no MCAP file" } else { "the file ends before its end mark" };
        assert!(said.starts_with(expected), "{length}: {said}");
    }
}

/// Whatever a byte becomes, the answer is an error or numbers: never a panic, never memory that the file does not fill.
#[test]
fn a_damaged_byte_is_no_panic() {
    let fixtures = ["ros2_lz4.mcap", "ros2_zstd.mcap"].map(|name| {
        let path = format!("{}/tests/recordings/{name}", env!("CARGO_MANIFEST_DIR"));
        std::fs::read(path).expect("a fixture")
    });
    let [lz4, zstd] = fixtures;
    for (bytes, stride) in [(small(), 1), (lz4, 41), (zstd, 41)] {
        assert!(read_all(&bytes).is_ok());
        let mut refused = 0;
        for at in (0..bytes.len()).step_by(stride) {
            for mask in [0x01, 0x80, 0xff] {
                let mut damaged = bytes.clone();
                damaged[at] ^= mask;
                refused += usize::from(read_all(&damaged).is_err());
            }
        }
        assert!(refused > 0);
    }
}

#[test]
fn other_encodings_are_refused_only_where_they_are_wanted() {
    let mut file = WriteOptions::new().compression(None).create(Cursor::new(Vec::new())).unwrap();
    let schema = file.add_schema("Point", "jsonschema", b"{}").unwrap();
    file.add_channel(schema, "/web", "json", &BTreeMap::new()).unwrap();
    file.finish().unwrap();
    let bytes = file.into_inner().into_inner();
    assert_eq!(read(Cursor::new(&bytes), &|_| vec![]).unwrap().topics[0].name, "/web");
    let said = take(&bytes, "data", None, Clock::Log).unwrap_err();
    assert!(
        said.starts_with("topic /web: its messages are \"json\" described by \"jsonschema\"; only \"cdr\""),
        "{said}"
    );
}
