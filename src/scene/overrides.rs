//! Changing a scene by key: `--set`, known conditions of a run, calibrated parameters.

use std::borrow::Cow;

use toml::{Table, Value};

use super::SceneError;
use super::differs::DIFFERS;
use crate::laws::LawTable;
use crate::nearest::did_you_mean;

/// Short names of the calibrated parameters and the scene keys they stand for.
const CALIBRATION_NAMES: [(&str, &str); 5] = [
    ("tube_c1_pa", "muscles.tube.material.c1_pa"),
    ("upstream_compliance_m3_pa", "hydraulics.upstream_compliance_m3_pa"),
    ("friction_m0_n", "muscles.friction.m0_n"),
    ("friction_m1_n_pa", "muscles.friction.m1_n_pa"),
    ("presliding_length_m", "muscles.friction.presliding_length_m"),
];

/// The scene key that a short name stands for; any other key is itself.
///
/// ```
/// use smam::scene::calibration_key;
///
/// assert_eq!(calibration_key("tube_c1_pa"), "muscles.tube.material.c1_pa");
/// assert_eq!(calibration_key("law.breakaway.a"), "law.breakaway.parameter.a.value");
/// assert_eq!(calibration_key("muscles.rest_length_m"), "muscles.rest_length_m");
/// ```
pub fn calibration_key(name: &str) -> Cow<'_, str> {
    match CALIBRATION_NAMES.iter().find(|(short, _)| *short == name) {
        Some((_, key)) => Cow::Borrowed(key),
        None => law_parameter(name).map_or(Cow::Borrowed(name), Cow::Owned),
    }
}

/// Keys of a law's own table: what else stands behind its name is a parameter.
const LAW_KEYS: [&str; 8] = ["name", "port", "adds", "scales", "when", "candidate", "parameter", "state"];

/// `law.NAME.PARAMETER` stands for `law.NAME.parameter.PARAMETER.value`.
fn law_parameter(key: &str) -> Option<String> {
    let (name, parameter) = key.strip_prefix("law.")?.split_once('.')?;
    let parameter = parameter.strip_prefix("parameter.").unwrap_or(parameter);
    let is_short = !parameter.contains('.') && !LAW_KEYS.contains(&parameter);
    is_short.then(|| format!("law.{name}.parameter.{parameter}.value"))
}

/// The names that stand for calibrated keys.
pub(super) fn calibration_names<'a>() -> impl Iterator<Item = &'a str> {
    CALIBRATION_NAMES.iter().map(|(name, _)| *name)
}

/// One changed key.
///
/// ```
/// use smam::scene::Override;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// assert_eq!(Override::parse("muscles.friction.m0_n = 0.2")?, Override::number("muscles.friction.m0_n", 0.2));
/// // A bare word is a text.
/// assert_eq!(Override::parse("muscles.tube.wall=unilateral")?.value.as_str(), Some("unilateral"));
/// assert!(Override::parse("muscles.friction.m0_n").is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Override {
    pub key: String,
    pub value: Value,
}

impl Override {
    /// Reads `key=value`; the value is TOML, or a bare word taken as text.
    pub fn parse(text: &str) -> Result<Self, SceneError> {
        let refuse = |message: &str| SceneError::Override {
            key: text.to_owned(),
            message: message.to_owned(),
            remedy: "write it as --set table.key=value, for example --set muscles.pre_elongation_ratio=0.6".to_owned(),
        };
        let (key, value) = text.split_once('=').ok_or_else(|| refuse("there is no `=`"))?;
        let (key, value) = (key.trim(), value.trim());
        if key.is_empty() || value.is_empty() {
            return Err(refuse("key or value is empty"));
        }
        let parsed = format!("x = {value}").parse::<Table>().ok().and_then(|mut t| t.remove("x"));
        Ok(Self { key: key.to_owned(), value: parsed.unwrap_or_else(|| Value::String(value.to_owned())) })
    }

    /// A number for a key.
    pub fn number(key: impl Into<String>, value: f64) -> Self {
        Self { key: key.into(), value: Value::Float(value) }
    }

    /// A whole number for a key: counts take no other.
    pub(crate) fn whole(key: impl Into<String>, value: i64) -> Self {
        Self { key: key.into(), value: Value::Integer(value) }
    }

    /// A law more, by its short form `PORT adds|scales EXPRESSION`.
    ///
    /// ```
    /// use smam::scene::{Override, Scene};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let leak = Override::law("line.outflow adds 1e-16 * pressure_pa", "law_1")?;
    /// assert_eq!(Scene::load("muscle_bench", &[leak])?.laws[0].address.to_string(), "line.outflow");
    /// // As a text it is what `--set` and `set = [...]` of a sweep take.
    /// let same = Override::parse("law.law_1={port=\"line.outflow\", adds=\"1e-16 * pressure_pa\"}")?;
    /// assert_eq!(Scene::load("muscle_bench", &[same])?.laws.len(), 1);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// A text that is no law, with what to write.
    pub fn law(text: &str, name: &str) -> Result<Self, SceneError> {
        let refuse = |message, remedy| SceneError::Law { text: text.to_owned(), message, remedy };
        let law = LawTable::parse(text, name).map_err(|(_, remedy)| refuse("this is no law".to_owned(), remedy))?;
        let texts = [("port", Some(law.port)), ("adds", law.adds), ("scales", law.scales)];
        let table = texts.into_iter().filter_map(|(key, text)| Some((key.to_owned(), Value::String(text?))));
        Ok(Self { key: format!("law.{name}"), value: Value::Table(table.collect()) })
    }

