//! Laws that are text: those of the catalogue, those that a scene declares as candidates, and those that a diagnosis makes up.

use super::{Element, ElementKind, Entry, EntryId, ParameterSpec, Range, entry::Trying};
use crate::laws::{Law, LawTable, Surroundings};

/// A law with the order that its parameters have in an effect.
#[derive(Debug)]
pub struct WrittenLaw {
    pub law: Law,
    pub table: LawTable,
    /// Of each parameter of the effect: which of the law's it is. The first is the size.
    order: Vec<usize>,
}

/// What a parameter of a law is as one of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    pub typical: f64,
    pub range: Range,
    pub is_fitted: bool,
}

impl WrittenLaw {
    /// The text of an entry's file, compiled.
    pub(super) fn of_entry(entry: &Entry) -> Result<Self, String> {
        let table = LawTable {
            name: entry.id.clone(),
            port: entry.port.clone(),
            adds: entry.adds.clone(),
            scales: entry.scales.clone(),
            parameter: entry.law_parameters(),
            state: entry.states.clone(),
            ..LawTable::default()
        };
        let mut law = table.law(&Surroundings::default()).map_err(|e| format!("{}; {}", e.message, e.remedy))?;
        law.energy = Some(format!("{}_work", entry.id));
        let order = entry.parameters.iter().filter_map(|p| law.parameter(p.name_in_law())).collect();
        Ok(Self { law, table, order })
    }

    /// The law at an element of an effect: at one of several, or at all.
    pub fn at(&self, element: Element) -> Law {
        let mut law = self.law.clone();
        let is_own = element.is_numbered && law.address.number.is_none();
        law.address.number = if is_own { Some(element.index) } else { law.address.number };
        law
    }

    /// Values of the law's parameters from those of an effect.
    pub fn values<D: Copy>(&self, of_effect: &[D]) -> Vec<D> {
        let place = |parameter: usize| self.order.iter().position(|&i| i == parameter).unwrap_or(0);
        (0..self.order.len()).map(|i| of_effect[place(i)]).collect()
    }

    /// As a table of a scene, with the values of an effect.
    pub(crate) fn table_with(&self, of_effect: &[f64]) -> LawTable {
        let mut table = LawTable { candidate: false, ..self.table.clone() };
        for (parameter, value) in self.law.parameters.iter().zip(self.values(of_effect)) {
            if let Some(own) = table.parameter.get_mut(&parameter.name) {
                own.value = value;
            }
        }
        table
    }
}

impl EntryId {
    /// Writes a law down as an entry; `size` is the parameter at whose zero it is absent, `numbers` describes each parameter.
    ///
    /// One that was written before, with the same numbers, keeps its place.
    pub fn write(table: &LawTable, law: &Law, size: usize, numbers: &[Fitted]) -> Self {
        let is_same = |entry: &Entry| {
            let parameters = entry.parameters.iter();
            entry.unlisted().is_some_and(|known| {
                known.table == *table && known.order.first() == Some(&size) && {
                    known.order.iter().zip(parameters).all(|(&i, p)| {
                        numbers[i] == Fitted { typical: p.typical, range: p.range, is_fitted: p.is_fitted }
                    })
                }
            })
        };
        Self::known_or(is_same, || entry_of(table, law, size, numbers))
    }
}

fn entry_of(table: &LawTable, law: &Law, size: usize, numbers: &[Fitted]) -> Entry {
    let others = (0..law.parameters.len()).filter(|i| *i != size);
    let order: Vec<usize> = std::iter::once(size).chain(others).collect();
    let parameters = order.iter().map(|&i| {
        let (key, own) = (law.parameters[i].name.clone(), numbers[i]);
        let default = (!own.is_fitted).then_some(own.typical);
        ParameterSpec {
            symbol: key.clone(),
            key,
            range: own.range,
            typical: own.typical,
            default,
            is_fitted: own.is_fitted,
            in_law: None,
        }
    });
    Entry {
        id: law.name.clone(),
        name: law.name.clone(),
        title: law.text(),
        element: element(law),
        also_on: None,
        stands_on: None,
        port: law.address.to_string(),
        acts: law.acts,
        variables: law.variables().iter().map(|v| v.name()).collect(),
        remembers: !law.states.is_empty(),
        equation: law.text(),
        source: "written in the scene, or made up by a diagnosis".to_owned(),
        may_repeat: false,
        // What the scene declares as a candidate has been named by whoever wrote it.
        hypothetical: !table.candidate,
        parameters: parameters.collect(),
        needs: Vec::new(),
        trying: Trying::default(),
        native: None,
        adds: table.adds.clone(),
        scales: table.scales.clone(),
        states: table.state.clone(),
        law: Some(WrittenLaw { law: law.clone(), table: table.clone(), order }),
        is_listed: false,
    }
}

