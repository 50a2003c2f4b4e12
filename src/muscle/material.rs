//! Hyperelastic laws of the wall's silicone, incompressible.

use super::error::{MuscleError, positive};
use crate::scalar::Scalar;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Gent's limit is approached up to this share; beyond it the energy goes on as a parabola.
const GENT_SHARE: f64 = 0.999;

/// One term of Ogden's law. A term with `mu_pa = 0` adds nothing; `alpha` must not be zero.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OgdenTerm<D> {
    /// Modulus of the term, Pa (its share of the shear modulus is `mu alpha / 2`).
    pub mu_pa: D,
    /// Exponent of the principal stretches.
    pub alpha: D,
}

/// Strain energy `W` per reference volume, Pa, of an incompressible rubber.
///
/// With the principal stretches `l1 l2 l3 = 1` and `J = l1^2 + l2^2 + l3^2 - 3`:
///
/// | law | energy | range |
/// |---|---|---|
/// | neo-Hookean | `C1 J` | moderate strain |
/// | Yeoh (1993) | `C1 J + C2 J^2 + C3 J^3` | large strain, one data set per silicone |
/// | Ogden (1972) | `sum mu/alpha (l1^alpha + l2^alpha + l3^alpha - 3)` | any, `mu alpha > 0` for stability |
/// | Gent (1996) | `-mu Jm/2 ln(1 - J/Jm)` | `J < Jm`; beyond `0.999 Jm` a parabola with the same value, slope and curvature |
///
/// The parabola keeps a simulation finite past the locking stretch; it is no physics there, and
/// `Wall::valid_range` says where it begins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "snake_case", deny_unknown_fields)]
pub enum Material<D> {
    NeoHookean { c1_pa: D },
    Yeoh { c1_pa: D, c2_pa: D, c3_pa: D },
    Ogden { terms: [OgdenTerm<D>; 3] },
    Gent { mu_pa: D, jm: D },
}

/// `W` and its derivatives to the logarithmic strains `h1 = ln l1` (axial) and `h2 = ln l2` (hoop), the third
/// being `-(h1 + h2)`; Pa.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response<D> {
    pub w: D,
    pub w1: D,
    pub w2: D,
    pub w11: D,
    pub w12: D,
    pub w22: D,
}

impl Material<f64> {
    /// Refuses moduli that leave the silicone without stiffness.
    pub fn check(&self) -> Result<(), MuscleError> {
        if let Material::Gent { jm, .. } = self {
            positive("jm", *jm)?;
        }
        if let Some(number) = self.numbers().into_iter().find(|n| !n.is_finite()) {
            return Err(MuscleError::Parameter {
                name: "a number of the material's law",
                value: number,
                rule: "finite",
            });
        }
        positive("shear modulus, Pa", self.shear_modulus_pa())
    }

    fn numbers(&self) -> Vec<f64> {
        match *self {
            Material::NeoHookean { c1_pa } => vec![c1_pa],
            Material::Yeoh { c1_pa, c2_pa, c3_pa } => vec![c1_pa, c2_pa, c3_pa],
            Material::Ogden { terms } => terms.iter().flat_map(|t| [t.mu_pa, t.alpha]).collect(),
            Material::Gent { mu_pa, jm } => vec![mu_pa, jm],
        }
    }
}

impl<D: Scalar> Material<D> {
    /// Shear modulus at small strain, Pa.
    ///
    /// ```
    /// use smam::muscle::Material;
    ///
    /// let silicone = Material::Yeoh { c1_pa: 0.255e6_f64, c2_pa: 0.0155e6, c3_pa: 0.0 };
    /// assert_eq!(silicone.shear_modulus_pa(), 0.51e6);
    /// assert!(silicone.check().is_ok());
    /// assert!(Material::NeoHookean { c1_pa: -0.255e6_f64 }.check().is_err());
    /// ```
    pub fn shear_modulus_pa(&self) -> D {
        match self {
            Material::NeoHookean { c1_pa } | Material::Yeoh { c1_pa, .. } => *c1_pa * 2.0,
            Material::Ogden { terms } => terms.iter().map(|t| t.mu_pa * t.alpha * 0.5).sum(),
            Material::Gent { mu_pa, .. } => *mu_pa,
        }
    }

