//! The number types the laws are written over.

use std::cell::Cell;
use std::fmt::Debug;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

use num_dual::DualNum;

/// Operators that assign, of numbers side by side that have the others.
macro_rules! assigns {
    ($number:ident) => {
        assigns! { $number: AddAssign add_assign +, SubAssign sub_assign -, MulAssign mul_assign *, DivAssign div_assign / }
    };
    ($number:ident: $($operator:ident $of:ident $sign:tt),*) => {$(
        impl<const N: usize> std::ops::$operator for $number<N> {
            #[inline(always)]
            fn $of(&mut self, other: Self) {
                *self = *self $sign other;
            }
        }
        impl<const N: usize> std::ops::$operator<f64> for $number<N> {
            #[inline(always)]
            fn $of(&mut self, other: f64) {
                *self = *self $sign other;
            }
        }
    )*};
}

mod jet;
mod lanes;

pub use jet::Jet;
#[doc(hidden)]
pub use lanes::Lanes;
pub(crate) use lanes::take_disagreement;

/// A real number, one that carries exact derivatives, or several numbers side by side.
///
/// Every law of the hydraulics, the muscle and the hysteresis is generic over this trait: with `f64` it is the plain law, with a
/// dual number of `num-dual`, or along several directions with [`Jet`], the same code also yields exact sensitivities, with
/// [`Lanes`] it is evaluated for several parameter sets at once.
///
/// Branches look at the real part alone, through [`Scalar::is_above`] and its like where numbers side by side usually
/// agree, through [`Scalar::select_above`] where each must go its own way.
///
/// ```
/// use num_dual::Dual64;
/// use smam::muscle::spring_rate;
/// use smam::scalar::Scalar;
///
/// // k = G d^4/(8 D^3 N): how much stiffer for each metre of wire diameter, by the law's own code.
/// let fixed = <Dual64 as Scalar>::constant;
/// let k = spring_rate(fixed(69.1e9), Dual64::new(0.2e-3, 1.0), fixed(1.25e-3), fixed(250.0));
/// assert!((Scalar::value(&k) - 28.3).abs() < 0.05);
/// assert!((k.eps / (4.0 * k.re / 0.2e-3) - 1.0).abs() < 1e-12);
/// ```
pub trait Scalar:
    Copy
    + Debug
    + PartialEq
    + Send
    + Sync
    + 'static
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
    + AddAssign<f64>
    + SubAssign<f64>
    + MulAssign<f64>
    + DivAssign<f64>
    + Sum
{
    /// Orders of derivatives that are carried.
    const DERIVATIVES: usize;

    /// The number without its derivatives. Of numbers side by side the first, and where they differ that is noted
    /// ([`Lanes`]).
    fn value(&self) -> f64;

    /// A constant: its derivatives are zero.
    fn constant(value: f64) -> Self;

    /// Whether the number is above `bound`.
    fn is_above(&self, bound: f64) -> bool {
        self.value() > bound
    }

    /// Whether the number is below `bound`.
    fn is_below(&self, bound: f64) -> bool {
        self.value() < bound
    }

    /// Whether the number is `bound`.
    fn is_at(&self, bound: f64) -> bool {
        self.value() == bound
    }

    /// Whether neither infinite nor no number at all.
    fn is_finite(&self) -> bool {
        self.value().is_finite()
    }

    /// `then` where the number is above `bound`, `otherwise` elsewhere.
    fn select_above(self, bound: Self, then: Self, otherwise: Self) -> Self {
        if self.value() > bound.value() { then } else { otherwise }
    }

    /// The row of a table that the number falls into; none outside the table.
    fn look_up<'a, const N: usize>(self, row: impl Fn(f64) -> Option<&'a [Self; N]>) -> Option<[Self; N]> {
        row(self.value()).copied()
    }

    /// The same for a table of plain numbers.
    fn look_up_plain<'a, const N: usize>(self, row: impl Fn(f64) -> Option<&'a [f64; N]>) -> Option<[Self; N]> {
        row(self.value()).map(|row| row.map(Self::constant))
    }

    fn abs(&self) -> Self;

    /// `|x|`; within `blended_at_rest` with the slopes of its mean over `still` to both sides: at rest a small change goes either way.
    fn abs_about_rest(&self, still: Self) -> Self {
        let _ = still;
        self.abs()
    }

    fn recip(&self) -> Self;
    fn sqrt(&self) -> Self;
    fn exp(&self) -> Self;
    fn exp_m1(&self) -> Self;
    fn ln(&self) -> Self;
    fn ln_1p(&self) -> Self;
    fn tanh(&self) -> Self;
    fn sin(&self) -> Self;
    fn cos(&self) -> Self;
    fn powi(&self, n: i32) -> Self;
    fn powf(&self, n: f64) -> Self;
    /// A power whose exponent is of the same type.
    fn powd(&self, n: Self) -> Self;
}

thread_local! {
    static BLENDS: Cell<bool> = const { Cell::new(false) };
}

/// Computes with the slopes that [`Scalar::abs_about_rest`] has for small changes; elsewhere they are those of the branch it is on.
pub(crate) fn blended_at_rest<R>(compute: impl FnOnce() -> R) -> R {
    let before = BLENDS.replace(true);
    let result = compute();
    BLENDS.set(before);
    result
}

/// Whether slopes are those of small changes here.
fn is_blended() -> bool {
    BLENDS.get()
}

/// Functions handed on as they are.
macro_rules! hand_on {
    ($($function:ident),*) => {
        $(#[inline]
        fn $function(&self) -> Self {
            DualNum::$function(self)
        })*
    };
}

impl<T: DualNum<Primitive = f64> + Copy + Send + Sync + 'static> Scalar for T {
    const DERIVATIVES: usize = T::NDERIV;

    #[inline]
    fn value(&self) -> f64 {
        self.re()
    }

    #[inline]
    fn constant(value: f64) -> Self {
        Self::from(value)
    }

    #[inline]
    fn abs(&self) -> Self {
        T::abs(self)
    }

    #[inline]
    fn abs_about_rest(&self, still: Self) -> Self {
        let (x, still) = (self.value(), still.value());
        if T::NDERIV == 0 || x.abs() >= still || !is_blended() {
            return T::abs(self);
        }
        *self * (x / still) + (x.abs() - x * x / still)
    }

    hand_on!(recip, sqrt, exp, exp_m1, ln, ln_1p, tanh, sin, cos);

    #[inline]
    fn powi(&self, n: i32) -> Self {
        DualNum::powi(self, n)
    }

    #[inline]
    fn powf(&self, n: f64) -> Self {
        DualNum::powf(self, n)
    }

    #[inline]
    fn powd(&self, n: Self) -> Self {
        // Of what is not above zero there are whole powers only, and nothing follows their exponent.
        let exponent = n.value();
        if self.value() <= 0.0 && exponent.fract() == 0.0 {
            return DualNum::powi(self, exponent as i32);
        }
        DualNum::powd(self, n)
    }
}
