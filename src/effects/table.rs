//! An effect as a table of a scene file.

use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::{Element, ElementKind, Entry, EntryId, catalogue, names};
use crate::laws::LawTable;

/// `[[effect]]`: name, element, for a sensor its channel, and the law's numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EffectTable {
    /// Name in the catalogue (`smam effects`).
    #[schemars(schema_with = "name_schema")]
    pub name: String,
    /// What has it: `muscle`, `cable_2`.
    pub element: String,
    /// Column of the sensor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    /// Whatever else stands in the table; must be the law's parameters.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, f64>,
}

fn name_schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": names() })
}

/// What is wrong with an [`EffectTable`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct EffectError {
    pub message: String,
    pub remedy: String,
}

/// An effect with its numbers, ready for the equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Effect<D> {
    /// What it is, of the catalogue or written down.
    pub entry: EntryId,
    pub element: Element,
    /// Column of the sensor.
    pub channel: Option<String>,
    /// In the order of the catalogue's parameters.
    pub values: Vec<D>,
}

impl Effect<f64> {
    /// The same with numbers of another kind.
    #[doc(hidden)]
    pub fn lift<T>(&self, number: impl Fn(f64) -> T) -> Effect<T> {
        Effect {
            entry: self.entry,
            element: self.element,
            channel: self.channel.clone(),
            values: self.values.iter().map(|x| number(*x)).collect(),
        }
    }

    /// As a law of a scene file, if it is one that was written down.
    pub fn law_table(&self) -> Option<LawTable> {
        Some(self.entry.unlisted()?.table_with(&self.values))
    }

    /// As a table of a scene file; one that was written down is a law ([`Effect::law_table`]).
    pub fn table(&self) -> EffectTable {
        let entry = self.entry.entry();
        EffectTable {
            name: entry.name.clone(),
            element: self.element.to_string(),
            channel: self.channel.clone(),
            parameters: entry.parameters.iter().zip(&self.values).map(|(p, v)| (p.key.clone(), *v)).collect(),
        }
    }
}

fn refuse(message: String, remedy: impl Into<String>) -> EffectError {
    EffectError { message, remedy: remedy.into() }
}

impl EffectTable {
    /// Looks the law up and checks element and numbers.
    ///
    /// ```
    /// use smam::effects::{EffectTable, find};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let table: EffectTable = toml::from_str("name = 'trapped_air'\nelement = 'line_2'\nfree_volume_m3 = 1e-9")?;
    /// let air = table.effect()?;
    /// assert_eq!((Some(air.entry), air.element.index), (find("trapped_air"), 1));
    /// // The polytropic exponent is isothermal unless it is given.
    /// assert_eq!(air.values, [1e-9, 1.0]);
    /// assert_eq!(air.table().effect()?, air);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Unknown name, element, key; a number missing or out of range; a sensor without channel.
    pub fn effect(&self) -> Result<Effect<f64>, EffectError> {
        let entry = self.entry()?;
        let element = Element::parse(&self.element).filter(|e| is_element_of(&entry, e.kind)).ok_or_else(|| {
            refuse(
                format!("element = \"{}\" cannot have {}", self.element, self.name),
                format!("write element = \"{}\", with its number where there are two of them", entry.element.name()),
            )
        })?;
        if (element.kind == ElementKind::Sensor) != self.channel.is_some() {
            return Err(match self.channel {
                None => refuse("channel is missing".to_owned(), "name the output column: channel = \"angle_deg\""),
                Some(_) => refuse("channel = ... is for sensors only".to_owned(), "remove it"),
            });
        }
        let keys: Vec<&str> = entry.parameters.iter().map(|p| p.key.as_str()).collect();
        if let Some(odd) = self.parameters.keys().find(|k| !keys.contains(&k.as_str())) {
            return Err(refuse(
                format!("key `{odd}` is unknown to {}", self.name),
                format!("its parameters are {}", keys.join(", ")),
            ));
        }
        let values = entry.parameters.iter().map(|p| self.value(p)).collect::<Result<_, _>>()?;
        Ok(Effect { entry, element, channel: self.channel.clone(), values })
    }

    /// The law of this name; where two share it, the one whose first parameter is given.
    fn entry(&self) -> Result<EntryId, EffectError> {
        let mut named = catalogue().filter(|entry| entry.name == self.name);
        let given = |entry: &EntryId| self.parameters.contains_key(&entry.parameters[0].key);
        named.clone().find(given).or(named.next()).ok_or_else(|| {
            refuse(format!("name = \"{}\" is no effect", self.name), format!("the effects are {}", names().join(", ")))
        })
    }

    fn value(&self, p: &super::ParameterSpec) -> Result<f64, EffectError> {
        let value = self.parameters.get(&p.key).copied().or(p.default).ok_or_else(|| {
            refuse(format!("key `{}` is missing", p.key), format!("give it a number, for example {:?}", p.typical))
        })?;
        if value >= p.range.min && value <= p.range.max {
            return Ok(value);
        }
        Err(refuse(
            format!("{} = {value} is out of range", p.key),
            format!("use {:?} to {:?} (SI units)", p.range.min, p.range.max),
        ))
    }
}

/// Where an effect may sit.
fn is_element_of(entry: &Entry, kind: ElementKind) -> bool {
    entry.element == kind || entry.also_on == Some(kind)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Effect<f64>, EffectError> {
        toml::from_str::<EffectTable>(text).expect("TOML").effect()
    }

    #[test]
    fn tables_go_there_and_back() {
        let air = parsed("name = \"trapped_air\"\nelement = \"line_2\"\nfree_volume_m3 = 1e-9").expect("right");
        assert_eq!((&*air.entry.id, air.element.index, air.values.as_slice()), ("trapped_air", 1, &[1e-9, 1.0][..]));
        assert_eq!(air.table().effect(), Ok(air));
        let delay = parsed("name = \"sensor_lag\"\nelement = \"sensor\"\nchannel = \"angle_deg\"\ndelay_s = 0.02");
        assert_eq!(delay.expect("right").entry.id, "sensor_delay");
    }

    #[test]
    fn errors_name_key_and_remedy() {
        let cases = [
            ("name = \"air\"\nelement = \"line\"", "is no effect", "trapped_air"),
            ("name = \"leak\"\nelement = \"muscle\"\nconductance_m3_s_pa = 0", "cannot have leak", "\"line\""),
            ("name = \"leak\"\nelement = \"line\"", "conductance_m3_s_pa", "number"),
            ("name = \"leak\"\nelement = \"line\"\nconductance_m3_s_pa = -1", "out of range", "0 to"),
            ("name = \"leak\"\nelement = \"line\"\nconductance_m3_s_pa = 0\nx = 1", "`x` is unknown", "parameters are"),
            ("name = \"sensor_gain\"\nelement = \"sensor\"\ngain_error = 0", "channel is missing", "output column"),
        ];
        for (text, message, remedy) in cases {
            let error = parsed(text).expect_err(text);
            assert!(error.message.contains(message) && error.remedy.contains(remedy), "{text}: {error:?}");
        }
    }
}
