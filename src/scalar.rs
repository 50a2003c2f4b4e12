//! The number type the laws are written over.

use num_dual::DualNum;

/// A real number, or one that carries exact derivatives.
///
/// Every law of the hydraulics, the muscle and the hysteresis is generic over this trait: with `f64` it is
/// the plain law, with a dual number of `num-dual` the same code also yields exact sensitivities to the
/// calibrated parameters. Branches look only at the real part, [`Scalar::value`].
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
