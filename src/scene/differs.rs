//! Muscles that are made otherwise than `[muscles]` says.

use std::borrow::Cow;
use std::path::Path;

use toml::{Table, Value};

use super::check::Place;
use super::check_muscles::check_make;
use super::from_table::from_table;
use super::overrides::coerced;
use super::{CalibrateSpec, Each, MuscleSpec, MusclesSpec, SceneError, SceneFile};

/// Before the key of `[muscles]` that is one muscle's own.
pub(super) const DIFFERS: &str = "differs";

/// What each muscle of a scene is made like: `[muscles]`, with what differs in its place.
pub(super) fn makes(scene: &SceneFile, file: &Path) -> Result<Vec<MusclesSpec>, SceneError> {
    let Some(common) = &scene.muscles else { return Ok(Vec::new()) };
    scene.muscle.iter().map(|muscle| make(common, muscle, file)).collect()
}

fn make(common: &MusclesSpec, muscle: &MuscleSpec, file: &Path) -> Result<MusclesSpec, SceneError> {
    if muscle.differs.is_empty() {
        return Ok(common.clone());
    }
    let place = Place { file, table: format!("[[muscle]] \"{}\" {DIFFERS}", muscle.name) };
    if common.displacement.is_some() {
        return Err(place.error(
            "[muscles.displacement] is one formula for all muscles",
            format!("remove `{DIFFERS}`, or describe the muscles by [muscles.tube] or [muscles.linear]"),
        ));
    }
    let mut table = Table::try_from(common).map_err(|e| place.error(e.to_string(), "give keys of [muscles]"))?;
    put_over(&mut table, &muscle.differs);
    let make: MusclesSpec = from_table(&table).map_err(|misread| {
        let message = format!("{}: {}", misread.key, misread.message);
        place.error(message, "give keys of [muscles], spelled as there: { tube.material.c1_pa = 3.1e5 }")
    })?;
    if muscle.cable.is_some() {
        place.positive("end_mass_kg", make.end_mass_kg)?;
    }
    check_make(&make, file, &|table| {
        let own = table.trim_start_matches("[muscles").trim_end_matches(']');
        format!("{}{own}", place.table)
    })?;
    Ok(make)
}

/// Puts the keys of one table over those of another, tables into tables.
fn put_over(table: &mut Table, own: &Table) {
    for (key, value) in own {
        match (table.get_mut(key), value) {
            // Another law of the material has numbers of its own.
            (Some(Value::Table(inner)), Value::Table(value))
                if value.get("law").is_none_or(|l| inner.get("law") == Some(l)) =>
            {
                put_over(inner, value);
            }
            (Some(slot), value) => *slot = coerced(value, slot),
            (None, value) => {
                table.insert(key.clone(), value.clone());
            }
        }
    }
}

/// The muscle and the key of `[muscles]` in a key like `muscle.NAME.differs.tube.material.c1_pa`.
pub(super) fn parts(key: &str) -> Option<(&str, &str)> {
    key.strip_prefix("muscle.")?.split_once(&format!(".{DIFFERS}."))
}

/// The key of `[muscles]` that a key of one muscle's own stands for.
pub(super) fn muscle_key(key: &str) -> Option<String> {
    parts(key).map(|(_, common)| format!("muscles.{common}"))
}

/// Muscles, by index, that a key of `[muscles]` or of one muscle's own sets, and the key of `[muscles]` that it is.
pub(crate) fn muscles_set_by<'a>(muscles: &[MuscleSpec], key: &'a str) -> Option<(Vec<usize>, Cow<'a, str>)> {
    if let Some((name, common)) = parts(key) {
        let index = muscles.iter().position(|m| m.name == name).or_else(|| name.parse().ok())?;
        return Some((vec![index], Cow::Owned(format!("muscles.{common}"))));
    }
    let common = key.strip_prefix("muscles.")?;
    let set = muscles.iter().enumerate().filter(|(_, m)| !is_own(m, common));
    Some((set.map(|(i, _)| i).collect(), Cow::Borrowed(key)))
}

/// Whether two keys set the same number: of the scene, or of a muscle that both reach.
pub(crate) fn set_the_same(muscles: &[MuscleSpec], a: &str, b: &str) -> bool {
    let (a, b) = (super::calibration_key(a), super::calibration_key(b));
    a == b
        || muscles_set_by(muscles, &a)
            .zip(muscles_set_by(muscles, &b))
            .is_some_and(|((of_a, a), (of_b, b))| a == b && of_a.iter().any(|m| of_b.contains(m)))
}

/// Whether a muscle has a value of its own under a key of `[muscles]`.
fn is_own(muscle: &MuscleSpec, key: &str) -> bool {
    let mut words = key.split('.');
    let first = words.next().and_then(|word| muscle.differs.get(word));
    words.fold(first, |here, word| here?.get(word)).is_some()
}

/// Calibrated numbers with those that are each muscle's own written out, one by one.
pub(super) fn written_out(
    scene: &SceneFile,
    declared: &[CalibrateSpec],
    file: &Path,
) -> Result<Vec<CalibrateSpec>, SceneError> {
    let each: Result<Vec<_>, _> = declared.iter().map(|spec| one_written_out(scene, spec, file)).collect();
    Ok(each?.concat())
}

/// The numbers that one `[[calibrate]]` stands for.
pub(super) fn one_written_out(
    scene: &SceneFile,
    spec: &CalibrateSpec,
    file: &Path,
) -> Result<Vec<CalibrateSpec>, SceneError> {
    let Some(Each::Muscle) = spec.each else { return Ok(vec![spec.clone()]) };
    let key = super::calibration_key(&spec.key);
    let Some(key) = key.strip_prefix("muscles.") else {
        let place = Place { file, table: format!("[[calibrate]] \"{}\"", spec.key) };
        return Err(place.error(
            "each = \"muscle\" needs a key of [muscles]",
            "leave `each` out, or give a key like muscles.tube.material.c1_pa",
        ));
    };
    let own = |m: &MuscleSpec| CalibrateSpec {
        key: format!("muscle.{}.{DIFFERS}.{key}", m.name),
        each: None,
        ..spec.clone()
    };
    Ok(scene.muscle.iter().map(own).collect())
}

