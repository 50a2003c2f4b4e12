//! An expression as a tree: what can stand in a law.

use std::fmt;

/// A function of one argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Function {
    Negate,
    Abs,
    Sign,
    Exp,
    Ln,
    Sqrt,
    Sin,
    Cos,
    Tanh,
}

/// What joins two arguments. Comparisons are 1 where they hold, else 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Min,
    Max,
    Above,
    AtLeast,
}

impl Function {
    /// Those with a name, as it is written.
    pub const NAMED: [(&str, Self); 8] = [
        ("abs", Self::Abs),
        ("sign", Self::Sign),
        ("exp", Self::Exp),
        ("ln", Self::Ln),
        ("sqrt", Self::Sqrt),
        ("sin", Self::Sin),
        ("cos", Self::Cos),
        ("tanh", Self::Tanh),
    ];

    fn name(self) -> &'static str {
        Self::NAMED.iter().find(|(_, f)| *f == self).map_or("-", |(name, _)| name)
    }

    /// Its value at a plain number.
    pub fn at(self, x: f64) -> f64 {
        match self {
            Self::Negate => -x,
            Self::Abs => x.abs(),
            Self::Sign => sign(x),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Sqrt => x.sqrt(),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tanh => x.tanh(),
        }
    }
}

/// -1, 0 or 1.
fn sign(x: f64) -> f64 {
    f64::from(i8::from(x > 0.0) - i8::from(x < 0.0))
}

impl Operator {
    /// The value of two plain numbers.
    pub fn at(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Add => a + b,
            Self::Subtract => a - b,
            Self::Multiply => a * b,
            Self::Divide => a / b,
            Self::Power => a.powf(b),
            Self::Min => a.min(b),
            Self::Max => a.max(b),
            Self::Above => f64::from(u8::from(a > b)),
            Self::AtLeast => f64::from(u8::from(a >= b)),
        }
    }

    fn sign(self) -> &'static str {
        match self {
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
            Self::Power => "^",
            Self::Min => "min",
            Self::Max => "max",
            Self::Above => ">",
            Self::AtLeast => ">=",
        }
    }

    /// How tightly it binds; functions and powers most.
    fn binding(self) -> u8 {
        match self {
            Self::Above | Self::AtLeast => 1,
            Self::Add | Self::Subtract => 2,
            Self::Multiply | Self::Divide => 3,
            Self::Power => 5,
            Self::Min | Self::Max => 6,
        }
    }
}

/// An expression. Symbols are places in a list that whoever reads the expression keeps.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// A number; whether it is written as a whole one, without point or exponent.
    Number(f64, bool),
    Symbol(usize),
    Of(Function, Box<Node>),
    Two(Operator, Box<Node>, Box<Node>),
    /// The third where the first is above the second, else the fourth; arises from derivatives alone.
    Where(Box<[Node; 4]>),
}

impl Node {
    /// A number that arises on the way.
    pub fn number(value: f64) -> Self {
        Self::Number(value, false)
    }

    /// The value where it is a number.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Self::Number(value, _) => Some(*value),
            _ => None,
        }
    }

    /// A function of an argument; of a number its value.
    pub fn of(function: Function, x: Self) -> Self {
        match (function, x) {
            (Function::Negate, Self::Number(value, is_whole)) => Self::Number(-value, is_whole),
            (Function::Negate, Self::Of(Function::Negate, x)) => *x,
            (function, x) => match x.constant() {
                Some(value) => Self::number(function.at(value)),
                None => Self::Of(function, Box::new(x)),
            },
        }
    }

    /// Two arguments joined. What is neutral goes, and numbers are joined at once.
    pub fn two(operator: Operator, a: Self, b: Self) -> Self {
        use Operator as O;
        match (operator, a.constant(), b.constant()) {
            (_, Some(x), Some(y)) => Self::number(operator.at(x, y)),
            (O::Add, Some(0.0), _) => b,
            (O::Add | O::Subtract, _, Some(0.0)) => a,
            (O::Subtract, Some(0.0), _) => Self::of(Function::Negate, b),
            (O::Multiply, Some(0.0), _) | (O::Multiply | O::Divide, _, Some(0.0)) if operator == O::Multiply => {
                Self::number(0.0)
            }
            (O::Divide, Some(0.0), _) => Self::number(0.0),
            (O::Multiply, Some(1.0), _) => b,
            (O::Multiply | O::Divide | O::Power, _, Some(1.0)) => a,
            (O::Power, _, Some(0.0)) => Self::number(1.0),
            _ => Self::Two(operator, Box::new(a), Box::new(b)),
        }
    }

    /// Whether a symbol stands in it.
    pub fn holds(&self, symbol: usize) -> bool {
        match self {
            Self::Number(..) => false,
            Self::Symbol(own) => *own == symbol,
            Self::Of(_, x) => x.holds(symbol),
            Self::Two(_, a, b) => a.holds(symbol) || b.holds(symbol),
            Self::Where(parts) => parts.iter().any(|part| part.holds(symbol)),
        }
    }

    /// How many nodes it has.
    pub fn size(&self) -> usize {
        1 + match self {
            Self::Number(..) | Self::Symbol(_) => 0,
            Self::Of(_, x) => x.size(),
            Self::Two(_, a, b) => a.size() + b.size(),
            Self::Where(parts) => parts.iter().map(Self::size).sum(),
        }
    }

    /// The exact derivative with respect to a symbol. At corners that of the branch taken: of `abs` at zero it is zero, of
    /// comparisons everywhere.
    pub fn derivative(&self, symbol: usize) -> Self {
        if !self.holds(symbol) {
            return Self::number(0.0);
        }
        match self {
            Self::Number(..) => Self::number(0.0),
            Self::Symbol(_) => Self::number(1.0),
            Self::Of(function, x) => times(slope(*function, x), x.derivative(symbol)),
            Self::Two(operator, a, b) => joined(*operator, a, b, symbol),
            Self::Where(parts) => {
                let [a, b, then, otherwise] = &**parts;
                where_above(a, b, then.derivative(symbol), otherwise.derivative(symbol))
            }
        }
    }

    /// As text, its symbols by their names.
    pub fn text<'a>(&'a self, names: &'a [String]) -> impl fmt::Display + 'a {
        Text { node: self, names, within: 0 }
    }
}

