//! `a^b` in plain arithmetic, so that the compiler can take several at once. For `a > 0`, to 1e-11.

use std::f64::consts::{LN_2, LOG2_E, SQRT_2};

/// 2^52: added to a small integer, leaves it in the low bits of the mantissa.
const TWO_52: f64 = 4_503_599_627_370_496.0;
/// Coefficients of `2 artanh(s)/s` in `s²`.
const ARTANH: [f64; 8] = [2.0, 2.0 / 3.0, 2.0 / 5.0, 2.0 / 7.0, 2.0 / 9.0, 2.0 / 11.0, 2.0 / 13.0, 2.0 / 15.0];
/// 1/k!, k = 0..10.
const FACTORIALS: [f64; 11] = [
    1.0,
    1.0,
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
];

/// `base^exponent` for a normal `base > 0`; results beyond 2^±1000 are cut there.
#[inline(always)]
pub(super) fn power(base: f64, exponent: f64) -> f64 {
    exponential(exponent * logarithm(base))
}

/// `(1 - exp(-x))/x` to `x⁴/720`; above zero for every `x`.
#[inline(always)]
pub(super) fn unfinished(x: f64) -> f64 {
    1.0 / (1.0 + x * (0.5 + x * (1.0 / 12.0)))
}

/// Natural logarithm: `x = m 2^k` with `m` around 1, and `ln m = 2 artanh((m - 1)/(m + 1))`.
#[inline(always)]
fn logarithm(x: f64) -> f64 {
    // Shifted so that the mantissa's cut falls at sqrt(1/2).
    let shift = 1.0f64.to_bits() - (SQRT_2 / 2.0).to_bits();
    let bits = x.to_bits() + shift;
    let k = f64::from_bits((bits >> 52) | TWO_52.to_bits()) - (TWO_52 + 1023.0);
    let mantissa = f64::from_bits((bits & ((1 << 52) - 1)) + (SQRT_2 / 2.0).to_bits());
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    k * LN_2 + s * polynomial(&ARTANH, s * s)
}

/// `2^k exp(r)` with `r` within half of ln 2.
#[inline(always)]
fn exponential(x: f64) -> f64 {
    let x = x.clamp(-1000.0 * LN_2, 1000.0 * LN_2);
    // Adding 1.5 2^52 rounds to an integer and leaves it in the low bits.
    let rounder = 1.5 * TWO_52;
    let shifted = x * LOG2_E + rounder;
    let r = x - (shifted - rounder) * LN_2;
    let scale = f64::from_bits((shifted.to_bits().wrapping_add(1023)) << 52);
    scale * polynomial(&FACTORIALS, r)
}

/// Even and odd powers apart: two short chains of operations instead of a long one.
#[inline(always)]
fn polynomial<const N: usize>(coefficients: &[f64; N], x: f64) -> f64 {
    let (mut even, mut odd) = (0.0, 0.0);
    for (i, c) in coefficients.iter().enumerate().rev() {
        if i % 2 == 0 {
            even = even * (x * x) + c;
        } else {
            odd = odd * (x * x) + c;
        }
    }
    even + x * odd
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meets_the_library() {
        for i in 1..2_000 {
            let base = f64::from(i) * 1e-3 * f64::from(i % 17 + 1);
            for exponent in [-0.5, 0.035, 0.0, 1.0, 1.7, 3.0] {
                let (found, exact) = (power(base, exponent), base.powf(exponent));
                assert!((found / exact - 1.0).abs() < 1e-11, "{base}^{exponent}: {found} for {exact}");
            }
        }
        for x in [-0.05f64, -1e-3, 1e-9, 0.01, 0.05] {
            let exact = -(-x).exp_m1() / x;
            assert!((unfinished(x) / exact - 1.0).abs() < 1.5e-8, "{x}: {} for {exact}", unfinished(x));
        }
        for base in [1e-300, 1e-12, 1e12, 1e300] {
            assert!((power(base, 0.5) / base.sqrt() - 1.0).abs() < 1e-11);
        }
    }
}
