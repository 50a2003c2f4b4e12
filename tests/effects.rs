//! Effects in full scenes, where they meet what only a full scene has.

use smam::recording::PiecewiseLinear;
use smam::scene::Scene;
use smam::system::{InputSource, Schedule, Simulation, record, step_errors, with_half_steps};

/// The pulley with its first cable on via points instead of a lever, and so much slack in it.
fn via_pulley(slack_m: f64) -> Scene {
    let text = std::fs::read_to_string("scenes/antagonistic_pulley.toml").expect("a stock scene");
    let lever = "route.lever = [{ joint = \"pulley\", lever_m = 0.008 }]";
    let via = "route.via = [{ link = \"frame\", point_m = [-0.03, 0.008, 0.0] }, { link = \"pulley_link\", point_m = [0.0, 0.008, 0.0] }]";
    let draw = "route.draw = [{ link = \"frame\", point_m = [0.0, 0.008, 0.0] }]";
    assert!(text.contains(lever) && text.contains(draw), "the stock scene has changed");
    let slack = format!("\n[[effect]]\nname = \"cable_slack\"\nelement = \"cable_1\"\nslack_length_m = {slack_m}\n");
    let text = format!("{}{slack}", text.replace(lever, via).replace(draw, ""));
    Scene::parse(&text, std::path::Path::new("scenes/antagonistic_pulley.toml"), &[]).unwrap_or_else(|e| panic!("{e}"))
}

/// Via points renew a cable's rest at every engine step; slack was lost there.
#[test]
fn slack_stays_in_a_cable_on_via_points() {
    let greatest_tension = |slack_m: f64| -> f64 {
        let mut simulation = Simulation::new(via_pulley(slack_m)).unwrap_or_else(|e| panic!("{e}"));
        // The first muscle pulls, the second holds against it.
        for (input, end_m) in [("plunger_1_mm", -2e-4), ("plunger_2_mm", 0.0)] {
            let way = PiecewiseLinear::new(&[0.0, 2.0], &[0.0, end_m]).expect("two points");
            simulation.set_input(input, InputSource::Recorded(way));
        }
        let shown = record(&mut simulation, &Schedule::even(2.0, 0.01)).unwrap_or_else(|e| panic!("{e}"));
        shown.channel("tension_1_n").expect("a channel").values.iter().copied().fold(0.0, f64::max)
    };
    let (tight, slack) = (greatest_tension(0.0), greatest_tension(8e-3));
    assert!(tight > 0.02, "{tight}");
    assert_eq!(slack, 0.0);
}

/// Dashpots far faster than a step: their stages are implicit, together with the coordinates.
#[test]
fn relaxations_much_shorter_than_a_step_stay_stable() {
    let text = std::fs::read_to_string("scenes/pressure_muscle.toml").expect("a stock scene");
    let stock = "stiffness_n_m = 200.0";
    assert!(text.contains(stock), "the stock scene has changed");
    // Beside so soft a spring the first branch relaxes in 0.05 s 5/10005, a twentieth of a step.
    let text = text.replace(stock, "stiffness_n_m = 5.0");
    let creep = "\n[[effect]]\nname = \"viscoelasticity\"\nelement = \"muscle\"\nstiffness_n_m = 1e4\nrelaxation_time_s = 0.05\ndecades = 0.1";
    let scene = Scene::parse(&format!("{text}{creep}\n"), std::path::Path::new("scenes/pressure_muscle.toml"), &[])
        .unwrap_or_else(|e| panic!("{e}"));
    let run = |scene: &Scene| {
        let mut simulation = Simulation::new(scene.clone()).unwrap_or_else(|e| panic!("{e}"));
        record(&mut simulation, &Schedule::even(4.0, 0.01)).unwrap_or_else(|e| panic!("{e}"))
    };
    let halved = with_half_steps(&scene).unwrap_or_else(|e| panic!("{e}"));
    for error in step_errors(&run(&scene), &run(&halved)) {
        assert!(error.share() < 1e-3, "{error:?}");
    }
}
