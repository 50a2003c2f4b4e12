//! Ports by number and by name, several laws at one port, and laws that act at times.

use crate::rig::{BOTH, SAMPLE_S, distance, run, scene};

const PULLEY: &str = "antagonistic_pulley";
const UNTIL_S: f64 = 2.5;

/// That two sets of laws are the same, and a third one is not.
fn alike(rig: &str, one: &[&str], other: &[&str], not: &[&str]) {
    for model in BOTH {
        let [a, b, c] = [one, other, not].map(|laws| run(model, &scene(rig, &[], laws), UNTIL_S));
        let far = distance(&a, &b, &[]);
        assert!(far < 1e-9, "{one:?} and {other:?} in {model:?}: {far:.1e}");
        assert!(distance(&a, &c, &[]) > 1e-5, "{one:?} and {not:?} in {model:?}");
    }
}

#[test]
fn without_a_number_all_elements_are_meant() {
    alike(
        PULLEY,
        &["muscle.friction scales 2.0"],
        &["muscle_1.friction scales 2.0", "muscle_2.friction scales 2.0"],
        &["muscle_2.friction scales 2.0"],
    );
    alike(
        PULLEY,
        &["cable.stretch adds -1e-4"],
        &["cable_1.stretch adds -1e-4", "cable_2.stretch adds -1e-4"],
        &["cable_1.stretch adds -1e-4"],
    );
}

/// A variable with its element's own number is the element's own; one with another's is that one's.
#[test]
fn variables_by_number() {
    alike(
        PULLEY,
        &["muscle_2.pull adds 5.0 * elongation_m"],
        &["muscle_2.pull adds 5.0 * elongation_2_m"],
        &["muscle_2.pull adds 5.0 * elongation_1_m"],
    );
}

/// The slope of a root at rest has no bound; the muscle goes on all the same, slower by what the law takes.
#[test]
fn a_root_at_rest_does_not_hold_the_rig() {
    for model in BOTH {
        let end_mm = |laws: &[&str]| run(model, &scene("muscle_bench", &[], laws), UNTIL_S).last("elongation_mm");
        let (free, damped) = (end_mm(&[]), end_mm(&["muscle.damping adds 5e-3 * max(speed_m_s / 1e-3, 0)^0.5"]));
        assert!(damped > 0.5 * free && damped < 0.9999 * free, "{model:?}: {damped} of {free} mm");
    }
}

#[test]
fn joints_go_by_name() {
    alike(PULLEY, &["joint.torque adds 1e-3"], &["joint(pulley).torque adds 1e-3"], &["joint.torque adds 2e-3"]);
}

/// In the reduced-order model the named notch becomes a coordinate of its own.
#[test]
fn one_joint_of_a_tube_bends_by_itself() {
    for model in BOTH {
        let stock = run(model, &scene("bending_catheter", &[], &[]), UNTIL_S);
        let one = run(model, &scene("bending_catheter", &[], &["joint(notch_3).stiffness scales 3.0"]), UNTIL_S);
        let all = run(model, &scene("bending_catheter", &[], &["joint.stiffness scales 1.25"]), UNTIL_S);
        let bend = |series: &crate::rig::Series| series.last("bend_deg");
        assert!(bend(&one) < 0.999 * bend(&stock), "{model:?}: {} {}", bend(&one), bend(&stock));
        assert!(bend(&all) < 0.999 * bend(&stock), "{model:?}");
    }
}

#[test]
fn laws_at_one_port_add_up_and_multiply() {
    alike(
        PULLEY,
        &["joint.torque adds 1e-3", "joint.torque adds 5e-4"],
        &["joint.torque adds 1.5e-3"],
        &["joint.torque adds 1e-3"],
    );
    // What is added is not scaled.
    alike(
        "muscle_bench",
        &["muscle.friction scales 2.0", "muscle.friction adds 0.05"],
        &["muscle.friction adds 0.05", "muscle.friction scales 2.0"],
        &["muscle.friction adds 0.1", "muscle.friction scales 2.0"],
    );
}

#[test]
fn conditions_switch_laws_on() {
    let when = "name = 'late'\nport = 'joint.torque'\nadds = '1e-3'\nwhen = 'time_s > 1.0'";
    alike(PULLEY, &[when], &["joint.torque adds 1e-3 * (time_s > 1.0)"], &["joint.torque adds 1e-3"]);
    for model in BOTH {
        let [stock, late] = [&[][..], &[when][..]].map(|laws| run(model, &scene(PULLEY, &[], laws), UNTIL_S));
        let switched = (1.0 / SAMPLE_S) as usize;
        let pairs: Vec<bool> =
            stock.of("angle_deg").iter().zip(late.of("angle_deg")).map(|(a, b)| (a - b).abs() < 1e-9).collect();
        assert!(pairs[..switched].iter().all(|same| *same) && !pairs[switched + 5], "{model:?}");
    }
}

/// A piston that jumps brings all its fluid in: 10 um on 15.9 mm2 into the two compliances of a muscle that is held.
#[test]
fn a_piston_that_jumps_loses_no_fluid() {
    let sets = ["muscles.tube.wall=held", "input.0.program={kind=\"constant\",value_m=0.0}"];
    let jump = "name = 'jump'\nport = 'plunger'\nadds = '1e-5'\nwhen = 'time_s > 0.5'";
    for model in BOTH {
        let law = run(model, &scene("muscle_blocked", &sets, &[jump]), UNTIL_S);
        let risen_kpa = law.last("pressure_kpa") - law.of("pressure_kpa")[0];
        let expected_kpa = 1e-5 * std::f64::consts::FRAC_PI_4 * 4.5e-3_f64.powi(2) / 1.06e-14 * 1e-3;
        assert!((risen_kpa / expected_kpa - 1.0).abs() < 1e-6, "{model:?}: {risen_kpa} {expected_kpa}");
    }
}
