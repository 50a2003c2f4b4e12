//! Numbers of what the muscles are made like. What keeps a law in its range is the law's own `check`; here it gets its place.

use std::path::Path;

use crate::muscle::{Coil, Friction, Stop};

use super::check::Place;
use super::{FrictionSpec, LinearSpec, MusclesSpec, SceneError, TubeSpec, WallSpec};

/// Checks `[muscles]` and the tables in it; `named` says how a table of it is called where it stands.
pub(super) fn check_make(m: &MusclesSpec, file: &Path, named: &dyn Fn(&str) -> String) -> Result<(), SceneError> {
    let at = |table: &str| Place { file, table: named(table) };
    let place = at("[muscles]");
    place.positive("rest_length_m", m.rest_length_m)?;
    place.not_negative("damping_n_s_m", m.damping_n_s_m)?;
    place.not_negative("end_mass_kg", m.end_mass_kg)?;
    place.finite("initial_load_n", m.initial_load_n)?;
    if !(0.0..=3.5).contains(&m.pre_elongation_ratio) {
        return Err(place.error(
            format!("pre_elongation_ratio = {} must be 0 to 3.5", m.pre_elongation_ratio),
            "it is elongation over rest length; the coil yields at 2.5 (350 % of the length)",
        ));
    }
    let kinds = [m.tube.is_some(), m.linear.is_some(), m.displacement.is_some()];
    if kinds.iter().filter(|k| **k).count() != 1 {
        return Err(place.error(
            "exactly one of [muscles.tube], [muscles.linear], [muscles.displacement] is needed",
            "keep one of them",
        ));
    }
    if let Some(tube) = &m.tube {
        check_tube(tube, at)?;
    }
    if let Some(LinearSpec { stiffness_n_m, pressure_gain_m2 }) = m.linear {
        at("[muscles.linear]").positive("stiffness_n_m", stiffness_n_m)?;
        at("[muscles.linear]").finite("pressure_gain_m2", pressure_gain_m2)?;
    }
    if let Some(model) = &m.displacement {
        let place = at("[muscles.displacement]");
        model.check().map_err(|e| place.error(e.to_string(), "choose numbers with which the state stays bounded"))?;
    }
    m.friction.as_ref().map_or(Ok(()), |friction| check_friction(friction, &at("[muscles.friction]")))
}

/// Outer over inner diameter, at most: a wall is cut into layers of equal ratio.
const THICKEST: f64 = 1e3;

fn check_tube<'a>(tube: &TubeSpec, at: impl Fn(&str) -> Place<'a>) -> Result<(), SceneError> {
    const STIFF: &str = "give it a number that is not negative, in SI units";
    let place = at("[muscles.tube]");
    place.positive("inner_diameter_m", tube.inner_diameter_m)?;
    place.finite("outer_diameter_m", tube.outer_diameter_m)?;
    if tube.outer_diameter_m <= tube.inner_diameter_m {
        return Err(place.error(
            format!(
                "outer_diameter_m = {} must be > inner_diameter_m = {}",
                tube.outer_diameter_m, tube.inner_diameter_m
            ),
            "give the diameters in m, outer larger than inner",
        ));
    }
    if tube.outer_diameter_m > THICKEST * tube.inner_diameter_m {
        return Err(place.error(
            format!(
                "outer_diameter_m = {:e} is more than {THICKEST} times inner_diameter_m = {:e}",
                tube.outer_diameter_m, tube.inner_diameter_m
            ),
            "give both diameters in m",
        ));
    }
    check_area_growth(tube, &place)?;
    let place = at("[muscles.tube.material]");
    tube.material.check().map_err(|e| place.error(e.to_string(), "give the moduli in Pa, above zero"))?;
    let place = at("[muscles.tube.coil]");
    let coil = Coil { stiffness_n_m: tube.coil.stiffness_n_m, preload_n: tube.coil.preload_n };
    coil.check().map_err(|e| place.error(e.to_string(), STIFF))?;
    place.positive("turns", tube.coil.turns)?;
    place.positive("outer_diameter_m", tube.coil.outer_diameter_m)?;
    let Some(stop) = tube.closed_stop else { return Ok(()) };
    let place = at("[muscles.tube.closed_stop]");
    let stop = Stop { stiffness_n_m: stop.stiffness_n_m, damping_n_s_m: stop.damping_n_s_m };
    stop.check().map_err(|e| place.error(e.to_string(), STIFF))
}

