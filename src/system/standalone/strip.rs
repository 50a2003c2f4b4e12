//! A strip of rubber in a testing machine.

use crate::effects::{Effect, MaxwellBranch, Native, logarithmic_creep};
use crate::muscle::{Material, RubberTerm};
use crate::scalar::Scalar;
use crate::scene::{Scene, StripSpec};
use crate::system::laws::Act;

/// `F = max(0, A0 P(1 + x/L0) + sum_i E_i (e - e_i))`: the crosshead at `x` from the slack length, `P` the nominal stress of the
/// strip's law. A strip that is slack does not push.
#[derive(Clone, Debug)]
pub(in crate::system) struct Strip {
    pub spec: StripSpec,
    pub position: usize,
}

/// Which number of a strip's law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StripNumber {
    Length,
    C1,
    C2,
    C3,
    Mu,
    Jm,
}

/// The rubber of a strip, and how far it has relaxed.
///
/// Relaxation is quasi-linear: branches are those of a linear muscle whose elongation is `e = A0 P / k`, `k` the strip's stiffness
/// unstretched. At small stretch that is the crosshead's way; at large stretch the overstress bends as the law does, so that what
/// a jump of stretch leaves over time is the same share at every stretch. Source: Fung, Biomechanics (1993), section 7.6.
#[derive(Clone, Debug)]
pub(in crate::system) struct StripRubber<D> {
    pub position: usize,
    length_m: D,
    section_m2: f64,
    material: Material<D>,
    terms: Vec<RubberTerm<D>>,
    /// Stiffness of the relaxed strip unstretched, N/m.
    stiffness_n_m: D,
    /// Each branch with the elongation of its dashpot.
    branches: Vec<(MaxwellBranch<D>, D)>,
    /// Time and elongation of the instant before.
    before: Option<(f64, D)>,
}

impl Strip {
    /// That of a scene, if it has one.
    pub fn of(scene: &Scene) -> Option<Self> {
        let spec = scene.file.strip.clone()?;
        let position = scene.file.input.iter().position(|i| i.channel == spec.position_input)?;
        Some(Self { spec, position })
    }

    /// The strip relaxed, with numbers that differ from the scene's and the effects on it.
    pub fn begin<D: Scalar>(
        &self,
        numbers: impl Iterator<Item = (StripNumber, D)>,
        effects: &[Effect<D>],
    ) -> StripRubber<D> {
        let mut material = self.spec.material.map(D::constant);
        let mut length_m = D::constant(self.spec.length_m);
        for (which, value) in numbers {
            match which {
                StripNumber::Length => length_m = value,
                of_law => material = put(material, of_law, value),
            }
        }
        let terms: Vec<RubberTerm<D>> = effects.iter().filter_map(term).collect();
        let shear_pa = terms.iter().fold(material.shear_modulus_pa(), |sum, term| sum + term.shear_modulus_pa());
        let stiffness_n_m = shear_pa * (3.0 * self.spec.section_m2) / length_m;
        let relaxing = effects.iter().filter(|e| e.entry.native == Some(Native::Viscoelasticity));
        let branches = relaxing.flat_map(|e| branches(&e.values, stiffness_n_m));
        StripRubber {
            position: self.position,
            length_m,
            section_m2: self.spec.section_m2,
            branches: branches.map(|branch| (branch, D::constant(0.0))).collect(),
            material,
            terms,
            stiffness_n_m,
            before: None,
        }
    }
}

fn put<D: Scalar>(material: Material<D>, which: StripNumber, value: D) -> Material<D> {
    match (material, which) {
        (Material::NeoHookean { .. }, StripNumber::C1) => Material::NeoHookean { c1_pa: value },
        (Material::Yeoh { c2_pa, c3_pa, .. }, StripNumber::C1) => Material::Yeoh { c1_pa: value, c2_pa, c3_pa },
        (Material::Yeoh { c1_pa, c3_pa, .. }, StripNumber::C2) => Material::Yeoh { c1_pa, c2_pa: value, c3_pa },
        (Material::Yeoh { c1_pa, c2_pa, .. }, StripNumber::C3) => Material::Yeoh { c1_pa, c2_pa, c3_pa: value },
        (Material::Gent { jm, .. }, StripNumber::Mu) => Material::Gent { mu_pa: value, jm },
        (Material::Gent { mu_pa, .. }, StripNumber::Jm) => Material::Gent { mu_pa, jm: value },
        (other, _) => other,
    }
}

/// The term of a law that an effect adds, if it is one.
fn term<D: Scalar>(effect: &Effect<D>) -> Option<RubberTerm<D>> {
    let v = &effect.values;
    Some(match effect.entry.native {
        Some(Native::RubberYeoh) => RubberTerm::Yeoh { c2_pa: v[0], c3_pa: v[1] },
        Some(Native::RubberMooneyRivlin) => RubberTerm::MooneyRivlin { c01_pa: v[0] },
        Some(Native::RubberOgden) => RubberTerm::Ogden { mu_pa: v[0], alpha: v[1] },
        Some(Native::RubberGent) => RubberTerm::Gent { inverse_limit: v[0] },
        _ => return None,
    })
}