    /// `KEY=VALUE`, as [`Self::parse`] reads it.
    pub fn text(&self) -> String {
        format!("{}={}", self.key, self.value)
    }

    /// Name and table of the law that it adds to a scene, if it does.
    pub(super) fn added_law(&self) -> Option<(&str, &Table)> {
        let name = self.key.strip_prefix("law.").filter(|name| !name.contains('.'))?;
        Some((name, self.value.as_table()?))
    }

    /// Puts the value into the scene's table. In lists of tables a segment is an index, a `name`, or a `channel`; a table under
    /// `law.NAME` is a law more.
    pub fn apply(&self, scene: &mut Table) -> Result<(), SceneError> {
        if let Some((name, law)) = self.added_law() {
            return add_law(scene, name, law);
        }
        let mut root = Value::Table(std::mem::take(scene));
        let result = self.put(&mut root).map_err(|error| nearest_of_all(error, &root));
        if let Value::Table(table) = root {
            *scene = table;
        }
        result
    }

    fn put(&self, root: &mut Value) -> Result<(), SceneError> {
        let key = calibration_key(&self.key);
        let path: Vec<&str> = key.split('.').collect();
        let deeper = if child_at(root, path[0]).is_none() { path_to(root, path[0]) } else { None };
        let missing = |depth: usize, known: &[String]| {
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            let meant = match &deeper {
                Some(whole) => format!(", did you mean \"{}\"?", [&[whole.as_str()], &path[1..]].concat().join(".")),
                None => did_you_mean(path[depth], &known),
            };
            SceneError::Override {
                key: self.key.clone(),
                message: format!("there is no `{}` in the scene{meant}", path[..=depth].join(".")),
                remedy: "`smam check SCENE --keys` lists the keys of the scene".to_owned(),
            }
        };
        let last = path.len() - 1;
        let mut here = root;
        // What is one muscle's own need not stand there yet.
        let own = path.iter().position(|segment| *segment == DIFFERS).filter(|_| path[0] == "muscle").unwrap_or(last);
        for (depth, segment) in path[..last].iter().enumerate() {
            if let (true, Some(table)) = (depth >= own, here.as_table_mut()) {
                table.entry(*segment).or_insert_with(|| Value::Table(Table::new()));
            }
            let known = names(here);
            here = child(here, segment).ok_or_else(|| missing(depth, &known))?;
        }
        if let Some(slot) = child(here, path[last]) {
            *slot = coerced(&self.value, slot);
            return Ok(());
        }
        // Keys with a default need not stand in the file; a wrong name is refused when the scene is read.
        let table = here.as_table_mut().ok_or_else(|| missing(last, &[]))?;
        table.insert(path[last].to_owned(), self.value.clone());
        Ok(())
    }
}

fn add_law(scene: &mut Table, name: &str, law: &Table) -> Result<(), SceneError> {
    let mut law = law.clone();
    law.insert("name".to_owned(), Value::String(name.to_owned()));
    match scene.entry("law").or_insert_with(|| Value::Array(Vec::new())) {
        Value::Array(laws) => {
            laws.push(Value::Table(law));
            Ok(())
        }
        _ => Err(SceneError::Override {
            key: format!("law.{name}"),
            message: "`law` is no list of tables in the scene".to_owned(),
            remedy: "write the scene's laws as [[law]]".to_owned(),
        }),
    }
}

/// An integer given where the scene has a float is that float.
pub(super) fn coerced(value: &Value, old: &Value) -> Value {
    match (value, old) {
        (Value::Integer(i), Value::Float(_)) => Value::Float(*i as f64),
        _ => value.clone(),
    }
}

/// What an entry of a list is called: its name, or the channel that it is about.
pub(super) fn entry_name(entry: &Value) -> Option<&str> {
    entry.get("name").or_else(|| entry.get("channel"))?.as_str()
}

/// What there is under a value: keys of a table, names of a list's entries.
fn names(value: &Value) -> Vec<String> {
    match value {
        Value::Table(table) => table.keys().cloned().collect(),
        Value::Array(list) => list.iter().filter_map(entry_name).map(str::to_owned).collect(),
        _ => Vec::new(),
    }
}

