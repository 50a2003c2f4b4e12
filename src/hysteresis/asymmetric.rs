//! The generalized asymmetric Bouc-Wen model.

use super::branch::Branch;
use super::error::{HysteresisError, not_negative, positive};
use crate::scalar::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Generalized asymmetric Bouc-Wen model with ten parameters:
///
/// `y = alpha_x x + alpha_z z`, `dz/dt = dx/dt (A - |z|^n psi)`,
/// `psi = b1 sgn(v z) + b2 sgn(x v) + b3 sgn(x z) + b4 sgn(v) + b5 sgn(z) + b6 sgn(x)`, `v = dx/dt`.
///
/// `x`, `y`, `z` in mm; `alpha_x`, `alpha_z`, `A`, `n` dimensionless, `b1..b6` in mm^-n. Range: `A > 0`, `n > 0`, and
/// the pull-back positive in each of the four cases where `z` grows ([`AsymmetricBoucWen::check`]).
///
/// Source: `psi` is Song and Der Kiureghian's (J. Eng. Mech. 132, 2006). Thai et al. 2021 do not print their
/// ten-parameter comparison; they cite Do et al., Mechatronics 24, 2014. **That this is their form is our
/// reading**: six shape terms, `A`, `n` and the two output gains make exactly ten. In the six phases of a loop about
/// the origin (all but `sgn x = sgn v != sgn z`), `b1 = lambda + delta`, `b2 = -delta`, `b3 = delta` is the symmetric model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AsymmetricBoucWen<D> {
    pub alpha_x: D,
    pub alpha_z: D,
    pub a: D,
    pub n: D,
    /// `b1..b6`.
    pub shape: [D; 6],
}

impl<D: Scalar> AsymmetricBoucWen<D> {
    /// Parameters in the order of [`AsymmetricBoucWen::to_array`].
    pub(crate) const PARAMETERS: [&'static str; 10] =
        ["alpha_x", "alpha_z", "a", "n", "b1", "b2", "b3", "b4", "b5", "b6"];

    pub fn from_array([alpha_x, alpha_z, a, n, b1, b2, b3, b4, b5, b6]: [D; 10]) -> Self {
        Self { alpha_x, alpha_z, a, n, shape: [b1, b2, b3, b4, b5, b6] }
    }

    pub fn to_array(&self) -> [D; 10] {
        let [b1, b2, b3, b4, b5, b6] = self.shape;
        [self.alpha_x, self.alpha_z, self.a, self.n, b1, b2, b3, b4, b5, b6]
    }

    /// Whether the state stays bounded.
    pub fn check(&self) -> Result<(), HysteresisError> {
        const MODEL: &str = "asymmetric Bouc-Wen";
        positive(MODEL, "a", self.a.value())?;
        positive(MODEL, "n", self.n.value())?;
        for (side, way) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let pull_back = self.pull_back(side, way, way).value();
            positive(MODEL, "pull-back of a growing state", pull_back)?;
        }
        Ok(())
    }

    /// Whether every closed loop turns the same way, `∮ z dx >= 0`: the pull-back is nowhere negative.
    ///
    /// With `z²/(2A)` as stored energy, `z dx` less what is stored is `|z|^(n+1)` times the pull-back over `A`. A pull-back on a
    /// side of `x = 0` that the input never visits, by its least and greatest value, does not matter.
    pub fn check_loops(&self, range_mm: [f64; 2]) -> Result<(), HysteresisError> {
        self.check()?;
        let visited = [(-1.0, range_mm[0] < 0.0), (1.0, range_mm[1] > 0.0)];
        for (side, _) in visited.into_iter().filter(|(_, visited)| *visited) {
            for (way, sign) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
                not_negative("asymmetric Bouc-Wen", "pull-back", self.pull_back(side, way, sign).value())?;
            }
        }
        Ok(())
    }

    /// Output, mm.
    pub fn output(&self, x_mm: D, z: D) -> D {
        self.alpha_x * x_mm + self.alpha_z * z
    }

    /// State after the input went straight from `from_mm` to `to_mm`; the law changes at `x = 0`.
    pub fn advance(&self, z: D, from_mm: D, to_mm: D) -> D {
        if from_mm.value() * to_mm.value() < 0.0 {
            let origin = D::constant(0.0);
            let halfway = self.advance_on_one_side(z, from_mm, origin);
            return self.advance_on_one_side(halfway, origin, to_mm);
        }
        self.advance_on_one_side(z, from_mm, to_mm)
    }

    fn advance_on_one_side(&self, z: D, from_mm: D, to_mm: D) -> D {
        let length = to_mm - from_mm;
        let way = if length.value() < 0.0 { -1.0 } else { 1.0 };
        let side = if (from_mm + to_mm).value() < 0.0 { -1.0 } else { 1.0 };
        self.branch(side, way).travel(z, length * way)
    }

    /// The state's law on one side of `x = 0` (1 or -1) while the input goes up (`way` 1) or down (-1).
    pub(super) fn branch(&self, side: f64, way: f64) -> Branch<D> {
        Branch {
            drive: self.a * way,
            decay_above: self.pull_back(side, way, 1.0),
            decay_below: self.pull_back(side, way, -1.0),
            exponent: self.n,
        }
    }

    /// `psi sgn(v z)`: the decay for given signs of `x`, `v` and `z`.
    fn pull_back(&self, side: f64, way: f64, sign: f64) -> D {
        let [b1, b2, b3, b4, b5, b6] = self.shape;
        b1 + b2 * (side * sign) + b3 * (side * way) + b4 * sign + b5 * way + b6 * (side * way * sign)
    }
}
