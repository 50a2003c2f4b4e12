//! Laws of the grammar with parameters: a slot with a shape or a curve, and laws proposed by the scene.

use std::collections::BTreeMap;

use super::acting::{Action, does, written};
use super::shapes::{P_RANGE, Shape};
use super::slots::{SCALE, Slot};
use crate::diagnose::case::Case;
use crate::diagnose::fit::Variant;
use crate::effects::{Entry, Fitted, Range};
use crate::laws::{LawTable, ParameterTable, Port, QUANTITIES};
use crate::scene::Candidate;

/// The law of a slot with a shape at a multiple of the slot's scale; `None` if the port cannot have it.
pub fn variant(case: &Case, slot: &Slot, shape: &Shape, scales: f64) -> Option<Variant> {
    let Action { acts, unit, typical, around: known } = &slot.action;
    let (acts, typical) = (*acts, *typical);
    let (scale, name) = (slot.scale * scales, slot.scale_name());
    let x = slot.reading.text(&slot.variable, &name);
    let shaped = || slot.reading.times(spelled(shape.text, &x));
    let own = if slot.is_constant() { "a".to_owned() } else { format!("a * {}", shaped()) };
    let mut parameter = BTreeMap::new();
    parameter.insert("a".to_owned(), number(typical, Some(unit)));
    if !slot.is_constant() {
        parameter.insert(name.clone(), number(scale, unit_of_scale(slot)));
    }
    if let Some(start) = shape.start {
        parameter.insert("p".to_owned(), number(start, Some("1")));
    }
    let more = slot.reading.parameter(&slot.variable);
    parameter.extend(more.iter().map(|(name, table, _)| (name.clone(), table.clone())));
    let (adds, scales) = does(acts, own);
    let table = LawTable {
        name: slot.name(),
        port: slot.address.clone(),
        adds,
        scales,
        parameter,
        state: slot.reading.states(&slot.variable),
        ..LawTable::default()
    };
    let law = table.law(known).ok()?;
    let size = law.parameter("a")?;
    let parameters: Vec<Fitted> = law
        .parameters
        .iter()
        .map(|p| match (p.name.as_str(), &more) {
            ("a", _) => Fitted { typical, range: Range { min: -1e3 * typical, max: 1e3 * typical }, is_fitted: true },
            ("p", _) => Fitted { typical: p.value, range: P_RANGE, is_fitted: true },
            (own, Some((name, table, is_fitted))) if own == name => around(table.value, *is_fitted),
            _ => Fitted {
                typical: scale,
                range: Range { min: 0.02 * slot.scale, max: 50.0 * slot.scale },
                is_fitted: shape.has_scale,
            },
        })
        .collect();
    let placed = written(case, &table, &law, &parameters, size);
    let values = placed.spec().typical();
    Some(Variant { placed, values })
}

/// A shape in a sum: at which scale of the variable, and how much of it there is to start with.
#[derive(Clone, Copy, Debug)]
pub struct Term<'a> {
    pub shape: &'a Shape,
    pub scale: f64,
    pub size: f64,
}

/// What the scale of a sum's second shape is called before its name: no law of a user's has it by chance.
const SECOND: &str = "second_";
/// Name of the size of a sum's second shape.
pub const SECOND_SIZE: &str = "b";

/// The law of a slot as a sum of two shapes that have no exponent, each with a size and a scale of its own.
pub fn sum(case: &Case, slot: &Slot, terms: &[Term; 2]) -> Option<Variant> {
    let Action { acts, unit, typical, around: known } = &slot.action;
    let scale = slot.scale_name();
    let names = [("a", scale.clone()), (SECOND_SIZE, format!("{SECOND}{scale}"))];
    let text = |(term, (size, scale)): (&Term, &(&str, String))| {
        format!("{size} * {}", spelled(term.shape.text, &slot.reading.text(&slot.variable, scale)))
    };
    let texts: Vec<String> = terms.iter().zip(&names).map(text).collect();
    let of_size = Range { min: -1e3 * typical, max: 1e3 * typical };
    let of_scale = Range { min: 0.02 * slot.scale, max: 50.0 * slot.scale };
    let (mut parameter, mut fitted, mut begun) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
    for (term, (size, scale)) in terms.iter().zip(names) {
        parameter.insert(size.to_owned(), number(*typical, Some(unit)));
        parameter.insert(scale.clone(), number(term.scale, unit_of_scale(slot)));
        begun.insert(size, term.size.clamp(of_size.min, of_size.max));
        fitted.insert(size.to_owned(), Fitted { typical: *typical, range: of_size, is_fitted: true });
        fitted.insert(scale, Fitted { typical: term.scale, range: of_scale, is_fitted: term.shape.has_scale });
    }
    let (adds, scales) = does(*acts, texts.join(" + "));
    let (name, port) = (slot.name(), slot.address.clone());
    let table = LawTable { name, port, adds, scales, parameter, ..LawTable::default() };
    let law = table.law(known).ok()?;
    let parameters: Vec<Fitted> = law.parameters.iter().map(|p| fitted.get(&p.name).copied()).collect::<Option<_>>()?;
    let placed = written(case, &table, &law, &parameters, law.parameter("a")?);
    let start = placed.spec().parameters.iter().map(|p| begun.get(p.key.as_str()).copied().unwrap_or(p.typical));
    let values = start.collect();
    Some(Variant { placed, values })
}

