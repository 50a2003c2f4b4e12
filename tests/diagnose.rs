//! Contract of the diagnosis, on independent recordings that conceal nothing or one effect: verdict, effect, element and
//! size are right, and the corrected scene - the full one - predicts a run that the diagnosis never saw.
//!
//! The recordings are not part of the project; without them this says so.

use std::path::{Path, PathBuf};

use serde_json::Value;
use smam::diagnose::{Case, Diagnosis, Options, Verdict, diagnose};
use smam::recording::{RecordingSet, Role, read_csv};
use smam::scene::Scene;
use smam::system::{InputSource, Schedule, Simulation, record};

/// The folder of the recordings and the truth about them.
fn practice() -> Option<(PathBuf, Value)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/recordings/practice");
    if !folder.exists() {
        println!("skipped: ../shared/recordings/practice is not there");
        return None;
    }
    let truth = std::fs::read_to_string(folder.join("truth.json")).expect("truth");
    Some((folder, serde_json::from_str(&truth).expect("truth is JSON")))
}

fn check(name: &str) {
    let Some((folder, truth)) = practice() else { return };
    let case = Case::load(&[&folder.join(name)], None, &[]).unwrap_or_else(|e| panic!("{e}"));
    let outcome = diagnose(case, Options { seed: 1 }, &|_| {}).unwrap_or_else(|e| panic!("{e}"));
    answer_is_right(name, &outcome.diagnosis, &truth[name]);
    let text = outcome.scene_text().expect("a scene").unwrap_or_else(|e| panic!("{e}"));
    corrected_scene_predicts(name, &folder, &text);
    let baseline = outcome.baseline_text().expect("a scene").unwrap_or_else(|e| panic!("{e}"));
    let numbers = |text: &str| -> Vec<String> {
        let is_word = |line: &&str| ["name = ", "title = "].iter().any(|word| line.starts_with(word));
        text.lines().filter(|line| !is_word(line)).map(str::to_owned).collect()
    };
    assert_eq!(
        numbers(&baseline) == numbers(&text),
        outcome.diagnosis.effects.is_empty(),
        "what is not named corrects nothing"
    );
}

fn answer_is_right(name: &str, d: &Diagnosis, truth: &Value) {
    let names: Vec<&str> = truth["names"].as_array().expect("names").iter().filter_map(Value::as_str).collect();
    println!("{name}: {}", d.summary);
    let expected = if names.is_empty() { Verdict::Adequate } else { Verdict::MissingPhysics };
    assert_eq!(d.verdict, expected, "{name}");
    assert_eq!(d.effects.iter().map(|e| e.name.as_str()).collect::<Vec<_>>(), names, "{name}");
    assert_eq!(d.location.element.as_deref(), truth["element"].as_str(), "{name}");
    for (key, size) in truth["size"].as_object().expect("size") {
        let key = key.trim_start_matches("branch_");
        let Some(found) = d.effects[0].parameters.get(key) else { panic!("{name}: no {key}") };
        let (size, ci) = (size.as_f64().expect("a number"), found.ci95);
        println!("{name}: {key} = {size:.4e}, found {:.4e} in {:.4e} .. {:.4e}", found.value, ci[0], ci[1]);
        assert!(ci[0] <= size && size <= ci[1], "{name}: {key}");
    }
}

fn corrected_scene_predicts(name: &str, folder: &Path, text: &str) {
    let set = RecordingSet::load(&folder.join(name)).expect("recordings.toml");
    let measured = read_csv(&folder.join(format!("{name}.holdout.csv"))).expect("holdout");
    let scene = Scene::parse(text, Path::new("corrected.toml"), &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut simulation = Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"));
    for spec in set.of_role(Role::Input) {
        simulation.set_input(&spec.column, InputSource::Recorded(measured.piecewise_si(&spec.column).expect("column")));
    }
    let simulated = record(&mut simulation, &Schedule::at(measured.time_s().to_vec())).expect("runs");
    for spec in set.of_role(Role::Output) {
        let (a, b) = (measured.channel(&spec.column), simulated.channel(&spec.column));
        let (a, b) = (&a.expect("column").values, &b.expect("column").values);
        let rmse = (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt();
        let ratio = rmse / spec.noise_sd.expect("stated");
        println!("{name}: {} rmse/noise {ratio:.3}", spec.column);
        assert!(ratio < 1.1, "{name}: {}", spec.column);
    }
}

#[test]
fn val_bench_recordings() {
    ["01", "02", "03", "04"].into_iter().for_each(check);
}

#[test]
fn val_pulley_recordings() {
    ["05", "06"].into_iter().for_each(check);
}

#[test]
fn val_catheter_recordings() {
    ["07", "08"].into_iter().for_each(check);
}
