//! Memory of laws: lags, branches that relax, what was greatest, play.

use crate::rig::{BOTH, Model, SAMPLE_S, Series, distance, run, run_by, scene};

/// A muscle at a fixed length: what is added to its pull is shown by the force alone.
const HELD: &[&str] = &[
    "muscles.tube.wall=held",
    "input.0.program={kind=\"points\",time_s=[0.0,1.0,2.0,3.0],value_m=[0.0,-1.0e-3,-0.5e-3,-1.5e-3]}",
];
const UNTIL_S: f64 = 3.0;

/// What a law adds to the force, per sample, N.
fn added_n(model: Model, law: &str) -> Vec<f64> {
    let [stock, with] = [&[][..], &[law][..]].map(|laws| run(model, &scene("muscle_blocked", HELD, laws), UNTIL_S));
    with.of("force_n").iter().zip(stock.of("force_n")).map(|(a, b)| a - b).collect()
}

/// The input at a sample, m.
fn input_m(i: usize) -> f64 {
    let t = SAMPLE_S * i as f64;
    let points = [(0.0, 0.0), (1.0, -1.0e-3), (2.0, -0.5e-3), (3.0, -1.5e-3)];
    let k = (t as usize).min(2);
    let ((t0, x0), (_, x1)) = (points[k], points[k + 1]);
    x0 + (x1 - x0) * (t - t0)
}

#[test]
fn val_a_lag_is_the_exact_first_order_response() {
    const TAU_S: f64 = 0.2;
    let law = "name = 'lag'\nport = 'muscle.pull'\nadds = 'k_n_m * s'\nparameter.k_n_m = { value = 1e3 }\n\
               parameter.tau_s = { value = 0.2 }\nstate.s = { rate = '(plunger_m - s)/tau_s', start = 'plunger_m' }";
    for model in BOTH {
        let added = added_n(model, law);
        let mut lagged = 0.0;
        for (i, found) in added.iter().enumerate().skip(1) {
            let (u0, u1) = (input_m(i - 1), input_m(i));
            let lead = TAU_S * (u1 - u0) / SAMPLE_S;
            lagged = u1 - lead + (lagged - u0 + lead) * (-SAMPLE_S / TAU_S).exp();
            // Steps of the second order: 0.1 ms and 1 ms against 200 ms.
            let within = if model == Model::Full { 1e-6 } else { 2e-5 };
            assert!((found - 1e3 * lagged).abs() < within, "{model:?} at {i}: {found} {}", 1e3 * lagged);
        }
    }
}

const MAXWELL: &str = "name = 'branch'\nport = 'muscle.pull'\nadds = 'e_n_m * (elongation_m - s)'\n\
                       parameter.e_n_m = { value = 6.0 }\nparameter.tau_s = { value = TAU }\n\
                       state.s = { rate = '(elongation_m - s)/tau_s', start = 'elongation_m' }";

/// The same stages as those of the catalogue's branch, tangents too.
#[test]
fn val_a_branch_as_a_law_is_that_of_the_catalogue() {
    for tau in ["4.0", "0.05"] {
        let effect = format!(
            "effect=[{{name=\"viscoelasticity\",element=\"muscle\",stiffness_n_m=6.0,relaxation_time_s={tau}}}]"
        );
        for model in BOTH {
            let law = run(model, &scene("muscle_bench", &[], &[&MAXWELL.replace("TAU", tau)]), UNTIL_S);
            let far = distance(&law, &run(model, &scene("muscle_bench", &[&effect], &[]), UNTIL_S), &[]);
            assert!(far < 1e-9, "{model:?}, {tau} s: {far:.1e}");
        }
    }
}

/// Relaxation within a hundredth of a step is a damper of E tau = 6 uN s/m: nothing, and nothing that shakes.
#[test]
fn val_a_branch_far_below_the_step_is_stable() {
    for model in BOTH {
        let law = run(model, &scene("muscle_bench", &[], &[&MAXWELL.replace("TAU", "1e-6")]), UNTIL_S);
        let far = distance(&law, &run(model, &scene("muscle_bench", &[], &[]), UNTIL_S), &[]);
        println!("{model:?} {far:.1e}");
        assert!(far < 1e-3, "{model:?}: {far:.1e}");
    }
}

#[test]
fn what_was_greatest_stays() {
    let law = "name = 'most'\nport = 'muscle.pull'\nadds = '1e3 * g'\nstate.g = { greatest = '-plunger_m' }";
    for model in BOTH {
        let mut greatest = 0.0_f64;
        for (i, found) in added_n(model, law).iter().enumerate() {
            greatest = greatest.max(-input_m(i));
            // It is taken at the ends of steps, of 1 ms at most.
            assert!((found - 1e3 * greatest).abs() < 2e-3, "{model:?} at {i}: {found} {}", 1e3 * greatest);
        }
    }
}

const PLAY: &str =
    "name = 'play'\nport = 'plunger'\nadds = 's - plunger_m'\nstate.s = { play_of = 'plunger_m', width = '4e-5' }";
const BACKLASH: &str = "effect=[{name=\"plunger_backlash\",element=\"syringe\",width_m=4e-5}]";

/// The piston is led over the step as the catalogue's is.
#[test]
fn val_play_as_a_law_is_that_of_the_catalogue() {
    let sets = ["input.0.program={kind=\"sine\",stroke_m=1.0e-3,frequency_hz=0.5}"];
    let with = |extra: &'static str| -> Vec<&str> { sets.iter().copied().chain([extra]).collect() };
    for model in BOTH {
        let law = run(model, &scene("muscle_bench", &sets, &[PLAY]), UNTIL_S);
        let effect = run(model, &scene("muscle_bench", &with(BACKLASH), &[]), UNTIL_S);
        let far = distance(&law, &effect, &[]);
        println!("{model:?} {far:.1e}");
        assert!(far < 1e-6, "{model:?}: {far:.1e}");
    }
}

/// A lag of the element's pressure, which no tangent knows of, at a hundredth of the step.
#[test]
fn val_fast_states_of_other_quantities_are_stable() {
    let law = "name = 'quick'\nport = 'joint.torque'\nadds = '1e-10 * s'\nparameter.tau_s = { value = 1e-6 }\n\
               state.s = { rate = '(pressure_pa - s)/tau_s', start = 'pressure_pa', unit = 'Pa' }";
    let same = "joint.torque adds 1e-10 * pressure_pa";
    let by = |law: &str, steps| -> Series { run_by(Model::Fast, &scene("muscle_bench", &[], &[law]), UNTIL_S, steps) };
    let [coarse, fine] = [5, 20].map(|steps| distance(&by(law, steps), &by(same, steps), &[]));
    println!("{coarse:.1e} {fine:.1e}");
    assert!(coarse < 1e-3 && fine < coarse, "{coarse:.1e} {fine:.1e}");
}
