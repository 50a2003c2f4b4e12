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
            "file": file(),
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
            "type": "number", "minimum": 0,
            "description": "Standard deviation of the noise, in the column's unit; estimated when left out. Inputs are smoothed by as much; 0 leaves one as \
                            it was recorded.",
        },
        "constant": { "type": "number", "description": "Inputs only: the value at which it stood, in the column's unit, where no file has it." },
        "topic": { "type": "string", "pattern": "^/", "description": "Bags only: the topic, /syringe/position." },
        "field": text("Bags only: path of the number in the message, wrench.force.z or data[2]; data when left out."),
        "joint": text("Bags only: which joint, by its name in the list `name` of the message."),
        "name": text("Tables only: the column's name in the file, if it is another: Pressure [bar]."),
        "unit": text("Unit of the numbers in the file: mm, cm, m, um, in, deg, rad, rev, kPa, Pa, MPa, bar, mbar, atm, psi, mmHg, N, mN, kN, gf, kgf, lbf, V; \
                      left out, a table's is that of its name or of the column, a bag's SI."),
        "scale": {
            "type": "number",
            "description": "Tables only: factor upon the numbers; for volts, what one volt is in the column's unit.",
        },
        "zero": { "type": "number", "description": "Number that counts as zero, in the file's unit; 101325 for absolute pressures in Pa." },
        "time": {
            "enum": ["stamp", "log"],
            "description": "Bags only: stamp (header.stamp where there is one) or log (when it was recorded).",
        },
    });
    json!({
        "type": "object",
        "properties": keys,
        "required": ["column", "role"],
        // Of an output, weights follow from its noise; an input that has none is taken as it was recorded.
        "if": { "properties": { "role": { "const": "output" } }, "required": ["role"] },
        "then": { "properties": { "noise_sd": { "exclusiveMinimum": 0 }, "constant": false } },
        "dependencies": Map::from_iter(super::bag_source::BAG_KEYS[1..].iter().map(|key| ((*key).to_owned(), json!(["topic"])))),
        "additionalProperties": false,
    })
}

/// `[file]`, and what a `[[run]]` may say otherwise.
fn file_keys() -> Map<String, Value> {
    let flag = |description: &str| json!({ "type": "boolean", "description": description });
    let texts =
        |description: &str| json!({ "type": "array", "items": { "type": "string" }, "description": description });
    let keys = json!({
        "encoding": text("utf-8, utf-16le, utf-16be, latin1, windows-1252, gbk or another of the Encoding Standard; a byte order mark outranks it."),
        "delimiter": { "enum": [",", ";", "tab", "|", "blanks", "comma", "semicolon", "bar", "\t", ":", " "], "description": "Between columns." },
        "decimal": { "enum": [".", ","], "description": "Decimal mark." },
        "thousands": { "enum": [".", ",", "'", " "], "description": "Mark between groups of three digits." },
        "skip_last_rows": { "type": "integer", "minimum": 0, "description": "Rows at the end that are no samples: means, extremes, a closing remark." },
        "skip_rows": { "type": "integer", "minimum": 0, "description": "Lines at the top that do not belong to the table." },
        "header": {
            "oneOf": [{ "type": "integer", "minimum": 1 }, { "type": "boolean" }],
            "description": "Line with the names of the columns, from 1; false: the file has none, names gives them.",
        },
        "names": texts("Names of the columns where header = false."),
        "units_row": flag("The row below the names holds units."),
        "missing": texts("Texts for a missing sample, besides NaN, n.a., - and the like."),
        "sheet": text("Sheet of a workbook; the first when left out."),
        "time_column": text("Name of the time column; time_s when left out."),
        "time_unit": { "enum": super::table::TIME_UNITS, "description": "Unit of the time; what its name says when left out, else s." },
        "time": { "enum": ["column", "index"], "description": "index: rows without a clock; their order is known, their pace is not." },
        "interval_s": { "type": "number", "exclusiveMinimum": 0, "description": "Time between two rows, for files without a time column." },
        "split_at_restart": flag("A clock that goes back begins a run of its own."),
        "merge_repeated": flag("Rows of one stamp become one, their mean."),
    });
    match keys {
        Value::Object(keys) => keys,
        // It is written as one above.
        _ => Map::new(),
    }
}

fn file() -> Value {
    json!({
        "type": "object",
        "description": "How the files are laid out; a [[run]] may say otherwise for its own.",
        "properties": file_keys(),
        "additionalProperties": false,
    })
}

fn run() -> Value {
    let mut keys = file_keys();
    keys.insert(
        "file".to_owned(),
        text("CSV file, workbook (.xlsx), Parquet file (.parquet) or ROS 2 bag (.mcap) in this folder."),
    );
    keys.insert(
        "use".to_owned(),
        json!({ "enum": ["fit", "holdout"], "description": "Nothing is fitted to a holdout run." }),
    );
    keys.insert(
        "not_recorded".to_owned(),
        json!({
            "type": "array", "items": { "type": "string" },
            "description": "Declared outputs that this run was recorded without.",
        }),
    );
    keys.insert("also".to_owned(), tables(&also()));
    keys.insert(
        "specimen".to_owned(),
        text("Which sample, or set-up, it was recorded on: calibrated numbers are each one's own in a diagnosis."),
    );
    json!({
        "type": "object",
        "description": "A run. Keys other than these are known conditions: numbers whose names end in their unit.",
        "properties": keys,
        "required": ["file"],
        "additionalProperties": { "type": "number" },
    })
}

/// `[[run.also]]`.
fn also() -> Value {
    let mut keys = file_keys();
    keys.insert(
        "file".to_owned(),
        text("Another table with channels of this run, in this folder: what a camera or a second logger wrote."),
    );
    keys.insert(
        "starts_s".to_owned(),
        json!({
            "type": "number",
            "description": "Where its time 0 lies in the time of the run's file, s; stamps in both files say it themselves.",
        }),
    );
    json!({
        "type": "object",
        "description": "Another file of the run, with a clock of its own; [file] does not hold for it.",
        "properties": keys,
        "required": ["file"],
        "additionalProperties": false,
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
    use super::super::also::ALSO_KEYS;
    use super::super::folder_tables::{CHANNEL_KEYS, RUN_KEYS, TOP_KEYS};
    use super::*;
    use crate::recording::bag_source::BAG_KEYS;
    use crate::recording::table::{FILE_KEYS, TABLE_KEYS};

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
        assert_eq!(keys(&channel()), sorted(&[&CHANNEL_KEYS[..], &TABLE_KEYS, &BAG_KEYS].concat()));
        assert_eq!(keys(&file()), sorted(&FILE_KEYS));
        assert_eq!(keys(&run()), sorted(&[&RUN_KEYS[..], &FILE_KEYS].concat()));
        assert_eq!(keys(&also()), sorted(&[&ALSO_KEYS[..], &FILE_KEYS].concat()));
    }
}
