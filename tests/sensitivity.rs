//! Contract of sensitivities: indices of functions whose indices are known, and the same bytes whoever computed the points.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;
use std::process::Command;

use smam::sweep::{Design, Estimate, SamplingSpec, Trajectories, VarySpec, sobol_indices};

fn range(from: f64, to: f64) -> VarySpec {
    VarySpec { key: "x".to_owned(), from: Some(from), to: Some(to), ..VarySpec::default() }
}

/// Values of a function at all points of a design.
fn values(design: &Design, of: impl Fn(&[f64]) -> f64) -> Vec<f64> {
    (0..design.count()).map(|i| of(&design.point(i))).collect()
}

/// Ishigami and Homma 1990: nonlinear, and its third key acts only with the first.
fn ishigami(x: &[f64]) -> f64 {
    x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
}

#[track_caller]
fn close(found: &[Estimate], expected: &[f64], within: f64) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found.value - expected).abs() < within, "{found:?} is not {expected}");
        assert!(found.low <= found.value && found.value <= found.high, "{found:?}");
        // Wider than 95 %: of nine intervals one in twenty would miss otherwise.
        let room = 0.5 * (found.high - found.low) + 1e-9;
        assert!((found.low - room..=found.high + room).contains(expected), "{found:?} leaves out {expected}");
    }
}

#[test]
fn sobol_indices_of_the_ishigami_function() {
    let sampling = SamplingSpec::Saltelli { count: 2048, seed: 1 };
    let design = Design::new(sampling, &vec![range(-PI, PI); 3]).expect("a design");
    assert_eq!(design.count(), 2048 * 5);
    let found = sobol_indices(3, &values(&design, ishigami), 1);
    // Closed forms with a = 7, b = 0.1.
    let (a2, b1, b2) = (49.0 / 8.0, 0.1 * PI.powi(4) / 5.0, 0.01 * PI.powi(8));
    let variance = a2 + b1 + b2 / 18.0 + 0.5;
    let (one, third) = (b1 + b2 / 50.0 + 0.5, 8.0 * b2 / 225.0);
    close(&found.first, &[one / variance, a2 / variance, 0.0], 0.02);
    close(&found.total, &[(one + third) / variance, a2 / variance, third / variance], 0.02);
}

#[test]
fn sobol_indices_of_the_g_function() {
    let a = [0.0, 1.0, 4.5, 9.0, 99.0];
    let sampling = SamplingSpec::Saltelli { count: 2048, seed: 3 };
    let design = Design::new(sampling, &vec![range(0.0, 1.0); a.len()]).expect("a design");
    let g = |x: &[f64]| x.iter().zip(a).map(|(x, a)| ((4.0 * x - 2.0).abs() + a) / (1.0 + a)).product();
    let found = sobol_indices(a.len(), &values(&design, g), 3);
    let parts: Vec<f64> = a.iter().map(|a| 1.0 / (3.0 * (1.0 + a).powi(2))).collect();
    let all: f64 = parts.iter().map(|v| 1.0 + v).product();
    let first: Vec<f64> = parts.iter().map(|v| v / (all - 1.0)).collect();
    let total: Vec<f64> = parts.iter().map(|v| v * all / (1.0 + v) / (all - 1.0)).collect();
    close(&found.first, &first, 0.02);
    close(&found.total, &total, 0.02);
}

#[test]
fn morris_effects_of_the_ishigami_function() {
    let sampling = SamplingSpec::Morris { trajectories: 500, levels: 4, seed: 1 };
    let design = Design::new(sampling, &vec![range(-PI, PI); 3]).expect("a design");
    let found = Trajectories::new(3, 4, 1).expect("four levels").effects(&values(&design, ishigami));
    // A step of two thirds of the range leads from -pi to pi/3 or from -pi/3 to pi, so that sines are 0 or sqrt(3)/2.
    let sine = 3f64.sqrt() / 2.0;
    let (near, far) = (0.1 * (PI / 3.0).powi(4), 0.1 * PI.powi(4));
    let expected = [1.5 * sine * (1.0 + 0.5 * (near + far)), 1.5 * 7.0 * 0.75, 1.5 * 0.5 * sine * (far - near)];
    close(&found.mu_star, &expected, 0.5);
    assert!((found.mu_star[1].value - 7.875).abs() < 1e-9, "{found:?}");
    assert!(found.sigma.iter().all(|s| s.value > 5.0), "nonlinear or not alone, all of them: {found:?}");
}

const SWEEP: &str = r#"
format = 1
name = "bench"
scene = "muscle_bench"
duration_s = 1.0
[sampling]
METHOD
[[vary]]
key = "muscles.friction.m0_n"
from = 0.05
to = 0.2
[[vary]]
key = "tube_c1_pa"
from = 0.2e6
to = 0.3e6
[[measure]]
name = "elongation_max_mm"
of = "max(elongation_mm)"
"#;

fn smam(arguments: &[&str]) {
    let done = Command::new(env!("CARGO_BIN_EXE_smam")).arg("sweep").args(arguments).output().expect("starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// Everything a sweep writes but its journal.
fn written(folder: &Path) -> Vec<Vec<u8>> {
    let files = ["table.csv", "table.parquet", "sensitivity.csv", "sensitivity.json", "sweep.html"];
    files.iter().map(|f| fs::read(folder.join(f)).unwrap_or_else(|e| panic!("{f}: {e}"))).collect()
}

#[test]
fn shards_and_resumed_sweeps_have_the_same_sensitivities() {
    for method in ["method = 'saltelli'\ncount = 8\nseed = 2", "method = 'morris'\ntrajectories = 6\nseed = 2"] {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name).display().to_string();
        let file = at("sweep.toml");
        fs::write(&file, SWEEP.replace("METHOD", method)).expect("written");
        smam(&[&file, "--out", &at("whole"), "--threads", "1"]);
        let expected = written(&folder.path().join("whole"));
        let table = String::from_utf8_lossy(&expected[2]).into_owned();
        assert_eq!(table.lines().count(), 3, "{table}");
        for shard in ["1/3", "2/3", "3/3"] {
            smam(&[&file, "--shard", shard, "--out", &at(&shard[..1])]);
        }
        smam(&["merge", &file, &at("1"), &at("2"), &at("3"), "--out", &at("merged")]);
        assert!(written(&folder.path().join("merged")) == expected, "merged: {method}");
        let journal = folder.path().join("whole/journal.jsonl");
        let lines = fs::read_to_string(&journal).expect("a journal");
        fs::write(&journal, &lines[..lines.len() / 2]).expect("cut");
        smam(&[&file, "--out", &at("whole"), "--resume"]);
        assert!(written(&folder.path().join("whole")) == expected, "resumed: {method}");
    }
}