fn element(law: &Law) -> ElementKind {
    let name = law.address.element();
    let plain = name.split('_').next().unwrap_or("");
    ElementKind::ALL.into_iter().find(|kind| kind.name() == plain).unwrap_or(ElementKind::Muscle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{find, registry};
    use crate::laws::{Quantity, Symbol};

    /// Value of an entry's law, and its slope to the elongation.
    fn at(id: &str, values: &[f64], elongation_m: f64, pressure_pa: f64) -> (f64, f64) {
        let entry = find(id).expect("of the catalogue").entry();
        let written = entry.law.as_ref().expect("a text");
        let values = written.values(values);
        let read = |symbol: &Symbol| match symbol {
            Symbol::Parameter(p) => values[*p],
            Symbol::Constant(x) => *x,
            Symbol::Variable(v) if v.quantity == Quantity::Elongation => elongation_m,
            _ => pressure_pa,
        };
        let by_symbol: Vec<f64> = written.law.symbols.iter().map(read).collect();
        let programs = &written.law.programs;
        let mut registers = vec![0.0; programs.value.registers()];
        programs.value.run(programs.value.symbols().iter().map(|s| by_symbol[*s]), &mut registers);
        (programs.value.output(0, &registers), programs.value.output(1, &registers))
    }

    #[test]
    fn a_hypothetical_force_is_a_monomial() {
        let (pull, slope) = at("hypothetical_force", &[0.3, 2.0, 1.0], 0.02, 0.5e6);
        assert!((pull - 0.3 * 4.0 * 0.5).abs() < 1e-12 && (slope - 2.0 * pull / 0.02).abs() < 1e-9, "{pull} {slope}");
        // To the power of nothing, at nothing and below.
        for elongation_m in [0.0, -0.01, 0.02] {
            assert_eq!(at("hypothetical_force", &[0.3, 0.0, 0.0], elongation_m, 0.0), (0.3, 0.0));
        }
        assert!((at("hypothetical_force", &[0.3, 2.0, 0.0], -0.02, -1.0).0 - 1.2).abs() < 1e-12);
        assert_eq!(at("hypothetical_force", &[0.3, 1.0, 0.0], 0.0, 0.0), (0.0, 30.0));
    }

    #[test]
    fn a_hypothetical_flow_grows_with_its_power() {
        assert!((at("hypothetical_flow", &[1e-12, 2.0], 0.0, 2.0e6).0 - 4e-12).abs() < 1e-24);
        assert_eq!(at("hypothetical_flow", &[1e-12, 0.0], 0.0, 0.0).0, 1e-12);
    }

    #[test]
    fn an_effect_on_one_of_several_elements_is_a_law_there() {
        let written = find("hypothetical_force").expect("of the catalogue").entry().law.as_ref().expect("a text");
        let port = |name: &str| written.at(Element::parse(name).expect("an element")).address.to_string();
        assert_eq!(port("muscle_2"), "muscle_2.pull");
        assert_eq!(port("muscle"), "muscle.pull");
    }

    #[test]
    fn a_law_is_written_down_once() {
        let text =
            "name = 'mine'\nport = 'muscle.pull'\nadds = 'k_n_m * elongation_m'\nparameter.k_n_m = { value = 2.0 }";
        let table: LawTable = toml::from_str(text).expect("TOML");
        let law = table.law(&Surroundings::default()).expect("right");
        let numbers = [Fitted { typical: 2.0, range: Range { min: 0.0, max: 9.0 }, is_fitted: true }];
        let first = EntryId::write(&table, &law, 0, &numbers);
        assert_eq!(EntryId::write(&table, &law, 0, &numbers), first);
        assert!(first.unlisted().is_some() && registry::catalogue().all(|listed| listed < first));
    }
}
