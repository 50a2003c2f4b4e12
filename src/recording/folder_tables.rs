//! The tables of `recordings.toml`: `[file]`, `[[channel]]`, `[[run]]`.

use super::also::also;
use super::bag_source::{BAG_KEYS, bag_source};
use super::folder_keys::{Keys, label};
use super::table::{FILE_KEYS, TABLE_KEYS, file_options, table_source};
use super::{ChannelSpec, FileOptions, RecordingError, Role, Run, RunUse, TIME_COLUMN, TableSource, parse_column};
use crate::nearest::did_you_mean;
use std::collections::{BTreeMap, HashSet};
use std::path::Path;

const FORMAT: i64 = 1;
pub(super) const TOP_KEYS: [&str; 5] = ["format", "scene", "file", "channel", "run"];
pub(super) const CHANNEL_KEYS: [&str; 4] = ["column", "role", "noise_sd", "constant"];
pub(super) const RUN_KEYS: [&str; 5] = ["file", "use", "not_recorded", "specimen", "also"];

pub(super) fn check_format(top: &Keys<'_>) -> Result<(), RecordingError> {
    match top.number("format")? {
        Some(format) if format == FORMAT as f64 => Ok(()),
        Some(format) => {
            Err(top.error(format!("format = {format} is not known\n  remedy: this version reads format = {FORMAT}")))
        }
        None => Err(top.error(format!("key \"format\" is missing\n  remedy: add format = {FORMAT}"))),
    }
}

pub(super) fn channels(top: &Keys<'_>, file: &Path) -> Result<Vec<ChannelSpec>, RecordingError> {
    let mut channels: Vec<ChannelSpec> = Vec::new();
    for (index, table) in top.tables("channel")?.into_iter().enumerate() {
        let keys = Keys::new(file, label("channel", index, table.get("column")), table);
        let spec = channel(&keys)?;
        if channels.iter().any(|other| other.column == spec.column) {
            return Err(keys.error("the column is declared twice\n  remedy: remove one [[channel]]"));
        }
        channels.push(spec);
    }
    Ok(channels)
}

/// What drives a simulation needs none; what is held against one does.
pub(super) fn check_outputs(top: &Keys<'_>, channels: &[ChannelSpec]) -> Result<(), RecordingError> {
    match channels.iter().all(|spec| spec.role == Role::Input) {
        true => Err(top.error("no channel has role = \"output\"\n  remedy: declare one that was measured")),
        false => Ok(()),
    }
}

/// What `[file]` says of every file.
pub(super) fn layout(top: &Keys<'_>, file: &Path) -> Result<FileOptions, RecordingError> {
    let Some(table) = top.subtable("file")? else { return Ok(FileOptions::default()) };
    let keys = Keys::new(file, "[file]", table);
    keys.refuse_unknown(&FILE_KEYS)?;
    file_options(&keys, &FileOptions::default())
}

fn channel(keys: &Keys<'_>) -> Result<ChannelSpec, RecordingError> {
    keys.refuse_unknown(&[&CHANNEL_KEYS[..], &TABLE_KEYS, &BAG_KEYS].concat())?;
    let column = keys.required_text("column", "plunger_mm")?;
    if column == TIME_COLUMN {
        return Err(keys.error("the time is no channel\n  remedy: remove this [[channel]]"));
    }
    let unit = parse_column(column).map_err(|error| keys.error(error.to_string()))?.unit;
    let role = keys
        .word("role", &[("input", Role::Input), ("output", Role::Output)])?
        .ok_or_else(|| keys.error("key \"role\" is missing\n  remedy: add role = \"input\" or role = \"output\""))?;
    let noise_sd = keys.number("noise_sd")?;
    // An input without noise is taken as recorded; of an output, weights follow from it.
    let is_right = |sd: f64| sd > 0.0 || sd == 0.0 && role == Role::Input;
    if let Some(sd) = noise_sd.filter(|sd| !is_right(*sd)) {
        return Err(keys.error(format!("noise_sd = {sd} must be > 0\n  remedy: leave it out to have it estimated")));
    }
    let constant = constant(keys, role)?;
    let bag = bag_source(keys, unit)?;
    // Beside a topic unit and zero are the bag's; a table's numbers are then the channel's as they stand.
    let table = match bag {
        None => table_source(keys, unit)?,
        Some(_) => TableSource { name: keys.text("name")?.map(str::to_owned), ..TableSource::default() },
    };
    Ok(ChannelSpec { column: column.to_owned(), role, noise_sd, constant, bag, table })
}

