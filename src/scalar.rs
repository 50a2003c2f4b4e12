//! The number type the laws are written over.

use num_dual::DualNum;

/// A real number, or one that carries exact derivatives.
///
/// Every law of the hydraulics, the muscle and the hysteresis is generic over this trait: with `f64` it is
/// the plain law, with a dual number of `num-dual` the same code also yields exact sensitivities to the
/// calibrated parameters. Branches look only at the real part, [`Scalar::value`].
pub trait Scalar: DualNum<Primitive = f64> + Copy + Send + Sync + 'static {
    /// The number without its derivatives.
    fn value(&self) -> f64;

    /// A constant: its derivatives are zero.
    fn constant(value: f64) -> Self {
        Self::from(value)
    }
}

impl<T: DualNum<Primitive = f64> + Copy + Send + Sync + 'static> Scalar for T {
    fn value(&self) -> f64 {
        self.re()
    }
}
