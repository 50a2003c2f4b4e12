//! From a table to a law: names, units, ranges.

use std::sync::Arc;

use super::address::Address;
use super::law::{Law, Parameter, Programs, State, Symbol};
use super::port::{Carrier, Port, PortSpec};
use super::quantity::{QUANTITIES, Quantity, Variable};
use super::syntax::{SyntaxError, parse};
use super::table::{LawTable, StateTable};
use super::tree::{Function, Node, Operator};
use super::units::{Unit, said, unit_of};
use super::{Acts, Dimension};
use crate::nearest::did_you_mean;

mod parameters;
mod states;

use parameters::parameter;
use states::memory;

/// What is wrong with a [`LawTable`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct LawError {
    pub message: String,
    pub remedy: String,
}

/// What others call a variable.
const USUAL: [(&str, &str); 8] = [
    ("velocity_m_s", "speed_m_s"),
    ("displacement_m", "elongation_m"),
    ("extension_m", "elongation_m"),
    ("length_m", "elongation_m"),
    ("position_m", "plunger_m"),
    ("force_n", "tension_n"),
    ("angular_velocity_rad_s", "angular_speed_rad_s"),
    ("t_s", "time_s"),
];

fn refuse(message: impl Into<String>, remedy: impl Into<String>) -> LawError {
    LawError { message: message.into(), remedy: remedy.into() }
}

/// What a law may know besides its element: the run's conditions that are numbers, and a channel's unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surroundings {
    pub conditions: Vec<(String, f64)>,
    /// SI unit of the channel that a sensor's law acts on.
    pub channel: Option<Dimension>,
}

impl LawTable {
    /// Reads the expressions, checks names and units, and compiles.
    ///
    /// ```
    /// use smam::laws::{LawTable, Surroundings};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// let table: LawTable = toml::from_str(
    ///     "name = 'breakaway'
    ///      port = 'muscle.friction'
    ///      scales = '1 + a * exp(-abs(speed_m_s) / speed_scale_m_s)'
    ///      parameter.a = { value = 0.4, min = 0.0, max = 5.0 }
    ///      parameter.speed_scale_m_s = { value = 2e-3 }",
    /// )?;
    /// let law = table.law(&Surroundings::default())?;
    /// assert_eq!(law.values(), [0.4, 2e-3]);
    /// // Without its scale the speed is no plain number.
    /// let wrong = LawTable { scales: Some("1 + a * exp(-abs(speed_m_s))".to_owned()), ..table };
    /// assert!(wrong.law(&Surroundings::default()).is_err_and(|e| e.message.contains("m/s")));
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Names, expressions, units and numbers that are not right, each with key and remedy.
    pub fn law(&self, around: &Surroundings) -> Result<Law, LawError> {
        check_name("name", &self.name)?;
        let address = Address::parse(&self.port).map_err(|(message, remedy)| refuse(message, remedy))?;
        let (acts, expression) = self.expression(&address)?;
        let reader = Reader::new(self, &address, around)?;
        reader.read(acts, expression)
    }

    fn expression(&self, address: &Address) -> Result<(Acts, &str), LawError> {
        let spec = address.port.spec();
        match (&self.adds, &self.scales) {
            (Some(adds), None) => Ok((Acts::Adds, adds)),
            (None, Some(scales)) if spec.scales => Ok((Acts::Scales, scales)),
            (None, Some(_)) => Err(refuse(
                format!("scales: nothing stands at {address} that could be scaled"),
                format!("write adds = \"...\", in {}", spec.adds.first().unwrap_or(&"the channel's unit")),
            )),
            (Some(_), Some(_)) => Err(refuse("adds and scales stand side by side", "write two laws")),
            (None, None) => {
                let (acts, example) = spec.example;
                Err(refuse("there is no expression", format!("write {} = \"{example}\"", acts.word())))
            }
        }
    }
}

/// Names are words: they stand in keys and expressions.
fn check_name(key: &str, name: &str) -> Result<(), LawError> {
    let is_word = name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    if is_word {
        return Ok(());
    }
    Err(refuse(format!("{key} = \"{name}\" is no word"), "use letters, digits and _, and begin with a letter"))
}

struct Reader<'a> {
    table: &'a LawTable,
    address: &'a Address,
    spec: &'static PortSpec,
    around: &'a Surroundings,
    parameters: Vec<Parameter>,
    states: Vec<(&'a str, &'a StateTable)>,
}

/// Names that the expressions have used so far, each with what it stands for.
#[derive(Default)]
struct Used {
    names: Vec<String>,
    symbols: Vec<Symbol>,
}

impl<'a> Reader<'a> {
    fn new(table: &'a LawTable, address: &'a Address, around: &'a Surroundings) -> Result<Self, LawError> {
        let parameters = table.parameter.iter().map(|(name, p)| parameter(name, p)).collect::<Result<Vec<_>, _>>()?;
        let states: Vec<_> = table.state.iter().map(|(name, s)| (name.as_str(), s)).collect();
        let reader = Self { table, address, spec: address.port.spec(), around, parameters, states };
        reader.check_names()?;
        Ok(reader)
    }

