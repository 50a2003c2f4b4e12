//! A number with its derivatives along a few directions.

use std::iter::Sum;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::{Scalar, is_blended};

/// A number and its derivatives along `N` directions. The number is to the last bit what plain arithmetic makes of it.
///
/// `num_dual::DualSVec64` does the same, but asks of every number whether it has derivatives at all; a diagnosis of a rig with two
/// muscles is up to a sixth shorter with jets (docs/adr/0002).
///
/// ```
/// use smam::muscle::Coil;
/// use smam::scalar::Jet;
///
/// let coil = Coil { stiffness_n_m: Jet::along(28.3, 0), preload_n: Jet::<2>::along(0.1, 1) };
/// let pull_n = coil.pull_n(Jet::from(0.01));
/// assert_eq!((pull_n.value, pull_n.slopes), (0.1 + 28.3 * 0.01, [0.01, 1.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<const N: usize> {
    pub value: f64,
    pub slopes: [f64; N],
}

impl<const N: usize> From<f64> for Jet<N> {
    /// A constant.
    #[inline(always)]
    fn from(value: f64) -> Self {
        Self { value, slopes: [0.0; N] }
    }
}

impl<const N: usize> Jet<N> {
    /// What is changed along one of the directions.
    ///
    /// # Panics
    /// Where there are not so many directions.
    pub fn along(value: f64, direction: usize) -> Self {
        let mut jet = Self::from(value);
        jet.slopes[direction] = 1.0;
        jet
    }

    /// A function of it. Where that is infinitely steep what does not change stays as it is.
    #[inline(always)]
    fn through(&self, value: f64, slope: f64) -> Self {
        self.map(value, |own| if own == 0.0 { 0.0 } else { own * slope })
    }

    #[inline(always)]
    fn map(self, value: f64, slope: impl Fn(f64) -> f64) -> Self {
        Self { value, slopes: self.slopes.map(slope) }
    }

    #[inline(always)]
    fn zip(self, other: Self, value: f64, slope: impl Fn(f64, f64) -> f64) -> Self {
        Self { value, slopes: std::array::from_fn(|i| slope(self.slopes[i], other.slopes[i])) }
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, self.value + other.value, |a, b| a + b)
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, self.value - other.value, |a, b| a - b)
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Self;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "the rule for slopes has other signs")]
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, self.value * other.value, |a, b| a * other.value + b * self.value)
    }
}

impl<const N: usize> Div for Jet<N> {
    type Output = Self;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "the rule for slopes has other signs")]
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let (value, inverse) = (self.value / other.value, other.value.recip());
        self.zip(other, value, |a, b| (a - b * value) * inverse)
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(-self.value, |a| -a)
    }
}

impl<const N: usize> Add<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl<const N: usize> Sub<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl<const N: usize> Mul<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: f64) -> Self {
        self.map(self.value * other, |a| a * other)
    }
}

impl<const N: usize> Div<f64> for Jet<N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: f64) -> Self {
        self.map(self.value / other, |a| a / other)
    }
}

assigns!(Jet);

impl<const N: usize> Sum for Jet<N> {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::from(-0.0), |sum, term| sum + term)
    }
}

/// Functions of one number: of `x`, where the function is `y`, its slope.
macro_rules! functions {
    ($($function:ident |$x:ident, $y:ident| $slope:expr;)*) => {
        $(#[inline]
        fn $function(&self) -> Self {
            let $x = self.value;
            let $y = $x.$function();
            self.through($y, $slope)
        })*
    };
}

impl<const N: usize> Scalar for Jet<N> {
    const DERIVATIVES: usize = 1;

    #[inline(always)]
    fn value(&self) -> f64 {
        self.value
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::from(value)
    }

    functions! {
        abs |x, _y| x.signum();
        recip |_x, y| -y * y;
        sqrt |_x, y| 0.5 / y;
        exp |_x, y| y;
        exp_m1 |_x, y| y + 1.0;
        ln |x, _y| x.recip();
        ln_1p |x, _y| (1.0 + x).recip();
        tanh |_x, y| 1.0 - y * y;
        sin |x, _y| x.cos();
        cos |x, _y| -x.sin();
    }

