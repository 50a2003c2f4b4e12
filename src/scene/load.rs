//! Finding, reading and validating scenes.

use std::path::{Path, PathBuf};

use toml::Table;

use crate::laws::Law;
use crate::nearest::did_you_mean;
use crate::stock;

use super::check_laws::{Candidate, SceneLaws};
use super::from_table::from_table;
use super::overrides::{Override, calibration_key, child_at, entry_name};
use super::{CalibrateSpec, MusclesSpec, Program, SceneError, SceneFile, check, check_keys, check_laws, differs};

/// A scene whose keys, numbers and names (within the file) are right.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Where it came from; paths in it are relative to this file's folder.
    pub path: PathBuf,
    pub file: SceneFile,
    /// Programme of each input, in the order of `file.input`.
    pub programs: Vec<Program>,
    /// What each muscle is made like: `[muscles]` with what differs.
    pub makes: Vec<MusclesSpec>,
    /// The laws of `file.law` that are part of the scene, ready for the equations; candidates are not.
    pub laws: Vec<Law>,
    /// Those that are: a diagnosis weighs them.
    pub candidates: Vec<Candidate>,
    /// `[[calibrate]]` as it stands in the file; in `file.calibrate` what each muscle has of its own is written out.
    pub(super) declared_calibrate: Vec<CalibrateSpec>,
}

impl Scene {
    /// Reads a scene by path or stock name and applies `overrides` in order.
    ///
    /// What is wrong is said by table, key and value:
    ///
    /// ```
    /// use smam::scene::{Override, Scene};
    ///
    /// let refused = |name: &str, changed: &[Override]| Scene::load(name, changed).err().map(|e| e.to_string());
    /// let message = refused("muscle_bnch", &[]).unwrap_or_default();
    /// assert!(message.contains("did you mean \"muscle_bench\"?"));
    /// let negative = Override::number("muscles.damping_n_s_m", -0.1);
    /// let message = refused("muscle_bench", &[negative]).unwrap_or_default();
    /// assert!(message.contains("[muscles]: damping_n_s_m = -0.1 must be >= 0"));
    /// ```
    pub fn load(path_or_name: &str, overrides: &[Override]) -> Result<Self, SceneError> {
        let path = find_scene(path_or_name)?;
        let text = stock::read_text(&path).map_err(|source| unreadable(&path, source))?;
        Self::parse(&text, &path, overrides)
    }

    /// Reads a scene from text; `path` is where it stands.
    ///
    /// ```
    /// use smam::{scene::Scene, stock};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let path = stock::builtin("scenes/muscle_bench.toml").ok_or("it is carried")?;
    /// let text = stock::read_text(&path)?.replace("stroke_m = 3.0e-3", "stroke_m = 1.5e-3");
    /// let scene = Scene::parse(&text, &path, &[])?;
    /// // Half a period of 0.1 Hz: the whole stroke.
    /// assert!((scene.programs[0].value(5.0) - 1.5e-3).abs() < 1e-12);
    /// # Ok(())
    /// # }
    /// ```
    pub fn parse(text: &str, path: &Path, overrides: &[Override]) -> Result<Self, SceneError> {
        let syntax = |message: String| SceneError::Syntax { file: path.to_owned(), message };
        // Straight from the text first: its errors carry line and column, those of a changed table cannot.
        let direct: Result<SceneFile, _> = serde_path_to_error::deserialize(
            toml::Deserializer::parse(text).map_err(|e| syntax(e.to_string().trim_end().to_owned()))?,
        );
        let file = match direct {
            Ok(file) if overrides.is_empty() => file,
            Err(e) => return Err(syntax(place(e.path(), e.inner().to_string().trim_end()))),
            Ok(_) => {
                let mut table: Table = text.parse().map_err(|e: toml::de::Error| syntax(e.to_string()))?;
                overrides.iter().try_for_each(|o| o.apply(&mut table))?;
                from_table(&table).map_err(|misread| SceneError::Override {
                    key: misread.key,
                    message: misread.message,
                    remedy: "`smam check SCENE --keys` lists the keys of the scene".to_owned(),
                })?
            }
        };
        Self::from_file(file, path).map_err(|e| of_added_law(e, overrides))
    }

    /// Validates a scene file; `path` is where its relative paths start.
    pub fn from_file(mut file: SceneFile, path: &Path) -> Result<Self, SceneError> {
        let programs = check::check(&file, path)?;
        let makes = differs::makes(&file, path)?;
        let declared_calibrate = std::mem::take(&mut file.calibrate);
        file.calibrate = differs::written_out(&file, &declared_calibrate, path)?;
        let SceneLaws { laws, candidates } = check_laws::check(&file, path)?;
        let scene = Self { path: path.to_owned(), file, programs, makes, laws, candidates, declared_calibrate };
        check_keys::check(&scene)?;
        Ok(scene)
    }