    /// A name means one thing.
    fn check_names(&self) -> Result<(), LawError> {
        let own = self.parameters.iter().map(|p| ("parameter", p.name.as_str()));
        let names: Vec<(&str, &str)> = own.chain(self.states.iter().map(|(name, _)| ("state", *name))).collect();
        for (i, (key, name)) in names.iter().enumerate() {
            check_name(key, name)?;
            let is_function = Function::NAMED.iter().any(|(f, _)| f == name) || ["min", "max"].contains(name);
            let is_taken = names[..i].iter().any(|(_, other)| other == name)
                || Variable::parse(name, self.spec.variables()).is_some()
                || self.around.conditions.iter().any(|(condition, _)| condition == name);
            if is_function || is_taken {
                return Err(refuse(format!("{key}.{name}: the name is taken"), "give it another name"));
            }
        }
        Ok(())
    }

    fn read(&self, acts: Acts, expression: &str) -> Result<Law, LawError> {
        let mut used = Used::default();
        let value = self.tree(acts.word(), expression, &mut used)?;
        let gate = self.table.when.as_ref().map(|when| self.tree("when", when, &mut used)).transpose()?;
        let mut trees = Vec::new();
        let mut units: Vec<Unit> = vec![Unit::Open; self.states.len()];
        for (i, (name, state)) in self.states.iter().enumerate() {
            let (tree, unit) = self.state(name, state, &mut used)?;
            trees.push(tree);
            units[i] = unit;
        }
        let unit = |tree: &Node| self.unit(tree, &used, &units);
        self.check_value(acts, &unit(&value).map_err(|e| self.wrong_unit(acts.word(), &e))?)?;
        for (tree, (name, _)) in trees.iter().zip(&self.states) {
            self.check_state(name, tree, &used, &units)?;
        }
        if let Some(gate) = &gate {
            unit(gate).map_err(|e| self.wrong_unit("when", &e))?;
        }
        self.check_used(&used)?;
        let whole = gated(acts, value, gate);
        let states = self.states.iter().map(|(name, s)| State {
            name: (*name).to_owned(),
            memory: memory(s),
            follows_start: s.rate.is_none() && s.start.is_none(),
        });
        Ok(Law {
            name: self.table.name.clone(),
            address: self.address.clone(),
            acts,
            expression: expression.to_owned(),
            when: self.table.when.clone(),
            energy: None,
            parameters: self.parameters.clone().into(),
            states: states.collect(),
            programs: Arc::new(Programs::new(&whole, &trees, &used.symbols)),
            symbols: used.symbols.into(),
        })
    }

    /// Reads the expression of a key.
    fn tree(&self, key: &str, text: &str, used: &mut Used) -> Result<Node, LawError> {
        let mut resolve = |name: &str| self.symbol(name, used);
        parse(text, &mut resolve).map_err(|SyntaxError { at, message, remedy }| {
            let before = text[..at].chars().count();
            refuse(format!("{key} = \"{text}\": at character {}: {message}", before + 1), remedy)
        })
    }

    fn symbol(&self, name: &str, used: &mut Used) -> Result<usize, (String, String)> {
        if let Some(known) = used.names.iter().position(|n| n == name) {
            return Ok(known);
        }
        let parameter = || self.parameters.iter().position(|p| p.name == name).map(Symbol::Parameter);
        let state = || self.states.iter().position(|(s, _)| *s == name).map(Symbol::State);
        let variable = || Variable::parse(name, self.spec.variables()).map(|v| Symbol::Variable(self.own(v)));
        let condition = || self.around.conditions.iter().find(|(c, _)| c == name).map(|(_, x)| Symbol::Constant(*x));
        let found = parameter().or_else(state).or_else(variable).or_else(condition);
        let symbol = found.ok_or_else(|| self.unknown(name))?;
        self.check_own(name, symbol)?;
        used.names.push(name.to_owned());
        used.symbols.push(symbol);
        Ok(used.names.len() - 1)
    }

    /// A variable that names the law's own element by its number is the element's own: slopes are taken to those.
    fn own(&self, variable: Variable) -> Variable {
        let is_before_line = self.address.port <= Port::SyringeCompliance;
        let is_same = match variable.quantity {
            // Without a number it is that before the line there.
            Quantity::Pressure => !is_before_line,
            Quantity::SyringePressure => is_before_line && self.spec.variables().contains(&Quantity::SyringePressure),
            quantity => self.spec.variables().contains(&quantity),
        };
        let is_own = variable.of.is_some() && variable.of == self.address.number && is_same;
        if is_own { Variable { of: None, ..variable } } else { variable }
    }

