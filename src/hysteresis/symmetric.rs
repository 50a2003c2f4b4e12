//! The symmetric Bouc-Wen model.

use super::branch::Branch;
use super::error::{HysteresisError, not_negative, positive};
use crate::scalar::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Symmetric Bouc-Wen model, Thai et al. 2021, eqs. (1)-(2):
///
/// `y = gamma_x x + gamma_z z`, `dz/dt = K dx/dt - lambda |dx/dt| |z|^(n-1) z - delta dx/dt |z|^n`.
///
/// `x`, `y`, `z` in mm; `gamma_x`, `gamma_z`, `K`, `n` dimensionless, `lambda`, `delta` in mm^-n. Range: `K > 0`,
/// `lambda + delta > 0` (bounded state), `n > 0`; the loop loses energy while `lambda >= |delta|`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SymmetricBoucWen<D> {
    pub gamma_x: D,
    pub gamma_z: D,
    pub k: D,
    pub lambda: D,
    pub delta: D,
    pub n: D,
}

impl<D: Scalar> SymmetricBoucWen<D> {
    /// Parameters in the order of [`SymmetricBoucWen::to_array`].
    pub(crate) const PARAMETERS: [&'static str; 6] = ["gamma_x", "gamma_z", "k", "lambda", "delta", "n"];

    pub fn from_array([gamma_x, gamma_z, k, lambda, delta, n]: [D; 6]) -> Self {
        Self { gamma_x, gamma_z, k, lambda, delta, n }
    }

    pub fn to_array(&self) -> [D; 6] {
        [self.gamma_x, self.gamma_z, self.k, self.lambda, self.delta, self.n]
    }

    /// Whether the state stays bounded.
    pub fn check(&self) -> Result<(), HysteresisError> {
        const MODEL: &str = "symmetric Bouc-Wen";
        positive(MODEL, "k", self.k.value())?;
        positive(MODEL, "n", self.n.value())?;
        positive(MODEL, "lambda + delta", (self.lambda + self.delta).value())
    }

    /// Whether every closed loop turns the same way, `∮ z dx >= 0`: `lambda >= |delta|`.
    ///
    /// With `z²/(2K)` as stored energy, `z dx` less what is stored is `|z|^(n+1) (lambda + delta sgn(z dx)) |dx|/K`.
    /// Source: Erlicher and Point 2004.
    pub fn check_loops(&self) -> Result<(), HysteresisError> {
        self.check()?;
        not_negative("symmetric Bouc-Wen", "lambda - |delta|", self.lambda.value() - self.delta.value().abs())
    }

    /// Output, mm.
    pub fn output(&self, x_mm: D, z: D) -> D {
        self.gamma_x * x_mm + self.gamma_z * z
    }

    /// State after the input went straight from `from_mm` to `to_mm`.
    ///
    /// ```
    /// use smam::hysteresis::SymmetricBoucWen;
    ///
    /// let model = SymmetricBoucWen::from_array([1.0_f64, 1.0, 2.0, 0.9, 0.3, 1.5]);
    /// // Far along, the state stands at (K/(lambda + delta))^(1/n), and at its opposite the other way.
    /// let limit = (2.0_f64 / 1.2).powf(1.0 / 1.5);
    /// assert!((model.advance(0.0, 0.0, 40.0) - limit).abs() < 1e-9);
    /// assert!((model.advance(0.3, 0.0, -40.0) + limit).abs() < 1e-9);
    /// ```
    pub fn advance(&self, z: D, from_mm: D, to_mm: D) -> D {
        let way = to_mm - from_mm;
        let sign = if way.value() < 0.0 { -1.0 } else { 1.0 };
        self.branch(sign).travel(z, way * sign)
    }

    /// The state's law while the input goes up (`sign` 1) or down (-1).
    pub(super) fn branch(&self, sign: f64) -> Branch<D> {
        Branch {
            drive: self.k * sign,
            decay_above: self.lambda + self.delta * sign,
            decay_below: self.lambda - self.delta * sign,
            exponent: self.n,
        }
    }
}
