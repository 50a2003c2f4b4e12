//! `[axis]`, `[strip]` and `[chamber]`: elements that stand alone.

use std::path::Path;

use super::check::{Place, input_names};
use super::{AxisSpec, ChamberSpec, OutputSpec, Quantity, SceneError, SceneFile, StripSpec};

/// Checks whichever of the elements the scene has; one scene has one of them, and nothing else.
pub(super) fn check(scene: &SceneFile, file: &Path) -> Result<(), SceneError> {
    let at = |table: &str| Place { file, table: table.to_owned() };
    if let Some(axis) = &scene.axis {
        check_axis(scene, axis, &at("[axis]"))?;
    }
    if let Some(strip) = &scene.strip {
        check_strip(scene, strip, &at("[strip]"))?;
    }
    if let Some(chamber) = &scene.chamber {
        check_chamber(chamber, &at("[chamber]"))?;
    }
    check_alone(scene, &at("top level"))?;
    scene.output.iter().try_for_each(|output| check_output(scene, output, file))
}

/// `[axis]` has stood beside unused tables before: only the new elements insist on standing alone.
fn check_alone(scene: &SceneFile, place: &Place) -> Result<(), SceneError> {
    let tables = [
        ("[strip]", scene.strip.is_some()),
        ("[chamber]", scene.chamber.is_some()),
        ("[axis]", scene.axis.is_some()),
        ("[muscles]", scene.muscles.is_some()),
        ("[mechanism]", scene.mechanism.is_some()),
        ("[hydraulics]", scene.hydraulics.is_some()),
    ];
    let mut present = tables.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| *name);
    let Some(first) = present.next().filter(|_| scene.strip.is_some() || scene.chamber.is_some()) else {
        return Ok(());
    };
    match present.next() {
        Some(other) => Err(place.error(
            format!("{first} stands alone, and there is {other} beside it"),
            format!("remove {other}, or {first}"),
        )),
        None => Ok(()),
    }
}

fn check_axis(scene: &SceneFile, axis: &AxisSpec, place: &Place) -> Result<(), SceneError> {
    place.known("position_input", &axis.position_input, &input_names(scene))?;
    if let Some(pressure) = &axis.pressure_input {
        place.known("pressure_input", pressure, &input_names(scene))?;
    }
    place.not_negative("piston_area_m2", axis.piston_area_m2)?;
    place.not_negative("mass_kg", axis.mass_kg)?;
    place.not_negative("damping_n_s_m", axis.damping_n_s_m)?;
    place.finite("offset_n", axis.offset_n)?;
    axis.derivative_window_s.map_or(Ok(()), |window_s| place.positive("derivative_window_s", window_s))
}

fn check_strip(scene: &SceneFile, strip: &StripSpec, place: &Place) -> Result<(), SceneError> {
    place.known("position_input", &strip.position_input, &input_names(scene))?;
    place.positive("length_m", strip.length_m)?;
    place.positive("section_m2", strip.section_m2)?;
    let material = Place { file: place.file, table: "[strip.material]".to_owned() };
    strip.material.check().map_err(|e| material.error(e.to_string(), "give the moduli in Pa, above zero"))
}

fn check_chamber(chamber: &ChamberSpec, place: &Place) -> Result<(), SceneError> {
    place.positive("ambient_pressure_pa", chamber.ambient_pressure_pa)?;
    place.finite("start_pressure_pa", chamber.start_pressure_pa)?;
    place.positive("number", chamber.number as f64)?;
    if chamber.start_pressure_pa + chamber.zero_pa() > 0.0 {
        return Ok(());
    }
    Err(place.error(
        format!("start_pressure_pa = {} lies below a vacuum", chamber.start_pressure_pa),
        "write reads = \"gauge\" where zero is the pressure of the surroundings, \"absolute\" where it is a vacuum",
    ))
}

fn check_output(scene: &SceneFile, output: &OutputSpec, file: &Path) -> Result<(), SceneError> {
    let place = Place { file, table: format!("[[output]] \"{}\"", output.channel) };
    let wanted = match output.quantity {
        Quantity::StripForce => ("[strip]", scene.strip.is_some()),
        Quantity::ChamberPressure => ("[chamber]", scene.chamber.is_some()),
        Quantity::ArcTipX | Quantity::ArcTipZ => return check_arc(output, &place),
        _ => return Ok(()),
    };
    match wanted {
        (_, true) => Ok(()),
        (table, false) => Err(place.error(
            format!("the scene has no {table} that could show {:?}", output.quantity),
            format!("add {table}, or show another quantity"),
        )),
    }
}

/// The tip of an arc needs the arc's length.
fn check_arc(output: &OutputSpec, place: &Place) -> Result<(), SceneError> {
    match output.arc_length_m {
        Some(length_m) => place.positive("arc_length_m", length_m),
        None => {
            Err(place.error("arc_length_m is missing", "give the length of the rod that the joints of `of` bend, in m"))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::scene::{Override, Scene};

    #[test]
    fn each_bad_number_is_refused_with_its_place_and_a_remedy() {
        let cases = [
            ("tensile_test", "strip.length_m=0.0", "[strip]: length_m = 0 must be > 0"),
            ("tensile_test", "strip.section_m2=-1.0", "[strip]: section_m2 = -1 must be > 0"),
            (
                "tensile_test",
                "strip.position_input=\"x_mm\"",
                "[strip]: position_input = \"x_mm\" is not in this scene",
            ),
            ("tensile_test", "strip.material.c1_pa=0.0", "[strip.material]: shear modulus, Pa = 0 must be > 0"),
            ("closed_chamber", "chamber.ambient_pressure_pa=0.0", "[chamber]: ambient_pressure_pa = 0 must be > 0"),
            ("closed_chamber", "chamber.start_pressure_pa=-2e5", "[chamber]: start_pressure_pa = -200000 lies below"),
            ("closed_chamber", "chamber.reads=\"bar\"", "gauge"),
            ("tendon_catheter", "output.0.arc_length_m=0.0", "\"tip_x_mm\": arc_length_m = 0 must be > 0"),
            ("closed_chamber", "chamber.number=0", "[chamber]: number = 0 must be > 0"),
            ("closed_chamber", "output.0.quantity=\"strip_force\"", "the scene has no [strip] that could show"),
        ];
        for (scene, change, expected) in cases {
            let change_read = Override::parse(change).expect("written rightly");
            let said = Scene::load(scene, &[change_read]).expect_err(change).to_string();
            assert!(said.contains(expected) && said.contains("remedy: "), "{change}: {said}");
        }
    }

    #[test]
    fn a_strip_stands_alone() {
        let mut file = Scene::load("tensile_test", &[]).expect("stock scene").file;
        file.chamber = Scene::load("closed_chamber", &[]).expect("stock scene").file.chamber;
        let said = Scene::from_file(file, "mine.toml".as_ref()).expect_err("two elements").to_string();
        assert!(said.contains("[strip] stands alone, and there is [chamber] beside it"), "{said}");
        assert!(said.contains("remedy: remove [chamber], or [strip]"), "{said}");
    }
}
