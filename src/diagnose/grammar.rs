//! Laws that nobody listed: every port of the scene, every variable that it can depend on, in shapes that a law may have.

use std::collections::BTreeMap;

use crate::effects::{Element, EntryId, Fitted, Range};
use crate::laws::{
    Acts, Address, Carrier, Law, LawTable, PORTS, ParameterTable, Port, PortSpec, QUANTITIES, Quantity, Surroundings,
};

use crate::scene::Candidate;

use super::candidates::Variant;
use super::case::Case;
use super::fit::Fit;
use super::model::Placed;
use super::reading::{Reading, readings};

/// A shape over `x`, the variable over its scale.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    pub text: &'static str,
    /// The same as a function.
    pub at: fn(f64) -> f64,
    /// Whether its scale bends it: if not, a size and a scale are one number.
    pub has_scale: bool,
    /// Whether it is one of those of which curves are made up when slots are screened.
    pub is_basis: bool,
    /// Whether a number `p` in it is fitted as well.
    has_number: bool,
}

const fn shape(text: &'static str, at: fn(f64) -> f64, has_scale: bool, is_basis: bool) -> Shape {
    Shape { text, at, has_scale, is_basis, has_number: false }
}

const fn with_number(text: &'static str, at: fn(f64) -> f64, has_scale: bool) -> Shape {
    Shape { text, at, has_scale, is_basis: true, has_number: true }
}

/// What a law is in that depends on nothing: a number of the rig that is another than the scene says.
pub const CONSTANT: Shape = shape("1", |_| 1.0, false, false);

/// Shapes over a variable, the simplest first.
pub const SHAPES: [Shape; 14] = [
    shape("x", |x| x, false, true),
    shape("x^2", |x| x * x, false, true),
    shape("abs(x)", f64::abs, false, false),
    shape("x^3", |x| x * x * x, false, false),
    shape("x*abs(x)", |x| x * x.abs(), false, false),
    shape("sqrt(abs(x))", |x| x.abs().sqrt(), false, false),
    shape("max(x - 1, 0)", |x| (x - 1.0).max(0.0), true, true),
    shape("exp(-abs(x))", |x| (-x.abs()).exp(), true, true),
    shape("tanh(x)", f64::tanh, true, true),
    shape("ln(1 + abs(x))", |x| x.abs().ln_1p(), true, false),
    shape("x/(1 + abs(x))", |x| x / (1.0 + x.abs()), true, false),
    shape("x^2/(1 + x^2)", |x| x * x / (1.0 + x * x), true, false),
    shape("exp(-x^2)", |x| (-x * x).exp(), true, false),
    shape("(x > 1)", |x| f64::from(u8::from(x > 1.0)), true, false),
];

/// Shapes that are tried over a variable where none of the others leaves only noise. `p` is a number that is fitted; the function
/// has it as it begins, [`P`].
const MORE_SHAPES: [Shape; 4] = [
    with_number("abs(x)^p", |x| x.abs().powf(P), false),
    with_number("x*abs(x)^p", |x| x * x.abs().powf(P), false),
    shape("sin(x)", f64::sin, true, true),
    with_number("exp(-(x - p)^2)", |x| (-(x - P).powi(2)).exp(), true),
];
const P: f64 = 1.5;
/// What `p` may be.
const P_RANGE: Range = Range { min: 0.1, max: 4.0 };

/// How far the grammar reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// A shape over a variable.
    Plain,
    /// More shapes, products of two variables, and what is remembered of one.
    Wide,
}

/// Variables that are tried at a port without a number in the name.
fn variables(spec: &PortSpec) -> &'static [Quantity] {
    use Quantity as Q;
    match spec.carrier {
        Carrier::Muscle if spec.element == "muscle" => &[Q::Elongation, Q::Speed, Q::Pressure, Q::Time],
        Carrier::Muscle if spec.element == "plunger" => &[Q::Pressure, Q::Plunger, Q::Time],
        Carrier::Muscle => &[Q::Pressure, Q::Flow, Q::Elongation, Q::Time],
        Carrier::Cable => &[Q::Angle, Q::Tension, Q::Stretch, Q::AngularSpeed, Q::Time],
        Carrier::Joint => &[Q::Angle, Q::AngularSpeed, Q::Time],
        Carrier::Sensor => &[],
    }
}