#[cfg(test)]
mod tests {
    use crate::scene::{Override, Scene};

    fn load(changes: &[&str]) -> Result<Scene, String> {
        let changes: Vec<Override> = changes.iter().map(|c| Override::parse(c).expect("written rightly")).collect();
        Scene::load("antagonistic_pulley", &changes).map_err(|e| e.to_string())
    }

    #[test]
    fn a_muscle_has_what_differs_and_else_what_all_have() {
        let scene =
            load(&["muscle.muscle_2.differs.tube.material.c1_pa=300000", "muscles.rest_length_m=0.06"]).expect("loads");
        let c1: Vec<String> =
            (0..2).map(|i| format!("{:?}", scene.makes[i].tube.as_ref().expect("a tube").material)).collect();
        assert_ne!(c1[0], c1[1]);
        assert!(c1[1].contains("300000"), "{}", c1[1]);
        assert!(scene.makes.iter().all(|m| m.rest_length_m == 0.06));
        let key = "muscle.muscle_2.differs.tube.material.c1_pa";
        assert_eq!(scene.number(key), Some(3e5));
        assert_eq!(scene.number(&key.replace('2', "1")), scene.number("muscles.tube.material.c1_pa"));
    }

    #[test]
    fn what_is_no_key_of_muscles_is_refused_with_its_place() {
        let cases = [
            (
                "muscle.muscle_1.differs.tube.materal.c1_pa=1e5",
                "[[muscle]] \"muscle_1\" differs: tube.materal: unknown field `materal`",
            ),
            (
                "muscle.muscle_1.differs.rest_length_m=-1.0",
                "[[muscle]] \"muscle_1\" differs: rest_length_m = -1 must be > 0",
            ),
            (
                "muscle.muscle_1.differs.tube.coil.turns=0.0",
                "[[muscle]] \"muscle_1\" differs.tube.coil: turns = 0 must be > 0",
            ),
            ("muscle.muscle_1.differs.linear={stiffness_n_m=1.0, pressure_gain_m2=0.0}", "exactly one of"),
            ("muscle.muscle_1.differs.end_mass_kg=0.0", "[[muscle]] \"muscle_1\" differs: end_mass_kg = 0 must be > 0"),
            ("muscle.muscle_1.differs.tube.material.c3_pa=nan", "a number of the material's law = NaN must be finite"),
            ("muscle.muscle_1.differs.tube.outer_diameter_m=1e300", "is more than 1000 times inner_diameter_m"),
        ];
        for (change, expected) in cases {
            let message = load(&[change]).expect_err("refused");
            assert!(message.contains(expected), "{message}");
        }
    }

    #[test]
    fn another_law_of_the_material_has_its_own_numbers() {
        let gent = "muscle.muscle_2.differs.tube.material={ law = 'gent', mu_pa = 5e5, jm = 80.0 }";
        let scene = load(&[gent]).expect("loads");
        assert!(matches!(scene.makes[1].tube.as_ref().expect("a tube").material, crate::muscle::Material::Gent { .. }));
        assert_eq!(scene.makes[0].tube, scene.file.muscles.as_ref().expect("muscles").tube);
    }

    #[test]
    fn a_name_comes_before_an_index() {
        let path = crate::stock::builtin("scenes/antagonistic_pulley.toml").expect("it is carried");
        let text = crate::stock::read_text(&path).expect("a text").replace("\"muscle_1\"", "\"1\"");
        let own = Override::parse("muscle.1.differs.rest_length_m=0.06").expect("written rightly");
        let scene = Scene::parse(&text, &path, &[own]).expect("loads");
        let lengths: Vec<f64> = scene.makes.iter().map(|m| m.rest_length_m).collect();
        assert_eq!(lengths[0], 0.06);
        assert_ne!(lengths[1], 0.06);
        assert_eq!(scene.number("muscle.1.differs.rest_length_m"), Some(0.06));
    }

    #[test]
    fn keys_of_one_number_are_the_same() {
        let muscles = load(&["muscle.muscle_2.differs.rest_length_m=0.06"]).expect("loads").file.muscle;
        let is_same = |a: &str, b: &str| super::set_the_same(&muscles, a, b);
        assert!(is_same("tube_c1_pa", "muscle.muscle_1.differs.tube.material.c1_pa"));
        assert!(is_same("muscle.0.differs.damping_n_s_m", "muscle.muscle_1.differs.damping_n_s_m"));
        assert!(!is_same("muscles.rest_length_m", "muscle.muscle_2.differs.rest_length_m"));
        assert!(!is_same("muscle.muscle_1.differs.damping_n_s_m", "muscle.muscle_2.differs.damping_n_s_m"));
    }

    #[test]
    fn calibrated_numbers_are_untied() {
        let scene = load(&["calibrate.0.each=muscle"]).expect("loads");
        let keys: Vec<&str> = scene.file.calibrate.iter().map(|c| c.key.as_str()).take(2).collect();
        assert_eq!(
            keys,
            ["muscle.muscle_1.differs.tube.material.c1_pa", "muscle.muscle_2.differs.tube.material.c1_pa"]
        );
        let message = load(&["calibrate.1.each=muscle"]).expect_err("refused");
        assert!(message.contains("each = \"muscle\" needs a key of [muscles]"), "{message}");
    }
}
