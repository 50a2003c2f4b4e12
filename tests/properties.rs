//! Properties of whole runs that no scene may lack: numbers stay numbers, energy is kept, time has no origin, units do not
//! matter, shorter steps change little, and a run that is taken up again goes on as if it had not been left.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use smam::recording::{Channel, Recording};
use smam::scene::{Override, Scene};
use smam::system::{InputSource, Schedule, Simulation, SystemError, record, step_errors, with_half_steps};

const RIGS: [&str; 3] = ["muscle_bench", "antagonistic_pulley", "bending_catheter"];
const DURATION_S: f64 = 1.5;

/// Keys that every rig has, each to be a quarter to four times its stock value.
const KEYS: [&str; 12] = [
    "hydraulics.line.length_m",
    "hydraulics.line.bore_m",
    "hydraulics.fluid.viscosity_pa_s",
    "hydraulics.fluid.density_kg_m3",
    "hydraulics.syringe.bore_m",
    "hydraulics.upstream_compliance_m3_pa",
    "hydraulics.downstream_compliance_m3_pa",
    "muscles.friction.m0_n",
    "muscles.friction.m1_n_pa",
    "muscles.friction.presliding_length_m",
    "muscles.tube.coil.stiffness_n_m",
    "muscles.damping_n_s_m",
];

fn stock(rig: &str) -> Scene {
    Scene::load(rig, &[]).unwrap_or_else(|e| panic!("{e}"))
}

/// The rig with each key times a power of four between -1 and 1.
fn changed(rig: &str, powers: &[f64]) -> Scene {
    let keys = stock(rig).keys();
    let number = |key: &str| -> f64 {
        let (_, text) = keys.iter().find(|(k, _)| k == key).unwrap_or_else(|| panic!("{rig} has no {key}"));
        text.parse().unwrap_or_else(|_| panic!("{key} = {text} is no number"))
    };
    let times = |(key, power): (&&str, &f64)| Override::number(*key, number(key) * 4f64.powf(*power));
    let overrides: Vec<Override> = KEYS.iter().zip(powers).map(times).collect();
    Scene::load(rig, &overrides).unwrap_or_else(|e| panic!("{e}"))
}

fn powers() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-1.0f64..=1.0, KEYS.len())
}

fn run(scene: Scene) -> Result<Recording, SystemError> {
    record(&mut Simulation::new(scene)?, &Schedule::even(DURATION_S, 0.01))
}

fn is_whole(recording: &Recording) -> bool {
    recording.channels().iter().all(|c| c.values.iter().all(|v| v.is_finite()))
}

