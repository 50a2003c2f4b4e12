//! `smam compare`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use serde_json::{Value, json};
use smam::identify::{FitReport, RecordedRun, fit_rig_parameters, load_runs, replay};
use smam::recording::{ChannelFit, Recording, RecordingSet, Role, Run, compare as compare_channels};
use smam::report::{ComparedChannel, ComparedRun, compare_svg};
use smam::scene::{Override, Scene, calibration_key};

use super::CliError;
use super::files::write;

/// Arguments of `smam compare`.
#[derive(Args)]
pub struct CompareArguments {
    /// Folder with a recordings.toml
    dir: PathBuf,
    /// Compare with this scene instead of the one that recordings.toml names
    #[arg(long)]
    scene: Option<String>,
    /// Change a key of the scene, or a calibrated parameter; may be given several times
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Compare this file instead of the declared runs; looked for in DIR, then as a path
    #[arg(long, value_name = "FILE.csv")]
    run: Option<String>,
    /// Where to write compare.svg and compare.json [default: out/compare_DIR]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the command.
pub fn compare(arguments: &CompareArguments) -> Result<ExitCode, CliError> {
    let mut overrides: Vec<Override> = arguments.set.iter().map(|s| Override::parse(s)).collect::<Result<_, _>>()?;
    let set = RecordingSet::load(&arguments.dir)?;
    let scene_name = scene_path(arguments, &set);
    let scene = Scene::load(&scene_name, &overrides)?;
    let declared = load_runs(&set, &set.runs, &mut |n| eprintln!("note: {n}"))?;
    let shown = match &arguments.run {
        Some(file) => load_runs(&set, &[chosen_run(&set, file)], &mut |n| eprintln!("note: {n}"))?,
        None => declared.clone(),
    };
    let report = fit_rig_parameters(&set, &scene_name, &overrides, &declared)?;
    say_fit(&report);
    overrides.extend(report.overrides());
    let simulated: Vec<Recording> =
        shown.iter().map(|run| replay(&scene_name, &overrides, run, 1)).collect::<Result<_, _>>()?;
    let fits: Vec<Vec<ChannelFit>> = shown
        .iter()
        .zip(&simulated)
        .map(|(run, is)| compare_channels(&run.recording, is, &set.channels))
        .collect::<Result<_, _>>()?;
    let out = arguments.out.clone().unwrap_or_else(|| default_out(&arguments.dir));
    write(&out.join("compare.svg"), &compare_svg(&figure(&set, &shown, &simulated, &fits)))?;
    let pooled = pool(&fits);
    let json = to_json(&scene, &shown, &fits, &pooled, &report);
    write(&out.join("compare.json"), &format!("{json:#}\n"))?;
    print_table(&shown, &fits, &pooled);
    eprintln!("picture: {}    figures: {}", out.join("compare.svg").display(), out.join("compare.json").display());
    Ok(ExitCode::SUCCESS)
}

/// A stock name, or a path relative to the recordings.
fn scene_path(arguments: &CompareArguments, set: &RecordingSet) -> String {
    if let Some(scene) = &arguments.scene {
        return scene.clone();
    }
    let beside = set.dir.join(&set.scene);
    if beside.is_file() { beside.display().to_string() } else { set.scene.clone() }
}

/// A declared run of that name, with its known conditions, or any other file.
fn chosen_run(set: &RecordingSet, file: &str) -> Run {
    if let Some(run) = set.runs.iter().find(|r| r.file == file) {
        return run.clone();
    }
    let path = Path::new(file);
    let file = match (set.dir.join(path).is_file(), path.canonicalize()) {
        (false, Ok(absolute)) => absolute.display().to_string(),
        _ => file.to_owned(),
    };
    Run { file, run_use: None, conditions: BTreeMap::new() }
}

fn default_out(dir: &Path) -> PathBuf {
    let name = dir.canonicalize().ok().and_then(|d| d.file_name().map(|n| n.to_string_lossy().into_owned()));
    Path::new("out").join(format!("compare_{}", name.unwrap_or_else(|| "recordings".to_owned())))
}


fn say_fit(report: &FitReport) {
    for p in &report.parameters {
        let bound = if p.on_bound { "   (on a bound of its range)" } else { "" };
        println!("fitted {} = {:.6e}{bound}", calibration_key(&p.key), p.value);
    }
}

fn figure(
    set: &RecordingSet,
    runs: &[RecordedRun],
    simulated: &[Recording],
    fits: &[Vec<ChannelFit>],
) -> Vec<ComparedRun> {
    let compared = runs.iter().zip(simulated).zip(fits).map(|((run, is), fits)| ComparedRun {
        name: Path::new(&run.run.file)
            .file_name()
            .map_or_else(|| run.run.file.clone(), |n| n.to_string_lossy().into_owned()),
        time_s: run.recording.time_s().to_vec(),
        channels: set
            .of_role(Role::Output)
            .zip(fits)
            .filter_map(|(spec, fit)| {
                Some(ComparedChannel {
                    column: spec.column.clone(),
                    measured: run.recording.find(&spec.column)?.values.clone(),
                    simulated: is.find(&spec.column)?.values.clone(),
                    noise_sd: fit.noise_sd,
                    rmse: fit.rmse,
                })
            })
            .collect(),
    });
    compared.collect()
}

/// Each channel over all runs: squares weighted by samples.
fn pool(fits: &[Vec<ChannelFit>]) -> Vec<ChannelFit> {
    let mut pooled: Vec<ChannelFit> = Vec::new();
    for fit in fits.iter().flatten() {
        match pooled.iter_mut().find(|p| p.column == fit.column) {
            Some(p) => {
                let (n, m) = (p.count as f64, fit.count as f64);
                let mean = |a: f64, b: f64| ((n * a * a + m * b * b) / (n + m)).sqrt();
                p.rmse = mean(p.rmse, fit.rmse);
                p.noise_sd = p.noise_sd.zip(fit.noise_sd).map(|(a, b)| mean(a, b));
                p.range = p.range.max(fit.range);
                p.count += fit.count;
            }
            None => pooled.push(fit.clone()),
        }
    }
    pooled
}

fn channel_json(fit: &ChannelFit) -> Value {
    json!({ "rmse": fit.rmse, "noise_sd": fit.noise_sd, "range": fit.range, "samples": fit.count })
}

fn by_channel(fits: &[ChannelFit]) -> Value {
    fits.iter().map(|f| (f.column.clone(), channel_json(f))).collect::<serde_json::Map<_, _>>().into()
}

fn to_json(
    scene: &Scene,
    runs: &[RecordedRun],
    fits: &[Vec<ChannelFit>],
    pooled: &[ChannelFit],
    report: &FitReport,
) -> Value {
    let per_run: serde_json::Map<_, _> =
        runs.iter().zip(fits).map(|(r, f)| (r.run.file.clone(), by_channel(f))).collect();
    let fitted: serde_json::Map<_, _> = report.parameters.iter().map(|p| (p.key.clone(), json!(p.value))).collect();
    json!({ "format": 1, "scene": scene.file.name, "channels": by_channel(pooled), "runs": per_run, "fitted": fitted })
}

fn print_table(runs: &[RecordedRun], fits: &[Vec<ChannelFit>], pooled: &[ChannelFit]) {
    let row = |name: &str, f: &ChannelFit| {
        let noise = f.noise_sd.map_or_else(|| format!("{:>12}", "?"), |n| format!("{n:>12.4}"));
        let ratio = f.rmse_over_noise().map_or_else(|| format!("{:>10}", "?"), |r| format!("{r:>10.2}"));
        println!("{name:<28} {:<18} {:>12.4} {noise} {ratio} {:>12.4}", f.column, f.rmse, f.range);
    };
    println!("{:<28} {:<18} {:>12} {:>12} {:>10} {:>12}", "run", "channel", "rmse", "noise sd", "rmse/noise", "range");
    for (run, fits) in runs.iter().zip(fits) {
        let name = Path::new(&run.run.file)
            .file_name()
            .map_or_else(|| run.run.file.clone(), |n| n.to_string_lossy().into_owned());
        fits.iter().for_each(|f| row(&name, f));
    }
    if runs.len() > 1 {
        pooled.iter().for_each(|f| row("all", f));
    }
}
