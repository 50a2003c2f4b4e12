//! Effects of the catalogue that can be written as a text, played both ways.

use rayon::prelude::*;

use crate::rig::{BOTH, Model, distance, run_by, scene};

struct Pair {
    name: &'static str,
    rig: &'static str,
    sets: &'static [&'static str],
    effect: &'static str,
    laws: &'static [&'static str],
    /// Of the channels' ranges; where it is not that of rounding, why.
    within: f64,
}

const ROUNDING: f64 = 1e-9;
/// Law and effect have other tangents, so that their steps differ by their own errors: in the square of the step.
const TANGENTS: f64 = 2e-5;
/// The effect's switching is met with sixteen parts of a step, the law's is not.
const SWITCHING: f64 = 2e-3;

const QUICK: &[&str] = &["input.0.program={kind=\"sine\",stroke_m=1.0e-3,frequency_hz=0.5}"];
const TURNING: &[&str] = &[
    "input.0.program={kind=\"sine\",stroke_m=-1.0e-3,frequency_hz=0.5}",
    "input.1.program={kind=\"sine\",stroke_m=1.0e-3,frequency_hz=0.5}",
];

const fn bench(name: &'static str, effect: &'static str, laws: &'static [&'static str], within: f64) -> Pair {
    Pair { name, rig: "muscle_bench", sets: QUICK, effect, laws, within }
}

const fn pulley(name: &'static str, effect: &'static str, laws: &'static [&'static str], within: f64) -> Pair {
    Pair { name, rig: "antagonistic_pulley", sets: TURNING, effect, laws, within }
}

const PAIRS: &[Pair] = &[
    bench(
        "leak",
        "{name=\"leak\",element=\"line\",conductance_m3_s_pa=1e-16}",
        &["line.outflow adds 1e-16 * pressure_pa"],
        TANGENTS,
    ),
    bench(
        "line_restriction",
        "{name=\"line_restriction\",element=\"line\",resistance_ratio=20.0}",
        &["line.resistance scales 1 + 20.0"],
        ROUNDING,
    ),
    bench(
        "line_restriction, quadratic",
        "{name=\"line_restriction\",element=\"line\",resistance_ratio=0.0,quadratic_pa_s2_m6=1e19}",
        &["line.pressure_drop adds 1e19 * flow_m3_s * abs(flow_m3_s)"],
        ROUNDING,
    ),
    bench(
        "thermal_expansion",
        "{name=\"thermal_expansion\",element=\"line\",volume_rate_m3_s=5e-11}",
        &["line.outflow adds -5e-11"],
        ROUNDING,
    ),
    bench(
        "trapped_air",
        "{name=\"trapped_air\",element=\"line\",free_volume_m3=1e-9}",
        &["line.compliance adds 1e-9/101325.0 / max(1 + pressure_pa/101325.0, 0.02)^2"],
        ROUNDING,
    ),
    bench(
        "coil_preload",
        "{name=\"coil_preload\",element=\"muscle\",preload_n=0.05}",
        &["muscle.coil adds 0.05 * tanh(elongation_m/0.25e-3)"],
        ROUNDING,
    ),
    bench(
        "gravity_load",
        "{name=\"gravity_load\",element=\"muscle\",weight_n=0.02}",
        &["joint.torque adds 0.02"],
        ROUNDING,
    ),
    pulley(
        "gravity_load of the mechanism",
        "{name=\"gravity_load\",element=\"mechanism\",weight_n=0.05}",
        &["joint.torque adds 0.05 * 0.008"],
        ROUNDING,
    ),
    bench(
        "pressure_friction",
        "{name=\"pressure_friction\",element=\"muscle\",friction_per_pressure_n_pa=1e-7}",
        &["muscle.friction adds 1e-7 * max(pressure_pa, 0)"],
        ROUNDING,
    ),
    bench(
        "viscoelasticity",
        "{name=\"viscoelasticity\",element=\"muscle\",stiffness_n_m=6.0,relaxation_time_s=0.5}",
        &[
            "name = 'branch'\nport = 'muscle.pull'\nadds = '6.0 * (elongation_m - s)'\nstate.s = { rate = '(elongation_m - s)/0.5', start = 'elongation_m' }",
        ],
        ROUNDING,
    ),
    bench(
        "plunger_backlash",
        "{name=\"plunger_backlash\",element=\"syringe\",width_m=4e-5}",
        &[
            "name = 'play'\nport = 'plunger'\nadds = 's - plunger_m'\nstate.s = { play_of = 'plunger_m', width = '4e-5' }",
        ],
        TANGENTS,
    ),
    bench(
        "plastic_set",
        "{name=\"plastic_set\",element=\"muscle\",set_rate_1_s=0.05,threshold_m=0.002}",
        &[
            "name = 'set'\nport = 'muscle.rest_length'\nadds = 's_m'\nstate.s_m = { rate = '0.05 * max(elongation_m - 0.002, 0)' }",
        ],
        TANGENTS,
    ),
    bench(
        "hypothetical_force",
        "{name=\"hypothetical_force\",element=\"muscle\",force_n=0.02,elongation_power=2,pressure_power=1}",
        &["muscle.pull adds 0.02 * (elongation_m/0.01)^2 * (pressure_pa/1e6)"],
        ROUNDING,
    ),
    bench(
        "hypothetical_flow",
        "{name=\"hypothetical_flow\",element=\"line\",flow_m3_s=1e-11,pressure_power=2}",
        &["line.outflow adds 1e-11 * (pressure_pa/1e6)^2"],
        ROUNDING,
    ),
    pulley(
        "cable_slack",
        "{name=\"cable_slack\",element=\"cable_1\",slack_length_m=5e-4}",
        &["cable_1.stretch adds -5e-4"],
        ROUNDING,
    ),
    pulley(
        "tendon_coupling",
        "{name=\"tendon_coupling\",element=\"mechanism\",lever_m=3e-4}",
        &["joint.torque adds 3e-4 * tension_2_n"],
        ROUNDING,
    ),
    pulley(
        "external_contact",
        "{name=\"external_contact\",element=\"mechanism\",stiffness_n_m_rad=1e-3,angle_rad=0.3}",
        &["joint.torque adds -1e-3 * max(angle_rad - 0.3, 0)"],
        SWITCHING,
    ),
    pulley(
        "bearing_friction",
        "{name=\"bearing_friction\",element=\"mechanism\",coulomb_torque_n_m=2e-4,presliding_rad=0.01}",
        &[
            "name = 'dahl'\nport = 'joint.torque'\nadds = '-2e-4 * z'\nstate.z = { rate = 'abs(angular_speed_rad_s)/0.01 * (sign(angular_speed_rad_s) - z)', unit = '1' }",
        ],
        SWITCHING,
    ),
    pulley(
        "sensor_gain",
        "{name=\"sensor_gain\",element=\"sensor\",channel=\"angle_deg\",gain_error=0.03}",
        &["sensor.angle_deg scales 1 + 0.03"],
        ROUNDING,
    ),
    pulley(
        "sensor_drift",
        "{name=\"sensor_drift\",element=\"sensor\",channel=\"angle_deg\",rate_per_s=0.01}",
        &["sensor.angle_deg adds 0.01 * 0.017453292519943295 * time_s"],
        ROUNDING,
    ),
    pulley(
        "sensor_lag",
        "{name=\"sensor_lag\",element=\"sensor\",channel=\"angle_deg\",time_constant_s=0.05}",
        &[
            "name = 'lag'\nport = 'sensor.angle_deg'\nadds = 's - reading'\nstate.s = { rate = '(reading - s)/0.05', start = 'reading' }",
        ],
        ROUNDING,
    ),
    pulley(
        "sensor_lag far below the sample",
        "{name=\"sensor_lag\",element=\"sensor\",channel=\"angle_deg\",time_constant_s=1e-4}",
        &[
            "name = 'lag'\nport = 'sensor.angle_deg'\nadds = 's - reading'\nstate.s = { rate = '(reading - s)/1e-4', start = 'reading' }",
        ],
        ROUNDING,
    ),
];

