//! Effects of a cable's drive against what is known by hand.

use crate::rig::{BOTH, Model, Series, distance, run, scene};

/// Out to 1 rad, a hold, back past the start to -0.6 rad, a hold.
const STOCK: &str = "input.0.program={kind=\"points\",time_s=[0.0,1.0,1.5,3.1,3.6],value_rad=[0.0,1.0,1.0,-0.6,-0.6]}";
/// The same behind a play of 0.2 rad: 1.6 mm at levers of 8 mm.
const BEHIND_PLAY: &str =
    "input.0.program={kind=\"points\",time_s=[0.0,0.1,1.0,1.7,3.1,3.6],value_rad=[0.0,0.0,0.9,0.9,-0.5,-0.5]}";
const UNTIL_S: f64 = 3.6;

fn effect(name: &str, value: &str) -> [String; 2] {
    ["cable_1", "cable_2"].map(|cable| format!("{{name=\"{name}\",element=\"{cable}\",{value}}}"))
}

fn with_effects(name: &str, value: &str) -> String {
    format!("effect=[{}]", effect(name, value).join(","))
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
    let play = with_effects("drive_backlash", "width_m=1.6e-3");
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
    let cubic = with_effects("drive_nonlinearity", "cubic_1_m2=-2e3");
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
    let law = &["cable.stretch adds -0.05*drive_speed_m_s"];
    for model in BOTH {
        let late = run(model, &scene("tendon_sheath", &[STOCK], law), 0.8);
        let stock = run(model, &scene("tendon_sheath", &[STOCK], &[]), 0.75);
        let (late, stock) = (late.last("tip_deg"), stock.last("tip_deg"));
        assert!((late - stock).abs() < 1e-3 * stock, "{model:?}: {late} and {stock} degrees");
    }
}

#[test]
fn a_cable_without_a_drive_has_no_play_of_one() {
    for name in ["drive_backlash", "drive_nonlinearity"] {
        let key = if name == "drive_backlash" { "width_m" } else { "cubic_1_m2" };
        let set = format!("effect=[{{name=\"{name}\",element=\"cable_1\",{key}=1e-3}}]");
        let set = smam::scene::Override::parse(&set).expect("an override");
        let refused = smam::scene::Scene::load("antagonistic_pulley", &[set]).expect_err("no drive").to_string();
        assert!(refused.contains("the cable has no drive"), "{refused}");
    }
}
