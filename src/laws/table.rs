//! A law as a table of a scene file, and as one line.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Acts;

/// `[[law]]`: a port of the rig, and an expression that is added to it or scales it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LawTable {
    /// A word: shown in answers, in the energy balance and in keys (`law.NAME.PARAMETER`).
    pub name: String,
    /// Where it acts: `muscle.friction` for all muscles, `muscle_1.friction` for one (`smam laws` lists the ports).
    pub port: String,
    /// Expression that is added to the port, in the port's unit: `stiffness_n_m * elongation_m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adds: Option<String>,
    /// Expression that the port is multiplied by, without a unit: `1 + a * exp(-abs(speed_m_s) / scale_m_s)`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scales: Option<String>,
    /// The law acts where this expression is not zero: `time_s > 10.0`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub when: Option<String>,
    /// The scene leaves the law out; a diagnosis considers it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub candidate: bool,
    /// Parameters of the expressions by name; the name ends in the unit: `parameter.scale_m_s = { value = 2e-3 }`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub parameter: BTreeMap<String, ParameterTable>,
    /// Memory of the law by name: `state.s = { rate = "(elongation_m - s) / tau_s" }`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub state: BTreeMap<String, StateTable>,
}

/// A parameter of a law; its name ends in its unit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterTable {
    /// In SI units.
    pub value: f64,
    /// Least value that is physical.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Greatest value that is physical.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// Unit, where the name does not end in it: `N s/m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
}

/// Memory of a law. Exactly one of `rate`, `greatest` and `play_of`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StateTable {
    /// Its rate of change, the state's unit per second: a lag `(elongation_m - s) / tau_s`, an integral `flow_m3_s`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<String>,
    /// The greatest value of this expression so far.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub greatest: Option<String>,
    /// Follows this expression with a dead zone of `width` in all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub play_of: Option<String>,
    /// Width of the dead zone of `play_of`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<String>,
    /// Where it starts; 0 for a rate, the expression's first value for the others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
    /// Unit, where neither its name nor `start` tells it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
}

impl LawTable {
    /// Reads the short form: `muscle.damping adds 0.05*tanh(speed_m_s/2e-3)`.
    ///
    /// ```
    /// use smam::laws::LawTable;
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let law = LawTable::parse("line.outflow adds 1e-17 * pressure_pa", "mine").map_err(|(message, _)| message)?;
    /// assert_eq!((law.port.as_str(), law.adds.as_deref()), ("line.outflow", Some("1e-17 * pressure_pa")));
    /// assert!(LawTable::parse("line.outflow 1e-17", "mine").is_err());
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// A text without port, `adds` or `scales`, and expression; with what to write.
    pub fn parse(text: &str, name: &str) -> Result<Self, (String, String)> {
        let parts = [Acts::Adds, Acts::Scales].into_iter().filter_map(|acts| split_at(text, acts));
        let Some((port, acts, law)) = parts.min_by_key(|(port, ..)| port.len()) else {
            return Err((
                format!("\"{text}\" is no law"),
                "write PORT adds EXPRESSION or PORT scales EXPRESSION, for example \
                 'muscle.damping adds 0.05*tanh(speed_m_s/2e-3)'"
                    .to_owned(),
            ));
        };
        let own = |wanted: Acts| (acts == wanted).then(|| law.to_owned());
        let (adds, scales) = (own(Acts::Adds), own(Acts::Scales));
        Ok(Self { name: name.to_owned(), port: port.to_owned(), adds, scales, ..Self::default() })
    }
}

/// Port, verb and expression of `PORT VERB EXPRESSION`.
fn split_at(text: &str, acts: Acts) -> Option<(&str, Acts, &str)> {
    let text = text.trim();
    let parts = text.match_indices(acts.word()).map(|(at, verb)| (&text[..at], &text[at + verb.len()..]));
    let mut apart =
        parts.filter(|(port, law)| port.ends_with(char::is_whitespace) && law.starts_with(char::is_whitespace));
    apart.next().map(|(port, law)| (port.trim(), acts, law.trim()))
}
