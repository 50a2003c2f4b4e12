//! A rubber law in uniaxial tension: a strip in a testing machine.

use super::Material;
use crate::scalar::Scalar;

impl<D: Scalar> Material<D> {
    /// Nominal stress of a strip at a stretch (> 0), force over the undeformed section, Pa.
    ///
    /// ```text
    /// P = dW/dl at l1 = l, l2 = l3 = l^(-1/2);    neo-Hookean: 2 C1 (l - l^-2)
    /// ```
    ///
    /// The sides are free, as in the middle of a strip several times longer than wide. Source: Treloar, The Physics of Rubber
    /// Elasticity (1975).
    ///
    /// ```
    /// use smam::muscle::Material;
    ///
    /// let rubber = Material::NeoHookean { c1_pa: 0.1e6_f64 };
    /// assert!((rubber.uniaxial_pa(2.0) / (0.2e6 * 1.75) - 1.0).abs() < 1e-12);
    /// ```
    pub fn uniaxial_pa(&self, stretch: D) -> D {
        // The slope to the axial strain with the hoop strain held: the hoop's own slope is zero on free sides.
        self.response(stretch * stretch, stretch.recip()).w1 / stretch
    }

    /// Slope of [`Material::uniaxial_pa`] unstretched: Young's modulus, Pa.
    pub fn youngs_modulus_pa(&self) -> D {
        self.shear_modulus_pa() * 3.0
    }
}

#[cfg(test)]
mod tests {
    use crate::muscle::{Material, OgdenTerm};

    /// Every law, with its stress in closed form at a stretch.
    fn laws(l: f64) -> [(Material<f64>, f64); 4] {
        let (j, strain) = (l * l + 2.0 / l - 3.0, l - l.powi(-2));
        let none = OgdenTerm { mu_pa: 0.0, alpha: 1.0 };
        // Mooney-Rivlin is Ogden's law with the exponents 2 and -2.
        let mooney = [OgdenTerm { mu_pa: 2.0e5, alpha: 2.0 }, OgdenTerm { mu_pa: -0.6e5, alpha: -2.0 }, none];
        [
            (Material::NeoHookean { c1_pa: 1e5 }, 2e5 * strain),
            (Material::Yeoh { c1_pa: 1e5, c2_pa: 3e3, c3_pa: -20.0 }, 2.0 * strain * (1e5 + 6e3 * j - 60.0 * j * j)),
            (Material::Gent { mu_pa: 2e5, jm: 40.0 }, 2e5 * strain / (1.0 - j / 40.0)),
            (Material::Ogden { terms: mooney }, 2.0 * strain * (1e5 + 0.3e5 / l)),
        ]
    }

    #[test]
    fn nominal_stress_is_that_of_the_closed_form() {
        for l in [0.9, 1.0, 1.5, 3.0, 5.0] {
            for (material, expected) in laws(l) {
                let found = material.uniaxial_pa(l);
                assert!(
                    (found - expected).abs() < 1e-9 * (1e5 + expected.abs()),
                    "{material:?} at {l}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn the_slope_unstretched_is_youngs_modulus() {
        for (material, _) in laws(1.0) {
            let slope = (material.uniaxial_pa(1.0 + 1e-6) - material.uniaxial_pa(1.0 - 1e-6)) / 2e-6;
            assert!((slope / material.youngs_modulus_pa() - 1.0).abs() < 1e-6, "{material:?}: {slope}");
        }
    }
}
