//! Keys that a scene file names: of what is calibrated, and of what a known condition sets.

use toml::{Table, Value};

use super::check::check_inputs;
use super::differs::{muscle_key, one_written_out, set_the_same};
use super::from_table::from_table;
use super::overrides::{Override, calibration_key, calibration_names, child_at, entry_name};
use super::{Scene, SceneError, SceneFile};
use crate::effects::catalogue;
use crate::nearest::did_you_mean;

/// Refuses keys under which the scene has no number, and one number that is calibrated twice.
pub(super) fn check(scene: &Scene) -> Result<(), SceneError> {
    for spec in &scene.declared_calibrate {
        for written in one_written_out(&scene.file, spec, &scene.path)? {
            check_key(scene, || format!("[[calibrate]] \"{}\"", spec.key), &written.key)?;
        }
    }
    for condition in &scene.file.condition {
        let table = || format!("[[condition]] \"{}\": keys", condition.name);
        condition.keys.iter().try_for_each(|key| check_key(scene, table, key))?;
    }
    check_calibrated_once(scene)
}

/// A key that is to be set holds a number, or may hold one.
fn check_key(scene: &Scene, table: impl Fn() -> String, key: &str) -> Result<(), SceneError> {
    if scene.number(key).is_some() || may_hold_number(scene, key) {
        return Ok(());
    }
    let keys = scene.keys();
    let known: Vec<&str> = keys.iter().map(|(key, _)| key.as_str()).chain(calibration_names()).collect();
    Err(SceneError::Value {
        file: scene.path.clone(),
        table: table(),
        message: format!("the scene has no number under the key \"{key}\"{}", did_you_mean(key, &known)),
        remedy: "`smam check SCENE --keys` lists the keys of the scene".to_owned(),
    })
}

/// Whether a key that does not stand in the scene could: optional ones are not listed.
fn may_hold_number(scene: &Scene, key: &str) -> bool {
    // Tables that take any key are checked by what reads them.
    if let Some(common) = muscle_key(key) {
        return scene.number(&common).is_some() || may_hold_number(scene, &common);
    }
    if let Some((name, parameter)) = key.strip_prefix("effect.").and_then(|rest| rest.split_once('.')) {
        return is_parameter(scene, name, parameter);
    }
    let Ok(mut table) = Table::try_from(&scene.file) else { return false };
    if Override::number(key, 1.0).apply(&mut table).is_err() {
        return false;
    }
    from_table::<SceneFile>(&table)
        .is_ok_and(|file| !key.starts_with("input.") || check_inputs(&file, &scene.path).is_ok())
}

/// Whether an effect of the scene, by its name or index, has this parameter.
fn is_parameter(scene: &Scene, effect: &str, parameter: &str) -> bool {
    let by_index = || effect.parse::<usize>().ok().and_then(|index| scene.file.effect.get(index));
    let table = scene.file.effect.iter().find(|table| table.name == effect).or_else(by_index);
    let mut entries = catalogue().filter(|entry| table.is_some_and(|table| table.name == entry.name));
    entries.any(|entry| entry.parameter(parameter).is_some())
}

/// Refuses two tables that stand for one number: a fit could not tell which of them moves it.
fn check_calibrated_once(scene: &Scene) -> Result<(), SceneError> {
    let tables = &scene.declared_calibrate;
    let keys: Vec<Vec<String>> = tables
        .iter()
        .map(|spec| {
            Ok(one_written_out(&scene.file, spec, &scene.path)?.iter().map(|s| by_names(scene, &s.key)).collect())
        })
        .collect::<Result<_, SceneError>>()?;
    let is_same = |a: &String, b: &String| set_the_same(&scene.file.muscle, a, b);
    for (second, own) in keys.iter().enumerate() {
        let meets = |other: &Vec<String>| other.iter().any(|a| own.iter().any(|b| is_same(a, b)));
        if let Some(first) = keys[..second].iter().position(meets) {
            return Err(SceneError::Value {
                file: scene.path.clone(),
                table: format!("[[calibrate]] \"{}\" (table {})", tables[second].key, second + 1),
                message: format!(
                    "sets the same number as [[calibrate]] \"{}\" (table {})",
                    tables[first].key,
                    first + 1
                ),
                remedy: "remove one of the two tables".to_owned(),
            });
        }
    }
    Ok(())
}

