//! Series of numbers from the topics of a bag.

use std::collections::BTreeMap;
use std::io::{Read, Seek};

use mcap::records::{Channel, MessageHeader, Record};

use super::definition::Definition;
use super::records::for_each;
use super::value::decode;

/// A stamp this far from the time of recording is from another clock, ns: one hour.
const OTHER_CLOCK_NS: i128 = 3_600_000_000_000;

/// Which time a sample has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// `header.stamp` of messages that have one, else when the message was recorded.
    Stamp,
    /// When the message was recorded.
    Log,
}

/// A topic of the bag.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topic {
    /// `/syringe/position`
    pub name: String,
    /// `std_msgs/msg/Float64`
    pub message_type: String,
}

/// What to take from a topic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pick {
    /// Name of the series.
    pub column: String,
    /// Path of the number in the message: `wrench.force.z`.
    pub field: String,
    /// Which element of a list: the one of this name in the list `name` beside it.
    pub joint: Option<String>,
    pub clock: Clock,
}

/// The numbers of one column.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    pub column: String,
    pub topic: Topic,
    /// Since the first message of the bag, s; increasing.
    pub time_s: Vec<f64>,
    /// Not finite: none.
    pub values: Vec<f64>,
}

/// What was asked of a bag.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Bag {
    pub series: Vec<Series>,
    /// Every topic of the bag, by name.
    pub topics: Vec<Topic>,
}

/// Reads a bag; `pick` says what to take of a topic.
///
/// # Errors
/// No MCAP file, one cut short or damaged, a message that is not as its type says, a field that is not there. Topic and
/// number of the message are named.
pub fn read(source: impl Read + Seek, pick: &dyn Fn(&Topic) -> Vec<Pick>) -> Result<Bag, String> {
    let mut reader = Reader { pick, schemas: BTreeMap::new(), feeds: BTreeMap::new(), begin_ns: None };
    for_each(source, &mut |record| reader.see(record))?;
    reader.finish()
}

struct Schema {
    name: String,
    encoding: String,
    text: Vec<u8>,
}

/// A channel of the file and what is taken from it.
struct Feed {
    topic: Topic,
    message_count: u64,
    picks: Vec<(Pick, Vec<Sample>)>,
    /// Of the messages; `None` where nothing is taken.
    definition: Option<Definition>,
}

struct Sample {
    time_ns: i128,
    value: f64,
    /// Number of the message within its topic, from 1.
    message: u64,
}

struct Reader<'a> {
    pick: &'a dyn Fn(&Topic) -> Vec<Pick>,
    schemas: BTreeMap<u16, Schema>,
    feeds: BTreeMap<u16, Feed>,
    /// When the first message was recorded.
    begin_ns: Option<u64>,
}

