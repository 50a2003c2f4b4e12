//! Shapes of unlisted laws over their variable.

use crate::effects::Range;

/// A shape over `x`, the variable over its scale.
#[derive(Clone, Copy, Debug)]
pub struct Shape {
    pub text: &'static str,
    /// The same as a function.
    pub at: fn(f64) -> f64,
    /// Whether its scale changes the shape; otherwise size and scale are one parameter.
    pub has_scale: bool,
    /// Whether it is one of the basis shapes of curves.
    pub is_basis: bool,
    /// Where its exponent or place `p` starts, if it has one; it is fitted, and the function has this value.
    pub start: Option<f64>,
}

const fn shape(text: &'static str, at: fn(f64) -> f64, has_scale: bool, is_basis: bool) -> Shape {
    Shape { text, at, has_scale, is_basis, start: None }
}

const fn with_number(text: &'static str, at: fn(f64) -> f64, has_scale: bool, start: f64) -> Shape {
    Shape { text, at, has_scale, is_basis: true, start: Some(start) }
}

/// The shape of a constant: a parameter of the rig that differs from the scene.
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

/// Exponents below and above one to start with: a fit that starts on the wrong side of a straight line stays there.
const ROOT: f64 = 0.5;
const POWER: f64 = 1.5;
const PLACE: f64 = 1.5;
/// Shapes tried if no other leaves only noise. Of those with the same text, the one that promises more is refitted.
pub const MORE_SHAPES: [Shape; 6] = [
    with_number("abs(x)^p", |x| x.abs().powf(POWER), false, POWER),
    with_number("abs(x)^p", |x| x.abs().powf(ROOT), false, ROOT),
    with_number("sign(x)*abs(x)^p", |x| x.signum() * x.abs().powf(POWER), false, POWER),
    with_number("sign(x)*abs(x)^p", |x| x.signum() * x.abs().powf(ROOT), false, ROOT),
    shape("sin(x)", f64::sin, true, true),
    with_number("exp(-(x - p)^2)", |x| (-(x - PLACE).powi(2)).exp(), true, PLACE),
];
/// Those that are monotonic from a run's beginning: ageing, warming, softening. Of a single run what comes and goes with the clock explains
/// anything.
pub const MORE_SHAPES_OF_ONE_RUN: [Shape; 2] = [MORE_SHAPES[0], MORE_SHAPES[1]];
/// Shapes with their exponent set free, from where each is the shape of this text: powers, the stretched exponential (friction over speed,
/// relaxation), Hill's saturation, and what sets in beyond a threshold.
const FREED: [(&str, Shape); 13] = [
    ("x", with_number("sign(x)*abs(x)^p", |x| x, false, 1.0)),
    ("abs(x)", with_number("abs(x)^p", f64::abs, false, 1.0)),
    ("x^2", with_number("abs(x)^p", |x| x * x, false, 2.0)),
    ("x^3", with_number("sign(x)*abs(x)^p", |x| x * x * x, false, 3.0)),
    ("x*abs(x)", with_number("sign(x)*abs(x)^p", |x| x * x.abs(), false, 2.0)),
    ("sqrt(abs(x))", with_number("abs(x)^p", |x| x.abs().sqrt(), false, 0.5)),
    ("max(x - 1, 0)", with_number("max(x - 1, 0)^p", |x| (x - 1.0).max(0.0), true, 1.0)),
    ("exp(-abs(x))", with_number("exp(-abs(x)^p)", |x| (-x.abs()).exp(), true, 1.0)),
    ("exp(-x^2)", with_number("exp(-abs(x)^p)", |x| (-x * x).exp(), true, 2.0)),
    ("tanh(x)", with_number("sign(x)*tanh(abs(x)^p)", f64::tanh, true, 1.0)),
    ("ln(1 + abs(x))", with_number("ln(1 + abs(x)^p)", |x| x.abs().ln_1p(), true, 1.0)),
    ("x/(1 + abs(x))", with_number("sign(x)*abs(x)^p/(1 + abs(x)^p)", |x| x / (1.0 + x.abs()), true, 1.0)),
    ("x^2/(1 + x^2)", with_number("abs(x)^p/(1 + abs(x)^p)", |x| x * x / (1.0 + x * x), true, 2.0)),
];

impl Shape {
    /// The same with a free exponent, if there is such a shape.
    pub fn freed(&self) -> Option<&'static Self> {
        FREED.iter().find(|(text, _)| self.start.is_none() && *text == self.text).map(|(_, shape)| shape)
    }
}

/// A straight line, and lines from a knot on: at one scale, at zero, and at minus one scale.
pub const LINE: Shape = SHAPES[0];
pub const RAMPS: [Shape; 3] = [
    SHAPES[6],
    shape("max(x, 0)", |x| x.max(0.0), false, false),
    shape("max(x + 1, 0)", |x| (x + 1.0).max(0.0), true, false),
];

/// What `p` may be.
pub const P_RANGE: Range = Range { min: 0.1, max: 4.0 };

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_freed_shape_starts_as_the_shape_itself() {
        for (text, own) in &FREED {
            let shape = SHAPES.iter().find(|shape| shape.text == *text).expect("a simple shape");
            assert!(own.freed().is_none() && own.has_scale == shape.has_scale, "{text}");
            for x in [-2.3, -0.4, 0.0, 0.7, 1.9] {
                assert!(((own.at)(x) - (shape.at)(x)).abs() < 1e-15, "{text} at {x}");
            }
        }
        let left: Vec<&str> = SHAPES.iter().filter(|s| s.freed().is_none()).map(|s| s.text).collect();
        assert_eq!(left, ["(x > 1)"]);
    }
}
