//! Dahl's friction that grows along the input.

use super::branch::Branch;
use super::error::{HysteresisError, not_negative, positive};
use crate::scalar::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Friction of Dahl's kind that grows along the input, on a curve:
///
/// `y = y0 + g x + q x² + s x³ + k (1 + c x) z`, `dz/dt = |du/dt| (sgn(du/dt) + rho - nu z)`, `u = x + e x²`.
///
/// `x`, `y`, `y0`, `u`, `z` in mm; `g`, `k`, `rho` dimensionless, `q`, `c`, `e`, `nu` in 1/mm, `s` in 1/mm². A muscle's friction grows with
/// its pressure, hence `c`, and slides with its elongation, which is no straight line over the plunger, hence `e`. Range: `nu > 0`,
/// `|rho| < 1`, inputs with `1 + 2 e x > 0`. Source: Dahl 1968; the state of Thai et al. 2021, eq. (4), at `A = n = 1`;
/// the growth and the two curves are ours ([`crate::muscle::Friction`] is the law that they stand for).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, bound(deserialize = "D: Scalar + Deserialize<'de>"))]
pub struct DahlGrowing<D> {
    /// `y0`, mm: where the output counts from.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub offset: D,
    /// Output per input beside the friction, `g`.
    pub gain: D,
    /// `q`, 1/mm.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub curvature: D,
    /// `s`, 1/mm².
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub cubic: D,
    /// Output per state at `x = 0`, `k`.
    pub stiffness: D,
    /// `c`, 1/mm.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub growth: D,
    /// 1/mm.
    pub nu: D,
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub rho: D,
    /// `e`, 1/mm.
    #[serde(default = "super::zero")]
    #[schemars(default = "super::zero::<f64>")]
    pub bend: D,
}

const MODEL: &str = "growing Dahl";

impl<D: Scalar> DahlGrowing<D> {
    /// Parameters in the order of [`DahlGrowing::to_array`].
    pub(crate) const PARAMETERS: [&'static str; 9] =
        ["offset", "gain", "curvature", "cubic", "stiffness", "growth", "nu", "rho", "bend"];

    pub fn from_array([offset, gain, curvature, cubic, stiffness, growth, nu, rho, bend]: [D; 9]) -> Self {
        Self { offset, gain, curvature, cubic, stiffness, growth, nu, rho, bend }
    }

    pub fn to_array(&self) -> [D; 9] {
        let Self { offset, gain, curvature, cubic, stiffness, growth, nu, rho, bend } = *self;
        [offset, gain, curvature, cubic, stiffness, growth, nu, rho, bend]
    }

    /// Output, mm.
    pub fn output(&self, x_mm: D, z: D) -> D {
        let curve = self.offset + (self.gain + (self.curvature + self.cubic * x_mm) * x_mm) * x_mm;
        curve + self.stiffness * (self.growth * x_mm + 1.0) * z
    }

    /// State after the input went straight from `from_mm` to `to_mm`; exact.
    ///
    /// ```
    /// use smam::hysteresis::DahlGrowing;
    ///
    /// let model = DahlGrowing::from_array([0.0_f64, 9.0, 0.0, 0.0, -2.0, 0.5, 1.25, 0.2, 0.0]);
    /// // Far along, the state stands at (1 + rho)/nu; turned about, 1/e of the way to -(1 - rho)/nu is left after 1/nu.
    /// let limit = model.advance(0.0, 0.0, 40.0);
    /// assert!((limit - 1.2 / 1.25).abs() < 1e-12);
    /// let back = model.advance(limit, 40.0, 39.2);
    /// assert!((back - (-0.8 + 2.0 / std::f64::consts::E) / 1.25).abs() < 1e-12);
    /// ```
    pub fn advance(&self, z: D, from_mm: D, to_mm: D) -> D {
        let way = self.travel(to_mm) - self.travel(from_mm);
        let sign = if way.value() < 0.0 { -1.0 } else { 1.0 };
        let branch =
            Branch { drive: self.rho + sign, decay_above: self.nu, decay_below: self.nu, exponent: D::constant(1.0) };
        branch.closed_form(z, way * sign)
    }

    /// `u`, mm.
    fn travel(&self, x_mm: D) -> D {
        x_mm + self.bend * x_mm * x_mm
    }

    /// Whether the state stays bounded and follows the motion.
    pub fn check(&self) -> Result<(), HysteresisError> {
        positive(MODEL, "nu", self.nu.value())?;
        positive(MODEL, "1 - |rho|", 1.0 - self.rho.value().abs())
    }

    /// Whether every loop within a range of inputs turns the same way, `∮ (1 + c x) z dx >= 0`.
    ///
    /// With `w = (1 + c x)/(1 + 2 e x)` the integrand is `w z du`. As `(z - z0) du = (z - z0) dz + nu (z - z0)² |du|` with
    /// `z0 = rho/nu`, and in parts, it is at least `∮ (nu w - |dw/du|/2)(z - z0)² |du|`: enough is
    /// `|c - 2 e| <= 2 nu (1 + c x)(1 + 2 e x)²`, whose right side, a product of falling or rising lines above zero, is least at an end.
    pub fn check_loops(&self, range_mm: [f64; 2]) -> Result<(), HysteresisError> {
        self.check()?;
        let [growth, bend, nu] = [self.growth, self.bend, self.nu].map(|p| p.value());
        for x_mm in range_mm {
            let (level, slope) = (1.0 + growth * x_mm, 1.0 + 2.0 * bend * x_mm);
            positive(MODEL, "1 + 2 bend x", slope)?;
            not_negative(MODEL, "1 + growth x", level)?;
            let least = 2.0 * nu * level * slope * slope - (growth - 2.0 * bend).abs();
            not_negative(MODEL, "2 nu (1 + growth x)(1 + 2 bend x)^2 - |growth - 2 bend|", least)?;
        }
        Ok(())
    }
}
