//! How an effect is described: one file of `entries/` each, or a law that was written down during a run.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::{ElementKind, Native, WrittenLaw};
use crate::laws::{Acts, ParameterTable, StateTable};

/// Bounds of a parameter, both included.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Range {
    pub min: f64,
    pub max: f64,
}

/// One parameter of an effect.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ParameterSpec {
    /// Key in scenes and answers; ends in the SI unit.
    pub key: String,
    /// Symbol in the equation.
    pub symbol: String,
    /// Outside it nothing physical is meant.
    pub range: Range,
    /// A size that is plain to see on a stock scene: where a fit starts.
    pub typical: f64,
    /// Value when a scene does not give it; `None`: it must be given.
    pub default: Option<f64>,
    /// Whether a diagnosis fits it, or leaves the default.
    #[serde(rename = "fitted")]
    pub is_fitted: bool,
    /// Its name in the text of the law, where the key is that of a variable.
    pub in_law: Option<String>,
}

impl ParameterSpec {
    pub(super) fn name_in_law(&self) -> &str {
        self.in_law.as_ref().unwrap_or(&self.key)
    }
}

/// A part of a scene that an effect acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    Axis,
    Strip,
    Chamber,
    Cable,
    SecondCable,
    /// A cable that an input pulls by itself, without a muscle.
    DrivenCable,
    /// A wall of rubber: muscles that are no linear springs.
    Wall,
    MuscleFriction,
}

/// What a scene must have for the effect, and what is said where it does not.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Need {
    pub scene: Part,
    pub message: String,
    pub remedy: String,
}

/// Levels of a recorded channel at which something could begin.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Levels {
    /// What the channel's name contains, and how it ends.
    #[serde(default)]
    pub column: String,
    pub ending: String,
    /// Shares of the samples that lie below.
    pub shares: Vec<f64>,
}

/// How a diagnosis tries an effect.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Trying {
    /// Values of the second parameter from which fits start; the typical one if there are none.
    pub second: Vec<f64>,
    /// Where these are found in the recordings, if such a channel was recorded.
    pub levels: Option<Levels>,
    /// Whether equal elements have it in common when one has it (material, make, surface): it is tried on all at once as well.
    pub shared: bool,
    /// Whether the surroundings set it: it may be another in every run.
    pub of_the_day: bool,
    /// It is not tried where a calibrated key contains this.
    pub unless_calibrated: Option<String>,
    /// It is tried on joints that are flexures only.
    pub needs_flexures: bool,
    /// It goes by rate or by time: recordings whose rows have no clock cannot show it.
    pub needs_clock: bool,
}

/// An effect: of the catalogue, or a law that was written down.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Entry {
    /// Name of its file; the catalogue has several laws under one `name`.
    #[serde(skip)]
    pub id: String,
    pub name: String,
    /// One line: what it is.
    pub title: String,
    pub element: ElementKind,
    /// Another kind of element that may have it.
    pub also_on: Option<ElementKind>,
    /// The element that stands alone (`[strip]`, `[chamber]`) and can have it.
    pub stands_on: Option<Part>,
    /// Port in the words of laws, what it does there, and the variables that it depends on.
    pub port: String,
    #[serde(default = "adds")]
    pub acts: Acts,
    #[serde(default)]
    pub variables: Vec<String>,
    /// Whether what it does depends on what was before: an effect whose text has states does.
    #[serde(default)]
    pub remembers: bool,
    /// The law as readers see it, and where it is from.
    pub equation: String,
    pub source: String,
    /// Whether one element may have it several times: relaxation has a spectrum, a polynomial several terms.
    #[serde(default)]
    pub may_repeat: bool,
    /// Whether it stands for physics nobody has named: never a candidate by itself.
    #[serde(default)]
    pub hypothetical: bool,
    /// The first is the size: at zero the effect is absent.
    #[serde(rename = "parameter")]
    pub parameters: Vec<ParameterSpec>,
    #[serde(default)]
    pub needs: Vec<Need>,
    #[serde(default, rename = "diagnosis")]
    pub trying: Trying,
    /// Its code, or the text of its law with the law's memory.
    pub native: Option<Native>,
    pub(super) adds: Option<String>,
    pub(super) scales: Option<String>,
    #[serde(default, rename = "state")]
    pub(super) states: BTreeMap<String, StateTable>,
    /// The text, compiled.
    #[serde(skip)]
    pub law: Option<WrittenLaw>,
    /// Whether it is of the catalogue.
    #[serde(skip)]
    pub is_listed: bool,
}

fn adds() -> Acts {
    Acts::Adds
}

impl Entry {
    /// Reads the file of an entry and compiles its law.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub(super) fn read(id: &str, text: &str) -> Result<Self, String> {
        let mut entry: Self = toml::from_str(text).map_err(|e| e.to_string())?;
        (entry.id, entry.is_listed) = (id.to_owned(), true);
        if entry.parameters.is_empty() {
            return Err("it has no [[parameter]]: the first is its size".to_owned());
        }
        match (entry.native, &entry.adds, &entry.scales) {
            (Some(_), None, None) => return Ok(entry),
            (None, ..) => {}
            _ => return Err("native stands beside adds or scales: keep one".to_owned()),
        }
        let law = WrittenLaw::of_entry(&entry)?;
        entry.acts = law.law.acts;
        entry.remembers = !law.law.states.is_empty();
        if entry.variables.is_empty() {
            entry.variables = law.law.variables().iter().map(|v| v.name()).collect();
        }
        entry.law = Some(law);
        Ok(entry)
    }

    /// Its law, if it is none of the catalogue but was written down: in a scene, or by a diagnosis.
    #[doc(hidden)]
    pub fn unlisted(&self) -> Option<&WrittenLaw> {
        self.law.as_ref().filter(|_| !self.is_listed)
    }

    /// The parameter of a key.
    pub fn parameter(&self, key: &str) -> Option<&ParameterSpec> {
        self.parameters.iter().find(|p| p.key == key)
    }

    /// Values of all parameters where a fit starts.
    pub fn typical(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| if p.is_fitted { p.typical } else { p.default.unwrap_or(p.typical) }).collect()
    }

    /// Its parameters as those of a law.
    pub(super) fn law_parameters(&self) -> BTreeMap<String, ParameterTable> {
        let table = |p: &ParameterSpec| ParameterTable { value: p.typical, ..ParameterTable::default() };
        self.parameters.iter().map(|p| (p.name_in_law().to_owned(), table(p))).collect()
    }
}
