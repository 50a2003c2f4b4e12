//! What a rubber's law lacks beyond the neo-Hookean: the shapes of other laws, each as a term that is added to it.

use crate::scalar::Scalar;

/// Up to this share of its limit Gent's term follows its law; beyond it goes on as a straight line.
const GENT_SHARE: f64 = 0.95;

/// A term of a rubber law in uniaxial tension, nominal stress over the stretch `l`; `J = l² + 2/l - 3`, `s = l - l^-2`.
///
/// | term | nominal stress | what it bends |
/// |---|---|---|
/// | Yeoh (1993) | `2 s (2 C2 J + 3 C3 J²)` | stiffer (or softer) at large stretch |
/// | Mooney-Rivlin (1940) | `2 s C01 / l` | stiffer at the beginning, softer then |
/// | Ogden (1972) | `mu (l^(alpha-1) - l^(-alpha/2-1))` | by the exponent |
/// | Gent (1996) | `mu0 s (1/(1 - J/Jm) - 1)` | locks at `J = Jm`; `mu0` is the shear modulus beside it |
///
/// Gent's number is `1/Jm`, which is zero where the chains have no limit. Beyond `0.95 Jm` its factor goes on as a straight line in
/// `J`, so that a fit on its way stays finite.
///
/// ```
/// use smam::muscle::RubberTerm;
///
/// let yeoh = RubberTerm::Yeoh { c2_pa: 1e3_f64, c3_pa: 0.0 };
/// // At twice the length J = 2, s = 1.75.
/// assert!((yeoh.stress_pa(2.0, 0.0) - 2.0 * 1.75 * 2.0 * 1e3 * 2.0).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RubberTerm<D> {
    Yeoh { c2_pa: D, c3_pa: D },
    MooneyRivlin { c01_pa: D },
    Ogden { mu_pa: D, alpha: D },
    Gent { inverse_limit: D },
}

impl<D: Scalar> RubberTerm<D> {
    /// Nominal stress at a stretch > 0 beside a law of the shear modulus `mu0_pa`, Pa.
    pub fn stress_pa(&self, stretch: D, mu0_pa: D) -> D {
        let l = stretch;
        let (j, strain) = (l * l + l.recip() * 2.0 - 3.0, l - (l * l).recip());
        match *self {
            Self::Yeoh { c2_pa, c3_pa } => strain * 2.0 * j * (c2_pa * 2.0 + c3_pa * j * 3.0),
            Self::MooneyRivlin { c01_pa } => strain * 2.0 * c01_pa / l,
            Self::Ogden { mu_pa, alpha } => {
                let log = l.ln();
                mu_pa * ((log * (alpha - 1.0)).exp() - (log * (alpha * -0.5 - 1.0)).exp())
            }
            Self::Gent { inverse_limit } => mu0_pa * strain * gent_factor(j * inverse_limit),
        }
    }

    /// What it adds to the shear modulus unstretched, Pa.
    pub fn shear_modulus_pa(&self) -> D {
        match *self {
            Self::Yeoh { .. } | Self::Gent { .. } => D::constant(0.0),
            Self::MooneyRivlin { c01_pa } => c01_pa * 2.0,
            Self::Ogden { mu_pa, alpha } => mu_pa * alpha * 0.5,
        }
    }
}

/// `x/(1 - x)`, `x` the share of the limit.
fn gent_factor<D: Scalar>(x: D) -> D {
    let edge = D::constant(GENT_SHARE);
    let at = edge.select_above(x, x, edge);
    let room = (-at + 1.0).recip();
    at * room + (x - at) * room * room
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::muscle::{Material, OgdenTerm};

    /// Each term beside a neo-Hookean law is the law it is named after.
    #[test]
    fn with_a_neo_hookean_law_each_term_makes_the_law_of_its_name() {
        let base = Material::NeoHookean { c1_pa: 1e5 };
        let none = OgdenTerm { mu_pa: 0.0, alpha: 1.0 };
        let two = |mu_pa: f64, alpha: f64| Material::Ogden {
            terms: [OgdenTerm { mu_pa: 2e5, alpha: 2.0 }, OgdenTerm { mu_pa, alpha }, none],
        };
        let cases = [
            (RubberTerm::Yeoh { c2_pa: 3e3, c3_pa: -20.0 }, Material::Yeoh { c1_pa: 1e5, c2_pa: 3e3, c3_pa: -20.0 }),
            (RubberTerm::MooneyRivlin { c01_pa: 0.3e5 }, two(-0.6e5, -2.0)),
            (RubberTerm::Ogden { mu_pa: 50.0, alpha: 6.0 }, two(50.0, 6.0)),
            (RubberTerm::Gent { inverse_limit: 1.0 / 40.0 }, Material::Gent { mu_pa: 2e5, jm: 40.0 }),
        ];
        for (term, law) in cases {
            for l in [1.0, 1.3, 2.0, 4.0] {
                let sum = base.uniaxial_pa(l) + term.stress_pa(l, base.shear_modulus_pa());
                assert!(
                    (sum / law.uniaxial_pa(l) - 1.0).abs() < 1e-9 || l == 1.0 && sum.abs() < 1e-9,
                    "{term:?} at {l}"
                );
            }
            let modulus = base.shear_modulus_pa() + term.shear_modulus_pa();
            assert!((modulus / law.shear_modulus_pa() - 1.0).abs() < 1e-12, "{term:?}");
        }
    }

    #[test]
    fn gents_term_stays_finite_and_smooth_past_its_limit() {
        let slope = |x: f64| (gent_factor(x + 1e-7) - gent_factor(x - 1e-7)) / 2e-7;
        assert!((slope(GENT_SHARE - 1e-6) / slope(GENT_SHARE + 1e-6) - 1.0).abs() < 1e-3);
        assert!(gent_factor(3.0).is_finite() && gent_factor(3.0) > gent_factor(2.0));
        assert_eq!(gent_factor(0.0), 0.0);
    }
}