/// What is tried at each port: whether it adds or scales, and a size that is plain to see.
fn action(port: Port) -> Option<(Acts, &'static str, f64)> {
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
        Port::Sensor => return None,
        _ => (Scales, "1", 0.05),
    })
}

/// A law of the grammar before it has a shape: where it acts, and on what it depends.
#[derive(Clone, Debug)]
pub struct Slot {
    pub address: String,
    pub port: Port,
    /// Empty where the law depends on nothing.
    pub variable: String,
    /// What of the variable the shape is over.
    pub reading: Reading,
    shapes: &'static [Shape],
    /// Unit scale of the variable: half of the greatest that it reaches.
    pub scale: f64,
    /// The variable in each open run.
    pub series: Vec<Vec<f64>>,
    /// A law whose only number is what acts at the port, and the size that is plain to see.
    pub injected: Placed,
    pub typical: f64,
}

impl Slot {
    /// Whether its law depends on nothing.
    pub fn is_constant(&self) -> bool {
        self.variable.is_empty()
    }

    /// The shapes that its law may have.
    pub fn shapes(&self) -> &'static [Shape] {
        self.shapes
    }

    /// The same slot, whose law may have the shapes that are tried where the simple ones leave something.
    pub fn bent(&self) -> Self {
        Self { shapes: &MORE_SHAPES, ..self.clone() }
    }

    /// Those of which its curve is made up when slots are screened.
    pub fn basis(&self) -> impl Iterator<Item = &'static Shape> {
        let is_constant = self.is_constant();
        // What is remembered is many: a straight line and a parabola must do.
        let most = if self.reading == Reading::Plain { usize::MAX } else { 2 };
        self.shapes().iter().filter(move |s| s.is_basis || is_constant).take(most)
    }

    /// Name of its law.
    pub fn name(&self) -> String {
        format!("{}{}", self.address.replace('.', "_"), self.reading.word())
    }

    /// Name of the element that it belongs to, as answers have it.
    pub fn element(&self) -> String {
        Address::parse(&self.address).map_or_else(|_| self.address.clone(), |a| a.element())
    }
}

impl PartialEq for Slot {
    fn eq(&self, other: &Self) -> bool {
        (&self.address, &self.variable, &self.reading) == (&other.address, &other.variable, &other.reading)
    }
}

/// All slots of a case's scene within reach: those whose variable moves in its open runs, and those that depend on nothing.
pub fn slots(case: &Case, from: &Fit, reach: Reach) -> Vec<Slot> {
    let mut slots = over_variables(case, from);
    match reach {
        Reach::Plain => slots.extend(constants(case)),
        Reach::Wide => {
            let more = slots.iter().flat_map(|slot| beyond(case, slot, &slots)).collect::<Vec<_>>();
            slots.iter_mut().for_each(|slot| slot.shapes = &MORE_SHAPES);
            slots.extend(more);
        }
    }
    slots
}

/// Slots at the place of one over a variable: its products, and what is remembered of it.
fn beyond(case: &Case, own: &Slot, all: &[Slot]) -> Vec<Slot> {
    let quantity = |slot: &Slot| Some(QUANTITIES.iter().find(|q| q.name() == slot.variable)?.quantity);
    let here: Vec<&Slot> = all.iter().filter(|slot| slot.address == own.address).collect();
    let known: Vec<(Quantity, f64)> = here.iter().filter_map(|s| Some((quantity(s)?, s.scale))).collect();
    let Some(variable) = quantity(own) else { return Vec::new() };
    let slot = |reading: Reading| {
        let other = reading.other().and_then(|q| here.iter().find(|slot| quantity(slot) == Some(q)));
        let runs = case.runs.iter().filter(|run| !run.is_sealed).enumerate();
        let series: Vec<Vec<f64>> = runs
            .map(|(r, run)| reading.series(&own.series[r], other.map_or(&[][..], |o| &o.series[r]), &run.drive.times_s))
            .collect();
        let greatest = series.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        (greatest > 0.0).then(|| Slot { reading, series, scale: 0.5 * greatest, shapes: &SHAPES, ..own.clone() })
    };
    readings(variable, &known).into_iter().filter_map(slot).collect()
}

