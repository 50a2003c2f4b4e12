//! Reading TOML keys with errors that name file, table, key and remedy.

use super::guess::TO_FILL_IN;
use super::{Header, RecordingError};
use crate::nearest::did_you_mean;
use std::path::Path;
use toml::{Table, Value};

/// A table of `recordings.toml` and where it stands.
pub(super) struct Keys<'a> {
    file: &'a Path,
    name: String,
    table: &'a Table,
}

impl<'a> Keys<'a> {
    pub(super) fn new(file: &'a Path, name: impl Into<String>, table: &'a Table) -> Self {
        Self { file, name: name.into(), table }
    }

    /// An error at this table.
    pub(super) fn error(&self, problem: impl Into<String>) -> RecordingError {
        RecordingError::Key { file: self.file.to_owned(), table: self.name.clone(), problem: problem.into() }
    }

    /// Refuses keys that are not among the known ones.
    pub(super) fn refuse_unknown(&self, known: &[&str]) -> Result<(), RecordingError> {
        match self.table.keys().find(|key| !known.contains(&key.as_str())) {
            None => Ok(()),
            Some(key) => Err(self.error(format!(
                "unknown key \"{key}\"{}\n  remedy: the keys here are {}",
                did_you_mean(key, known),
                known.join(", ")
            ))),
        }
    }

    /// Refuses keys that belong to another table.
    pub(super) fn refuse_keys_of(&self, other: &str, keys: &[&str]) -> Result<(), RecordingError> {
        match self.table.iter().find(|(key, _)| keys.contains(&key.as_str())) {
            None => Ok(()),
            Some((key, value)) => Err(self.error(format!(
                "key \"{key}\" is one of {other}\n  remedy: write {key} = {value} below a line {other}"
            ))),
        }
    }

    pub(super) fn has(&self, key: &str) -> bool {
        self.table.contains_key(key)
    }

