//! Shapes that a law nobody listed may have over its variable.

use crate::effects::Range;

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
    pub has_number: bool,
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
pub const MORE_SHAPES: [Shape; 4] = [
    with_number("abs(x)^p", |x| x.abs().powf(P), false),
    with_number("x*abs(x)^p", |x| x * x.abs().powf(P), false),
    shape("sin(x)", f64::sin, true, true),
    with_number("exp(-(x - p)^2)", |x| (-(x - P).powi(2)).exp(), true),
];
/// Of these, what goes one way from a run's beginning on: what ages, warms up or softens. Something that comes and goes with the
/// clock is an event of one run, and no law.
pub const MORE_SHAPES_OF_TIME: [Shape; 1] = [MORE_SHAPES[0]];
pub const P: f64 = 1.5;
/// What `p` may be.
pub const P_RANGE: Range = Range { min: 0.1, max: 4.0 };
