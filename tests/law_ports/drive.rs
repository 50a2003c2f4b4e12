//! Effects of a cable's drive against what is known by hand.

use smam::scene::{Override, Scene};
use smam::system::Simulation;

use crate::rig::{BOTH, Model, Series, distance, law, run, scene};

/// Out to 1 rad, a hold, back past the start to -0.6 rad, a hold.
const STOCK: &str = "input.0.program={kind=\"points\",time_s=[0.0,1.0,1.5,3.1,3.6],value_rad=[0.0,1.0,1.0,-0.6,-0.6]}";
/// The same behind a play of 0.2 rad: 1.6 mm at levers of 8 mm.
const BEHIND_PLAY: &str =
    "input.0.program={kind=\"points\",time_s=[0.0,0.1,1.0,1.7,3.1,3.6],value_rad=[0.0,0.0,0.9,0.9,-0.5,-0.5]}";
const UNTIL_S: f64 = 3.6;

/// Both cables hang on the one drive.
fn with_effect(name: &str, value: &str) -> String {
    format!("effect=[{{name=\"{name}\",element=\"cable\",{value}}}]")
}

fn at_rest_the_same(one: &Series, known: &Series, model: Model) {
    for (column, values) in known.columns() {
        let greatest = values.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let off = (one.last(column) - known.last(column)).abs();
        assert!(off < 1e-6 * greatest, "{model:?} {column}: {off:.2e} of {greatest:.2e}");
    }
}

#[test]
fn val_play_of_a_drive_is_a_drive_that_turns_late() {
    let play = with_effect("drive_backlash", "width_m=1.6e-3");
    for model in BOTH {
        let played = run(model, &scene("tendon_sheath", &[STOCK, &play], &[]), UNTIL_S);
        let known = run(model, &scene("tendon_sheath", &[BEHIND_PLAY], &[]), UNTIL_S);
        let far = distance(&played, &known, &[]);
        println!("{model:?}: {far:.1e} of the range");
        // A play is taken up at the end of a step: as late as that while it moves, and nowhere at rest.
        assert!(far < 5e-3, "{model:?}: {far:.2e}");
        at_rest_the_same(&played, &known, model);
    }
}

#[test]
fn val_a_drive_that_saturates_goes_less_far() {
    let cubic = with_effect("drive_nonlinearity", "cubic_1_m2=-2e3");
    let way = |rad: f64| rad * (1.0 - 2e3 * (8e-3 * rad).powi(2));
    let (out, back) = (way(1.0), way(-0.6));
    let known = format!(
        "input.0.program={{kind=\"points\",time_s=[0.0,1.0,1.5,3.1,3.6],value_rad=[0.0,{out},{out},{back},{back}]}}"
    );
    for model in BOTH {
        let bent = run(model, &scene("tendon_sheath", &[STOCK, &cubic], &[]), UNTIL_S);
        at_rest_the_same(&bent, &run(model, &scene("tendon_sheath", &[&known], &[]), UNTIL_S), model);
    }
}

/// `u - T du/dt` of a ramp is the ramp, late by T.
#[test]
fn val_a_drive_that_falls_behind_with_its_speed_is_late() {
    let slow = &["cable.stretch adds -0.05*drive_speed_m_s"];
    for model in BOTH {
        let late = run(model, &scene("tendon_sheath", &[STOCK], slow), 0.8);
        let stock = run(model, &scene("tendon_sheath", &[STOCK], &[]), 0.75);
        let (late, stock) = (late.last("tip_deg"), stock.last("tip_deg"));
        assert!((late - stock).abs() < 1e-3 * stock, "{model:?}: {late} and {stock} degrees");
    }
}

#[test]
fn a_cable_without_a_drive_has_no_play_of_one() {
    for (name, key) in [("drive_backlash", "width_m"), ("drive_nonlinearity", "cubic_1_m2")] {
        let set = with_effect(name, &format!("{key}=1e-3"));
        let set = Override::parse(&set).expect("an override");
        let refused = Scene::load("antagonistic_pulley", std::slice::from_ref(&set)).expect_err("no drive").to_string();
        assert!(refused.contains("the cable has no drive"), "{refused}");
        // One of two has none: both are not to be had, the first one is.
        let mut mixed = Scene::load("tendon_sheath", &[set]).expect("two drives").file;
        mixed.cable[1].drive = None;
        let refused = Scene::from_file(mixed.clone(), "mixed.toml".as_ref()).expect_err("one drive").to_string();
        assert!(refused.contains("the cable has no drive"), "{refused}");
        mixed.effect[0].element = "cable_1".to_owned();
        Scene::from_file(mixed, "mixed.toml".as_ref()).unwrap_or_else(|e| panic!("{e}"));
    }
}

#[test]
fn a_law_of_the_drive_on_all_cables_needs_a_drive_on_each() {
    let mut mixed = Scene::load("tendon_sheath", &[]).expect("a stock scene");
    mixed.file.cable[1].drive = None;
    mixed.file.law.push(law("cable.stretch adds 0.01*drive_m", 0));
    let mixed = Scene::from_file(mixed.file, &mixed.path).unwrap_or_else(|e| panic!("{e}"));
    let refused = Simulation::new(mixed).err().expect("one drive").to_string();
    assert!(refused.contains("drive_m") && refused.contains("no input drives the cable"), "{refused}");
}
