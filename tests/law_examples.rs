//! Contract: what `smam laws` prints as an example runs as it stands on a stock scene, and its energy is accounted for.

use smam::laws::{Carrier, LawTable, PORTS};
use smam::scene::Scene;
use smam::system::Simulation;

const SCENES: [&str; 5] = ["antagonistic_pulley", "muscle_bench", "driven_axis", "tensile_test", "closed_chamber"];

/// The first stock scene that has the port, with the law.
fn simulation(law: &LawTable) -> Simulation {
    let with_law = |name: &&str| {
        let mut scene = Scene::load(name, &[]).unwrap_or_else(|e| panic!("{e}"));
        scene.file.law.push(law.clone());
        Simulation::new(Scene::from_file(scene.file, &scene.path).ok()?).ok()
    };
    SCENES.iter().find_map(with_law).unwrap_or_else(|| panic!("{}: no stock scene has it", law.port))
}

#[test]
fn every_printed_example_runs_on_a_stock_scene() {
    for spec in &PORTS {
        let mut simulation = simulation(&spec.example_table());
        simulation.keep_energy_balance();
        simulation.advance_to(3.0).unwrap_or_else(|e| panic!("{}: {e}", spec.name()));
        let balance = simulation.energy_balance().expect("it was kept");
        if spec.carrier == Carrier::Alone {
            assert_eq!(balance.turnover_j(), 0.0, "{}: nothing is integrated there", spec.name());
            continue;
        }
        let share = balance.unaccounted_j().abs() / balance.turnover_j();
        println!("{}: {share:.1e} of the turnover unaccounted", spec.name());
        assert!(share < 1e-3, "{}: {share}", spec.name());
    }
}
