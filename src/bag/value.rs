//! A message as a tree of named values, and the number at a place in it.

use super::cdr::{Cdr, past_end};
use super::definition::{Count, Definition, Field, Kind};

/// Messages within messages; ROS 2 knows no type that contains itself.
const DEEPEST: usize = 32;

/// What a field holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value<'d> {
    Number(f64),
    Text(String),
    List(Vec<Value<'d>>),
    Numbers(Vec<f64>),
    Fields(Vec<(&'d str, Value<'d>)>),
}

/// Decodes a message.
pub(super) fn decode<'d>(definition: &'d Definition, message: &[u8]) -> Result<Value<'d>, String> {
    let mut cdr = Cdr::new(message)?;
    fields(definition, &definition.fields, &mut cdr, 0)
}

fn fields<'d>(
    definition: &'d Definition,
    fields: &'d [Field],
    cdr: &mut Cdr<'_>,
    depth: usize,
) -> Result<Value<'d>, String> {
    if depth > DEEPEST {
        return Err("its type contains itself".to_owned());
    }
    if fields.is_empty() {
        // A message of no fields is one byte on the wire.
        cdr.take::<1>()?;
    }
    let each = fields.iter().map(|f| Ok((f.name.as_str(), field(definition, f, cdr, depth)?)));
    each.collect::<Result<_, String>>().map(Value::Fields)
}

fn field<'d>(
    definition: &'d Definition,
    field: &'d Field,
    cdr: &mut Cdr<'_>,
    depth: usize,
) -> Result<Value<'d>, String> {
    let count = match field.count {
        Count::One => return one(definition, &field.kind, cdr, depth),
        Count::Fixed(count) => count,
        Count::Sequence => cdr.length()?,
    };
    // Every element has at least one byte: a count that lies costs no memory and no time.
    if count > cdr.remaining() {
        return Err(past_end());
    }
    if matches!(field.kind, Kind::Text | Kind::Message(_)) {
        let list: Result<Vec<Value<'d>>, String> =
            (0..count).map(|_| one(definition, &field.kind, cdr, depth)).collect();
        return list.map(Value::List);
    }
    (0..count).map(|_| number(&field.kind, cdr)).collect::<Result<_, String>>().map(Value::Numbers)
}

fn one<'d>(definition: &'d Definition, kind: &'d Kind, cdr: &mut Cdr<'_>, depth: usize) -> Result<Value<'d>, String> {
    if matches!(kind, Kind::Text | Kind::Message(_)) {
        cdr.count_part()?;
    }
    match kind {
        Kind::Text => cdr.text().map(Value::Text),
        Kind::Message(name) => fields(definition, definition.part(name)?, cdr, depth + 1),
        plain => number(plain, cdr).map(Value::Number),
    }
}

fn number(kind: &Kind, cdr: &mut Cdr<'_>) -> Result<f64, String> {
    Ok(match kind {
        Kind::Bool | Kind::Uint8 => f64::from(u8::from_le_bytes(cdr.take()?)),
        Kind::Int8 => f64::from(i8::from_le_bytes(cdr.take()?)),
        Kind::Int16 => f64::from(i16::from_le_bytes(cdr.take()?)),
        Kind::Uint16 => f64::from(u16::from_le_bytes(cdr.take()?)),
        Kind::Int32 => f64::from(i32::from_le_bytes(cdr.take()?)),
        Kind::Uint32 => f64::from(u32::from_le_bytes(cdr.take()?)),
        Kind::Int64 => i64::from_le_bytes(cdr.take()?) as f64,
        Kind::Uint64 => u64::from_le_bytes(cdr.take()?) as f64,
        Kind::Float32 => f64::from(f32::from_le_bytes(cdr.take()?)),
        Kind::Float64 => f64::from_le_bytes(cdr.take()?),
        Kind::Text | Kind::Message(_) => return Err("a text where a number was expected".to_owned()),
    })
}

