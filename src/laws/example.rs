//! Each port's example as a whole law, with numbers that a rig of the stock scenes' size can have.

use std::collections::BTreeMap;

use super::syntax::parse;
use super::{Acts, LawTable, ParameterTable, PortSpec, Variable};

/// Value of each parameter that an example of [`super::PORTS`] uses, SI.
const VALUES: [(&str, f64); 27] = [
    ("a", 0.2),
    ("mu", 0.1),
    ("compliance_m_pa", 1e-10),
    ("conductance_m3_s_pa", 1e-16),
    ("opening_pa", 1e5),
    ("scale_pa", 1e6),
    ("q_pa_s2_m6", 1e18),
    ("volume_m3", 1e-9),
    ("atmosphere_pa", 101_325.0),
    ("stiffness_n_m", 50.0),
    ("taut_m", 1e-3),
    ("ageing_s", 10.0),
    ("preload_n", 0.1),
    ("opening_m", 1e-4),
    ("speed_scale_m_s", 2e-3),
    ("c3_n", 0.05),
    ("growth_1_m", 20.0),
    ("rate_m_s", 1e-6),
    ("slack_m", 1e-4),
    ("scale_m", 1e-3),
    ("torque_n_m", 1e-4),
    ("speed_rad_s", 0.05),
    ("c_n_m_s_rad", 1e-4),
    ("scale_s", 60.0),
    ("friction_n", 3.0),
    ("stribeck_m_s", 2e-3),
    ("rate_1_s", 0.05),
];

impl PortSpec {
    /// The example as a `[[law]]` table that can stand in a scene.
    ///
    /// ```
    /// use smam::laws::{Port, Surroundings};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let table = Port::Friction.spec().example_table();
    /// assert_eq!(table.port, "muscle.friction");
    /// assert_eq!(table.law(&Surroundings::default())?.values(), [0.2, 1e6]);
    /// # Ok(())
    /// # }
    /// ```
    #[doc(hidden)]
    pub fn example_table(&self) -> LawTable {
        let (acts, expression) = self.example;
        let port = self.name().replace("CHANNEL", "angle_deg");
        let mut law = LawTable { name: "my_law".to_owned(), port, ..LawTable::default() };
        let text = Some(expression.to_owned());
        match acts {
            Acts::Adds => law.adds = text,
            Acts::Scales => law.scales = text,
        }
        law.parameter = self.parameters_of(expression);
        law
    }

    /// Every name of an expression that is no variable, as a parameter.
    fn parameters_of(&self, expression: &str) -> BTreeMap<String, ParameterTable> {
        let mut names = Vec::new();
        let mut symbol = |name: &str| {
            if Variable::parse(name, self.variables()).is_none() {
                names.push(name.to_owned());
            }
            Ok(0)
        };
        // An example that cannot be read has no names; a test reads all of them.
        let _ = parse(expression, &mut symbol);
        let value = |name: &str| VALUES.iter().find(|(known, _)| *known == name).map_or(1.0, |(_, value)| *value);
        let named = |name: String| {
            let table = ParameterTable { value: value(&name), ..ParameterTable::default() };
            (name, table)
        };
        names.into_iter().map(named).collect()
    }
}

impl LawTable {
    /// The table as a scene holds it, `[[law]]` included.
    pub fn to_toml(&self) -> String {
        let quoted = |text: &str| toml::Value::from(text).to_string();
        let words = [("name", Some(&self.name)), ("port", Some(&self.port))];
        let texts = [("adds", &self.adds), ("scales", &self.scales), ("when", &self.when)];
        let lines = words.into_iter().chain(texts.map(|(key, text)| (key, text.as_ref())));
        let mut text = "[[law]]\n".to_owned();
        for (key, value) in lines.filter_map(|(key, value)| Some((key, value?))) {
            text += &format!("{key} = {}\n", quoted(value));
        }
        if self.candidate {
            text += "candidate = true\n";
        }
        for (name, parameter) in &self.parameter {
            text += &format!("parameter.{name} = {}\n", inline(parameter));
        }
        for (name, state) in &self.state {
            text += &format!("state.{name} = {}\n", inline(state));
        }
        text
    }
}

/// A small table on one line.
fn inline(table: &impl serde::Serialize) -> String {
    // Numbers and texts alone: this cannot fail.
    let value = toml::Value::try_from(table).unwrap_or(toml::Value::Table(toml::Table::new()));
    value.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::{PORTS, Surroundings};

    #[test]
    fn every_example_is_a_law_that_can_stand_in_a_scene() {
        for spec in &PORTS {
            let table = spec.example_table();
            let unvalued = table.parameter.keys().find(|name| !VALUES.iter().any(|(known, _)| known == name));
            assert_eq!(unvalued, None, "{}: a parameter without a value", spec.name());
            let text = table.to_toml();
            let read: LawTable =
                toml::from_str(&text.replace("[[law]]\n", "")).unwrap_or_else(|e| panic!("{text}: {e}"));
            assert_eq!(read, table, "{text}");
            let law = read.law(&Surroundings::default()).unwrap_or_else(|e| panic!("{text}: {e}"));
            assert_eq!((law.address.port, law.acts), (spec.port, spec.example.0));
        }
    }

    #[test]
    fn values_are_those_of_examples() {
        let used: Vec<String> = PORTS.iter().flat_map(|spec| spec.example_table().parameter.into_keys()).collect();
        for (name, _) in VALUES {
            assert!(used.iter().any(|u| u == name), "{name} stands in no example");
        }
    }

    #[test]
    fn a_law_with_memory_is_written_out() {
        let text = "name = 'lag'\nport = 'muscle_1.pull'\nadds = 'k_n_m * (elongation_m - s)'\nwhen = 'time_s > 1'\n\
                    parameter.k_n_m = { value = 2.0, min = 0.0 }\n\
                    state.s = { rate = '(elongation_m - s) / 0.5', start = 'elongation_m' }";
        let law: LawTable = toml::from_str(text).expect("TOML");
        let again: LawTable = toml::from_str(&law.to_toml().replace("[[law]]\n", "")).expect("its own text");
        assert_eq!(again, law);
    }
}