/// The value at which an input stood that no file has.
fn constant(keys: &Keys<'_>, role: Role) -> Result<Option<f64>, RecordingError> {
    let constant = keys.number("constant")?;
    if constant.is_some() {
        if role == Role::Output {
            return Err(keys.error("constant is for inputs\n  remedy: leave an output out that was not recorded"));
        }
        let of_files = [&TABLE_KEYS[..], &BAG_KEYS, &["noise_sd"]].concat();
        if let Some(odd) = of_files.into_iter().find(|key| keys.has(key)) {
            return Err(keys.error(format!(
                "{odd} says where the files have the channel, constant that they lack it\n  remedy: remove one of the two"
            )));
        }
    }
    Ok(constant)
}

pub(super) fn runs(
    top: &Keys<'_>,
    file: &Path,
    channels: &[ChannelSpec],
    layout: &FileOptions,
) -> Result<Vec<Run>, RecordingError> {
    let mut seen = HashSet::new();
    let mut runs = Vec::new();
    for (index, table) in top.tables("run")?.into_iter().enumerate() {
        let keys = Keys::new(file, label("run", index, table.get("file")), table);
        let run = run(&keys, channels, layout)?;
        if !seen.insert(run.file.clone()) {
            return Err(keys.error("the file is listed twice\n  remedy: remove one [[run]]"));
        }
        let named = runs.first().map_or(run.specimen.is_some(), |first: &Run| first.specimen.is_some());
        if run.specimen.is_some() != named {
            return Err(keys.error(
                "some runs name a specimen and others do not\n  remedy: give each [[run]] one: specimen = \"sample 1\"",
            ));
        }
        runs.push(run);
    }
    Ok(runs)
}

fn run(keys: &Keys<'_>, channels: &[ChannelSpec], layout: &FileOptions) -> Result<Run, RecordingError> {
    let mut conditions = BTreeMap::new();
    for key in keys.others(&[&RUN_KEYS[..], &FILE_KEYS].concat()) {
        let nearest = did_you_mean(key, &RUN_KEYS);
        if !nearest.is_empty() {
            let known = RUN_KEYS.join(", ");
            return Err(keys.error(format!(
                "unknown key \"{key}\"{nearest}\n  remedy: the keys here are {known} and the scene's conditions"
            )));
        }
        if let Some(value) = keys.number(key)? {
            conditions.insert(key.to_owned(), value);
        }
    }
    let file = keys.required_text("file", "sine.csv")?.to_owned();
    let layout = file_options(keys, layout)?;
    Ok(Run {
        also: also(keys, &file, &layout)?,
        file,
        run_use: keys.word("use", &[("fit", RunUse::Fit), ("holdout", RunUse::Holdout)])?,
        not_recorded: not_recorded(keys, channels)?,
        specimen: keys.text("specimen")?.map(str::to_owned),
        layout,
        conditions,
    })
}

/// Inputs drive the simulation: they are there in every run.
fn not_recorded(keys: &Keys<'_>, channels: &[ChannelSpec]) -> Result<Vec<String>, RecordingError> {
    let columns = keys.texts("not_recorded")?;
    let outputs: Vec<&str> = channels.iter().filter(|c| c.role == Role::Output).map(|c| c.column.as_str()).collect();
    if let Some(twice) = (1..columns.len()).find(|i| columns[..*i].contains(&columns[*i])) {
        let column = &columns[twice];
        return Err(keys.error(format!("not_recorded names \"{column}\" twice\n  remedy: name it once")));
    }
    match columns.iter().find(|c| !outputs.contains(&c.as_str())) {
        None => Ok(columns),
        Some(odd) => Err(keys.error(format!(
            "not_recorded names \"{odd}\", which is no declared output{}\n  remedy: the outputs are {}",
            did_you_mean(odd, &outputs),
            outputs.join(", ")
        ))),
    }
}