fn times(a: Node, b: Node) -> Node {
    Node::two(Operator::Multiply, a, b)
}

fn over(a: Node, b: Node) -> Node {
    Node::two(Operator::Divide, a, b)
}

fn where_above(a: &Node, b: &Node, then: Node, otherwise: Node) -> Node {
    if then == otherwise { then } else { Node::Where(Box::new([a.clone(), b.clone(), then, otherwise])) }
}

/// Derivative of a function at `x`.
fn slope(function: Function, x: &Node) -> Node {
    let of = |function| Node::of(function, x.clone());
    let one = || Node::number(1.0);
    match function {
        Function::Negate => Node::number(-1.0),
        Function::Abs => of(Function::Sign),
        Function::Sign => Node::number(0.0),
        Function::Exp => of(Function::Exp),
        Function::Ln => over(one(), x.clone()),
        Function::Sqrt => over(Node::number(0.5), of(Function::Sqrt)),
        Function::Sin => of(Function::Cos),
        Function::Cos => Node::of(Function::Negate, of(Function::Sin)),
        Function::Tanh => {
            Node::two(Operator::Subtract, one(), Node::two(Operator::Power, of(Function::Tanh), Node::number(2.0)))
        }
    }
}

fn joined(operator: Operator, a: &Node, b: &Node, symbol: usize) -> Node {
    let (da, db) = (a.derivative(symbol), b.derivative(symbol));
    match operator {
        Operator::Add | Operator::Subtract => Node::two(operator, da, db),
        Operator::Multiply => Node::two(Operator::Add, times(da, b.clone()), times(a.clone(), db)),
        Operator::Divide => {
            let first = over(da, b.clone());
            let second = over(times(a.clone(), db), Node::two(Operator::Power, b.clone(), Node::number(2.0)));
            Node::two(Operator::Subtract, first, second)
        }
        Operator::Power => power_slope(a, b, da, db),
        Operator::Min => where_above(a, b, db, da),
        Operator::Max => where_above(a, b, da, db),
        Operator::Above | Operator::AtLeast => Node::number(0.0),
    }
}

fn power_slope(a: &Node, b: &Node, da: Node, db: Node) -> Node {
    let lowered = Node::two(Operator::Subtract, b.clone(), Node::number(1.0));
    let by_base = times(times(b.clone(), Node::two(Operator::Power, a.clone(), lowered)), da);
    // An exponent that is a parameter can be zero: then nothing follows the base, not even at zero.
    let by_base = match b.constant() {
        Some(_) => by_base,
        None => {
            Node::Where(Box::new([Node::of(Function::Abs, b.clone()), Node::number(0.0), by_base, Node::number(0.0)]))
        }
    };
    if db.constant() == Some(0.0) {
        return by_base;
    }
    let whole = Node::two(Operator::Power, a.clone(), b.clone());
    Node::two(Operator::Add, by_base, times(times(whole, Node::of(Function::Ln, a.clone())), db))
}

/// See [`Node::text`]; `within` is the binding of what stands around.
struct Text<'a> {
    node: &'a Node,
    names: &'a [String],
    within: u8,
}

impl fmt::Display for Text<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = |node, within| Text { node, names: self.names, within };
        match self.node {
            Node::Number(value, _) if *value < 0.0 && self.within > 2 => write!(f, "({value:?})"),
            Node::Number(value, true) => write!(f, "{value}"),
            Node::Number(value, false) => write!(f, "{value:?}"),
            Node::Symbol(i) => f.write_str(self.names.get(*i).map_or("?", String::as_str)),
            Node::Of(Function::Negate, x) if self.within > 2 => write!(f, "(-{})", part(x, 4)),
            Node::Of(Function::Negate, x) => write!(f, "-{}", part(x, 4)),
            Node::Of(function, x) => write!(f, "{}({})", function.name(), part(x, 0)),
            Node::Two(operator @ (Operator::Min | Operator::Max), a, b) => {
                write!(f, "{}({}, {})", operator.sign(), part(a, 0), part(b, 0))
            }
            Node::Two(operator, a, b) => {
                let own = operator.binding();
                let (left, right) = if *operator == Operator::Power { (own + 1, own) } else { (own, own + 1) };
                let brackets = own < self.within;
                let space = if own < 5 { " " } else { "" };
                let (open, close) = if brackets { ("(", ")") } else { ("", "") };
                write!(f, "{open}{}{space}{}{space}{}{close}", part(a, left), operator.sign(), part(b, right))
            }
            Node::Where(parts) => {
                let [a, b, then, otherwise] = &**parts;
                write!(f, "({} > {} ? {} : {})", part(a, 0), part(b, 0), part(then, 0), part(otherwise, 0))
            }
        }
    }
}
