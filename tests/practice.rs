//! Independent recordings on the stock rigs: with nothing concealed and the true calibration set, the scene must
//! reproduce the held-out run to its noise. The recordings are not part of the project; without them this says so.

use std::path::Path;

use smam::recording::{RecordingSet, Role, read_csv};
use smam::scene::{Override, Scene};
use smam::system::{InputSource, Schedule, Simulation, record};

const PRACTICE: &str = "../shared/recordings/practice";

fn rmse(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

fn holdout_meets_noise(case: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(PRACTICE);
    if !folder.exists() {
        println!("skipped: {PRACTICE} is not there");
        return;
    }
    let truth: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("truth.json")).expect("truth"))
            .expect("truth is JSON");
    let calibration = truth[case]["calibration"].as_object().expect("calibration");
    let overrides: Vec<Override> =
        calibration.iter().map(|(key, value)| Override::number(key, value.as_f64().expect("number"))).collect();
    let set = RecordingSet::load(&folder.join(case)).expect("recordings.toml");
    let scene = Scene::load(&set.scene, &overrides).expect("scene");
    let measured = read_csv(&folder.join(format!("{case}.holdout.csv"))).expect("holdout");
    let mut simulation = Simulation::new(scene).expect("builds");
    for spec in set.of_role(Role::Input) {
        simulation.set_input(&spec.column, InputSource::Recorded(measured.piecewise_si(&spec.column).expect("column")));
    }
    let simulated = record(&mut simulation, &Schedule::at(measured.time_s().to_vec())).expect("runs");
    for spec in set.of_role(Role::Output) {
        let error = rmse(
            &measured.channel(&spec.column).expect("column").values,
            &simulated.channel(&spec.column).expect("column").values,
        );
        let ratio = error / spec.noise_sd.expect("stated");
        println!("{case} {}: rmse/noise {ratio:.3}", spec.column);
        assert!(ratio < 1.15, "{case} {}: {ratio:.3} times its noise", spec.column);
    }
}

#[test]
fn val_bench_holdout_meets_noise() {
    holdout_meets_noise("01");
}

#[test]
fn val_pulley_holdout_meets_noise() {
    holdout_meets_noise("05");
}

#[test]
fn val_catheter_holdout_meets_noise() {
    holdout_meets_noise("08");
}
