//! Whether the units of an expression come out.

use super::Dimension;
use super::tree::{Function, Node, Operator};

/// Unit of a part of an expression.
///
/// A bare number takes the unit of what it is added to or compared with. In a product a whole number counts; one with a
/// point or an exponent carries whatever SI unit is missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Unit {
    Known(Dimension),
    /// A whole number, or a product of such.
    Count,
    /// A number with a unit that is not said.
    Open,
}

impl Unit {
    /// Whether it can be this unit.
    pub fn can_be(self, wanted: Dimension) -> bool {
        match self {
            Self::Known(own) => own == wanted,
            Self::Count | Self::Open => true,
        }
    }

    /// What it is in a product.
    fn in_product(self) -> Self {
        if self == Self::Count { Self::Known(Dimension::NONE) } else { self }
    }

    fn join(self, other: Self) -> Option<Self> {
        match (self, other) {
            (Self::Known(a), Self::Known(b)) => (a == b).then_some(self),
            (Self::Known(_), _) => Some(self),
            (_, Self::Known(_)) => Some(other),
            (Self::Open, _) | (_, Self::Open) => Some(Self::Open),
            (Self::Count, Self::Count) => Some(Self::Count),
        }
    }
}

/// The unit of an expression; `of` is that of each symbol.
///
/// # Errors
/// The part whose units do not come out, in words.
pub fn unit_of(node: &Node, of: &dyn Fn(usize) -> Unit, names: &[String]) -> Result<Unit, String> {
    let part = |node| unit_of(node, of, names);
    match node {
        Node::Number(_, true) => Ok(Unit::Count),
        Node::Number(_, false) => Ok(Unit::Open),
        Node::Symbol(symbol) => Ok(of(*symbol)),
        Node::Of(function, x) => of_function(*function, x, part(x)?, names),
        Node::Two(operator, a, b) => of_two(*operator, (a, b), (part(a)?, part(b)?), node, names),
        Node::Where(parts) => part(&parts[2]),
    }
}

fn of_function(function: Function, x: &Node, unit: Unit, names: &[String]) -> Result<Unit, String> {
    match function {
        Function::Negate | Function::Abs => Ok(unit),
        Function::Sign => Ok(Unit::Known(Dimension::NONE)),
        Function::Sqrt => Ok(match unit {
            Unit::Known(d) => Unit::Known(d.power(0.5)),
            other => other,
        }),
        _ if unit.can_be(Dimension::NONE) => Ok(Unit::Known(Dimension::NONE)),
        _ => {
            let name = Function::NAMED.iter().find(|(_, f)| *f == function).map_or("", |(name, _)| name);
            Err(format!("{name} takes a plain number, `{}` is in {}", x.text(names), said(unit)))
        }
    }
}

fn of_two(
    operator: Operator,
    (a, b): (&Node, &Node),
    (of_a, of_b): (Unit, Unit),
    node: &Node,
    names: &[String],
) -> Result<Unit, String> {
    let both = |f: fn(Dimension, Dimension) -> Dimension| match (of_a.in_product(), of_b.in_product()) {
        (Unit::Known(a), Unit::Known(b)) => Unit::Known(f(a, b)),
        _ => Unit::Open,
    };
    match operator {
        Operator::Multiply | Operator::Divide if of_a == Unit::Count && of_b == Unit::Count => Ok(Unit::Count),
        Operator::Multiply => Ok(both(|a, b| a * b)),
        Operator::Divide => Ok(both(|a, b| a / b)),
        Operator::Power => of_power((a, b), (of_a, of_b), names),
        _ => match of_a.join(of_b) {
            Some(_) if matches!(operator, Operator::Above | Operator::AtLeast) => Ok(Unit::Known(Dimension::NONE)),
            Some(unit) => Ok(unit),
            None => Err(format!("in `{}` the one is in {}, the other in {}", node.text(names), said(of_a), said(of_b))),
        },
    }
}

fn of_power((a, b): (&Node, &Node), (of_a, of_b): (Unit, Unit), names: &[String]) -> Result<Unit, String> {
    if !of_b.can_be(Dimension::NONE) {
        return Err(format!("the power `{}` is in {}, not a plain number", b.text(names), said(of_b)));
    }
    match (of_a, b.constant()) {
        (Unit::Known(d), Some(n)) => Ok(Unit::Known(d.power(n))),
        (Unit::Known(d), None) if d != Dimension::NONE => Err(format!(
            "`{}` is in {} and its power is no number: divide it by a scale first",
            a.text(names),
            said(of_a)
        )),
        (unit, _) => Ok(unit),
    }
}

/// A unit in words.
pub fn said(unit: Unit) -> String {
    match unit {
        Unit::Known(d) => d.to_string(),
        Unit::Count => "a plain number".to_owned(),
        Unit::Open => "a unit that is not said".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laws::syntax::parse;

    const NAMES: [&str; 5] = ["elongation_m", "speed_m_s", "pressure_pa", "angle_rad", "c_n_s_m"];

    fn unit(text: &str) -> Result<Unit, String> {
        let mut symbols = |name: &str| {
            NAMES.iter().position(|n| *n == name).ok_or_else(|| (format!("{name} is unknown"), String::new()))
        };
        let node = parse(text, &mut symbols).unwrap_or_else(|e| panic!("{text}: {e:?}"));
        let of = |i: usize| Unit::Known(Dimension::of_name(NAMES[i]).unwrap_or(Dimension::NONE));
        unit_of(&node, &of, &NAMES.map(str::to_owned))
    }

    #[test]
    fn units_come_out() {
        for (text, wanted) in [
            ("c_n_s_m * speed_m_s", "N"),
            ("pressure_pa * elongation_m^2", "N"),
            ("sqrt(elongation_m) * elongation_m^0.5", "m"),
            ("1 + 0.4 * exp(-abs(speed_m_s)/2e-3)", "1"),
            ("max(elongation_m - 1e-3, 0)", "m"),
            ("2 * elongation_m", "m"),
            ("(elongation_m > 0) * speed_m_s", "m/s"),
            ("elongation_m / 2", "m"),
        ] {
            let found = unit(text).unwrap_or_else(|e| panic!("{text}: {e}"));
            assert!(found.can_be(Dimension::parse(wanted).expect("a unit")), "{text}: {found:?}");
        }
        // A number with a point may carry a unit, a whole one counts.
        let newton = Dimension::parse("N").expect("a unit");
        assert!(unit("0.5 * elongation_m").expect("units").can_be(newton));
        assert!(!unit("2 * elongation_m").expect("units").can_be(newton));
    }

    #[test]
    fn what_does_not_come_out_is_named() {
        for (text, word) in [
            ("elongation_m + pressure_pa", "the one is in m, the other in Pa"),
            ("exp(speed_m_s)", "`speed_m_s` is in m/s"),
            ("tanh(elongation_m / 2)", "`elongation_m / 2` is in m"),
            ("elongation_m > pressure_pa", "the one is in m"),
            ("angle_rad^elongation_m", "the power"),
            ("elongation_m^angle_rad", "divide it by a scale first"),
            ("max(elongation_m, speed_m_s)", "the other in m/s"),
        ] {
            let message = unit(text).expect_err(text);
            assert!(message.contains(word), "{text}: {message}");
        }
    }
}
