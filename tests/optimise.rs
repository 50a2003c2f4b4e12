//! Contract of optimisation: fronts that are known, limits that hold, and the same bytes after any kill.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use smam::sweep::{Evolution, SamplingSpec, Score, VarySpec, front};

fn range() -> VarySpec {
    VarySpec { key: "x".to_owned(), from: Some(0.0), to: Some(1.0), ..VarySpec::default() }
}

/// All scores that an optimisation has seen.
fn optimised(keys: usize, population: u64, generations: u64, seed: u32, of: impl Fn(&[f64]) -> Score) -> Vec<Score> {
    let sampling = SamplingSpec::Nsga2 { population, generations, seed };
    let mut evolution = Evolution::new(sampling, &vec![range(); keys]).expect("an optimisation");
    let mut all = Vec::new();
    while let Some(asked) = evolution.ask() {
        let scores: Vec<Score> = asked.iter().map(|x| of(x)).collect();
        all.extend(scores.clone());
        evolution.tell(scores);
    }
    all
}

/// Zitzler, Deb, Thiele 2000: the front is `1 - sqrt(f1)`, where all keys but the first are zero.
fn zdt1(x: &[f64]) -> Vec<f64> {
    let g = 1.0 + 9.0 * x[1..].iter().sum::<f64>() / (x.len() - 1) as f64;
    vec![x[0], g * (1.0 - (x[0] / g).sqrt())]
}

#[test]
fn the_front_of_zdt1_is_found_and_covered() {
    let all = optimised(8, 40, 80, 1, |x| Score { costs: zdt1(x), excess: 0.0 });
    assert_eq!(all.len(), 3200);
    let mut found: Vec<&Vec<f64>> = front(&all).into_iter().map(|i| &all[i].costs).collect();
    found.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let above = |c: &Vec<f64>| c[1] - (1.0 - c[0].sqrt());
    let mean = found.iter().map(|c| above(c)).sum::<f64>() / found.len() as f64;
    assert!(mean < 0.02, "{mean} above the front");
    let widest = found.windows(2).map(|p| p[1][0] - p[0][0]).fold(found[0][0], f64::max);
    assert!(found.len() > 40 && widest < 0.1 && found[found.len() - 1][0] > 0.95, "{} points, {widest}", found.len());
}

#[test]
fn limits_cut_the_front_where_they_stand() {
    // Of ZDT1 only what has f1 + f2 <= 0.8: between sqrt(f1) = 0.276 and 0.724.
    let score = |x: &[f64]| {
        let costs = zdt1(x);
        let excess = (costs.iter().sum::<f64>() - 0.8).max(0.0);
        Score { costs, excess }
    };
    let all = optimised(5, 40, 80, 2, score);
    let found: Vec<f64> = front(&all).into_iter().map(|i| all[i].costs[0]).collect();
    let (least, greatest) = found.iter().fold((f64::MAX, f64::MIN), |(l, g), f| (l.min(*f), g.max(*f)));
    let end = |sign: f64| (0.5 * (1.0 + sign * 0.2f64.sqrt())).powi(2);
    assert!((least - end(-1.0)).abs() < 0.02 && (greatest - end(1.0)).abs() < 0.02, "{least} .. {greatest}");
}

#[test]
fn points_that_fail_are_left_behind() {
    // The left half of the first key has no value.
    let score = |x: &[f64]| match x[0] < 0.5 {
        true => Score { costs: vec![f64::NAN; 2], excess: f64::INFINITY },
        false => Score { costs: zdt1(x), excess: 0.0 },
    };
    let all = optimised(4, 20, 30, 3, score);
    let failed = |scores: &[Score]| scores.iter().filter(|s| s.excess > 0.0).count();
    assert!(failed(&all[..20]) >= 8 && failed(&all[580..]) <= 3, "{} {}", failed(&all[..20]), failed(&all[580..]));
}

