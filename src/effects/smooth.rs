//! Functions that several laws share.

use crate::scalar::Scalar;

/// `ln cosh x`, the integral of `tanh`, without overflow.
pub(super) fn ln_cosh<D: Scalar>(x: D) -> D {
    let size = x.abs();
    size + (-(size * 2.0)).exp().ln_1p() - std::f64::consts::LN_2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_zero_and_far_away() {
        assert_eq!(ln_cosh(0.0), 0.0);
        assert!((ln_cosh(0.7) - 0.7_f64.cosh().ln()).abs() < 1e-15);
        assert!((ln_cosh(-1e3) - (1e3 - std::f64::consts::LN_2)).abs() < 1e-9);
    }
}