/// Slots of laws that depend on nothing. What acts in the fluid as it did before adds no number of its own: a steady flow or pressure
/// is physics, not a number.
fn constants(case: &Case) -> Vec<Slot> {
    let open = || case.runs.iter().filter(|run| !run.is_sealed);
    let is_number = |spec: &&PortSpec| {
        action(spec.port).is_some_and(|(acts, ..)| acts == Acts::Scales) || spec.port == Port::RestLength
    };
    let each =
        PORTS.iter().filter(is_number).flat_map(|spec| addresses(case, spec).into_iter().map(|a| (spec.port, a)));
    let slot = |(port, address): (Port, String)| {
        let (injected, typical) = injected(case, &address, port)?;
        let series = open().map(|run| vec![1.0; run.drive.times_s.len()]).collect();
        let shapes = std::slice::from_ref(&CONSTANT);
        let (variable, reading) = (String::new(), Reading::Plain);
        Some(Slot { address, port, variable, reading, shapes, scale: 1.0, series, injected, typical })
    };
    each.filter_map(slot).collect()
}

/// Slots whose variable moves in the open runs.
fn over_variables(case: &Case, from: &Fit) -> Vec<Slot> {
    let mut asked = Vec::new();
    for spec in PORTS.iter().filter(|spec| action(spec.port).is_some()) {
        for address in addresses(case, spec) {
            for quantity in variables(spec) {
                let variable = quantity.spec().name();
                let probe = LawTable {
                    name: "probe".to_owned(),
                    port: address.clone(),
                    adds: Some(format!("0.0 * {variable}")),
                    ..LawTable::default()
                };
                let probe = match spec.adds.is_empty() {
                    true => None,
                    false => probe.law(&Surroundings::default()).ok(),
                };
                asked.extend(probe.map(|law| (law, address.clone(), spec.port, variable)));
            }
        }
    }
    let laws: Vec<Law> = asked.iter().map(|(law, ..)| law.clone()).collect();
    let open = case.runs.iter().filter(|run| !run.is_sealed);
    let Some(visited) = open
        .map(|run| run.twin.visited(&run.drive, &from.model.setting(case, run, &from.x), &laws))
        .collect::<Option<Vec<_>>>()
    else {
        return Vec::new();
    };
    let slot = |(i, (_, address, port, variable)): (usize, (Law, String, Port, String))| {
        let series: Vec<Vec<f64>> = visited.iter().map(|run| run[i].clone()).collect();
        let greatest = series.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        let (injected, typical) = injected(case, &address, port)?;
        let (reading, shapes, scale) = (Reading::Plain, &SHAPES[..], 0.5 * greatest);
        (greatest > 0.0).then_some(Slot { address, port, variable, reading, shapes, scale, series, injected, typical })
    };
    asked.into_iter().enumerate().filter_map(slot).collect()
}

/// A law at a port whose only number is what acts there.
fn injected(case: &Case, address: &str, port: Port) -> Option<(Placed, f64)> {
    let (acts, unit, typical) = action(port)?;
    let (adds, scales) = match acts {
        Acts::Adds => (Some("u".to_owned()), None),
        Acts::Scales => (None, Some("1 + u".to_owned())),
    };
    let number = ParameterTable { unit: Some(unit.to_owned()), ..ParameterTable::default() };
    let table = LawTable {
        name: "injected".to_owned(),
        port: address.to_owned(),
        adds,
        scales,
        parameter: BTreeMap::from([("u".to_owned(), number)]),
        ..LawTable::default()
    };
    let law = table.law(&Surroundings::default()).ok()?;
    let range = Range { min: -1e3 * typical, max: 1e3 * typical };
    Some((written(case, &table, &law, &[Fitted { typical, range, is_fitted: true }], 0), typical))
}

