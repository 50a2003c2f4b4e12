//! Laws that are weighed like entries of the catalogue: those that a scene declares as candidates, and those that a diagnosis
//! makes up.

use std::sync::RwLock;

use super::{EffectSpec, ElementKind, Kind, ParameterSpec, Range};
use crate::laws::{Law, LawTable};

/// Which of the laws that were written down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct LawId(u32);

/// A law with the description that effects have.
#[derive(Debug)]
pub struct WrittenLaw {
    pub spec: EffectSpec,
    pub law: Law,
    pub table: LawTable,
    /// Of each number of the effect: which parameter of the law it is. The first is the size.
    order: Vec<usize>,
}

/// All that were written so far, each once: an entry stays for as long as the program runs, as those of the catalogue do.
static WRITTEN: RwLock<Vec<&'static WrittenLaw>> = RwLock::new(Vec::new());

/// What a parameter of a law is as a number of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitted {
    pub typical: f64,
    pub range: Range,
    pub is_fitted: bool,
}

impl LawId {
    /// Writes a law down; `size` is the parameter at whose zero it is absent, `numbers` describes each parameter.
    ///
    /// One that was written before, with the same numbers, keeps its place.
    pub fn write(table: &LawTable, law: &Law, size: usize, numbers: &[Fitted]) -> Self {
        let mut written = WRITTEN.write().unwrap_or_else(std::sync::PoisonError::into_inner);
        let is_same = |known: &&'static WrittenLaw| {
            known.table == *table && known.order.first() == Some(&size) && {
                known.order.iter().zip(known.spec.parameters).all(|(&i, p)| {
                    (p.typical, p.range, p.is_fitted) == (numbers[i].typical, numbers[i].range, numbers[i].is_fitted)
                })
            }
        };
        if let Some(at) = written.iter().position(is_same) {
            return Self(at as u32);
        }
        let id = Self(written.len() as u32);
        written.push(Box::leak(Box::new(entry(id, table, law, size, numbers))));
        id
    }

    /// The law.
    pub fn law(self) -> &'static WrittenLaw {
        let written = WRITTEN.read().unwrap_or_else(std::sync::PoisonError::into_inner);
        // An id exists only once its law has been written, and none is ever taken away.
        written[self.0 as usize]
    }
}

fn entry(id: LawId, table: &LawTable, law: &Law, size: usize, numbers: &[Fitted]) -> WrittenLaw {
    let others = (0..law.parameters.len()).filter(|i| *i != size);
    let order: Vec<usize> = std::iter::once(size).chain(others).collect();
    let leak = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
    let parameters = order.iter().map(|&i| {
        let (name, own) = (leak(&law.parameters[i].name), numbers[i]);
        let default = (!own.is_fitted).then_some(own.typical);
        ParameterSpec {
            key: name,
            symbol: name,
            range: own.range,
            typical: own.typical,
            default,
            is_fitted: own.is_fitted,
        }
    });
    let spec = EffectSpec {
        kind: Kind::Law(id),
        name: leak(&law.name),
        title: leak(&law.text()),
        element: element(law),
        law: leak(&law.text()),
        source: "written in the scene, or made up by a diagnosis",
        parameters: Box::leak(parameters.collect::<Vec<_>>().into_boxed_slice()),
    };
    WrittenLaw { spec, law: law.clone(), table: table.clone(), order }
}

fn element(law: &Law) -> ElementKind {
    let name = law.address.element();
    let plain = name.split('_').next().unwrap_or("");
    ElementKind::ALL.into_iter().find(|kind| kind.name() == plain).unwrap_or(ElementKind::Muscle)
}

impl WrittenLaw {
    /// Values of the law's parameters from those of an effect.
    pub fn values<D: Copy>(&self, of_effect: &[D]) -> Vec<D> {
        let place = |parameter: usize| self.order.iter().position(|&i| i == parameter).unwrap_or(0);
        (0..self.order.len()).map(|i| of_effect[place(i)]).collect()
    }

    /// As a table of a scene, with the numbers of an effect.
    pub fn table_with(&self, of_effect: &[f64]) -> LawTable {
        let mut table = LawTable { candidate: false, ..self.table.clone() };
        for (parameter, value) in self.law.parameters.iter().zip(self.values(of_effect)) {
            if let Some(own) = table.parameter.get_mut(&parameter.name) {
                own.value = value;
            }
        }
        table
    }
}
