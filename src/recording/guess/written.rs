//! A guess as a `recordings.toml`.

use std::path::Path;

use toml::Value;

use super::super::table::{Header, TimeSource, label};
use super::super::{Role, parse_column};
use super::open;
use super::sizes;
use super::{FileOptions, Guess, GuessedColumn, Sureness, Wanted};

/// The scene that is written, and its channels.
#[derive(Clone, Copy, Debug)]
pub struct OpenScene<'a> {
    /// By name or path.
    pub name: &'a str,
    /// What it has.
    pub channels: &'a [Wanted],
}

/// A further file of a run as it was guessed, and where its time 0 lies, if that is to be written.
#[derive(Clone, Debug)]
pub struct AlsoGuess {
    /// The file.
    pub guess: Guess,
    /// Where its time 0 lies in the time of the run's file, s, and what is to be said of it.
    pub starts_s: Option<(f64, String)>,
}

/// The text of a `recordings.toml` for files of one kind; the columns are those of the first. `also` has the further file of each, or
/// nothing. `in_folder` says how the file calls a recording.
pub fn to_toml(
    guesses: &[Guess],
    also: &[AlsoGuess],
    scene: OpenScene<'_>,
    in_folder: &dyn Fn(&Path) -> String,
) -> String {
    let mut text = String::from(
        "# Written by `smam import`: look it over, change what is wrong. Keys: `smam schema recordings`.\nformat = 1\n",
    );
    text += &format!("scene = {}\n", quoted(scene.name));
    let Some(first) = guesses.first() else { return text };
    let is_common = guesses.iter().all(|guess| guess.options == first.options);
    let layout = layout_lines(&first.options);
    if is_common && !layout.is_empty() {
        text += &format!("\n[file]\n{layout}");
    }
    if first.time.is_none() {
        text += "# No column of times was found. If the rows were taken at an even pace, say so under [file]:\n#   interval_s = 0.01\n\
                 # if their pace is not known (nothing that depends on rate can then be judged):\n#   time = \"index\"\n#   interval_s = 0.1\n";
    }
    first.columns.iter().for_each(|column| text += &channel(column));
    let others = also.first().map_or(Vec::new(), |also| columns_beside(&also.guess, first));
    others.iter().for_each(|column| text += &channel(column));
    text += &absent(&[&first.columns[..], &others].concat(), scene.channels);
    for (index, guess) in guesses.iter().enumerate() {
        text += &format!("\n[[run]]\nfile = {}\n", quoted(&in_folder(&guess.file)));
        if !is_common {
            text += &layout_lines(&guess.options);
        }
        text += &also.get(index).map_or(String::new(), |also| also_lines(also, in_folder));
    }
    text
}

/// The columns of a further file that are channels which the first has not.
fn columns_beside(also: &Guess, first: &Guess) -> Vec<GuessedColumn> {
    let is_taken = |wanted: &Wanted| first.columns.iter().any(|c| c.channel.as_ref().is_some_and(|(w, _)| w == wanted));
    also.columns.iter().filter(|c| c.channel.as_ref().is_some_and(|(w, _)| !is_taken(w))).cloned().collect()
}

fn also_lines(also: &AlsoGuess, in_folder: &dyn Fn(&Path) -> String) -> String {
    let file = quoted(&in_folder(&also.guess.file));
    let start = also.starts_s.as_ref().map_or(String::new(), |(s, said)| format!("starts_s = {s:.3}{said}\n"));
    format!("[[run.also]]\nfile = {file}\n{start}{}", layout_lines(&also.guess.options))
}

fn quoted(text: &str) -> String {
    Value::String(text.to_owned()).to_string()
}