    pub(super) fn text(&self, key: &str) -> Result<Option<&'a str>, RecordingError> {
        match self.table.get(key) {
            None => Ok(None),
            Some(Value::String(text)) if !text.is_empty() => Ok(Some(text)),
            Some(other) => Err(self
                .error(format!("{key} = {other} must be a text that is not empty\n  remedy: write it between quotes"))),
        }
    }

    pub(super) fn required_text(&self, key: &str, example: &str) -> Result<&'a str, RecordingError> {
        self.text(key)?
            .ok_or_else(|| self.error(format!("key \"{key}\" is missing\n  remedy: add {key} = \"{example}\"")))
    }

    /// A list of texts; empty when the key is not there.
    pub(super) fn texts(&self, key: &str) -> Result<Vec<String>, RecordingError> {
        let Some(value) = self.table.get(key) else { return Ok(Vec::new()) };
        let list = value.as_array().and_then(|list| list.iter().map(|v| v.as_str().map(str::to_owned)).collect());
        list.ok_or_else(|| {
            self.error(format!("{key} = {value} must be a list of texts\n  remedy: write {key} = [\"force_n\"]"))
        })
    }

    /// A text that is one of a few words.
    pub(super) fn word<T: Copy>(&self, key: &str, words: &[(&str, T)]) -> Result<Option<T>, RecordingError> {
        let Some(text) = self.text(key)? else {
            return Ok(None);
        };
        if let Some((_, meaning)) = words.iter().find(|(word, _)| *word == text) {
            return Ok(Some(*meaning));
        }
        let known: Vec<&str> = words.iter().map(|(word, _)| *word).collect();
        Err(self.error(format!(
            "{key} = \"{text}\" is not known{}\n  remedy: write one of \"{}\"",
            did_you_mean(text, &known),
            known.join("\", \"")
        )))
    }

    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, RecordingError> {
        match self.table.get(key) {
            None => Ok(None),
            Some(Value::Integer(whole)) => Ok(Some(*whole as f64)),
            Some(Value::Float(number)) if number.is_finite() => Ok(Some(*number)),
            Some(Value::String(text)) if text.starts_with(TO_FILL_IN) => Err(self.error(format!(
                "{key} = \"{text}\" is still open\n  remedy: write the number in the place of the text: {key} = 2.5"
            ))),
            Some(other) => Err(self.error(format!(
                "{key} = {other} must be a finite number\n  remedy: write {key} = 0.5, or whatever it is"
            ))),
        }
    }

    pub(super) fn flag(&self, key: &str) -> Result<Option<bool>, RecordingError> {
        match self.table.get(key) {
            None => Ok(None),
            Some(Value::Boolean(flag)) => Ok(Some(*flag)),
            Some(other) => {
                Err(self.error(format!("{key} = {other} must be true or false\n  remedy: write {key} = true")))
            }
        }
    }

    /// A whole number, not negative.
    pub(super) fn count(&self, key: &str) -> Result<Option<usize>, RecordingError> {
        let Some(value) = self.table.get(key) else { return Ok(None) };
        let count = value.as_integer().and_then(|whole| usize::try_from(whole).ok());
        count.map(Some).ok_or_else(|| {
            self.error(format!("{key} = {value} must be a whole number, 0 or more\n  remedy: write {key} = 3"))
        })
    }

    /// The line of the names, from 1, or `false` for none.
    pub(super) fn header(&self) -> Result<Option<Header>, RecordingError> {
        let line = |whole: i64| usize::try_from(whole).ok().filter(|line| *line > 0);
        match self.table.get("header") {
            None | Some(Value::Boolean(true)) => Ok(None),
            Some(Value::Boolean(false)) => Ok(Some(Header::Absent)),
            Some(Value::Integer(whole)) if line(*whole).is_some() => Ok(line(*whole).map(Header::Line)),
            Some(other) => Err(self.error(format!(
                "header = {other} is no line\n  remedy: write header = 4 for names in the fourth line, header = false for none"
            ))),
        }
    }

    /// The table of `[key]`, if there is one.
    pub(super) fn subtable(&self, key: &str) -> Result<Option<&'a Table>, RecordingError> {
        match self.table.get(key) {
            None => Ok(None),
            Some(Value::Table(table)) => Ok(Some(table)),
            Some(other) => Err(self.error(format!("{key} = {other} must be a table\n  remedy: write [{key}]"))),
        }
    }

    /// The tables of `[[key]]`; at least one.
    pub(super) fn tables(&self, key: &str) -> Result<Vec<&'a Table>, RecordingError> {
        let wrong = || self.error(format!("no [[{key}]] table\n  remedy: add one per {key}"));
        let list = self.table.get(key).and_then(Value::as_array);
        let tables: Option<Vec<&Table>> =
            list.filter(|list| !list.is_empty()).and_then(|list| list.iter().map(Value::as_table).collect());
        tables.ok_or_else(wrong)
    }

    /// The tables of `[[above.key]]` below this one, which is an `[[above]]`; there may be none.
    pub(super) fn tables_below(&self, above: &str, key: &str) -> Result<Vec<Self>, RecordingError> {
        if !self.has(key) {
            return Ok(Vec::new());
        }
        let named = |(index, table): (usize, &'a Table)| {
            Keys::new(
                self.file,
                format!("{}, {}", self.name, label(&format!("{above}.{key}"), index, table.get("file"))),
                table,
            )
        };
        Ok(self.tables(key)?.into_iter().enumerate().map(named).collect())
    }

    /// The keys that are not among `known`.
    pub(super) fn others(&self, known: &[&str]) -> Vec<&'a str> {
        let keys = self.table.keys().map(String::as_str);
        keys.filter(|key| !known.contains(key)).collect()
    }
}

/// `[[run]] 2 ("sine.csv")`: the number counts from 1.
pub(super) fn label(kind: &str, index: usize, name: Option<&Value>) -> String {
    let name = name.map_or(String::new(), |name| format!(" ({name})"));
    format!("[[{kind}]] {}{name}", index + 1)
}