    /// The same law over another number type, parameter by parameter.
    pub fn map<E>(&self, f: impl Fn(D) -> E) -> Material<E> {
        match *self {
            Material::NeoHookean { c1_pa } => Material::NeoHookean { c1_pa: f(c1_pa) },
            Material::Yeoh { c1_pa, c2_pa, c3_pa } => {
                Material::Yeoh { c1_pa: f(c1_pa), c2_pa: f(c2_pa), c3_pa: f(c3_pa) }
            }
            Material::Ogden { terms } => {
                Material::Ogden { terms: terms.map(|t| OgdenTerm { mu_pa: f(t.mu_pa), alpha: f(t.alpha) }) }
            }
            Material::Gent { mu_pa, jm } => Material::Gent { mu_pa: f(mu_pa), jm: f(jm) },
        }
    }

    /// `C1, C2, C3` where the energy is linear in them.
    pub(super) fn linear_coefficients(&self) -> Option<[D; 3]> {
        match *self {
            Material::NeoHookean { c1_pa } => Some([c1_pa, D::constant(0.0), D::constant(0.0)]),
            Material::Yeoh { c1_pa, c2_pa, c3_pa } => Some([c1_pa, c2_pa, c3_pa]),
            _ => None,
        }
    }

    /// Largest `J = I1 - 3` at which the law itself holds (infinite but for Gent).
    pub(super) fn largest_invariant(&self) -> f64 {
        match self {
            Material::Gent { jm, .. } => GENT_SHARE * jm.value(),
            _ => f64::INFINITY,
        }
    }

    /// The response at squared axial and hoop stretches `a` and `b`.
    pub(super) fn response(&self, a: D, b: D) -> Response<D> {
        match self {
            Material::Ogden { terms } => ogden_response(terms, a, b),
            _ => self.invariant_response(a, b),
        }
    }

    fn invariant_response(&self, a: D, b: D) -> Response<D> {
        let c = (a * b).recip();
        let [w, slope, curvature] = self.profile(a + b + c - 3.0);
        let (j1, j2) = ((a - c) * 2.0, (b - c) * 2.0);
        Response {
            w,
            w1: slope * j1,
            w2: slope * j2,
            w11: curvature * j1 * j1 + slope * (a + c) * 4.0,
            w12: curvature * j1 * j2 + slope * c * 4.0,
            w22: curvature * j2 * j2 + slope * (b + c) * 4.0,
        }
    }

    /// `W`, `dW/dJ`, `d2W/dJ2` of the laws in `J` alone.
    fn profile(&self, j: D) -> [D; 3] {
        match *self {
            Material::NeoHookean { c1_pa } => [c1_pa * j, c1_pa, D::constant(0.0)],
            Material::Yeoh { c1_pa, c2_pa, c3_pa } => [
                j * (c1_pa + j * (c2_pa + j * c3_pa)),
                c1_pa + j * (c2_pa * 2.0 + j * c3_pa * 3.0),
                c2_pa * 2.0 + j * c3_pa * 6.0,
            ],
            Material::Gent { mu_pa, jm } => gent_profile(mu_pa, jm, j),
            // Ogden's law is not one of `J`; `response` never sends it here.
            Material::Ogden { .. } => [D::constant(0.0); 3],
        }
    }
}

fn gent_profile<D: Scalar>(mu: D, jm: D, j: D) -> [D; 3] {
    let edge = jm * GENT_SHARE;
    let at = edge.select_above(j, j, edge);
    let room = -(at / jm) + 1.0;
    let w = -(mu * jm * 0.5 * room.ln());
    let slope = mu * 0.5 / room;
    let curvature = slope / (room * jm);
    let past = j - at;
    [w + past * (slope + past * curvature * 0.5), slope + past * curvature, curvature]
}

fn ogden_response<D: Scalar>(terms: &[OgdenTerm<D>; 3], a: D, b: D) -> Response<D> {
    let (h1, h2) = (a.ln() * 0.5, b.ln() * 0.5);
    let zero = D::constant(0.0);
    let mut sum = Response { w: zero, w1: zero, w2: zero, w11: zero, w12: zero, w22: zero };
    for OgdenTerm { mu_pa, alpha } in *terms {
        let p1 = (alpha * h1).exp();
        let p2 = (alpha * h2).exp();
        let p3 = (p1 * p2).recip();
        sum.w += mu_pa / alpha * (p1 + p2 + p3 - 3.0);
        sum.w1 += mu_pa * (p1 - p3);
        sum.w2 += mu_pa * (p2 - p3);
        sum.w11 += mu_pa * alpha * (p1 + p3);
        sum.w12 += mu_pa * alpha * p3;
        sum.w22 += mu_pa * alpha * (p2 + p3);
    }
    sum
}