/// A law as something that a model can hold.
fn written(case: &Case, table: &LawTable, law: &Law, numbers: &[Fitted], size: usize) -> Placed {
    let entry = EntryId::write(table, law, size, numbers);
    let number = law.address.number;
    let count = match law.address.port.spec().carrier {
        Carrier::Cable => case.scene.file.cable.len(),
        _ => case.scene.file.muscle.len(),
    };
    let count = if number.is_some() { count } else { 1 };
    Placed { entry, element: Element::of(entry.element, number.unwrap_or(0), count), channel: None }
}

/// A port of every element that there is by itself, and of all at once where there are several.
fn addresses(case: &Case, spec: &PortSpec) -> Vec<String> {
    let file = &case.scene.file;
    let (count, together) = match spec.carrier {
        Carrier::Muscle => (file.muscle.len(), true),
        Carrier::Cable => (file.cable.len(), true),
        // On a slider that a muscle moves itself a force on the joint is one of the muscle.
        Carrier::Joint => (usize::from(file.mechanism.is_some() && !file.cable.is_empty()), false),
        Carrier::Sensor => (0, false),
    };
    let name = |number: Option<usize>| {
        let number = number.map_or(String::new(), |n| format!("_{n}"));
        if spec.term.is_empty() {
            format!("{}{number}", spec.element)
        } else {
            format!("{}{number}.{}", spec.element, spec.term)
        }
    };
    match count {
        0 => Vec::new(),
        1 => vec![name(None)],
        n => (1..=n).map(|i| name(Some(i))).chain(together.then(|| name(None))).collect(),
    }
}

/// The law of a slot in a shape, its scale so many times the slot's; none where the port cannot have it.
pub fn variant(case: &Case, slot: &Slot, shape: &Shape, scales: f64) -> Option<Variant> {
    let (acts, unit, typical) = action(slot.port)?;
    let (scale, ending) = (slot.scale * scales, ending(&slot.variable));
    let name = format!("scale{ending}");
    let x = slot.reading.text(&slot.variable, &name);
    let own = if slot.is_constant() { "a".to_owned() } else { format!("a * {}", spelled(shape.text, &x)) };
    let mut parameter = BTreeMap::new();
    let number = |value: f64, unit: Option<&str>| ParameterTable {
        value,
        unit: unit.map(str::to_owned),
        ..ParameterTable::default()
    };
    parameter.insert("a".to_owned(), number(typical, Some(unit)));
    if !slot.is_constant() {
        parameter.insert(name.clone(), number(scale, ending.is_empty().then_some("1")));
    }
    if shape.has_number {
        parameter.insert("p".to_owned(), number(P, Some("1")));
    }
    let more = slot.reading.parameter(&slot.variable);
    parameter.extend(more.iter().map(|(name, table, _)| (name.clone(), table.clone())));
    let (adds, scales) = match acts {
        Acts::Adds => (Some(own), None),
        Acts::Scales => (None, Some(format!("1 + {own}"))),
    };
    let table = LawTable {
        name: slot.name(),
        port: slot.address.clone(),
        adds,
        scales,
        parameter,
        state: slot.reading.states(&slot.variable),
        ..LawTable::default()
    };
    let law = table.law(&Surroundings::default()).ok()?;
    let size = law.parameter("a")?;
    let numbers: Vec<Fitted> = law
        .parameters
        .iter()
        .map(|p| match (p.name.as_str(), &more) {
            ("a", _) => Fitted { typical, range: Range { min: -1e3 * typical, max: 1e3 * typical }, is_fitted: true },
            ("p", _) => Fitted { typical: P, range: P_RANGE, is_fitted: true },
            (own, Some((name, table, is_fitted))) if own == name => around(table.value, *is_fitted),
            _ => Fitted {
                typical: scale,
                range: Range { min: 0.02 * slot.scale, max: 50.0 * slot.scale },
                is_fitted: shape.has_scale,
            },
        })
        .collect();
    let placed = written(case, &table, &law, &numbers, size);
    let values = placed.spec().typical();
    Some(Variant { placed, values })
}

