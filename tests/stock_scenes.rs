//! Contract of the stock scenes: their expectations hold, halving the step changes nothing that matters, two runs are
//! identical to the byte, and the energy balance closes.

use smam::recording::Recording;
use smam::scene::{Override, Scene};
use smam::system::{Schedule, Simulation, judge, record};

/// Scenes with a plant of hydraulics, muscles or tendons; gripping has contact phases and is judged apart.
const SMOOTH: [&str; 10] = [
    "muscle_bench",
    "muscle_free",
    "muscle_lift",
    "muscle_blocked",
    "muscle_printed_model",
    "antagonistic_pulley",
    "bending_catheter",
    "pressure_muscle",
    "tendon_sheath",
    "tendon_catheter",
];

fn run(name: &str, overrides: &[Override]) -> (Simulation, Recording) {
    let scene = Scene::load(name, overrides).unwrap_or_else(|e| panic!("{e}"));
    let spec = scene.file.simulation;
    let mut simulation = Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"));
    simulation.keep_energy_balance();
    let recording = record(&mut simulation, &Schedule::even(spec.duration_s, spec.output_interval_s));
    (simulation, recording.unwrap_or_else(|e| panic!("{e}")))
}

#[test]
fn val_expectations_hold() {
    for name in smam::stock::scenes() {
        let (simulation, recording) = run(name, &[]);
        for verdict in judge(simulation.scene(), &recording).expect("judged") {
            assert!(verdict.passed, "{name}: {verdict:?}");
        }
    }
}

/// Greatest change of an output in percent of its range, with its name.
fn greatest_change(a: &Recording, b: &Recording, inputs: usize) -> (f64, String) {
    let changes = a.channels().iter().zip(b.channels()).skip(inputs).map(|(x, y)| {
        let finite = y.values.iter().copied();
        let range = finite.clone().fold(f64::MIN, f64::max) - finite.fold(f64::MAX, f64::min);
        let change = x.values.iter().zip(&y.values).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
        (if range > 0.0 { 100.0 * change / range } else { 0.0 }, x.column.clone())
    });
    changes.fold((0.0, String::new()), |m, c| if c.0 > m.0 { c } else { m })
}

#[test]
fn val_halving_the_step_changes_nothing() {
    for name in SMOOTH {
        let (simulation, whole) = run(name, &[]);
        let file = &simulation.scene().file;
        let half = Override::number("simulation.step_s", file.simulation.step_s / 2.0);
        let (_, halved) = run(name, &[half]);
        let (change, channel) = greatest_change(&whole, &halved, file.input.len());
        println!("{name}: {change:.5} % of the range ({channel})");
        assert!(change <= 0.03, "{name}: {channel} changes by {change:.4} % of its range");
    }
}

#[test]
fn val_energy_balance_closes() {
    for name in SMOOTH {
        let (simulation, _) = run(name, &[]);
        let balance = simulation.energy_balance().expect("kept");
        let share = 100.0 * balance.unaccounted_j().abs() / balance.turnover_j();
        println!("{name}: {share:.5} % of the turnover");
        assert!(
            share <= 0.1,
            "{name}: {share:.4} % of the plunger's turnover is unaccounted for: {:?}",
            balance.lines()
        );
    }
}

#[test]
fn two_runs_are_identical() {
    for name in ["muscle_bench", "bending_catheter", "grip_and_release"] {
        let shorter = [Override::number("simulation.duration_s", 3.0)];
        let (_, first) = run(name, &shorter);
        let (_, second) = run(name, &shorter);
        assert_eq!(first, second, "{name}");
    }
}

#[test]
fn val_gripping_does_not_depend_on_the_step() {
    let (_, whole) = run("grip_and_release", &[]);
    let (_, halved) = run("grip_and_release", &[Override::number("simulation.step_s", 2.5e-4)]);
    for channel in ["ball_in_jaws_x_mm", "ball_in_jaws_z_mm"] {
        let (a, b) = (whole.channel(channel).expect("channel"), halved.channel(channel).expect("channel"));
        // While it is held: from the closed grip to just before letting go.
        let held = whole.time_s().iter().zip(a.values.iter().zip(&b.values)).filter(|(t, _)| (2.5..7.4).contains(*t));
        let worst = held.map(|(_, (a, b))| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst <= 0.05, "{channel}: {worst} mm");
    }
}

#[test]
fn val_force_against_elongation_is_straight() {
    // Paper, Fig. 4b: R² = 0.9962 of the greatest force over the elongation, 0 to 125 mm.
    use smam::muscle::{Coil, Material, Wall, WallGeometry};
    let geometry = WallGeometry { inner_radius_m: 0.255e-3, outer_radius_m: 0.525e-3, rest_length_m: 0.05 };
    let wall = Wall::new(geometry, Material::Yeoh { c1_pa: 0.255e6, c2_pa: 0.0155e6, c3_pa: 0.0 }).expect("stock");
    let coil = Coil { stiffness_n_m: 28.3, preload_n: 0.0 };
    let points: Vec<(f64, f64)> =
        (0..=125).map(|mm| f64::from(mm) * 1e-3).map(|e: f64| (e, wall.pull_n(e) + coil.pull_n(e))).collect();
    let n = points.len() as f64;
    let (mx, my) = (points.iter().map(|p| p.0).sum::<f64>() / n, points.iter().map(|p| p.1).sum::<f64>() / n);
    let xy: f64 = points.iter().map(|(x, y)| (x - mx) * (y - my)).sum();
    let xx: f64 = points.iter().map(|(x, _)| (x - mx).powi(2)).sum();
    let yy: f64 = points.iter().map(|(_, y)| (y - my).powi(2)).sum();
    let r_squared = xy * xy / (xx * yy);
    assert!(r_squared >= 0.995, "{r_squared}");
}