    /// A piston goes with what has a slope here: anything else would leave it where it is. What a channel shows, and elements that
    /// stand alone, are not beside anything that has a number.
    fn check_own(&self, name: &str, symbol: Symbol) -> Result<(), (String, String)> {
        let Symbol::Variable(Variable { of: Some(_), .. }) = symbol else { return Ok(()) };
        let what = match self.spec.carrier {
            _ if self.address.port == Port::Plunger => "a piston",
            Carrier::Sensor => "what a channel shows",
            Carrier::Alone => "an element that stands alone",
            Carrier::Muscle | Carrier::Cable | Carrier::Joint => return Ok(()),
        };
        let known: Vec<String> = self.spec.variables().iter().map(|q| q.spec().name()).collect();
        Err((format!("{what} cannot follow {name}"), format!("use what is its own: {}", known.join(", "))))
    }

    fn unknown(&self, name: &str) -> (String, String) {
        let variables: Vec<String> = self.spec.variables().iter().map(|q| q.spec().name()).collect();
        let own = self.parameters.iter().map(|p| p.name.as_str()).chain(self.states.iter().map(|(s, _)| *s));
        let conditions = self.around.conditions.iter().map(|(c, _)| c.as_str());
        let known: Vec<&str> = variables.iter().map(String::as_str).chain(own).chain(conditions).collect();
        let elsewhere = QUANTITIES.iter().any(|q| q.name() == name);
        let message = match elsewhere {
            true => format!("{} has no {name} of its own", self.spec.name()),
            false => {
                let usual = USUAL.iter().find(|(word, own)| *word == name && known.contains(own));
                let meant = usual.map_or(name, |(_, own)| own);
                format!("there is no variable or parameter \"{name}\"{}", did_you_mean(meant, &known))
            }
        };
        let port = self.spec.name();
        let remedy = format!(
            "`smam laws {port}` lists the variables ({}); a number of your own is parameter.{name} = {{ value = 1.0 }}",
            variables.join(", ")
        );
        (message, remedy)
    }

    fn unit(&self, tree: &Node, used: &Used, states: &[Unit]) -> Result<Unit, String> {
        let of = |i: usize| match used.symbols[i] {
            Symbol::Variable(v) if v.quantity == Quantity::Reading => {
                self.around.channel.map_or(Unit::Open, Unit::Known)
            }
            Symbol::Variable(v) => Unit::Known(v.quantity.dimension()),
            Symbol::Parameter(p) => Unit::Known(self.parameters[p].dimension),
            Symbol::State(s) => states[s],
            Symbol::Constant(_) => Unit::Known(Dimension::of_name(&used.names[i]).unwrap_or(Dimension::NONE)),
        };
        unit_of(tree, &of, &used.names)
    }

    fn wrong_unit(&self, key: &str, why: &str) -> LawError {
        refuse(
            format!("{key}: the units do not come out: {why}"),
            "divide by a scale in the same unit; a parameter's unit is what its name ends in (speed_scale_m_s), or unit = \"m/s\"",
        )
    }

    fn check_value(&self, acts: Acts, unit: &Unit) -> Result<(), LawError> {
        let wanted: Vec<Dimension> = match (acts, self.address.port) {
            (Acts::Scales, _) => vec![Dimension::NONE],
            (Acts::Adds, Port::Sensor) => self.around.channel.into_iter().collect(),
            (Acts::Adds, _) => self.spec.added_units().collect(),
        };
        if wanted.is_empty() || wanted.iter().any(|d| unit.can_be(*d)) {
            return Ok(());
        }
        let words: Vec<String> = wanted.iter().map(Dimension::to_string).collect();
        let missing: Vec<String> = match unit {
            Unit::Known(own) => wanted.iter().map(|wanted| (*wanted / *own).to_string()).collect(),
            _ => words.clone(),
        };
        let wanted = words.join(" or ");
        let missing = missing.iter().map(|unit| format!("\"{unit}\"")).collect::<Vec<_>>().join(" or ");
        Err(refuse(
            format!(
                "{}: the units do not come out: {} takes {wanted}, the expression is in {}",
                acts.word(),
                self.address,
                said(*unit)
            ),
            format!(
                "multiply by a parameter with unit = {missing}; a number with a point may carry a unit (50.0), a whole one \
                 does not (50)"
            ),
        ))
    }

    /// A parameter that stands in no expression is a slip of the pen.
    fn check_used(&self, used: &Used) -> Result<(), LawError> {
        match self.parameters.iter().find(|p| !used.names.contains(&p.name)) {
            Some(p) => Err(refuse(format!("parameter.{} stands in no expression", p.name), "use it, or remove it")),
            None => Ok(()),
        }
    }
}

/// The law where its condition is met, and nothing elsewhere.
fn gated(acts: Acts, value: Node, gate: Option<Node>) -> Node {
    let Some(gate) = gate else { return value };
    let neutral = if acts == Acts::Adds { 0.0 } else { 1.0 };
    let is_met = Node::Of(Function::Abs, Box::new(gate));
    let beyond = Node::two(Operator::Subtract, value, Node::number(neutral));
    let gated = Node::Where(Box::new([is_met, Node::number(0.0), beyond, Node::number(0.0)]));
    Node::two(Operator::Add, gated, Node::number(neutral))
}