/// A slot's law as a curve: the sum of the shapes of its basis, each with a size of its own, at the slot's scale.
pub fn curve(case: &Case, slot: &Slot) -> Option<Variant> {
    let (acts, unit, typical) = action(slot.port)?;
    let ending = ending(&slot.variable);
    let scale = format!("scale{ending}");
    let x = slot.reading.text(&slot.variable, &scale);
    let terms: Vec<String> = slot.basis().zip(SIZES).map(|(s, a)| format!("{a} * {}", spelled(s.text, &x))).collect();
    let number = |value: f64, unit: Option<&str>| ParameterTable {
        value,
        unit: unit.map(str::to_owned),
        ..ParameterTable::default()
    };
    let mut parameter: BTreeMap<String, ParameterTable> =
        SIZES.iter().take(terms.len()).map(|a| ((*a).to_owned(), number(typical, Some(unit)))).collect();
    parameter.insert(scale, number(slot.scale, ending.is_empty().then_some("1")));
    let sum = terms.join(" + ");
    let (adds, scales) = match acts {
        Acts::Adds => (Some(sum), None),
        Acts::Scales => (None, Some(format!("1 + {sum}"))),
    };
    let port = slot.address.clone();
    let table = LawTable { name: slot.name(), port, adds, scales, parameter, ..LawTable::default() };
    let law = table.law(&Surroundings::default()).ok()?;
    let own = Fitted { typical, range: Range { min: -1e3 * typical, max: 1e3 * typical }, is_fitted: true };
    let fixed = Fitted { typical: slot.scale, range: Range { min: 0.0, max: f64::INFINITY }, is_fitted: false };
    let is_size = |name: &str| SIZES.contains(&name);
    let numbers: Vec<Fitted> = law.parameters.iter().map(|p| if is_size(&p.name) { own } else { fixed }).collect();
    let placed = written(case, &table, &law, &numbers, law.parameter(SIZES[0])?);
    let values = placed.spec().typical();
    Some(Variant { placed, values })
}

/// Sizes of a curve's shapes.
const SIZES: [&str; 5] = ["a", "b", "c", "d", "e"];

/// A number that may be fifty times as great or as small.
fn around(typical: f64, is_fitted: bool) -> Fitted {
    Fitted { typical, range: Range { min: 0.02 * typical, max: 50.0 * typical }, is_fitted }
}

/// A law that the scene proposes, tried from its own numbers. A parameter without a range has that of its scale.
pub fn candidate(case: &Case, own: &Candidate) -> Variant {
    let number = |(i, p): (usize, &crate::laws::Parameter)| {
        let scale = p.value.abs().max(f64::MIN_POSITIVE);
        let (low, high) = if i == own.size { (-1e3 * scale, 1e3 * scale) } else { (0.02 * p.value, 50.0 * p.value) };
        let or = |bound: f64, other: f64| if bound.is_finite() { bound } else { other };
        let range = Range { min: or(p.min, low.min(high)), max: or(p.max, low.max(high)) };
        Fitted { typical: p.value, range, is_fitted: true }
    };
    let numbers: Vec<Fitted> = own.law.parameters.iter().enumerate().map(number).collect();
    let placed = written(case, &own.table, &own.law, &numbers, own.size);
    let values = placed.spec().typical();
    Variant { placed, values }
}

/// Ending of a variable's name with its unit: `_m_s`; empty for a plain number.
fn ending(variable: &str) -> &str {
    let spec = QUANTITIES.iter().find(|q| q.name() == variable);
    let own = spec.map_or(0, |q| q.ending.len());
    if own == 0 { "" } else { &variable[variable.len() - own - 1..] }
}

/// A shape with `x` spelled out.
fn spelled(shape: &str, x: &str) -> String {
    let letters: Vec<char> = shape.chars().collect();
    let is_word = |i: usize| letters.get(i).is_some_and(|c| c.is_ascii_alphanumeric());
    let each = letters.iter().enumerate().map(|(i, c)| match c {
        'x' if !(is_word(i + 1) || i > 0 && is_word(i - 1)) => x.to_owned(),
        c => c.to_string(),
    });
    each.collect()
}
