//! Several numbers side by side.

use std::cell::Cell;
use std::iter::Sum;
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::Scalar;

/// The same quantity of `L` parameter sets: arithmetic is done on all at once, each exactly as by itself.
///
/// A branch can go only one way. Where the numbers would not all take the same, the first one decides and the
/// disagreement is noted for the thread: whoever started the computation asks for it afterwards, throws the result away and
/// follows each set by itself (`system::rom`). A law that knows nothing of lanes can therefore be slow but never wrong.
///
/// ```
/// use smam::muscle::Coil;
/// use smam::scalar::Lanes;
///
/// let coils = Coil { stiffness_n_m: Lanes([28.3, 30.0]), preload_n: Lanes([0.1, 0.1]) };
/// let Lanes(pull_n) = coils.pull_n(Lanes([0.01, 0.01]));
/// let one = Coil { stiffness_n_m: 30.0, preload_n: 0.1 };
/// assert_eq!(pull_n[1], one.pull_n(0.01));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const L: usize>(pub [f64; L]);

thread_local! {
    static DISAGREED: Cell<bool> = const { Cell::new(false) };
}

#[cold]
fn disagree() {
    DISAGREED.set(true);
}

/// Whether lanes of this thread have disagreed since this was last asked.
pub(crate) fn take_disagreement() -> bool {
    DISAGREED.replace(false)
}

impl<const L: usize> Lanes<L> {
    #[inline(always)]
    fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    /// The row of each lane; none where one is outside the table.
    #[inline(always)]
    fn rows<'a, R>(&self, row: impl Fn(f64) -> Option<&'a R>) -> Option<[&'a R; L]> {
        let mut rows = [row(self.0[0]); L];
        for (own, &x) in rows.iter_mut().zip(&self.0).skip(1) {
            *own = row(x);
        }
        let first = rows[0];
        if rows.iter().any(|row| row.is_some() != first.is_some()) {
            disagree();
        }
        let mut found = [first?; L];
        for (to, row) in found.iter_mut().zip(rows) {
            *to = row?;
        }
        Some(found)
    }

    /// The answer of all lanes, or of the first.
    #[inline(always)]
    fn ask(&self, holds: impl Fn(f64) -> bool) -> bool {
        let count = self.0.iter().filter(|x| holds(**x)).count();
        if count != 0 && count != L {
            disagree();
        }
        holds(self.0[0])
    }
}

/// An operator on lanes, and between lanes and a number that all share.
macro_rules! operator {
    ($($operator:ident $of:ident $sign:tt)*) => {$(
        impl<const L: usize> $operator for Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $of(self, other: Self) -> Self {
                self.zip(other, |a, b| a $sign b)
            }
        }
        impl<const L: usize> $operator<f64> for Lanes<L> {
            type Output = Self;
            #[inline(always)]
            fn $of(self, other: f64) -> Self {
                self.map(|a| a $sign other)
            }
        }
    )*};
}

operator! {
    Add add +
    Sub sub -
    Mul mul *
    Div div /
}

assigns!(Lanes);

impl<const L: usize> Neg for Lanes<L> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|a| -a)
    }
}

impl<const L: usize> Sum for Lanes<L> {
    /// From zero of the sign that plain sums begin with.
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self([-0.0; L]), |sum, term| sum + term)
    }
}

/// Functions lane by lane.
macro_rules! each {
    ($($function:ident),*) => {
        $(#[inline(always)]
        fn $function(&self) -> Self {
            self.map(f64::$function)
        })*
    };
}

impl<const L: usize> Scalar for Lanes<L> {
    const DERIVATIVES: usize = 0;

    #[inline(always)]
    fn value(&self) -> f64 {
        if self.0.iter().any(|x| x.to_bits() != self.0[0].to_bits()) {
            disagree();
        }
        self.0[0]
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self([value; L])
    }

    #[inline(always)]
    fn is_above(&self, bound: f64) -> bool {
        self.ask(|x| x > bound)
    }

    #[inline(always)]
    fn is_below(&self, bound: f64) -> bool {
        self.ask(|x| x < bound)
    }

    #[inline(always)]
    fn is_at(&self, bound: f64) -> bool {
        self.ask(|x| x == bound)
    }

    #[inline(always)]
    fn is_finite(&self) -> bool {
        self.ask(f64::is_finite)
    }

    #[inline(always)]
    fn select_above(self, bound: Self, then: Self, otherwise: Self) -> Self {
        Self(std::array::from_fn(|i| if self.0[i] > bound.0[i] { then.0[i] } else { otherwise.0[i] }))
    }

    #[inline(always)]
    fn look_up<'a, const N: usize>(self, row: impl Fn(f64) -> Option<&'a [Self; N]>) -> Option<[Self; N]> {
        let rows = self.rows(row)?;
        // Sets that differ little are mostly in one row.
        if rows.iter().all(|row| std::ptr::eq(*row, rows[0])) {
            return Some(*rows[0]);
        }
        let mut found = [Self([0.0; L]); N];
        for (lane, row) in rows.into_iter().enumerate() {
            for (to, from) in found.iter_mut().zip(row) {
                to.0[lane] = from.0[lane];
            }
        }
        Some(found)
    }

    #[inline(always)]
    fn look_up_plain<'a, const N: usize>(self, row: impl Fn(f64) -> Option<&'a [f64; N]>) -> Option<[Self; N]> {
        let rows = self.rows(row)?;
        let mut found = [Self([0.0; L]); N];
        for (lane, row) in rows.into_iter().enumerate() {
            for (to, from) in found.iter_mut().zip(row) {
                to.0[lane] = *from;
            }
        }
        Some(found)
    }

    each!(abs, recip, sqrt, exp, exp_m1, ln, ln_1p, tanh, sin, cos);

    #[inline(always)]
    fn powi(&self, n: i32) -> Self {
        self.map(|x| x.powi(n))
    }

    #[inline(always)]
    fn powf(&self, n: f64) -> Self {
        self.map(|x| x.powf(n))
    }

    #[inline(always)]
    fn powd(&self, n: Self) -> Self {
        self.zip(n, |x, n| Scalar::powd(&x, n))
    }
}
