//! The JSON Schema of scene files, for editors: the same types that read them, with their comments as descriptions.
//!
//! It knows keys, types and words. Ranges, names within the file and what excludes what are known to the checks alone.

use schemars::generate::SchemaSettings;
use schemars::transform::transform_subschemas;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use super::SceneFile;

/// The schema as text, draft 7: what editors of TOML know.
pub fn scene_schema() -> String {
    let settings = SchemaSettings::draft07().with_transform(without_null);
    let mut schema = settings.into_generator().into_root_schema_for::<SceneFile>();
    schema.insert("title".to_owned(), "Scene of smam".into());
    schema_text(&schema)
}

/// A schema as a file holds it.
fn schema_text(schema: &Schema) -> String {
    // Numbers and texts alone: this cannot fail.
    serde_json::to_string_pretty(schema).unwrap_or_default() + "\n"
}

/// TOML knows no null: a key is there or not.
fn without_null(schema: &mut Schema) {
    let is_null = |value: &Value| *value == json!("null") || *value == json!({ "type": "null" });
    if let Some(Value::Array(types)) = schema.get_mut("type") {
        types.retain(|t| !is_null(t));
        if let [only] = types.as_slice() {
            let only = only.clone();
            schema.insert("type".to_owned(), only);
        }
    }
    if let Some(Value::Array(choices)) = schema.get_mut("anyOf") {
        choices.retain(|c| !is_null(c));
        if let [Value::Object(only)] = choices.as_slice() {
            let only = Value::Object(only.clone());
            schema.remove("anyOf");
            schema.insert("allOf".to_owned(), json!([only]));
        }
    }
    transform_subschemas(&mut without_null, schema);
}

/// A kind of programme: its keys, `_U` standing for the unit of the channel. Lists end in `[]`, what may be left out in `?`.
const PROGRAMS: [(&str, &[&str]); 8] = [
    ("constant", &["value_U", "start_s?"]),
    ("sine", &["stroke_U", "frequency_hz", "offset_U?", "start_s?"]),
    ("two_sines", &["stroke_U", "frequency_hz", "second_frequency_hz", "offset_U?", "start_s?"]),
    ("non_harmonic", &["stroke_U", "frequency_hz", "offset_U?", "start_s?"]),
    ("chirp", &["stroke_U", "from_hz", "to_hz", "duration_s", "start_s?"]),
    ("staircase", &["steps_U[]", "hold_s", "rise_s", "start_s?"]),
    ("ramp_hold", &["to_U", "rise_s", "hold_s?", "fall_s?", "start_s?"]),
    ("points", &["time_s[]", "value_U[]"]),
];

/// SI units of input channels.
const UNITS: [&str; 3] = ["m", "rad", "pa"];

/// The schema of `[input.program]`, one choice for each kind and unit.
pub(super) fn program(_: &mut SchemaGenerator) -> Schema {
    let choices: Vec<Value> =
        PROGRAMS.iter().flat_map(|(kind, keys)| UNITS.iter().map(move |unit| choice(kind, keys, unit))).collect();
    json_schema!({ "type": "object", "anyOf": choices })
}

fn choice(kind: &str, keys: &[&str], unit: &str) -> Value {
    let mut properties = Map::from_iter([("kind".to_owned(), json!({ "const": kind }))]);
    let mut required = vec!["kind".to_owned()];
    for key in keys {
        let name = key.trim_end_matches(['?', ']', '[']).replace("_U", &format!("_{unit}"));
        let schema = match key.ends_with("[]") {
            true => json!({ "type": "array", "items": { "type": "number" }, "minItems": 1 }),
            false => json!({ "type": "number" }),
        };
        properties.insert(name.clone(), schema);
        if !key.ends_with('?') {
            required.push(name);
        }
    }
    json!({ "properties": properties, "required": required, "additionalProperties": false })
}

#[cfg(test)]
mod tests {
    use super::super::Program;
    use super::*;

    /// The list of programmes here and the reader of programmes know the same keys.
    #[test]
    fn programmes_of_the_schema_are_those_that_are_read() {
        for (kind, keys) in PROGRAMS {
            for unit in UNITS {
                let mut table = toml::Table::from_iter([("kind".to_owned(), kind.into())]);
                for key in keys {
                    let name = key.trim_end_matches(['?', ']', '[']).replace("_U", &format!("_{unit}"));
                    let value = if key.ends_with("[]") { vec![1.0].into() } else { toml::Value::Float(1.0) };
                    table.insert(name, value);
                }
                Program::parse(&table, unit).unwrap_or_else(|e| panic!("{kind} in {unit}: {e}"));
                for key in keys.iter().filter(|key| !key.ends_with('?')) {
                    let name = key.trim_end_matches("[]").replace("_U", &format!("_{unit}"));
                    let mut without = table.clone();
                    without.remove(&name);
                    assert!(Program::parse(&without, unit).is_err(), "{kind} without {name}");
                }
            }
        }
        let unknown = Program::parse(&toml::Table::from_iter([("kind".to_owned(), "no".into())]), "m").unwrap_err();
        let listed: Vec<&str> = PROGRAMS.iter().map(|(kind, _)| *kind).collect();
        assert!(unknown.ends_with(&format!("known are {}", listed.join(", "))), "{unknown}");
    }

    #[test]
    fn no_key_may_be_null() {
        assert!(!scene_schema().contains("null"));
    }
}
