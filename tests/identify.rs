//! Contract: `smam identify` finds the printed model in a loop that the program itself recorded, says what the loop does not
//! hold, and what it writes goes into a scene.

use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use smam::hysteresis::{HysteresisModel, PaperModel};
use smam::recording::read_csv;

fn smam(arguments: &[&str], folder: &Path) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_smam")).args(arguments).current_dir(folder).output();
    output.expect("the program starts")
}

/// Two periods of the printed model at 50 Hz, with a little noise of its own.
fn loop_file(folder: &Path) -> PathBuf {
    let time_s: Vec<f64> = (0..1_000).map(|i| f64::from(i) * 0.02).collect();
    let input_mm: Vec<f64> = time_s.iter().map(|t| 1.5 - 1.5 * (TAU * 0.1 * t).cos()).collect();
    let output_mm = HysteresisModel::Paper(PaperModel::printed()).follow(&time_s, &input_mm);
    let mut text = "time_s,plunger_mm,elongation_mm\n".to_owned();
    for (i, t) in time_s.iter().enumerate() {
        let noise = 0.02 * (((i * 7_919) % 1_000) as f64 / 500.0 - 1.0);
        text.push_str(&format!("{t},{},{}\n", input_mm[i], output_mm[i] + noise));
    }
    let file = folder.join("loop.csv");
    fs::write(&file, text).expect("a file");
    file
}

#[test]
fn finds_the_printed_model_and_writes_page_and_figures() {
    let folder = tempfile::tempdir().expect("a folder");
    loop_file(folder.path());
    let output =
        smam(&["identify", "loop.csv", "--model", "paper", "--model", "symmetric", "--out", "o"], folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(folder.path().join("o/identify.json")).expect("figures");
    let answer: Value = serde_json::from_str(&text).expect("JSON");
    let paper = &answer["identified"][0];
    let value = |name: &str| {
        let parameters = paper["parameters"].as_array().expect("a list");
        let found = parameters.iter().find(|p| p["name"] == name).expect("the parameter");
        found["value"].as_f64().expect("a number")
    };
    let printed = PaperModel::printed().with_drive(1.0);
    for (name, truth) in [("alpha_x2", printed.alpha_x2), ("alpha_z", printed.alpha_z), ("nu", printed.nu)] {
        assert!((value(name) / truth - 1.0).abs() < 0.02, "{name}: {} for {truth}", value(name));
    }
    let notes = paper["warnings"].as_array().expect("a list");
    assert!(notes.iter().any(|n| n.as_str().is_some_and(|n| n.starts_with("a is fixed at 1"))), "{notes:?}");
    let f = |i: usize| answer["identified"][i]["f_mm2"].as_f64().expect("a number");
    assert!(f(0) < 2e-4 && f(1) > 100.0 * f(0), "{} {}", f(0), f(1));
    let page = fs::read_to_string(folder.path().join("o/identify.html")).expect("a page");
    assert!(page.contains(r#""type":"TimeSeries""#) && page.contains(r#""label":"measured""#));
    assert!(page.contains("default-src 'none'"));
    let again =
        smam(&["identify", "loop.csv", "--model", "paper", "--model", "symmetric", "--out", "p"], folder.path());
    assert!(again.status.success());
    assert_eq!(fs::read(folder.path().join("p/identify.json")).expect("figures"), text.as_bytes());
}

/// A model with several states, found, put into a scene, run on the same plunger: the loop that was fitted.
#[test]
fn what_it_writes_goes_into_a_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    loop_file(folder.path());
    let output = smam(&["identify", "loop.csv", "--model", "prandtl-ishlinskii", "--out", "o"], folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let stock = fs::read_to_string(root.join("scenes/muscle_printed_model.toml")).expect("the scene");
    let mut scene: toml::Table = stock.parse().expect("TOML");
    let found: toml::Table =
        fs::read_to_string(folder.path().join("o/prandtl-ishlinskii.toml")).expect("a table").parse().expect("TOML");
    let own = |table: &toml::Table| table["muscles"]["displacement"].clone();
    scene["muscles"].as_table_mut().expect("a table").insert("displacement".to_owned(), own(&found));
    let model = root.join("models/muscle_bench.urdf").display().to_string();
    scene["mechanism"].as_table_mut().expect("a table").insert("urdf".to_owned(), toml::Value::String(model));
    fs::write(folder.path().join("scene.toml"), scene.to_string()).expect("a scene");
    let arguments = ["run", "scene.toml", "--input", "loop.csv", "--output", "simulated.csv"];
    let output = smam(&arguments, folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let read = |name: &str| read_csv(&folder.path().join(name)).expect("a recording");
    let (measured, simulated) = (read("loop.csv"), read("simulated.csv"));
    let y = simulated.piecewise_si("elongation_mm").expect("a column");
    let pairs = measured.time_s().iter().zip(measured.si("elongation_mm").expect("a column"));
    let mean = pairs.map(|(&t, m)| (1e3 * (y.value(t) - m)).powi(2)).sum::<f64>() / measured.sample_count() as f64;
    let figures = fs::read_to_string(folder.path().join("o/identify.json")).expect("figures");
    let answer: Value = serde_json::from_str(&figures).expect("JSON");
    let f = answer["identified"][0]["f_mm2"].as_f64().expect("a number");
    assert!((mean / f - 1.0).abs() < 0.02, "{mean} for {f}");
}

/// Noise for an output: a fit is a fit, but the report says what it is worth.
#[test]
fn a_hopeless_fit_is_called_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let draw = |i: usize, k: usize| ((i * k) % 1_009) as f64 / 1_009.0;
    let rows: String =
        (0..400).map(|i| format!("{},{},{}\n", i as f64 * 0.05, draw(i, 7_919), draw(i, 104_729))).collect();
    fs::write(folder.path().join("noise.csv"), format!("time_s,plunger_mm,elongation_mm\n{rows}")).expect("a file");
    let output = smam(&["identify", "noise.csv", "--model", "symmetric"], folder.path());
    assert!(String::from_utf8_lossy(&output.stdout).contains("explains next to nothing"), "{output:?}");
}

#[test]
fn what_cannot_be_identified_is_refused_with_a_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("still.csv"), "time_s,plunger_mm,elongation_mm\n0,1,2\n1,1,2\n").expect("a file");
    fs::write(folder.path().join("force.csv"), "time_s,plunger_mm,force_n\n0,1,2\n1,1,2\n").expect("a file");
    let says = |arguments: &[&str], words: &str| {
        let output = smam(arguments, folder.path());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(words), "{said}");
    };
    says(&["identify", "still.csv"], "record whole strokes");
    says(&["identify", "force.csv", "--output", "force_n"], "is no length");
    says(&["identify", "still.csv", "--model", "preisach"], "known: symmetric, asymmetric, paper");
}