const UNTIL_S: f64 = 3.0;

fn far(pair: &Pair, model: Model, steps: u16) -> (f64, f64) {
    let effect = format!("effect=[{}]", pair.effect);
    let sets: Vec<&str> = pair.sets.iter().copied().chain([effect.as_str()]).collect();
    let law = run_by(model, &scene(pair.rig, pair.sets, pair.laws), UNTIL_S, steps);
    let effect = run_by(model, &scene(pair.rig, &sets, &[]), UNTIL_S, steps);
    let stock = run_by(model, &scene(pair.rig, pair.sets, &[]), UNTIL_S, steps);
    (distance(&law, &effect, &[]), distance(&stock, &effect, &[]))
}

#[test]
fn val_effects_as_laws_are_those_of_the_catalogue() {
    let all: Vec<(&Pair, Model)> = PAIRS.iter().flat_map(|pair| BOTH.map(|model| (pair, model))).collect();
    let ran: Vec<_> = all.into_par_iter().map(|(pair, model)| (pair, model, far(pair, model, 10))).collect();
    let mut wrong = Vec::new();
    for (pair, model, (far, moved)) in ran {
        println!("{model:?} {:<32} {far:.1e} of the range; from stock {moved:.1e}", pair.name);
        if far > pair.within || moved < 1e-4 {
            wrong.push(format!("{model:?} {}: {far:.2e}, from stock {moved:.1e}", pair.name));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Where they are not the same to rounding, shorter steps bring them together.
#[test]
fn val_what_is_left_between_them_shrinks_with_the_step() {
    for pair in PAIRS.iter().filter(|pair| pair.within > ROUNDING) {
        let [coarse, fine] = [5, 20].map(|steps| far(pair, Model::Fast, steps).0);
        println!("{:<32} {coarse:.1e} {fine:.1e}", pair.name);
        assert!(fine < 0.6 * coarse || coarse < 1e-8, "{}: {coarse:.2e} {fine:.2e}", pair.name);
    }
}
