//! Runs of several specimens in one diagnosis: numbers of each, one law for all, and one predicted from the others.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use smam::diagnose::{Case, Diagnosis, Options, Verdict, diagnose};
use smam::recording::{Channel, Recording};
use smam::scene::{Override, Scene};
use smam::system::{Schedule, Simulation, record};

/// Name and stiffness of the rubber, Pa.
const SPECIMENS: [(&str, f64); 3] = [("first", 2.2e5), ("second", 2.9e5), ("third", 2.55e5)];
const PROGRAMMES: [&str; 2] = [
    "input.0.program={kind=\"sine\",stroke_m=1.3e-3,frequency_hz=0.12}",
    "input.0.program={kind=\"sine\",stroke_m=0.9e-3,frequency_hz=0.31}",
];
const LEAK: &str = "effect=[{name=\"leak\",element=\"line\",conductance_m3_s_pa=2e-17}]";
const NOISE: [(&str, f64); 2] = [("elongation_mm", 0.02), ("pressure_kpa", 5.0)];

/// Two runs of each of the first `count` specimens, all of which leak.
fn recorded(folder: &Path, count: usize) {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut text =
        "format = 1\nscene = \"muscle_bench\"\n[[channel]]\ncolumn = \"plunger_mm\"\nrole = \"input\"\n".to_owned();
    for (column, sd) in NOISE {
        let _ = write!(text, "[[channel]]\ncolumn = \"{column}\"\nrole = \"output\"\nnoise_sd = {sd}\n");
    }
    for (name, c1_pa) in &SPECIMENS[..count] {
        for (i, programme) in PROGRAMMES.iter().enumerate() {
            let c1 = format!("muscles.tube.material.c1_pa={c1_pa}");
            let set: Vec<Override> =
                [c1.as_str(), programme, LEAK].iter().map(|text| Override::parse(text).expect("an override")).collect();
            let mut simulation = Simulation::new(Scene::load("muscle_bench", &set).expect("stock")).expect("stock");
            let played = record(&mut simulation, &Schedule::even(25.0, 0.02)).expect("a run");
            let file = format!("{name}_{i}.csv");
            noisy(&played, &mut random).write_csv(&folder.join(&file)).expect("written");
            let _ = write!(text, "[[run]]\nfile = \"{file}\"\nspecimen = \"{name}\"\n");
        }
    }
    std::fs::write(folder.join("recordings.toml"), text).expect("written");
}

fn noisy(played: &Recording, random: &mut ChaCha8Rng) -> Recording {
    let mut channels = vec![played.channel("plunger_mm").expect("driven").clone()];
    for (column, sd) in NOISE {
        let mut noise = || -> f64 { StandardNormal.sample(random) };
        let values = &played.channel(column).expect("shown").values;
        channels.push(Channel::new(column, values.iter().map(|x| x + sd * noise()).collect()));
    }
    Recording::new(played.time_s().to_vec(), channels).expect("increasing")
}

fn answer(case: Case) -> Diagnosis {
    let outcome = diagnose(case, Options { seed: 1 }, &|line| println!("  {line}")).unwrap_or_else(|e| panic!("{e}"));
    println!("{}", outcome.diagnosis.summary);
    outcome.diagnosis
}

#[test]
fn numbers_are_each_specimens_and_the_law_is_one() {
    let folder = tempfile::tempdir().expect("a folder");
    recorded(folder.path(), 2);
    let out = folder.path().join("out");
    let status = Command::new(env!("CARGO_BIN_EXE_smam"))
        .arg("diagnose")
        .arg(folder.path())
        .arg("--out")
        .arg(&out)
        .status()
        .expect("the program starts");
    assert!(status.success());
    let text = std::fs::read_to_string(out.join("diagnosis.json")).expect("an answer");
    let d: Diagnosis = serde_json::from_str(&text).expect("an answer");
    assert_eq!(d.verdict, Verdict::MissingPhysics, "{}", d.summary);
    let [leak] = &d.effects[..] else { panic!("{:?}", d.effects) };
    assert_eq!(leak.name, "leak");
    let stiffness = &d.specimens["tube_c1_pa"];
    assert!(stiffness.differs);
    for (name, c1_pa) in &SPECIMENS[..2] {
        let found = &stiffness.values[*name];
        let half = found.ci95[1] - found.value;
        assert!((found.value - c1_pa).abs() < 2.0 * half.max(1e-3 * c1_pa), "{name}: {found:?}");
    }
    assert!(!d.specimens["friction_m0_n"].differs, "{:?}", d.specimens);
    assert!(d.warnings.iter().any(|w| w.contains("2 specimens (first, second), one law for all")), "{:?}", d.warnings);
    // A scene for each, with its own numbers.
    let c1 = |file: &str| {
        let scene = Scene::load(&out.join(file).display().to_string(), &[]).unwrap_or_else(|e| panic!("{e}"));
        scene.number("muscles.tube.material.c1_pa").expect("a number")
    };
    assert!((c1("scene.toml") / 2.2e5 - 1.0).abs() < 0.01 && (c1("scene_second.toml") / 2.9e5 - 1.0).abs() < 0.01);
}

#[test]
fn a_specimen_is_predicted_from_the_others() {
    let folder = tempfile::tempdir().expect("a folder");
    recorded(folder.path(), 3);
    let load = || Case::load(&[folder.path()], None, &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut case = load();
    case.transfer("third").unwrap_or_else(|e| panic!("{e}"));
    let held: Vec<&str> = case.runs.iter().filter(|run| run.is_held_out).map(|run| run.file.as_str()).collect();
    assert_eq!(held, ["third_0.csv", "third_1.csv"]);
    let d = answer(case);
    assert_eq!(d.fit.holdout, ["third_0.csv", "third_1.csv"]);
    assert_eq!(d.specimens["tube_c1_pa"].values.len(), 2);
    // The mean of the others' numbers is its own: the law alone is left to be told.
    assert!(d.effects.iter().any(|e| e.name == "leak") && d.fit.gap_closed > 0.9, "{} {}", d.summary, d.fit.gap_closed);
    let refused = load().transfer("fourth").expect_err("no such specimen").to_string();
    assert!(refused.contains("there are first, second, third"), "{refused}");
}

#[test]
fn specimens_are_named_for_every_run_or_for_none() {
    let folder = tempfile::tempdir().expect("a folder");
    recorded(folder.path(), 2);
    let path = folder.path().join("recordings.toml");
    let text = std::fs::read_to_string(&path).expect("there").replacen("specimen = \"second\"\n", "", 1);
    std::fs::write(&path, &text).expect("written");
    let refused = Case::load(&[folder.path()], None, &[]).expect_err("one lacks it").to_string();
    assert!(
        refused.contains("[[run]] 3 (\"second_0.csv\")") && refused.contains("specimen = \"sample 1\""),
        "{refused}"
    );
    // The remedy, tried.
    let fixed = text.replace("file = \"second_0.csv\"\n", "file = \"second_0.csv\"\nspecimen = \"sample 1\"\n");
    std::fs::write(&path, fixed).expect("written");
    assert!(Case::load(&[folder.path()], None, &[]).is_ok());
}