/// The printed model turned round: played on the model itself, the programme gives what was wanted.
#[test]
fn a_model_is_turned_round() {
    let folder = tempfile::tempdir().expect("a folder");
    loop_file(folder.path());
    let output = smam(&["identify", "loop.csv", "--model", "paper", "--out", "o"], folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let wanted = |t: f64| 2.0 + 8.0 * (1.0 - (TAU * 0.07 * t).cos());
    let rows: String = (0..2_000).map(|i| f64::from(i) * 0.01).map(|t| format!("{t},{}\n", wanted(t))).collect();
    fs::write(folder.path().join("wanted.csv"), format!("time_s,elongation_mm\n{rows}")).expect("a file");
    let output = smam(&["feedforward", "o/paper.toml", "wanted.csv", "--out", "p.csv"], folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let programme = read_csv(&folder.path().join("p.csv")).expect("a programme");
    let plunger = &programme.channel("plunger_mm").expect("a column").values;
    assert!(plunger.iter().all(|x| (0.0..=3.0).contains(x)));
    let played = HysteresisModel::Paper(PaperModel::printed()).follow(programme.time_s(), plunger);
    let apart = played.iter().zip(programme.time_s()).skip(200).map(|(y, t)| (y - wanted(*t)).powi(2)).sum::<f64>();
    assert!((apart / 1_800.0).sqrt() < 0.1, "{}", (apart / 1_800.0).sqrt());
    let output = smam(&["feedforward", "loop.csv", "wanted.csv"], folder.path());
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("smam identify"));
}