/// The branches of one `viscoelasticity`.
fn branches<D: Scalar>(values: &[D], stiffness_n_m: D) -> Vec<MaxwellBranch<D>> {
    let together = MaxwellBranch { stiffness_n_m: values[0], relaxation_time_s: values[1] };
    match values[2].is_above(0.0) {
        true => logarithmic_creep(together, values[2].value(), stiffness_n_m),
        false => vec![together],
    }
}

impl<D: Scalar> StripRubber<D> {
    /// Force at a position of the crosshead and a time, N, with what laws do to it.
    pub fn force_n(&mut self, position_m: f64, time_s: f64, laws: Act<D>) -> D {
        let elongation = self.elongation_m(position_m);
        let (time_before_s, before) = self.before.replace((time_s, elongation)).unwrap_or((time_s, D::constant(0.0)));
        let dt = time_s - time_before_s;
        let mut force = self.stiffness_n_m * elongation;
        for (branch, dashpot) in &mut self.branches {
            if dt > 0.0 {
                *dashpot = relaxed(branch.relaxation_time_s, (before, elongation), *dashpot, dt);
            }
            force += branch.pull_n(elongation, *dashpot);
        }
        let (force, zero) = (laws.on(force), D::constant(0.0));
        force.select_above(zero, force, zero)
    }

    /// Elongation of the linear muscle that pulls as the relaxed strip does, m; zero while it is slack.
    fn elongation_m(&self, position_m: f64) -> D {
        let stretch = self.length_m.recip() * position_m.max(0.0) + 1.0;
        let shear_pa = self.material.shear_modulus_pa();
        let law_pa = self.material.uniaxial_pa(stretch);
        let stress_pa = self.terms.iter().fold(law_pa, |sum, term| sum + term.stress_pa(stretch, shear_pa));
        stress_pa * self.section_m2 / self.stiffness_n_m
    }
}

/// A dashpot after a time in which the elongation went straight from one value to another: exact.
fn relaxed<D: Scalar>(tau: D, (from, to): (D, D), dashpot: D, dt: f64) -> D {
    // It lags behind a straight line by its time constant times the slope.
    let lead = tau * (to - from) / dt;
    let left = (-(tau.recip() * dt)).exp();
    to - lead + (dashpot - from + lead) * left
}

#[cfg(test)]
mod tests {
    use super::*;

    const L0: f64 = 0.08;
    const A0: f64 = 22e-6;

    fn strip() -> Strip {
        let spec = StripSpec {
            position_input: "position_mm".to_owned(),
            length_m: L0,
            section_m2: A0,
            material: Material::NeoHookean { c1_pa: 1e4 },
        };
        Strip { spec, position: 0 }
    }

    fn effect(text: &str) -> Effect<f64> {
        toml::from_str::<crate::effects::EffectTable>(text).expect("TOML").effect().expect("right")
    }

    #[test]
    fn the_force_is_that_of_the_law_and_never_a_push() {
        let mut rubber = strip().begin::<f64>(std::iter::empty(), &[]);
        assert_eq!(rubber.force_n(-0.01, 0.0, Act::neutral()), 0.0);
        // Twice the length: 2 C1 (2 - 1/4).
        assert!((rubber.force_n(L0, 1.0, Act::neutral()) / (A0 * 2e4 * 1.75) - 1.0).abs() < 1e-12);
        let mut stiffer = strip().begin([(StripNumber::C1, 2e4)].into_iter(), &[]);
        assert!((stiffer.force_n(L0, 0.0, Act::neutral()) / (A0 * 4e4 * 1.75) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn after_a_step_the_overstress_decays_by_its_time_and_in_proportion_to_the_law() {
        let relaxes = effect("name = 'viscoelasticity'\nelement = 'muscle'\nstiffness_n_m = 33\nrelaxation_time_s = 5");
        // Stiffness unstretched: 3 * 2e4 * 22e-6/0.08 = 16.5 N/m; the branch has twice that.
        for stretch in [1.5, 3.0] {
            let mut rubber = strip().begin(std::iter::empty(), std::slice::from_ref(&relaxes));
            let relaxed_n = A0 * 2e4 * (stretch - f64::powi(stretch, -2));
            rubber.force_n(0.0, -1e-9, Act::neutral());
            for t in [0.0, 2.0, 5.0, 50.0] {
                let share = rubber.force_n((stretch - 1.0) * L0, t, Act::neutral()) / relaxed_n;
                assert!((share - (1.0 + 2.0 * (-t / 5.0f64).exp())).abs() < 1e-6, "{share} at {t} s");
            }
        }
    }

    #[test]
    fn a_strip_that_is_let_go_after_relaxing_is_slack() {
        let relaxes = effect("name = 'viscoelasticity'\nelement = 'muscle'\nstiffness_n_m = 33\nrelaxation_time_s = 5");
        let mut rubber = strip().begin(std::iter::empty(), &[relaxes]);
        rubber.force_n(0.0, 0.0, Act::neutral());
        rubber.force_n(L0, 1.0, Act::neutral());
        rubber.force_n(L0, 100.0, Act::neutral());
        assert_eq!(rubber.force_n(0.0, 100.1, Act::neutral()), 0.0);
    }
}