    #[inline]
    fn abs_about_rest(&self, still: Self) -> Self {
        let (x, still) = (self.value, still.value);
        if x.abs() >= still || !is_blended() { self.abs() } else { self.through(x.abs(), x / still) }
    }

    #[inline]
    fn powi(&self, n: i32) -> Self {
        let slope = if n == 0 { 0.0 } else { f64::from(n) * self.value.powi(n - 1) };
        self.through(self.value.powi(n), slope)
    }

    #[inline]
    fn powf(&self, n: f64) -> Self {
        let slope = if n == 0.0 { 0.0 } else { n * self.value.powf(n - 1.0) };
        self.through(self.value.powf(n), slope)
    }

    #[inline]
    fn powd(&self, n: Self) -> Self {
        // Of what is not above zero there are whole powers only, and nothing follows their exponent.
        if self.value <= 0.0 && n.value.fract() == 0.0 {
            return self.powi(n.value as i32);
        }
        let value = self.value.powf(n.value);
        self.powf(n.value) + n.through(0.0, value * self.value.ln())
    }
}

#[cfg(test)]
mod tests {
    use num_dual::{Dual64, DualNum};
    use proptest::prelude::*;

    use super::*;

    type Two = Jet<2>;

    /// Value and slope of something in one number, by a jet and by `num-dual`.
    fn both(x: f64, of_jet: impl Fn(&Two) -> Two, of_dual: impl Fn(&Dual64) -> Dual64) {
        let (jet, dual) = (of_jet(&Jet::along(x, 1)), of_dual(&Dual64::new(x, 1.0)));
        let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-10 * b.abs().max(1.0);
        assert!(is_near(jet.value, dual.re) && is_near(jet.slopes[1], dual.eps), "at {x}: {jet:?}, {dual}");
        assert_eq!(jet.slopes[0], 0.0);
    }

    fn quotient<T: Scalar>(x: T) -> T {
        (x * 2.0 - x / 3.0 + 1.0) / (x * x - 9.5)
    }

    proptest! {
        #[test]
        fn every_function_has_the_slope_that_another_library_finds(x in 0.05f64..3.0) {
            both(x, Scalar::abs, Scalar::abs);
            both(-x, Scalar::abs, Scalar::abs);
            both(x, Scalar::recip, DualNum::recip);
            both(x, Scalar::sqrt, DualNum::sqrt);
            both(x, Scalar::exp, DualNum::exp);
            both(x, Scalar::exp_m1, DualNum::exp_m1);
            both(x, Scalar::ln, DualNum::ln);
            both(x, Scalar::ln_1p, DualNum::ln_1p);
            both(x, Scalar::tanh, DualNum::tanh);
            both(x, Scalar::sin, DualNum::sin);
            both(x, Scalar::cos, DualNum::cos);
            both(x, |x| Scalar::powi(x, 3), |x| DualNum::powi(x, 3));
            both(x, |x| Scalar::powf(x, 1.7), |x| DualNum::powf(x, 1.7));
            both(x, |x| Scalar::powd(x, *x), |x| DualNum::powd(x, *x));
            both(x, |x| quotient(*x), |x| quotient(*x));
        }
    }

    #[test]
    fn what_does_not_change_stays_so_where_a_function_is_infinitely_steep() {
        assert_eq!(Scalar::sqrt(&Jet::<2>::from(0.0)).slopes, [0.0; 2]);
        assert_eq!(Scalar::powf(&Jet::<2>::from(0.0), 0.5).slopes, [0.0; 2]);
        assert_eq!(Scalar::powd(&Jet::<2>::along(-2.0, 0), Jet::from(2.0)).slopes, [-4.0, 0.0]);
        assert_eq!(Scalar::powd(&Jet::<2>::from(0.0), Jet::from(0.0)), Jet::from(1.0));
    }

    #[test]
    fn a_sum_of_nothing_is_the_zero_of_plain_sums() {
        let nothing: Two = std::iter::empty().sum();
        assert!(nothing.value.is_sign_negative() && std::iter::empty::<f64>().sum::<f64>().is_sign_negative());
    }
}
