//! A law ready for the equations.

use std::sync::Arc;

use super::address::Address;
use super::port::Carrier;
use super::program::Program;
use super::quantity::{Quantity, Variable};
use super::tree::Node;
use super::{Acts, Dimension};

/// A number of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    pub name: String,
    pub value: f64,
    pub min: f64,
    pub max: f64,
    pub dimension: Dimension,
}

/// How a state moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// By its rate.
    Rate,
    /// The greatest value of an expression so far.
    Greatest,
    /// Follows an expression with a dead zone.
    Play,
}

/// Memory of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    pub name: String,
    pub memory: Memory,
    /// Whether nothing says where it starts: what it follows decides.
    pub follows_start: bool,
}

/// What a name in a law's expressions stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Symbol {
    Variable(Variable),
    Parameter(usize),
    State(usize),
    /// A known condition of the run.
    Constant(f64),
}

/// Quantities to which a law's slopes are taken for the implicit step: those of its own element.
pub const SLOPES: [Quantity; 10] = [
    Quantity::Elongation,
    Quantity::Speed,
    Quantity::Pressure,
    Quantity::Angle,
    Quantity::AngularSpeed,
    Quantity::Position,
    Quantity::Plunger,
    Quantity::Time,
    Quantity::Flow,
    Quantity::Stretch,
];

/// A law at a port. Cheap to clone: what it is made of is shared.
#[derive(Clone, Debug, PartialEq)]
pub struct Law {
    pub name: String,
    pub address: Address,
    pub acts: Acts,
    /// The expression as it was written, and the condition beside it.
    pub expression: String,
    pub when: Option<String>,
    /// Its line in the energy balance, if that is another than its own name.
    pub energy: Option<String>,
    pub parameters: Arc<[Parameter]>,
    pub states: Arc<[State]>,
    /// What the symbols of the programs stand for.
    pub symbols: Arc<[Symbol]>,
    pub programs: Arc<Programs>,
}

/// The expressions of a law, compiled.
#[derive(Clone, Debug, PartialEq)]
pub struct Programs {
    /// What is added, or scales; after it its derivatives to [`SLOPES`], then to each state.
    pub value: Program,
    /// Of each state its rate; 0 for those that follow an expression.
    pub rates: Program,
    /// Of each state the derivatives of its rate: to itself, to elongation and to speed.
    pub rate_slopes: Program,
    /// Of each state where it starts, the expression that it follows, and the width of its play.
    pub starts: Program,
    pub follows: Program,
    pub widths: Program,
}

/// Trees of a state.
#[derive(Clone, Debug)]
pub(super) struct StateTrees {
    pub rate: Node,
    pub start: Node,
    pub follows: Node,
    pub width: Node,
}

impl Programs {
    /// Those of its states.
    pub(crate) fn of_states(&self) -> [&Program; 5] {
        [&self.rates, &self.rate_slopes, &self.starts, &self.follows, &self.widths]
    }

    pub(super) fn new(value: &Node, states: &[StateTrees], symbols: &[Symbol]) -> Self {
        let own = |quantity| {
            let wanted = Symbol::Variable(Variable { quantity, of: None });
            symbols.iter().position(|s| *s == wanted)
        };
        let state = |i: usize| symbols.iter().position(|s| *s == Symbol::State(i));
        let slope = |node: &Node, symbol: Option<usize>| symbol.map_or(Node::number(0.0), |s| node.derivative(s));
        let to_quantities = SLOPES.iter().map(|q| slope(value, own(*q)));
        let slopes = to_quantities.chain((0..states.len()).map(|i| slope(value, state(i))));
        let value_and_slopes: Vec<Node> = std::iter::once(value.clone()).chain(slopes).collect();
        let rate_slopes: Vec<Node> = states
            .iter()
            .enumerate()
            .flat_map(|(i, s)| {
                [state(i), own(Quantity::Elongation), own(Quantity::Speed)].map(|symbol| slope(&s.rate, symbol))
            })
            .collect();
        let all = |part: fn(&StateTrees) -> &Node| -> Program {
            Program::new(&states.iter().map(|s| part(s).clone()).collect::<Vec<_>>())
        };
        Self {
            value: Program::new(&value_and_slopes),
            rates: all(|s| &s.rate),
            rate_slopes: Program::new(&rate_slopes),
            starts: all(|s| &s.start),
            follows: all(|s| &s.follows),
            widths: all(|s| &s.width),
        }
    }
}

/// Values of variables at which a law is looked at.
const PROBES: [f64; 4] = [-0.7, 1e-3, 0.3, 41.0];

impl Law {
    /// Values of its parameters as the scene has them.
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|p| p.value).collect()
    }

    /// The place of a parameter.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }

    /// The parameter at whose zero the law vanishes, whatever its variables are; none where there is no such.
    pub fn size(&self) -> Option<usize> {
        let neutral = if self.acts == Acts::Adds { 0.0 } else { 1.0 };
        let vanishes = |size: usize| {
            PROBES.iter().all(|probe| {
                let read = |(i, symbol): (usize, &Symbol)| match symbol {
                    Symbol::Parameter(p) if *p == size => 0.0,
                    Symbol::Parameter(p) => self.parameters[*p].value,
                    Symbol::Constant(x) => *x,
                    Symbol::Variable(_) | Symbol::State(_) => probe * (1.0 + i as f64),
                };
                let by_symbol: Vec<f64> = self.symbols.iter().enumerate().map(read).collect();
                self.programs.value.value(&by_symbol) == neutral
            })
        };
        (0..self.parameters.len()).find(|&p| vanishes(p))
    }

    /// The variables that it depends on, each once.
    pub fn variables(&self) -> Vec<Variable> {
        let variables = self.symbols.iter().filter_map(|s| match s {
            Symbol::Variable(v) => Some(*v),
            _ => None,
        });
        variables.collect()
    }

    /// Whether it acts in a plant that is integrated, and neither on an element that stands alone nor on what a channel shows.
    pub(crate) fn is_of_plant(&self) -> bool {
        !matches!(self.address.port.spec().carrier, Carrier::Alone | Carrier::Sensor)
    }

    /// `muscle_1.friction scales 1 + a * x`.
    pub fn text(&self) -> String {
        let when = self.when.as_ref().map_or(String::new(), |when| format!(" when {when}"));
        format!("{} {} {}{when}", self.address, self.acts.word(), self.expression)
    }
}