/// A key whose entries of lists are called by their names where they have one.
fn by_names(scene: &Scene, key: &str) -> String {
    let key = calibration_key(key);
    let Ok(value) = Value::try_from(&scene.file) else { return key.into_owned() };
    let mut here = Some(&value);
    let segments = key.split('.').map(|segment| {
        let is_entry = here.is_some_and(Value::is_array);
        here = here.and_then(|value| child_at(value, segment));
        match here.and_then(entry_name) {
            Some(name) if is_entry => name.to_owned(),
            _ => segment.to_owned(),
        }
    });
    segments.collect::<Vec<_>>().join(".")
}

#[cfg(test)]
mod tests {
    use crate::scene::{Override, Scene};

    fn refused(scene: &str, change: &str) -> String {
        let change = Override::parse(change).expect("written rightly");
        Scene::load(scene, &[change]).err().map_or_else(String::new, |e| e.to_string())
    }

    #[test]
    fn a_number_is_calibrated_once() {
        let two =
            |a: &str, b: &str| format!("calibrate=[{{key=\"{a}\", min=0.1, max=1.0}}, {{{b}, min=0.1, max=1.0}}]");
        let message = refused("muscle_bench", &two("friction_m0_n", "key=\"muscles.friction.m0_n\""));
        assert!(
            message.contains(
                "[[calibrate]] \"muscles.friction.m0_n\" (table 2): sets the same number as [[calibrate]] \"friction_m0_n\" (table 1)"
            ),
            "{message}"
        );
        for (a, b) in [
            ("cable.0.damping_n_s_m", "key=\"cable.tendon_1.damping_n_s_m\""),
            ("muscle.muscle_1.differs.rest_length_m", "key=\"muscles.rest_length_m\", each=\"muscle\""),
        ] {
            let scene = if a.starts_with("cable") { "tendon_sheath" } else { "antagonistic_pulley" };
            assert!(
                refused(scene, &two(a, b)).contains("sets the same number"),
                "{a}, {b}: {}",
                refused(scene, &two(a, b))
            );
        }
        assert_eq!(refused("muscle_bench", &two("friction_m0_n", "key=\"muscles.rest_length_m\"")), "");
    }

    #[test]
    fn keys_of_conditions_are_keys_of_the_scene() {
        let condition = |key: &str| format!("condition=[{{name=\"load_n\", keys=[\"{key}\"]}}]");
        for (key, nearest) in [
            ("muscles.frictoin.m0_n", "did you mean \"muscles.friction.m0_n\"?"),
            ("input.plunger_mm.program.strok_m", "did you mean \"input.plunger_mm.program.stroke_m\"?"),
            ("muscle.muscle.differs.rest_lenth_m", ""),
            ("nowhere", ""),
        ] {
            let message = refused("muscle_bench", &condition(key));
            let place = "[[condition]] \"load_n\": keys: the scene has no number under the key";
            assert!(message.contains(place) && message.contains(nearest), "{key}: {message}");
        }
        let known =
            ["muscles.friction.m0_n", "friction_m0_n", "input.plunger_mm.program.start_s", "muscles.end_mass_kg"];
        known.into_iter().for_each(|key| assert_eq!(refused("muscle_bench", &condition(key)), "", "{key}"));
    }

    /// What `keys` lists is what `--set` takes.
    #[test]
    fn indices_of_listed_keys_are_those_of_the_file() {
        let each = Override::parse("calibrate.0.each=muscle").expect("written rightly");
        let scene = Scene::load("antagonistic_pulley", std::slice::from_ref(&each)).expect("loads");
        for (key, value) in scene.keys().into_iter().filter(|(key, _)| key.starts_with("calibrate.")) {
            let same = Override::parse(&format!("{key}={value}")).expect("a key");
            let again = Scene::load("antagonistic_pulley", &[each.clone(), same]).expect("loads");
            assert_eq!(again.keys(), scene.keys(), "{key}");
        }
        assert!(scene.keys().contains(&("calibrate.0.each".to_owned(), "\"muscle\"".to_owned())));
    }
}