/// What stands under a segment of a key; of a list the entry of this name or index.
pub(super) fn child<'a>(value: &'a mut Value, segment: &str) -> Option<&'a mut Value> {
    match value {
        Value::Table(table) => table.get_mut(segment),
        Value::Array(list) => {
            let named = list.iter().position(|item| entry_name(item) == Some(segment));
            list.get_mut(named.or_else(|| segment.parse().ok())?)
        }
        _ => None,
    }
}

/// As [`child`], to be looked at.
pub(super) fn child_at<'a>(value: &'a Value, segment: &str) -> Option<&'a Value> {
    match value {
        Value::Table(table) => table.get(segment),
        Value::Array(list) => {
            let named = list.iter().find(|item| entry_name(item) == Some(segment));
            named.or_else(|| list.get(segment.parse::<usize>().ok()?))
        }
        _ => None,
    }
}

/// The error with the nearest of all keys, where nothing near stands at its own place.
fn nearest_of_all(error: SceneError, root: &Value) -> SceneError {
    match error {
        SceneError::Override { key, message, remedy } if !message.contains("did you mean") => {
            let keys = leaves(root);
            let meant = did_you_mean(&key, &keys.iter().map(String::as_str).collect::<Vec<_>>());
            SceneError::Override { message: message + &meant, key, remedy }
        }
        other => other,
    }
}

/// The keys of all values below tables, lists apart.
fn leaves(value: &Value) -> Vec<String> {
    let Value::Table(table) = value else { return Vec::new() };
    let of = |(key, below): (&String, &Value)| match below {
        Value::Table(_) => leaves(below).into_iter().map(|leaf| format!("{key}.{leaf}")).collect(),
        Value::Array(_) => Vec::new(),
        _ => vec![key.clone()],
    };
    table.iter().flat_map(of).collect()
}

/// The way down to the first table of this name, if there is one within tables.
fn path_to(value: &Value, name: &str) -> Option<String> {
    let table = value.as_table()?;
    if table.get(name).is_some_and(Value::is_table) {
        return Some(name.to_owned());
    }
    table.iter().find_map(|(key, below)| Some(format!("{key}.{}", path_to(below, name)?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_nested_keys_and_named_entries() {
        let mut scene: Table = "[a]\nb = 1.5\n[[cable]]\nname = 'x'\nk = 1.0\n[[input]]\nchannel = 'u_mm'\nk = 1.0"
            .parse()
            .expect("test TOML");
        for text in ["a.b=2", "cable.x.k=3", "input.u_mm.k=4", "a.word=held"] {
            Override::parse(text).and_then(|o| o.apply(&mut scene)).expect("valid");
        }
        assert_eq!(scene["a"]["b"], Value::Float(2.0));
        assert_eq!(scene["cable"][0]["k"], Value::Float(3.0));
        assert_eq!(scene["input"][0]["k"], Value::Float(4.0));
        assert_eq!(scene["a"]["word"].as_str(), Some("held"));
    }

    #[test]
    fn a_law_is_added_whatever_the_scene_has() {
        let mut scene: Table = "[[law]]\nname = 'own'\nport = 'line.outflow'\nadds = '0'".parse().expect("test TOML");
        let short = Override::law("muscle.friction scales 1.5", "law_1").expect("a law");
        assert_eq!(Override::parse(&short.text()).expect("its own text"), short);
        short.apply(&mut scene).expect("a list of laws");
        assert_eq!(scene["law"][1]["name"].as_str(), Some("law_1"));
        let changed = Override::parse("law.law_1.scales='2'").expect("a key");
        changed.apply(&mut scene).expect("the law is there");
        assert_eq!(scene["law"][1]["scales"].as_str(), Some("2"));
        let error = Override::law("muscle.friction 1.5", "law_1").expect_err("no law").to_string();
        assert!(error.starts_with("--law 'muscle.friction 1.5': this is no law\n  remedy: write PORT adds"), "{error}");
    }

    #[test]
    fn a_missing_table_is_named() {
        let mut scene: Table = "[a]\nb = 1.5".parse().expect("test TOML");
        let error = Override::number("c.d", 1.0).apply(&mut scene).expect_err("no table c");
        assert!(error.to_string().starts_with("--set c.d: there is no `c` in the scene"), "{error}");
        let mut deep: Table = "[a.c]\nd = 1.5".parse().expect("test TOML");
        let error = Override::number("c.d", 1.0).apply(&mut deep).expect_err("no table c").to_string();
        assert!(error.starts_with("--set c.d: there is no `c` in the scene, did you mean \"a.c.d\"?\n"), "{error}");
        let mut rig: Table = "[muscles.friction]\nm0_n = 0.1\n[[muscle]]\nname = 'muscle'".parse().expect("test TOML");
        let error = Override::number("muscle.friction.m0", 0.2).apply(&mut rig).expect_err("no such table").to_string();
        assert!(error.contains("did you mean \"muscles.friction.m0_n\"?"), "{error}");
        Override::number("muscles.friction.m0_n", 0.2).apply(&mut rig).expect("what was proposed");
    }
}