/// The same scenes in every run; more of them with PROPTEST_CASES.
fn config() -> ProptestConfig {
    let cases = std::env::var("PROPTEST_CASES").ok().and_then(|count| count.parse().ok()).unwrap_or(24);
    ProptestConfig { cases, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn numbers_stay_numbers_or_the_run_says_where_it_ended(rig in 0..RIGS.len(), powers in powers()) {
        match run(changed(RIGS[rig], &powers)) {
            Ok(recording) => prop_assert!(is_whole(&recording)),
            Err(SystemError::Diverged { time_s, what }) => prop_assert!(time_s > 0.0 && !what.is_empty()),
            Err(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn energy_is_kept(rig in 0..RIGS.len(), powers in powers()) {
        let mut simulation = Simulation::new(changed(RIGS[rig], &powers)).expect("builds");
        simulation.keep_energy_balance();
        if simulation.advance_to(DURATION_S).is_ok() {
            let balance = simulation.energy_balance().expect("kept");
            let share = balance.unaccounted_j().abs() / balance.turnover_j().max(1e-9);
            // What `smam run --energy` warns of.
            prop_assert!(share < 1e-2, "{share:.2e} of the turnover is unaccounted for");
            let lost = balance.lines().into_iter().filter(|(name, _)| name.starts_with("lost_"));
            for (name, joule) in lost {
                prop_assert!(joule > -1e-12, "{name}: {joule:.2e} J: a law that dissipates gave energy");
            }
        }
    }

    #[test]
    fn shorter_steps_change_little(rig in 0..RIGS.len(), powers in powers()) {
        let scene = changed(RIGS[rig], &powers);
        let halved = with_half_steps(&scene).expect("valid");
        if let (Ok(run), Ok(halved)) = (run(scene), run(halved)) {
            for error in step_errors(&run, &halved) {
                // What hardly moves has no range to speak of: 10 um, 0.01 degrees, 10 Pa, 10 mN.
                prop_assert!(error.share() < 0.02 || error.greatest < 1e-2, "{error:?}");
            }
        }
    }
}

/// A scene driven by its own programme as a recording that begins at `start_s`.
fn played_from(rig: &str, start_s: f64) -> Recording {
    let scene = stock(rig);
    let times = Schedule::even(DURATION_S, 0.01).times();
    let shifted: Vec<f64> = times.iter().map(|t| t + start_s).collect();
    let mut simulation = Simulation::new(scene.clone()).expect("builds");
    for (input, program) in scene.file.input.iter().zip(&scene.programs) {
        let values: Vec<f64> = times.iter().map(|&t| program.value(t) * 1e3).collect();
        let drive = Recording::new(shifted.clone(), vec![Channel::new(input.channel.clone(), values)]).expect("valid");
        let source = InputSource::Recorded(drive.piecewise_si(&input.channel).expect("a known unit"));
        simulation.set_input(&input.channel, source);
    }
    record(&mut simulation, &Schedule::at(shifted)).expect("runs")
}

#[test]
fn time_has_no_origin() {
    for rig in RIGS {
        // A power of two, so that the instants themselves are the same numbers but for their last bits.
        let (here, there) = (played_from(rig, 0.0), played_from(rig, 64.0));
        for (a, b) in here.channels().iter().zip(there.channels()) {
            let range = a.values.iter().fold(0.0_f64, |most, v| most.max(v.abs())).max(1e-9);
            let worst = a.values.iter().zip(&b.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-6 * range, "{rig}: {} moves by {worst:.2e} of {range:.2e}", a.column);
        }
    }
}

#[test]
fn units_do_not_matter() {
    let scene = stock("muscle_bench");
    let times = Schedule::even(DURATION_S, 0.01).times();
    let metres: Vec<f64> = times.iter().map(|&t| scene.programs[0].value(t)).collect();
    let driven = |column: &str, factor: f64| {
        let values = metres.iter().map(|m| m * factor).collect();
        let drive = Recording::new(times.clone(), vec![Channel::new(column, values)]).expect("valid");
        let mut simulation = Simulation::new(scene.clone()).expect("builds");
        let source = InputSource::Recorded(drive.piecewise_si(column).expect("a known unit"));
        simulation.set_input("plunger_mm", source);
        record(&mut simulation, &Schedule::at(times.clone())).expect("runs")
    };
    let (in_mm, in_um) = (driven("plunger_mm", 1e3), driven("plunger_um", 1e6));
    for (a, b) in in_mm.channels().iter().zip(in_um.channels()) {
        for (a, b) in a.values.iter().zip(&b.values) {
            assert!((a - b).abs() <= 1e-9 * a.abs().max(1e-3), "{a} {b}");
        }
    }
}

#[test]
fn a_run_taken_up_again_goes_on_to_the_bit() {
    for rig in RIGS {
        let schedule = Schedule::even(DURATION_S, 0.01);
        let whole = run(stock(rig)).expect("runs");
        let mut simulation = Simulation::new(stock(rig)).expect("builds");
        let times = schedule.times();
        let half = times.len() / 2;
        // The instant where it is taken up stands in both.
        let (first, rest) = (&times[..=half], &times[half..]);
        let begun = record(&mut simulation, &Schedule::at(first.to_vec())).expect("runs");
        let mut kept = simulation.clone();
        // What goes on meanwhile does not reach what was kept.
        simulation.advance_to(DURATION_S).expect("runs");
        let resumed = record(&mut kept, &Schedule::at(rest.to_vec())).expect("runs");
        for ((all, first), rest) in whole.channels().iter().zip(begun.channels()).zip(resumed.channels()) {
            let joined: Vec<f64> = first.values.iter().chain(&rest.values[1..]).copied().collect();
            assert!(all.values == joined, "{rig}: {}", all.column);
        }
    }
}
