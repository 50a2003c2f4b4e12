//! Message definitions as a bag brings them: text in the language of `.msg` files.
//!
//! The type of the topic comes first; those it is made of follow, each behind a line of `=` and a line `MSG: pkg/Type`.

use std::collections::BTreeMap;

/// What a field holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Bool,
    Int8,
    Uint8,
    Int16,
    Uint16,
    Int32,
    Uint32,
    Int64,
    Uint64,
    Float32,
    Float64,
    Text,
    /// Another message: its name without `msg`, `std_msgs/Header`.
    Message(String),
}

/// How many of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Count {
    One,
    Fixed(usize),
    Sequence,
}

/// A field of a message.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) count: Count,
}

/// A message type and those it is made of.
#[derive(Clone, Debug)]
pub(super) struct Definition {
    pub(super) fields: Vec<Field>,
    parts: BTreeMap<String, Vec<Field>>,
}

impl Definition {
    /// Reads the definition of the message type `name` (`sensor_msgs/msg/JointState`).
    pub(super) fn parse(name: &str, text: &str) -> Result<Self, String> {
        let mut sections = vec![(plain(name), Vec::new())];
        let mut begins = false;
        for line in text.lines().map(str::trim) {
            match line.strip_prefix("MSG:") {
                Some(part) if begins => sections.push((plain(part.trim()), Vec::new())),
                _ if line.len() >= 3 && line.bytes().all(|b| b == b'=') => {
                    begins = true;
                    continue;
                }
                _ => {
                    let package = sections[sections.len() - 1].0.split('/').next().unwrap_or("").to_owned();
                    let found = field(line, &package).map_err(|problem| format!("`{line}`: {problem}"))?;
                    let last = sections.len() - 1;
                    sections[last].1.extend(found);
                }
            }
            begins = false;
        }
        let (_, fields) = sections.remove(0);
        let mut parts: BTreeMap<String, Vec<Field>> = sections.into_iter().collect();
        // Both are part of every ROS 2; some recorders leave them out.
        for stamp in ["builtin_interfaces/Time", "builtin_interfaces/Duration"] {
            parts.entry(stamp.to_owned()).or_insert_with(time_fields);
        }
        Ok(Self { fields, parts })
    }

    /// The fields of a message that is a field.
    pub(super) fn part(&self, name: &str) -> Result<&[Field], String> {
        self.parts.get(name).map(Vec::as_slice).ok_or_else(|| format!("the bag has no definition of {name}"))
    }
}

fn time_fields() -> Vec<Field> {
    [("sec", Kind::Int32), ("nanosec", Kind::Uint32)]
        .map(|(name, kind)| Field { name: name.to_owned(), kind, count: Count::One })
        .into()
}

/// `std_msgs/msg/Header` and `std_msgs/Header` are one.
fn plain(name: &str) -> String {
    name.replace("/msg/", "/")
}

/// The field of a line; `None` for a comment, a constant or nothing.
fn field(line: &str, package: &str) -> Result<Option<Field>, String> {
    let line = line.split('#').next().unwrap_or("").trim();
    let Some((kind, rest)) = line.split_once(char::is_whitespace) else {
        return if line.is_empty() { Ok(None) } else { Err("a type without a name".to_owned()) };
    };
    let rest = rest.trim_start();
    let end = rest.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(rest.len());
    let (name, after) = rest.split_at(end);
    if after.trim_start().starts_with('=') {
        return Ok(None);
    }
    let (kind, count) = kind_and_count(kind, package)?;
    Ok(Some(Field { name: name.to_owned(), kind, count }))
}

fn kind_and_count(text: &str, package: &str) -> Result<(Kind, Count), String> {
    let Some((kind, bracket)) = text.split_once('[') else {
        return Ok((kind(text, package)?, Count::One));
    };
    let inside = bracket.strip_suffix(']').ok_or("a bracket is not closed")?;
    let count = match inside {
        "" => Count::Sequence,
        bounded if bounded.starts_with("<=") => Count::Sequence,
        fixed => match fixed.parse() {
            Ok(count) if count > 0 => Count::Fixed(count),
            _ => return Err(format!("[{fixed}] is no length")),
        },
    };
    Ok((self::kind(kind, package)?, count))
}

fn kind(text: &str, package: &str) -> Result<Kind, String> {
    // `string<=20` is a string.
    let name = text.split("<=").next().unwrap_or(text);
    Ok(match name {
        "bool" => Kind::Bool,
        "int8" => Kind::Int8,
        "uint8" | "byte" | "char" => Kind::Uint8,
        "int16" => Kind::Int16,
        "uint16" => Kind::Uint16,
        "int32" => Kind::Int32,
        "uint32" => Kind::Uint32,
        "int64" => Kind::Int64,
        "uint64" => Kind::Uint64,
        "float32" => Kind::Float32,
        "float64" => Kind::Float64,
        "string" => Kind::Text,
        "wstring" => return Err("wide strings are not read; record a topic without them".to_owned()),
        "time" => Kind::Message("builtin_interfaces/Time".to_owned()),
        "duration" => Kind::Message("builtin_interfaces/Duration".to_owned()),
        "Header" => Kind::Message("std_msgs/Header".to_owned()),
        other if other.contains('/') => Kind::Message(plain(other)),
        other => Kind::Message(format!("{package}/{other}")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_definition_with_parts_constants_bounds_and_comments() {
        let text = "# what a lab wrote\nuint8 OPEN=1\nstring<=5 LABEL = 'a # b'\nstd_msgs/Header header\n\
                    float64[<=3] bounded  # three at most\nint32[4] four\nPart[] parts\nstring note \"a=b\"\n\
                    ================================================================================\n\
                    MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
                    ===\nMSG: lab_msgs/Part\nbool on\n";
        let definition = Definition::parse("lab_msgs/msg/State", text).unwrap();
        let found: Vec<(&str, &Kind, Count)> =
            definition.fields.iter().map(|f| (f.name.as_str(), &f.kind, f.count)).collect();
        assert_eq!(
            found,
            [
                ("header", &Kind::Message("std_msgs/Header".to_owned()), Count::One),
                ("bounded", &Kind::Float64, Count::Sequence),
                ("four", &Kind::Int32, Count::Fixed(4)),
                ("parts", &Kind::Message("lab_msgs/Part".to_owned()), Count::Sequence),
                ("note", &Kind::Text, Count::One),
            ]
        );
        assert_eq!(definition.part("std_msgs/Header").unwrap().len(), 2);
        assert_eq!(definition.part("builtin_interfaces/Time").unwrap().len(), 2);
        assert_eq!(definition.part("lab_msgs/None").unwrap_err(), "the bag has no definition of lab_msgs/None");
    }

    #[test]
    fn what_cannot_be_read_is_refused_with_its_line() {
        let refusal = |text: &str| Definition::parse("a/B", text).unwrap_err();
        assert_eq!(refusal("float64[0] x"), "`float64[0] x`: [0] is no length");
        assert!(refusal("float64[3 x").contains("not closed"));
        assert!(refusal("wstring x").contains("wide strings"));
        assert!(refusal("float64").contains("without a name"));
    }
}
