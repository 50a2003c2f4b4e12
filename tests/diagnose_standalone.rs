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

/// An axis with the stock area, at three pressures: speed and way of a slow multisine, noise of 0.2 N.
fn axes(hidden_n: impl Fn(f64, f64) -> f64) -> TempDir {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    let mut row = |t: f64, pressure_pa: f64, phase: f64| {
        let position_m = 0.03 * (0.7 * t + phase).sin() + 0.01 * (1.9 * t).sin();
        let noise: f64 = StandardNormal.sample(&mut random);
        let force_n = 5e-4 * pressure_pa + hidden_n(position_m, pressure_pa) + 0.2 * noise;
        vec![t, 1e3 * position_m, 1e-3 * pressure_pa, force_n]
    };
    let runs = [(5e4, 0.0), (1e5, 1.0), (2e5, 2.0)]
        .map(|(pressure_pa, phase)| (0..800).map(|i| row(0.025 * f64::from(i), pressure_pa, phase)).collect());
    let columns = [("position_mm", "input"), ("pressure_kpa", "input"), ("force_n", "output")];
    folder("driven_axis", &columns, &runs)
}

/// The port, what the law depends on, and the share of the misfit on the held-out run that it takes away.
fn said(d: &Diagnosis) -> (&str, &[String], f64) {
    let [law] = &d.effects[..] else { panic!("{}: {:?}", d.summary, d.effects) };
    let port = law.port.as_str();
    let [channel] = &d.fit.channels.values().collect::<Vec<_>>()[..] else { panic!("one output") };
    let above_noise = |rmse: f64| rmse.powi(2) - channel.noise_sd.powi(2);
    (port, &law.variables, 1.0 - above_noise(channel.rmse_corrected) / above_noise(channel.rmse_baseline))
}

/// A spring at the end of the way, which the catalogue does not have.
#[test]
fn a_law_of_an_axis_that_nobody_listed_is_found() {
    let d = answer(axes(|x, _| 4e3 * (x - 0.02).max(0.0)).path());
    let (port, variables, closed) = said(&d);
    assert_eq!((port, variables), ("axis.force", &["position_m".to_owned()][..]), "{}", d.summary);
    assert!(closed > 0.9, "{closed}: {:?}", d.fit.channels);
}

/// A strip whose rubber grows softer while it is tested.
#[test]
fn a_law_of_a_strip_that_nobody_listed_is_found() {
    let [c1_pa, length_m, section_m2] = [5e4, 0.05, 2e-5];
    let mut random = ChaCha8Rng::seed_from_u64(13);
    let mut row = |t: f64, period_s: f64| {
        let share = 1.0 - (2.0 * (t / period_s).fract() - 1.0).abs();
        let l: f64 = 1.0 + 1.5 * share;
        let noise: f64 = StandardNormal.sample(&mut random);
        let force_n = section_m2 * 2.0 * c1_pa * (l - l.powi(-2)) * (1.0 - 0.06 * (1.0 + t / 8.0).ln());
        vec![t, 1e3 * length_m * (l - 1.0), force_n + 0.01 * noise]
    };
    let runs = [7.0, 11.0, 40.0].map(|period| (0..600).map(|i| row(0.1 * f64::from(i), period)).collect());
    let d = answer(folder("tensile_test", &[("position_mm", "input"), ("force_n", "output")], &runs).path());
    let (port, variables, closed) = said(&d);
    assert_eq!((port, variables), ("strip.force", &["time_s".to_owned()][..]), "{}", d.summary);
    assert!(closed > 0.9, "{closed}: {:?}", d.fit.channels);
}