/// Whether the law of an effect is such a sum.
pub fn is_sum(own: &Entry) -> bool {
    own.unlisted().is_some() && own.parameters.iter().any(|p| p.key.starts_with(SECOND))
}

/// Scales of the two shapes of such a sum, given its parameters' values.
pub fn scales_of_sum(own: &Entry, values: &[f64]) -> Option<[f64; 2]> {
    let scale =
        |start: &str| own.parameters.iter().zip(values).find(|(p, _)| p.key.starts_with(start)).map(|(_, v)| *v);
    Some([scale(SCALE)?, scale(SECOND)?])
}

/// A slot's law as a curve: the sum of its basis shapes, each with its own size, at the slot's scale.
pub fn curve(case: &Case, slot: &Slot) -> Option<Variant> {
    let shapes: Vec<String> = slot.basis().map(|shape| shape.text.to_owned()).collect();
    sum_of(case, slot, &shapes)
}

/// A slot's law as a sum of so many terms over `x`, each with its own size ([`SIZES`]), at the slot's scale.
pub(super) fn sum_of(case: &Case, slot: &Slot, terms: &[String]) -> Option<Variant> {
    let Action { acts, unit, typical, around: known } = &slot.action;
    let (scale, typical) = (slot.scale_name(), *typical);
    let x = slot.reading.text(&slot.variable, &scale);
    let sizes = &SIZES[..terms.len()];
    let texts: Vec<String> = terms.iter().zip(sizes).map(|(term, a)| format!("{a} * {}", spelled(term, &x))).collect();
    let mut parameter: BTreeMap<String, ParameterTable> =
        sizes.iter().map(|a| ((*a).to_owned(), number(typical, Some(unit)))).collect();
    parameter.insert(scale, number(slot.scale, unit_of_scale(slot)));
    let (adds, scales) = does(*acts, texts.join(" + "));
    let (name, port) = (slot.name(), slot.address.clone());
    let table = LawTable { name, port, adds, scales, parameter, ..LawTable::default() };
    let law = table.law(known).ok()?;
    let own = Fitted { typical, range: Range { min: -1e3 * typical, max: 1e3 * typical }, is_fitted: true };
    let fixed = Fitted { typical: slot.scale, range: Range { min: 0.0, max: f64::INFINITY }, is_fitted: false };
    let is_size = |name: &str| sizes.contains(&name);
    let parameters: Vec<Fitted> = law.parameters.iter().map(|p| if is_size(&p.name) { own } else { fixed }).collect();
    let placed = written(case, &table, &law, &parameters, law.parameter(SIZES[0])?);
    let values = placed.spec().typical();
    Some(Variant { placed, values })
}

fn number(value: f64, unit: Option<&str>) -> ParameterTable {
    ParameterTable { value, unit: unit.map(str::to_owned), ..ParameterTable::default() }
}

/// Unit of the scale of a slot's variable, where its name does not say it: that of what a channel shows is the channel's.
fn unit_of_scale(slot: &Slot) -> Option<&str> {
    let plain = if slot.port == Port::Sensor { slot.action.unit.as_str() } else { "1" };
    ending(&slot.variable).is_empty().then_some(plain)
}

/// Sizes of a curve's terms.
pub(super) const SIZES: [&str; 8] = ["a", "b", "c", "d", "e", "f", "g", "h"];

/// A parameter that may be fifty times larger or smaller.
fn around(typical: f64, is_fitted: bool) -> Fitted {
    Fitted { typical, range: Range { min: 0.02 * typical, max: 50.0 * typical }, is_fitted }
}

/// A law proposed by the scene, starting from its own values. A parameter without a range gets one from its scale.
pub fn candidate(case: &Case, own: &Candidate) -> Variant {
    let number = |(i, p): (usize, &crate::laws::Parameter)| {
        let scale = p.value.abs().max(f64::MIN_POSITIVE);
        let (low, high) = if i == own.size { (-1e3 * scale, 1e3 * scale) } else { (0.02 * p.value, 50.0 * p.value) };
        let or = |bound: f64, other: f64| if bound.is_finite() { bound } else { other };
        let range = Range { min: or(p.min, low.min(high)), max: or(p.max, low.max(high)) };
        Fitted { typical: p.value, range, is_fitted: true }
    };
    let parameters: Vec<Fitted> = own.law.parameters.iter().enumerate().map(number).collect();
    let placed = written(case, &own.table, &own.law, &parameters, own.size);
    let values = placed.spec().typical();
    Variant { placed, values }
}

/// Ending of a variable's name with its unit: `_m_s`; empty for a plain number.
pub(super) fn ending(variable: &str) -> &str {
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