impl<'d> Value<'d> {
    fn get(&self, name: &str) -> Option<&Value<'d>> {
        match self {
            Self::Fields(fields) => fields.iter().find(|(n, _)| *n == name).map(|(_, v)| v),
            _ => None,
        }
    }

    /// The number at `path`: names between points, a place in a list in brackets (`data[2]`), or the place where the
    /// list `name` beside it has `joint`. `None` where this message does not have that joint, or not that far a list.
    pub(super) fn number_at(&self, path: &str, joint: Option<&str>) -> Result<Option<f64>, String> {
        let mut here = self;
        let (parents, last) = path.rsplit_once('.').unwrap_or(("", path));
        for step in parents.split('.').filter(|step| !step.is_empty()) {
            match here.step(step)? {
                Some(next) => here = next,
                None => return Ok(None),
            }
        }
        let Some(found) = here.step_to_end(last)? else { return Ok(None) };
        match (found, joint) {
            (End::Number(number), None) => Ok(Some(number)),
            (End::Numbers(numbers), Some(joint)) => Ok(here.place_of(joint)?.and_then(|at| numbers.get(at).copied())),
            (End::Number(_), Some(_)) => Err(format!("`{path}` is one number; leave `joint` out")),
            (End::Numbers(_), None) => {
                Err(format!("`{path}` is a list; say which: joint = \"NAME\", or field = \"{path}[0]\""))
            }
        }
    }

    /// Where the list `name` has the joint.
    fn place_of(&self, joint: &str) -> Result<Option<usize>, String> {
        match self.get("name") {
            Some(Value::List(names)) => Ok(names.iter().position(|n| matches!(n, Value::Text(t) if t == joint))),
            _ => Err("it has no list `name` of joints; leave `joint` out".to_owned()),
        }
    }

    fn named(&self, name: &str) -> Result<&Value<'d>, String> {
        self.get(name).ok_or_else(|| format!("it has no field `{name}`; its numbers are {}", self.numbers().join(", ")))
    }

    /// One step along a path: a field, or an element of a list of messages.
    fn step(&self, step: &str) -> Result<Option<&Value<'d>>, String> {
        let (name, place) = name_and_place(step)?;
        match (self.named(name)?, place) {
            (value, None) => Ok(Some(value)),
            (Value::List(list), Some(place)) => Ok(list.get(place)),
            _ => Err(format!("`{name}` is no list of messages")),
        }
    }

    fn step_to_end(&self, step: &str) -> Result<Option<End<'_>>, String> {
        let (name, place) = name_and_place(step)?;
        match (self.named(name)?, place) {
            (Value::Number(number), None) => Ok(Some(End::Number(*number))),
            (Value::Numbers(numbers), None) => Ok(Some(End::Numbers(numbers))),
            (Value::Numbers(numbers), Some(place)) => Ok(numbers.get(place).map(|v| End::Number(*v))),
            (other, _) => Err(format!("`{step}` is no number; its numbers are {}", other.numbers().join(", "))),
        }
    }

    /// Paths of the numbers in it, as an error lists them.
    pub(super) fn numbers(&self) -> Vec<String> {
        match self {
            Self::Fields(fields) => fields
                .iter()
                .flat_map(|(name, value)| match value {
                    Value::Number(_) => vec![(*name).to_owned()],
                    Value::Numbers(_) => vec![format!("{name}[]")],
                    inner => inner.numbers().into_iter().map(|path| format!("{name}.{path}")).collect(),
                })
                .collect(),
            _ => Vec::new(),
        }
    }

    /// `header.stamp` in ns, if the message has one.
    pub(super) fn stamp_ns(&self) -> Option<i128> {
        /// A lab's own stamp may hold any number; one that is far off is refused by whoever asks, as of another clock.
        const FARTHEST: f64 = 1e20;
        let stamp = self.get("header")?.get("stamp")?;
        let part = |name| match stamp.get(name) {
            Some(Value::Number(number)) => Some(number.clamp(-FARTHEST, FARTHEST) as i128),
            _ => None,
        };
        Some(part("sec")? * 1_000_000_000 + part("nanosec")?)
    }
}

/// Where a path leads.
enum End<'v> {
    Number(f64),
    Numbers(&'v [f64]),
}

/// `data[2]` → `data`, 2.
fn name_and_place(step: &str) -> Result<(&str, Option<usize>), String> {
    let Some((name, bracket)) = step.split_once('[') else { return Ok((step, None)) };
    let place = bracket.strip_suffix(']').and_then(|text| text.parse().ok());
    place.map(|place| (name, Some(place))).ok_or_else(|| format!("`{step}`: write the place as in data[2], from 0"))
}
