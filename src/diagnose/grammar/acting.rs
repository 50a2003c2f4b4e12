//! Actions tried at each port, and laws as effects of a model.

use std::collections::BTreeMap;

use crate::diagnose::case::Case;
use crate::diagnose::fit::Placed;
use crate::effects::{Element, EntryId, Fitted, Range};
use crate::laws::{Acts, Carrier, Law, LawTable, ParameterTable, Port, Surroundings};

/// Action tried at each port: adding or scaling, and a clearly visible size.
pub fn action(port: Port) -> Option<(Acts, &'static str, f64)> {
    use Acts::{Adds, Scales};
    Some(match port {
        Port::Plunger => (Adds, "m", 2e-5),
        Port::SyringeFlow | Port::Outflow => (Adds, "m3/s", 1e-11),
        Port::PressureDrop => (Adds, "Pa", 1e4),
        Port::Resistance => (Scales, "1", 2.0),
        Port::Inertance => return None,
        Port::Pull => (Adds, "N", 0.02),
        Port::RestLength => (Adds, "m", 2e-4),
        Port::Stretch => (Adds, "m", 1e-4),
        Port::Torque => (Adds, "N m", 1e-4),
        Port::AxisForce | Port::AxisFriction => (Adds, "N", 3.0),
        Port::ChamberOutflow | Port::Sensor => return None,
        _ => (Scales, "1", 0.05),
    })
}

/// Action of laws at one place.
#[derive(Clone, Debug)]
pub struct Action {
    pub acts: Acts,
    pub unit: String,
    /// A clearly visible size.
    pub typical: f64,
    /// Quantities available to such a law.
    pub around: Surroundings,
}

impl Action {
    pub fn at(port: Port) -> Option<Self> {
        let (acts, unit, typical) = action(port)?;
        Some(Self { acts, unit: unit.to_owned(), typical, around: Surroundings::default() })
    }
}

/// A constant law at a port.
pub fn injected(case: &Case, address: &str, action: &Action) -> Option<Placed> {
    let Action { acts, unit, typical, around } = action;
    let (adds, scales) = does(*acts, "u".to_owned());
    let number = ParameterTable { unit: Some(unit.clone()), ..ParameterTable::default() };
    let table = LawTable {
        name: "injected".to_owned(),
        port: address.to_owned(),
        adds,
        scales,
        parameter: BTreeMap::from([("u".to_owned(), number)]),
        ..LawTable::default()
    };
    let law = table.law(around).ok()?;
    let range = Range { min: -1e3 * typical, max: 1e3 * typical };
    Some(written(case, &table, &law, &[Fitted { typical: *typical, range, is_fitted: true }], 0))
}

/// A law as an effect of a model.
pub fn written(case: &Case, table: &LawTable, law: &Law, parameters: &[Fitted], size: usize) -> Placed {
    let entry = EntryId::write(table, law, size, parameters);
    let number = law.address.number;
    let count = match law.address.port.spec().carrier {
        Carrier::Cable => case.scene.file.cable.len(),
        Carrier::Alone => 1,
        _ => case.scene.file.muscle.len(),
    };
    let count = if number.is_some() { count } else { 1 };
    let channel = law.address.of.clone().filter(|_| law.address.port == Port::Sensor);
    Placed { entry, element: Element::of(entry.element, number.unwrap_or(0), count), channel }
}

/// The expression that a law adds, or that it scales by.
pub fn does(acts: Acts, by: String) -> (Option<String>, Option<String>) {
    match acts {
        Acts::Adds => (Some(by), None),
        Acts::Scales => (None, Some(format!("1 + {by}"))),
    }
}