/// A muscle that shall stretch far at little pressure, but by 5 mm at least.
const SWEEP: &str = r#"
format = 1
name = "bench"
scene = "muscle_bench"
duration_s = 5.0
[sampling]
method = "nsga2"
population = 8
generations = 4
seed = 1
[[vary]]
key = "hydraulics.syringe.bore_m"
from = 2.0e-3
to = 5.0e-3
[[vary]]
key = "tube_c1_pa"
from = 0.2e6
to = 0.3e6
[[measure]]
name = "elongation_range_mm"
of = "range(elongation_mm)"
[[measure]]
name = "pressure_max_kpa"
of = "max(pressure_kpa)"
[[objective]]
measure = "elongation_range_mm"
goal = "maximise"
[[objective]]
measure = "pressure_max_kpa"
goal = "minimise"
[[limit]]
measure = "elongation_range_mm"
min = 5.0
"#;

fn smam(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_smam")).arg("sweep").args(arguments).output().expect("the program starts")
}

fn done(arguments: &[&str]) {
    let output = smam(arguments);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Everything a sweep writes but its journal.
fn written(folder: &Path) -> Vec<Vec<u8>> {
    let files = ["table.csv", "table.parquet", "best.csv", "sweep.html"];
    files.iter().map(|f| fs::read(folder.join(f)).unwrap_or_else(|e| panic!("{f}: {e}"))).collect()
}

#[test]
fn a_scene_is_optimised_under_limits_and_goes_on_after_a_kill() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    let file = at("sweep.toml");
    fs::write(&file, SWEEP).expect("written");
    done(&[&file, "--out", &at("one"), "--threads", "1"]);
    done(&[&file, "--out", &at("two"), "--threads", "2"]);
    let expected = written(&folder.path().join("one"));
    assert!(written(&folder.path().join("two")) == expected, "threads");
    let journal = folder.path().join("two/journal.jsonl");
    let lines = fs::read_to_string(&journal).expect("a journal");
    fs::write(&journal, &lines[..lines.len() / 2 + 9]).expect("cut");
    done(&[&file, "--out", &at("two"), "--resume"]);
    assert!(written(&folder.path().join("two")) == expected, "resumed");

    let best = String::from_utf8_lossy(&expected[2]).into_owned();
    let rows: Vec<Vec<f64>> =
        best.lines().skip(1).map(|l| l.split(',').filter_map(|c| c.parse().ok()).collect()).collect();
    assert!(rows.len() >= 3, "{best}");
    assert!(rows.iter().all(|row| row[3] >= 5.0), "limit: {best}");
    for (a, b) in rows.iter().flat_map(|a| rows.iter().map(move |b| (a, b))) {
        assert!(!(a[3] > b[3] && a[4] < b[4]), "{a:?} beats {b:?}");
    }
    let shard = smam(&[&file, "--out", &at("shard"), "--shard", "1/2"]);
    assert!(String::from_utf8_lossy(&shard.stderr).contains("has no shards"), "{shard:?}");
}

#[test]
fn goals_that_cannot_be_are_refused_before_anything_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sweep.toml");
    for (old, new, words) in [
        (
            "measure = \"pressure_max_kpa\"\ngoal",
            "measure = \"pressure_max\"\ngoal",
            "did you mean \"pressure_max_kpa\"?",
        ),
        ("min = 5.0", "", "it has no bound"),
        ("population = 8", "population = 2", "at least 4"),
        ("from = 2.0e-3\nto = 5.0e-3", "mean = 3.0e-3\nsd = 1.0e-4", "give from and to"),
        ("goal = \"minimise\"", "goal = \"lower\"", "expected `maximise` or `minimise`"),
    ] {
        fs::write(&file, SWEEP.replace(old, new)).expect("written");
        let refused = smam(&[&file.display().to_string(), "--out", &folder.path().join("out").display().to_string()]);
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(refused.status.code() == Some(2) && said.contains(words), "{new}: {said}");
        assert!(!folder.path().join("out").exists(), "{new}");
    }
}
