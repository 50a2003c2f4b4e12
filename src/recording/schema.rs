//! The JSON Schema of `recordings.toml`, for editors.

use serde_json::{Map, Value, json};

/// The schema as text, draft 7: what editors of TOML know.
pub fn recordings_schema() -> String {
    let schema = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Recordings for smam",
        "description": "What the recordings of a folder are: recordings.toml.",
        "type": "object",
        "properties": {
            "format": { "const": 1, "description": "Version of this format: 1." },
            "scene": text("A stock scene, or the path of a scene file (from this folder, else from where you are)."),
            "channel": tables(&channel()),
            "run": tables(&run()),
        },
        "required": ["format", "scene", "channel", "run"],
        "additionalProperties": false,
    });
    // Numbers and texts alone: this cannot fail.
    serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"
}

fn channel() -> Value {
    let suffixes: Vec<&str> = super::KNOWN_UNITS.iter().map(|u| u.suffix).collect();
    let column = json!({
        "type": "string",
        "pattern": format!("^.+_({})$", suffixes.join("|")),
        "description": "Name of the column, unit as suffix: plunger_mm.",
    });
    let keys = json!({
        "column": column,
        "role": {
            "enum": ["input", "output"],
            "description": "input: drives the simulation. output: is compared.",
        },
        "noise_sd": {
            "type": "number", "exclusiveMinimum": 0,
            "description": "Standard deviation of the noise, in the column's unit; estimated when left out.",
        },
        "topic": { "type": "string", "pattern": "^/", "description": "Bags only: the topic, /syringe/position." },
        "field": text("Bags only: path of the number in the message, wrench.force.z or data[2]; data when left out."),
        "joint": text("Bags only: which joint, by its name in the list `name` of the message."),
        "unit": {
            "enum": suffixes,
            "description": "Bags only: unit of the number in the bag; SI when left out.",
        },
        "zero": {
            "type": "number",
            "description": "Bags only: reading that counts as zero, in the bag's unit; 101325 for absolute pressures in Pa.",
        },
        "time": {
            "enum": ["stamp", "log"],
            "description": "Bags only: stamp (header.stamp where there is one) or log (when it was recorded).",
        },
    });
    json!({
        "type": "object",
        "properties": keys,
        "required": ["column", "role"],
        "dependencies": Map::from_iter(super::bag_source::BAG_KEYS[1..].iter().map(|key| ((*key).to_owned(), json!(["topic"])))),
        "additionalProperties": false,
    })
}

fn run() -> Value {
    json!({
        "type": "object",
        "description": "A run. Keys other than these are known conditions: numbers whose names end in their unit.",
        "properties": {
            "file": text("CSV file, Parquet file (.parquet) or ROS 2 bag (.mcap) in this folder."),
            "use": { "enum": ["fit", "holdout"], "description": "Nothing is fitted to a holdout run." },
            "not_recorded": {
                "type": "array", "items": { "type": "string" },
                "description": "Declared outputs that this run was recorded without.",
            },
        },
        "required": ["file"],
        "additionalProperties": { "type": "number" },
    })
}

fn tables(item: &Value) -> Value {
    json!({ "type": "array", "minItems": 1, "items": item })
}

fn text(description: &str) -> Value {
    json!({ "type": "string", "minLength": 1, "description": description })
}

#[cfg(test)]
mod tests {
    use super::super::folder::{CHANNEL_KEYS, RUN_KEYS, TOP_KEYS};
    use super::*;
    use crate::recording::bag_source::BAG_KEYS;

    fn keys(schema: &Value) -> Vec<String> {
        let mut keys: Vec<String> = schema["properties"].as_object().expect("keys").keys().cloned().collect();
        keys.sort();
        keys
    }

    fn sorted(known: &[&str]) -> Vec<String> {
        let mut known: Vec<String> = known.iter().map(|k| (*k).to_owned()).collect();
        known.sort();
        known
    }

    #[test]
    fn keys_of_the_schema_are_those_that_are_read() {
        let schema: Value = serde_json::from_str(&recordings_schema()).expect("JSON");
        assert_eq!(keys(&schema), sorted(&TOP_KEYS));
        assert_eq!(keys(&channel()), sorted(&[&CHANNEL_KEYS[..], &BAG_KEYS].concat()));
        assert_eq!(keys(&run()), sorted(&RUN_KEYS));
    }
}