impl Reader<'_> {
    fn see(&mut self, record: Record<'_>) -> Result<(), String> {
        match record {
            Record::Schema { header, data } => {
                let schema = Schema { name: header.name, encoding: header.encoding, text: data.into_owned() };
                self.schemas.insert(header.id, schema);
            }
            Record::Channel(channel) if !self.feeds.contains_key(&channel.id) => {
                let id = channel.id;
                let feed = self.feed(channel)?;
                self.feeds.insert(id, feed);
            }
            Record::Message { header, data } => self.message(&header, &data)?,
            _ => {}
        }
        Ok(())
    }

    fn feed(&self, channel: Channel) -> Result<Feed, String> {
        let schema = self.schemas.get(&channel.schema_id);
        let message_type = schema.map_or(String::new(), |s| s.name.clone());
        let topic = Topic { name: channel.topic, message_type };
        let picks = (self.pick)(&topic);
        let refuse = |problem: String| format!("topic {}: {problem}", topic.name);
        let definition = match (picks.is_empty(), schema) {
            (true, _) => None,
            (false, Some(s)) if s.encoding == "ros2msg" && channel.message_encoding == "cdr" => {
                let text = String::from_utf8_lossy(&s.text);
                let parsed = Definition::parse(&s.name, &text);
                Some(parsed.map_err(|e| refuse(format!("the definition of {}: {e}", s.name)))?)
            }
            (false, schema) => {
                let described = schema.map_or("nothing", |s| s.encoding.as_str());
                return Err(refuse(format!(
                    "its messages are \"{}\" described by \"{described}\"; only \"cdr\" described by \"ros2msg\" is read, \
                     which is what `ros2 bag record -s mcap` writes",
                    channel.message_encoding
                )));
            }
        };
        Ok(Feed { topic, message_count: 0, picks: picks.into_iter().map(|p| (p, Vec::new())).collect(), definition })
    }

    fn message(&mut self, header: &MessageHeader, data: &[u8]) -> Result<(), String> {
        self.begin_ns = Some(self.begin_ns.map_or(header.log_time, |first| first.min(header.log_time)));
        let Some(feed) = self.feeds.get_mut(&header.channel_id) else {
            return Err(format!(
                "a message of channel {}, which the file does not have; copy it again",
                header.channel_id
            ));
        };
        feed.message_count += 1;
        feed.take(header.log_time, data)
            .map_err(|problem| format!("topic {}, message {}: {problem}", feed.topic.name, feed.message_count))
    }

    fn finish(self) -> Result<Bag, String> {
        let begin_ns = i128::from(self.begin_ns.unwrap_or(0));
        let mut bag = Bag::default();
        for feed in self.feeds.into_values() {
            for (pick, samples) in feed.picks {
                if let Some(other) = bag.series.iter().find(|s| s.column == pick.column) {
                    return Err(format!(
                        "both {} and {} give the column \"{}\"; say in recordings.toml which: topic = \"{}\"",
                        other.topic.name, feed.topic.name, pick.column, feed.topic.name
                    ));
                }
                bag.series.push(series(pick, feed.topic.clone(), samples, begin_ns)?);
            }
            bag.topics.push(feed.topic);
        }
        bag.topics.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(bag)
    }
}

impl Feed {
    fn take(&mut self, log_time_ns: u64, data: &[u8]) -> Result<(), String> {
        let Some(definition) = &self.definition else { return Ok(()) };
        let message = decode(definition, data)?;
        let log_ns = i128::from(log_time_ns);
        for (pick, samples) in &mut self.picks {
            let Some(value) = message.number_at(&pick.field, pick.joint.as_deref())? else { continue };
            let time_ns = match (pick.clock, message.stamp_ns()) {
                (Clock::Stamp, Some(stamp_ns)) => one_clock(stamp_ns, log_ns)?,
                _ => log_ns,
            };
            samples.push(Sample { time_ns, value, message: self.message_count });
        }
        Ok(())
    }
}

/// The stamp, if it is of the clock that the bag was recorded by.
fn one_clock(stamp_ns: i128, log_ns: i128) -> Result<i128, String> {
    let off_ns = stamp_ns - log_ns;
    if off_ns.abs() <= OTHER_CLOCK_NS {
        return Ok(stamp_ns);
    }
    Err(format!(
        "header.stamp is {:.0} s off the time of recording: it was not set, or is of another clock; \
         add time = \"log\" to the [[channel]] to go by the time of recording",
        off_ns as f64 / 1e9
    ))
}

/// Samples in the order of their time. Recorders may write them out of order, never two at one instant.
fn series(pick: Pick, topic: Topic, mut samples: Vec<Sample>, begin_ns: i128) -> Result<Series, String> {
    samples.sort_by_key(|s| s.time_ns);
    if let Some(w) = samples.windows(2).find(|w| w[0].time_ns == w[1].time_ns) {
        return Err(format!(
            "topic {}, message {}: it has the time of message {}; give every message its own header.stamp, or add \
             time = \"log\" to the [[channel]]",
            topic.name, w[1].message, w[0].message
        ));
    }
    Ok(Series {
        column: pick.column,
        topic,
        time_s: samples.iter().map(|s| (s.time_ns - begin_ns) as f64 / 1e9).collect(),
        values: samples.iter().map(|s| s.value).collect(),
    })
}
