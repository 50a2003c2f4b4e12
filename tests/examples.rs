//! Contract: every example runs, in an empty folder, and prints what it is there to show.
//!
//! A whole `cargo test` builds the examples as well; before `cargo test --test examples` alone, `cargo build --examples`.

use std::path::PathBuf;
use std::process::Command;

fn program(example: &str) -> PathBuf {
    let own = std::env::current_exe().expect("a running program has a path");
    let build = own.parent().and_then(|deps| deps.parent()).expect("target/PROFILE/deps/NAME");
    build.join("examples").join(format!("{example}{}", std::env::consts::EXE_SUFFIX))
}

/// What an example prints.
fn printed(example: &str, arguments: &[&str]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let program = program(example);
    assert!(program.is_file(), "{}: not built; `cargo build --examples` builds it", program.display());
    let done = Command::new(&program).args(arguments).current_dir(folder.path()).output().expect("it starts");
    assert!(done.status.success(), "{example}: {}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).expect("UTF-8")
}

/// The number that stands before some words.
fn number_before(text: &str, words: &str) -> f64 {
    let before = text.split(words).next().expect("a first part");
    before.split_whitespace().last().and_then(|w| w.trim_start_matches('(').parse().ok()).unwrap_or(f64::NAN)
}

#[test]
fn one_muscle() {
    let text = printed("one_muscle", &[]);
    let range_mm = number_before(&text, " mm, loop");
    assert!((26.0..28.5).contains(&range_mm), "{text}");
    let loops_mm2: Vec<f64> = text.lines().step_by(2).map(|l| number_before(l, " mm2")).collect();
    assert!(loops_mm2.len() == 3 && loops_mm2[0] < loops_mm2[1] && loops_mm2[1] < loops_mm2[2], "{text}");
}

#[test]
fn pulley() {
    let text = printed("pulley", &[]);
    assert_eq!(text.lines().count(), 5, "{text}");
}

#[test]
fn own_finger() {
    let text = printed("own_finger", &[]);
    assert!(text.contains("knuckle_deg") && text.contains("middle_deg"), "{text}");
    let reach: f64 =
        text.lines().next().and_then(|l| l.rsplit(' ').next()).and_then(|w| w.parse().ok()).expect("a number");
    assert!(reach > 10.0, "{text}");
}

#[test]
fn custom_effect() {
    let text = printed("custom_effect", &[]);
    let at_most: Vec<f64> = text.lines().map(|l| number_before(l, " mm at most")).collect();
    assert!(at_most.len() == 3 && at_most[0] > at_most[1] && at_most[1] > at_most[2], "{text}");
}

#[test]
fn find_a_leak() {
    let text = printed("find_a_leak", &[]);
    let answer: serde_json::Value = serde_json::from_str(&text).expect("a diagnosis");
    assert_eq!(answer["verdict"], "missing_physics");
    assert_eq!(answer["effects"][0]["name"], "leak");
}

#[test]
fn sweep() {
    let text = printed("sweep", &[]);
    assert_eq!(text.lines().count(), 10, "{text}");
    assert!(!text.contains("NaN"), "{text}");
}

#[test]
fn feedforward() {
    let text = printed("feedforward", &[]);
    assert!(number_before(&text, " times less") > 3.0, "{text}");
}

/// A case that hides nothing: the calibrated scene leaves noise, and the same program writes the same bytes.
#[test]
fn benchmark() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |place: &str| {
        let out = folder.path().join(place);
        let text = printed("benchmark", &[out.to_str().expect("UTF-8"), "case_20261201"]);
        assert_eq!(text, "case_20261201: muscle_bench\n");
        let read = |file: &str| std::fs::read_to_string(out.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"));
        let case = "cases/case_20261201";
        let files =
            ["recordings.toml", "steps.csv", "calibrated/scene.toml", "calibrated/steps.csv", "next/inputs.csv"];
        let files = files.map(|file| read(&format!("{case}/{file}")));
        let kept_back = ["truth/case_20261201.json", "truth/case_20261201.csv"].map(read);
        (files, kept_back, read(&format!("{case}/next/calibrated.csv")))
    };
    let (files, [truth, measured], predicted) = write("once");
    let truth: serde_json::Value = serde_json::from_str(&truth).expect("JSON");
    assert_eq!(truth["causes"], serde_json::json!([]));
    assert_eq!(measured.lines().count(), predicted.lines().count());
    let elongations_mm = |csv: &str| -> Vec<f64> {
        csv.lines().skip(1).map(|row| row.split(',').nth(1).and_then(|x| x.parse().ok()).unwrap_or(f64::NAN)).collect()
    };
    let noise_mm = truth["noise_sd"]["elongation_mm"].as_f64().expect("a number");
    let (measured, predicted) = (elongations_mm(&measured), elongations_mm(&predicted));
    let left = measured.iter().zip(&predicted).map(|(m, p)| (m - p) / noise_mm).filter(|r| r.is_finite());
    let squares: Vec<f64> = left.map(|r| r * r).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    assert!((0.8..1.3).contains(&mean), "{mean} noise variances of what was kept back");
    assert_eq!(write("again").0, files);
}

/// Every file in `examples/` with a number is started here.
#[test]
fn none_is_forgotten() {
    let here = include_str!("examples.rs");
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/examples")).expect("a folder of the project") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        let Some((_, rest)) = name.split_once('_').filter(|(n, _)| n.chars().all(|c| c.is_ascii_digit())) else {
            continue;
        };
        let example = rest.trim_end_matches(".rs");
        assert!(here.contains(&format!("printed(\"{example}\"")), "{name} is not run by tests/examples.rs");
    }
}
