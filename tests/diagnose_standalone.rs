//! Contract of the diagnosis on elements that stand alone: recordings made here in closed form, nothing of the simulation in them.

use std::fs;
use std::path::Path;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use smam::diagnose::{Case, Diagnosis, Options, diagnose};
use tempfile::TempDir;

/// A folder of recordings of a scene; each run has rows of time, inputs and outputs.
fn folder(scene: &str, columns: &[(&str, &str)], runs: &[Vec<Vec<f64>>]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut set = format!("format = 1\nscene = \"{scene}\"\n");
    for (column, role) in columns {
        set += &format!("[[channel]]\ncolumn = \"{column}\"\nrole = \"{role}\"\n");
    }
    let head: Vec<&str> = std::iter::once("time_s").chain(columns.iter().map(|(column, _)| *column)).collect();
    for (i, rows) in runs.iter().enumerate() {
        let lines = rows.iter().map(|row| row.iter().map(f64::to_string).collect::<Vec<_>>().join(","));
        let text: Vec<String> = std::iter::once(head.join(",")).chain(lines).collect();
        fs::write(folder.path().join(format!("run_{i}.csv")), text.join("\n")).expect("written");
        set += &format!("[[run]]\nfile = \"run_{i}.csv\"\n");
    }
    fs::write(folder.path().join("recordings.toml"), set).expect("written");
    folder
}

fn answer(folder: &Path) -> Diagnosis {
    let case = Case::load(&[folder], None, &[]).unwrap_or_else(|e| panic!("{e}"));
    let outcome = diagnose(case, Options { seed: 1 }, &|line| println!("  {line}")).unwrap_or_else(|e| panic!("{e}"));
    println!("{}", outcome.diagnosis.summary);
    outcome.diagnosis
}

/// A minute of the excess `p0 exp(-k t)` of each chamber, with noise of 0.3 kPa.
fn chambers(rates_1_s: &[f64]) -> TempDir {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut row = |k: f64, t: f64| {
        let noise: f64 = StandardNormal.sample(&mut random);
        vec![t, 650.0 * (-k * t).exp() + 0.3 * noise]
    };
    let runs = rates_1_s.iter().map(|&k| (0..600).map(|i| row(k, 0.1 * f64::from(i))).collect());
    folder("closed_chamber", &[("pressure_kpa", "output")], &runs.collect::<Vec<_>>())
}

#[test]
fn every_chamber_of_a_folder_has_a_leak_of_its_own() {
    let rates_1_s = [0.0, 0.004, 0.02];
    let d = answer(chambers(&rates_1_s).path());
    let found: Vec<&str> = d.effects.iter().filter(|e| e.name == "leak").map(|e| e.element.as_str()).collect();
    assert_eq!(found.len(), 2, "{:?}", d.effects);
    for (element, rate_1_s) in [("line_2", 0.004), ("line_3", 0.02)] {
        let leak = d.effects.iter().find(|e| e.element == element).unwrap_or_else(|| panic!("{element}: {found:?}"));
        let value = leak.parameters["rate_1_s"].value;
        assert!((value / rate_1_s - 1.0).abs() < 0.02, "{element}: {value}");
    }
    assert!(d.fit.channels["pressure_kpa"].rmse_corrected < 0.5, "{:?}", d.fit.channels);
}

/// Of one chamber recorded twice the leak is said once.
#[test]
fn a_leak_that_all_runs_share_is_one() {
    let d = answer(chambers(&[0.01, 0.01]).path());
    let [leak] = &d.effects[..] else { panic!("{}: {:?}", d.summary, d.effects) };
    assert_eq!((leak.name.as_str(), leak.element.as_str()), ("leak", "line"));
    assert!((leak.parameters["rate_1_s"].value / 0.01 - 1.0).abs() < 0.02, "{leak:?}");
}

/// A strip of the stock length and section whose rubber follows Yeoh's law, pulled and let go at two speeds.
#[test]
fn a_strip_that_stiffens_lacks_another_rubber_law() {
    let [c1_pa, c2_pa, length_m, section_m2] = [5e4, 4e3, 0.05, 2e-5];
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let mut row = |t: f64, period_s: f64| {
        let share = 1.0 - (2.0 * (t / period_s).fract() - 1.0).abs();
        let l: f64 = 1.0 + 2.0 * share;
        let j = l * l + 2.0 / l - 3.0;
        let noise: f64 = StandardNormal.sample(&mut random);
        let force_n = section_m2 * 2.0 * (l - l.powi(-2)) * (c1_pa + 2.0 * c2_pa * j);
        vec![t, 1e3 * length_m * (l - 1.0), force_n + 0.01 * noise]
    };
    let runs = [10.0, 20.0, 40.0].map(|period| (0..400).map(|i| row(0.1 * f64::from(i), period)).collect());
    let d = answer(folder("tensile_test", &[("position_mm", "input"), ("force_n", "output")], &runs).path());
    let [law] = &d.effects[..] else { panic!("{}: {:?}", d.summary, d.effects) };
    assert_eq!((law.name.as_str(), law.element.as_str()), ("rubber_law", "muscle"));
    assert!(d.fit.channels["force_n"].rmse_corrected < 0.012, "{:?}", d.fit.channels);
}