/// A bore that grows, on a wall that the coil holds.
fn check_area_growth(tube: &TubeSpec, place: &Place) -> Result<(), SceneError> {
    place.finite("area_growth_1_m", tube.area_growth_1_m)?;
    if !(0.0..=20.0).contains(&tube.area_growth_1_m) {
        return Err(place.error(
            format!("area_growth_1_m = {} must lie between 0 and 20", tube.area_growth_1_m),
            "leave it out for a coil that holds its bore; a few 1/m widen it by tens of percent",
        ));
    }
    if tube.area_growth_1_m != 0.0 && tube.wall == WallSpec::Unilateral {
        return Err(place.error(
            "area_growth_1_m and wall = \"unilateral\" exclude each other".to_owned(),
            "leave one of them out: a wall off its coil has an area of its own",
        ));
    }
    Ok(())
}

fn check_friction(f: &FrictionSpec, place: &Place) -> Result<(), SceneError> {
    if !(f.n >= 1.0 && f.n.is_finite()) {
        return Err(place.error(format!("n = {} must be >= 1", f.n), "leave n out for 1, which is Dahl's friction"));
    }
    let law = Friction {
        m0_n: f.m0_n,
        m1_n_pa: f.m1_n_pa,
        presliding_length_m: f.presliding_length_m,
        a: f.a,
        nu: f.nu,
        n: f.n,
        rho: f.rho,
    };
    law.check().map_err(|e| {
        place.error(e.to_string(), "m0_n and m1_n_pa >= 0; presliding_length_m, a, nu > 0; |rho| < a; all in SI units")
    })
}

#[cfg(test)]
mod tests {
    use crate::scene::{Override, Scene};

    fn refusal(scene: &str, change: &str) -> String {
        let change = Override::parse(change).expect("written rightly");
        Scene::load(scene, &[change]).expect_err("refused").to_string()
    }

    #[test]
    fn each_bad_number_is_refused_with_its_place() {
        let cases = [
            ("muscles.friction.m0_n=-0.1", "[muscles.friction]: m0_n = -0.1 must be >= 0"),
            ("muscles.friction.n=0.5", "[muscles.friction]: n = 0.5 must be >= 1"),
            ("muscles.friction.nu=-1.0", "[muscles.friction]: nu = -1 must be > 0"),
            ("muscles.friction.rho=1.5", "[muscles.friction]: friction: |rho| = 1.5 must be smaller than a = 1"),
            ("muscles.tube.coil.preload_n=-0.2", "[muscles.tube.coil]: preload_n = -0.2 must be >= 0"),
            ("muscles.tube.coil.stiffness_n_m=-1.0", "[muscles.tube.coil]: stiffness_n_m = -1 must be >= 0"),
            ("muscles.tube.closed_stop.damping_n_s_m=-3.0", "[muscles.tube.closed_stop]: damping_n_s_m = -3"),
            ("muscles.tube.material.c1_pa=-1.0", "[muscles.tube.material]: shear modulus, Pa = -2 must be > 0"),
            ("muscles.tube.inner_diameter_m=0.0", "[muscles.tube]: inner_diameter_m = 0 must be > 0"),
            ("muscles.initial_load_n=nan", "[muscles]: initial_load_n = NaN must be finite"),
        ];
        for (change, expected) in cases {
            let said = refusal("muscle_bench", change);
            assert!(said.contains(expected) && said.contains("remedy: "), "{change}: {said}");
        }
    }

    #[test]
    fn bad_displacement_models_are_refused() {
        let said = refusal("muscle_printed_model", "muscles.displacement.nu=-1.0");
        assert!(said.contains("[muscles.displacement]: asymmetric model: nu = -1 must be > 0"), "{said}");
    }
}