fn layout_lines(options: &FileOptions) -> String {
    let mut lines = String::new();
    let mut line = |key: &str, value: Option<String>| {
        if let Some(value) = value {
            lines += &format!("{key} = {value}\n");
        }
    };
    let list = |texts: &[String]| {
        (!texts.is_empty()).then(|| format!("[{}]", texts.iter().map(|t| quoted(t)).collect::<Vec<_>>().join(", ")))
    };
    line("encoding", options.encoding.map(|e| quoted(&e.name().to_lowercase())));
    line("delimiter", options.delimiter.map(|d| quoted(&d.word())));
    line("decimal", options.decimal.map(|d| quoted(&d.to_string())));
    line("thousands", options.thousands.map(|d| quoted(&d.to_string())));
    line("skip_rows", (options.skip_rows > 0).then(|| options.skip_rows.to_string()));
    line("skip_last_rows", (options.skip_last_rows > 0).then(|| options.skip_last_rows.to_string()));
    line(
        "header",
        options.header.map(|header| match header {
            Header::Line(line) => line.to_string(),
            Header::Absent => "false".to_owned(),
        }),
    );
    line("names", list(&options.names));
    line("units_row", options.units_row.then(|| "true".to_owned()));
    line("missing", list(&options.missing));
    line("sheet", options.sheet.as_deref().map(quoted));
    line("time_column", options.time_column.as_deref().map(quoted));
    line("time_unit", options.time_unit.map(|u| quoted(u.name)));
    if let TimeSource::Interval(s) | TimeSource::Index(s) = options.time {
        line("interval_s", Some(s.to_string()));
    }
    line("time", matches!(options.time, TimeSource::Index(_)).then(|| quoted("index")));
    line("split_at_restart", options.split_at_restart.then(|| "true".to_owned()));
    line("merge_repeated", options.merge_repeated.then(|| "true".to_owned()));
    lines
}

fn channel(column: &GuessedColumn) -> String {
    let Some((wanted, sureness)) = &column.channel else { return without_channel(column) };
    let mut text = format!("\n[[channel]]\ncolumn = {}\nrole = \"{}\"\n", quoted(&wanted.column), role(wanted.role));
    if column.name != wanted.column {
        let doubt = if *sureness == Sureness::Sure { "" } else { "    # likely, by its name: is it?" };
        text += &format!("name = {}{doubt}\n", quoted(&column.name));
    }
    text + &unit(column, wanted)
}

fn unit(column: &GuessedColumn, wanted: &Wanted) -> String {
    let Ok(own) = parse_column(&wanted.column) else { return String::new() };
    let open = column.open_point();
    match (&column.unread_unit, open) {
        (Some(text), Some(point)) => return open::comment(text) + &open::scale_line(&point),
        (None, Some(point)) => {
            let unit = column.unit.map_or(String::new(), |unit| format!("unit = {}\n", quoted(unit.name)));
            return unit + &open::scale_line(&point);
        }
        _ => {}
    }
    match column.unit {
        None => sizes::no_unit(own.unit, column.greatest),
        // The name says it itself.
        Some(_) if column.name == wanted.column || label(&column.name).unit == column.unit => String::new(),
        Some(unit) => format!("unit = {}\n", quoted(unit.name)),
    }
}

fn without_channel(column: &GuessedColumn) -> String {
    if column.is_text {
        return format!("\n# Column {} holds texts: not read.\n", quoted(&column.name));
    }
    format!(
        "\n# Column {} is like no channel of the scene. If it is one:\n# [[channel]]\n# column = \"...\"\n# role = \"output\"\n# name = {}\n",
        quoted(&column.name),
        quoted(&column.name)
    )
}

fn role(role: Role) -> &'static str {
    match role {
        Role::Input => "input",
        Role::Output => "output",
    }
}

/// Inputs that no column was found for; a scene cannot be driven without them.
fn absent(columns: &[GuessedColumn], channels: &[Wanted]) -> String {
    let is_found = |wanted: &&Wanted| columns.iter().any(|c| c.channel.as_ref().is_some_and(|(w, _)| w == *wanted));
    let inputs = channels.iter().filter(|w| w.role == Role::Input && !is_found(w));
    let lines = inputs.map(|w| {
        format!("\n# No column was found for this input, which the scene needs. Fill in its name and take the marks away:\n# [[channel]]\n# column = {}\n# role = \"input\"\n# name = \"...\"\n", quoted(&w.column))
    });
    lines.collect()
}