    /// The scene as its file has it, with defaults; the indices of its lists are those that `--set` takes.
    fn as_declared(&self) -> Option<toml::Value> {
        let file = SceneFile { calibrate: self.declared_calibrate.clone(), ..self.file.clone() };
        toml::Value::try_from(&file).ok()
    }

    /// Every number, word and list of the scene by the key that `--set` takes, defaults included.
    pub fn keys(&self) -> Vec<(String, String)> {
        let mut keys = Vec::new();
        if let Some(value) = self.as_declared() {
            list_keys("", &value, &mut keys);
        }
        keys
    }

    /// The value that stands at a key, as [`Self::keys`] writes it; entries of a list also by their index.
    pub fn value(&self, key: &str) -> Option<String> {
        let value = self.as_declared()?;
        let here = key.split('.').try_fold(&value, |here, segment| child_at(here, segment))?;
        (!here.is_table()).then(|| here.to_string())
    }

    /// The number that stands at a key, or at that of a calibration name.
    ///
    /// ```
    /// use smam::scene::Scene;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let scene = Scene::load("tendon_sheath", &[])?;
    /// assert!(scene.number("mechanism.joint.0.stiffness_n_m_rad").is_some());
    /// assert_eq!(scene.number("name"), None);
    /// # Ok(())
    /// # }
    /// ```
    pub fn number(&self, key: &str) -> Option<f64> {
        let key = calibration_key(key);
        let own = self.value(&key);
        // What does not differ is what all muscles have.
        let common = || differs::parts(&key).and_then(|(_, common)| self.value(&format!("muscles.{common}")));
        own.or_else(common)?.parse().ok()
    }

    /// Folder that relative paths of the scene start from.
    pub fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new("."))
    }
}

/// What is wrong with a law that did not come from the file is said of where it came from.
fn of_added_law(error: SceneError, overrides: &[Override]) -> SceneError {
    let SceneError::Value { file, table, message, remedy } = error else { return error };
    let is_meant = |name: &str| table.starts_with("[[law]]") && table.ends_with(&format!("\"{name}\""));
    let added = overrides.iter().filter_map(Override::added_law).find(|(name, _)| is_meant(name));
    let Some((name, law)) = added else { return SceneError::Value { file, table, message, remedy } };
    let word = |key: &str| law.get(key).and_then(toml::Value::as_str);
    let short = ["adds", "scales"].iter().find_map(|key| Some(format!("{} {key} {}", word("port")?, word(key)?)));
    match short.filter(|_| law.len() == 2) {
        Some(text) => SceneError::Law { text, message, remedy },
        None => SceneError::Override { key: format!("law.{name}"), message, remedy },
    }
}

/// A file that is there but no text has another remedy than one that is not there.
fn unreadable(path: &Path, source: std::io::Error) -> SceneError {
    let file = path.to_owned();
    match source.kind() {
        std::io::ErrorKind::InvalidData => SceneError::Value {
            file,
            table: "encoding".to_owned(),
            message: "it is not UTF-8 text".to_owned(),
            remedy: "save it as text in UTF-8".to_owned(),
        },
        _ => SceneError::Unreadable { file, source },
    }
}

fn list_keys(prefix: &str, value: &toml::Value, keys: &mut Vec<(String, String)>) {
    let join = |segment: &str| if prefix.is_empty() { segment.to_owned() } else { format!("{prefix}.{segment}") };
    match value {
        toml::Value::Table(table) => table.iter().for_each(|(k, v)| list_keys(&join(k), v, keys)),
        toml::Value::Array(list) if list.iter().any(toml::Value::is_table) => {
            for (i, item) in list.iter().enumerate() {
                let name = entry_name(item).map_or_else(|| i.to_string(), str::to_owned);
                list_keys(&join(&name), item, keys);
            }
        }
        other => keys.push((prefix.to_owned(), other.to_string())),
    }
}

fn place(path: &serde_path_to_error::Path, message: &str) -> String {
    if path.iter().next().is_none() { message.to_owned() } else { format!("{path}: {message}") }
}

/// A path as it is, or a stock scene by name: `scenes/NAME.toml` here if there is one, else the one that the program carries.
pub fn find_scene(path_or_name: &str) -> Result<PathBuf, SceneError> {
    let direct = Path::new(path_or_name);
    if direct.extension().is_some() || direct.is_file() {
        return Ok(direct.to_owned());
    }
    let file = format!("scenes/{path_or_name}.toml");
    let here = Some(PathBuf::from(&file)).filter(|path| path.is_file());
    here.or_else(|| stock::builtin(&file)).ok_or_else(|| match direct.is_dir() {
        true => SceneError::Unreadable { file: direct.to_owned(), source: std::io::ErrorKind::IsADirectory.into() },
        false => SceneError::UnknownName {
            name: path_or_name.to_owned(),
            nearest: did_you_mean(path_or_name, &stock::scenes().collect::<Vec<_>>()),
            known: stock::scenes().collect::<Vec<_>>().join(", "),
        },
    })
}
