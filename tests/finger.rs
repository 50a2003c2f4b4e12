//! Somebody's own rig: a finger of two joints, a cable over points of its links, a camera that sees its tip. What runs is diagnosed.

use std::fs;
use std::path::Path;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use smam::diagnose::{Case, Diagnosis, Options, Verdict, diagnose};
use smam::recording::{Channel, Recording};
use smam::scene::{Override, Scene};
use smam::system::{Rom, RomRun, RomSetting, Schedule, Simulation, record};

const SCENE: &str = "tests/finger/finger.toml";
const PROGRAM: &str =
    "time_s = [0.0, 4.0, 8.0, 12.0, 16.0, 20.0], value_m = [0.0, -1.2e-3, -0.3e-3, -1.0e-3, -0.5e-3, 0.0]";

fn load(path: &Path, changes: &[&str]) -> Scene {
    let changes: Vec<Override> = changes.iter().map(|c| Override::parse(c).unwrap_or_else(|e| panic!("{e}"))).collect();
    Scene::load(&path.display().to_string(), &changes).unwrap_or_else(|e| panic!("{e}"))
}

fn play(scene: Scene, duration_s: f64) -> Recording {
    let mut simulation = Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"));
    record(&mut simulation, &Schedule::even(duration_s, 0.02)).unwrap_or_else(|e| panic!("{e}"))
}

fn rom_run(scene: &Scene, full: &Recording) -> RomRun {
    let inputs = scene.file.input.iter().map(|i| full.si(&i.channel).expect("an input")).collect();
    RomRun { times_s: full.time_s().to_vec(), inputs, plan: None }
}

/// Levers that change by half, weights that turn with the links, and a tip that goes round a corner: all as the engine has them.
#[test]
fn val_the_fast_model_follows_a_cable_over_points() {
    let scene = load(Path::new(SCENE), &[]);
    let full = play(scene.clone(), 20.0);
    let rom = Rom::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    let fast = rom.simulate(&rom_run(&scene, &full), &RomSetting::default()).expect("finite");
    for (column, fast) in rom.columns().zip(&fast) {
        let full = &full.find(column).expect("a channel").values;
        let (low, high) = full.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        let squares: f64 = full[50..].iter().zip(&fast[50..]).map(|(a, b)| (a - b).powi(2)).sum();
        let percent = 100.0 * (squares / (full.len() - 50) as f64).sqrt() / (high - low);
        println!("{column}: {percent:.4} % of {low:.2} .. {high:.2}");
        assert!(percent < 0.2 && high - low > 5.0, "{column} differs by {percent:.4} % of {low} .. {high}");
    }
}

/// Recordings of the finger with an effect that its scene does not have.
fn recordings(folder: &Path, effect: &str) {
    for file in ["finger.urdf", "finger.toml"] {
        fs::copy(Path::new(SCENE).with_file_name(file), folder.join(file)).expect("copied");
    }
    let text = fs::read_to_string(SCENE).expect("the scene");
    let programs = [
        ("slow.csv", PROGRAM),
        (
            "steps.csv",
            "time_s = [0.0, 0.5, 5.0, 5.5, 10.0, 10.5, 15.0, 15.5, 20.0], \
                       value_m = [0.0, -0.6e-3, -0.6e-3, -1.2e-3, -1.2e-3, -0.2e-3, -0.2e-3, -0.9e-3, -0.9e-3]",
        ),
        (
            "loops.csv",
            "time_s = [0.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0, 18.0, 20.0], \
                       value_m = [0.0, -1.1e-3, 0.0, -0.8e-3, -0.2e-3, -1.2e-3, -0.6e-3, -1.0e-3, -0.1e-3, -0.7e-3, 0.0]",
        ),
    ];
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for (file, program) in programs {
        assert!(text.contains(PROGRAM));
        let rig = folder.join(format!("{file}.toml"));
        fs::write(&rig, format!("{}\n{effect}\n", text.replace(PROGRAM, program))).expect("written");
        let clean = play(load(&rig, &["muscles.friction.m0_n=0.115", "muscles.tube.material.c1_pa=0.26e6"]), 20.0);
        fs::remove_file(&rig).expect("removed");
        let mut noisy = |c: &Channel| {
            let sd = match c.column.as_str() {
                "pressure_kpa" => 2.0,
                "plunger_mm" => 0.0,
                _ => 0.03,
            };
            let values = c.values.iter().map(|v| {
                let n: f64 = StandardNormal.sample(&mut random);
                v + sd * n
            });
            Channel::new(c.column.clone(), values.collect())
        };
        let channels = clean.channels().iter().map(&mut noisy).collect();
        let noisy = Recording::new(clean.time_s().to_vec(), channels).expect("increasing");
        noisy.write_csv(&folder.join(file)).unwrap_or_else(|e| panic!("{e}"));
    }
    let set = r#"
format = 1
scene = "finger.toml"
channel = [
    { column = "plunger_mm", role = "input" },
    { column = "tip_x_mm", role = "output" },
    { column = "tip_z_mm", role = "output" },
    { column = "pressure_kpa", role = "output" },
]
run = [{ file = "slow.csv" }, { file = "steps.csv" }, { file = "loops.csv", use = "holdout" }]
"#;
    fs::write(folder.join("recordings.toml"), set).expect("written");
}

fn answer(folder: &Path) -> Diagnosis {
    let case = Case::load(&[folder], None, &[]).unwrap_or_else(|e| panic!("{e}"));
    let outcome = diagnose(case, Options { seed: 1 }, &|line| println!("  {line}")).unwrap_or_else(|e| panic!("{e}"));
    println!("{}\n{:?}", outcome.diagnosis.summary, outcome.diagnosis.effects.first().map(|e| &e.parameters));
    outcome.diagnosis
}

#[test]
fn val_what_a_finger_hides_from_its_camera_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    recordings(folder.path(), "[[effect]]\nname = \"leak\"\nelement = \"line\"\nconductance_m3_s_pa = 2e-17");
    let d = answer(folder.path());
    assert_eq!(d.verdict, Verdict::MissingPhysics, "{}", d.summary);
    let names: Vec<(&str, &str)> = d.effects.iter().map(|e| (e.name.as_str(), e.element.as_str())).collect();
    assert_eq!(names, [("leak", "line")]);
    let size = d.effects[0].parameters["conductance_m3_s_pa"];
    assert!((size.value / 2e-17 - 1.0).abs() < 0.1, "{size:?}");
    assert!(d.fit.gap_closed > 0.95 && d.fit.full_scene.agrees, "{:?}", d.fit);
}

#[test]
fn a_finger_that_lacks_nothing_is_left_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    recordings(folder.path(), "");
    let d = answer(folder.path());
    assert_eq!(d.verdict, Verdict::Adequate, "{}", d.summary);
}

/// The joint further out stiffens as it bends: a law of that joint alone, which no law of the two together can stand for.
#[test]
fn val_a_law_of_one_joint_is_found_there() {
    let folder = tempfile::tempdir().expect("a folder");
    let law = "[[law]]\nname = \"stiffens\"\nport = \"joint(knuckle).stiffness\"\nscales = \"1 + 2.0 * angle_rad^2\"";
    recordings(folder.path(), law);
    let d = answer(folder.path());
    let law = d.effects.iter().find(|e| e.hypothetical).unwrap_or_else(|| panic!("{}", d.summary));
    assert!(law.port.starts_with("joint(knuckle)."), "{}", d.summary);
    assert_eq!(law.variables, ["angle_rad"], "{}", d.summary);
    assert!(d.fit.gap_closed > 0.95 && d.fit.full_scene.agrees, "{:?}", d.fit);
}
