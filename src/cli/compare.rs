//! `smam compare`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use rayon::prelude::*;
use serde_json::{Value, json};
use smam::identify::{FitReport, RecordedRun, check_channels, fit_rig_parameters, lead_in, load_runs, replay};
use smam::recording::{
    Begun, BySize, ChannelFit, Recording, RecordingSet, Role, Run, RunUse, compare as compare_channels, motion_ratio,
    other_zero, unit_by_size,
};
use smam::report::{ComparedChannel, ComparedRun, HtmlPage, VERMILION, choices, quantity};
use smam::scene::{Override, Scene, calibration_key};

use super::CliError;
use super::changes::Changes;
use super::files::{Files, Together, make_folder, recorded_files, scene_files};
use super::import::recordings;
use super::results::{Results, name_of};

/// Arguments of `smam compare`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam compare rig/monday                        every run beside its simulation
  smam compare rig/monday --scene my_scene.toml  against another scene than the recordings name")]
pub struct CompareArguments {
    /// Folder with a recordings.toml; or a file, which is described as `smam import` does
    dir: PathBuf,
    /// Compare with this scene instead of the one that recordings.toml names
    #[arg(long)]
    scene: Option<String>,
    #[command(flatten)]
    changes: Changes,
    /// Compare this file instead of the declared runs; looked for in DIR, then as a path
    #[arg(long, value_name = "FILE.csv")]
    run: Option<String>,
    /// Where to write compare.html and compare.json [default: out/compare_DIR]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Runs the command.
pub fn compare(arguments: &CompareArguments) -> Result<ExitCode, CliError> {
    let mut overrides = arguments.changes.overrides()?;
    let set = recordings(&arguments.dir, arguments.scene.as_deref())?;
    let scene_name = arguments.scene.clone().unwrap_or_else(|| set.scene_path());
    let scene = Scene::load(&scene_name, &overrides)?;
    let declared = load_runs(&set, &set.runs, &mut |n| eprintln!("note: {n}"))?;
    let shown = match &arguments.run {
        Some(file) => load_runs(&set, &[chosen_run(&set, file)], &mut |n| eprintln!("note: {n}"))?,
        None => declared.clone(),
    };
    let may_fit: Vec<RecordedRun> = declared.into_iter().filter(|r| r.run.run_use != Some(RunUse::Holdout)).collect();
    let results = Results::of(&arguments.dir, "compare", arguments.out.as_deref())?;
    let out = &results.folder;
    check_channels(&set, &scene)?;
    let mut begin_at_zero = Vec::new();
    for run in &shown {
        let way = lead_in(&scene, run).map_err(|e| e.in_file(&run.run.file))?;
        begin_at_zero.push(way.is_none());
        way.iter().for_each(|way| eprintln!("note: {}: {}", run.run.file, way.note()));
    }
    let mut read = Files::default();
    read.extend(recorded_files(&set).into_iter().chain(scene_files(&scene)));
    read.extend(shown.iter().map(|run| set.dir.join(&run.run.file)));
    read.refuse_in(out, |name| ["compare.html", "compare.json"].contains(&name))?;
    make_folder(out)?;
    results.note_input()?;
    let report = fit_rig_parameters(&set, &scene_name, &overrides, &may_fit)?;
    say_fit(&report);
    overrides.extend(report.overrides());
    let simulated = replay_all(&scene_name, &overrides, &shown)?;
    let fits: Vec<Vec<ChannelFit>> = shown
        .iter()
        .zip(&simulated)
        .map(|(run, is)| compare_channels(&run.recording, is, &set.channels_of(&run.run)))
        .collect::<Result<_, _>>()?;
    shown.iter().zip(&simulated).for_each(|(run, is)| warn_of_units(run, is, &set));
    let at_zero = shown.iter().zip(&simulated).zip(begin_at_zero).filter_map(|(pair, own)| own.then_some(pair));
    warn_of_zeros(&scene, &at_zero.collect::<Vec<_>>());
    let heading = format!("{}: measured, and simulated by {}", name_of(&arguments.dir), scene.file.name);
    let mut files = Together::default();
    files.page(out, "compare.html", &page(&heading, &report, &figure(&shown, &simulated, &fits), &shown, &fits))?;
    let pooled = pool(fits.iter());
    let json = to_json(&scene, &shown, &fits, &pooled, &report);
    files.text(&out.join("compare.json"), &format!("{json:#}\n"))?;
    files.place()?;
    print_table(&shown, &fits);
    eprintln!("page: {}    figures: {}", out.join("compare.html").display(), out.join("compare.json").display());
    Ok(ExitCode::SUCCESS)
}

/// Every run simulated, side by side on the cores there are; the results stand in the order of the runs.
fn replay_all(scene: &str, overrides: &[Override], runs: &[RecordedRun]) -> Result<Vec<Recording>, CliError> {
    let replayed: Result<_, _> = runs.par_iter().map(|run| replay(scene, overrides, run, 1)).collect();
    Ok(replayed?)
}

/// Says where a channel moves as numbers in another unit would.
fn warn_of_units(run: &RecordedRun, simulated: &Recording, set: &RecordingSet) {
    for spec in set.channels_of(&run.run).iter().filter(|spec| spec.role == Role::Output) {
        let (Some(was), Some(is)) = (run.recording.find(&spec.column), simulated.find(&spec.column)) else { continue };
        let ratio = motion_ratio(run.recording.time_s(), &was.values, &is.values);
        if let Some(BySize::Wrong(words) | BySize::Odd(words)) = ratio.and_then(|r| unit_by_size(&spec.column, r)) {
            eprintln!("warning: {}: {words}", run.run.file);
        }
    }
}

/// Says which channels count from another zero than the scene; by runs that begin with their inputs at zero.
fn warn_of_zeros(scene: &Scene, runs: &[(&RecordedRun, &Recording)]) {
    for output in &scene.file.output {
        let begun = runs.iter().filter_map(|(run, is)| {
            let (was, is) = (run.recording.find(&output.channel)?, is.find(&output.channel)?);
            let (times_s, simulated) = (run.recording.time_s(), is.values.clone());
            // Of what does not follow the scene, or in another unit, a zero says nothing.
            let ratio = motion_ratio(times_s, &was.values, &simulated)?;
            let is_wrong = matches!(unit_by_size(&output.channel, ratio), Some(BySize::Wrong(_)));
            (!is_wrong).then_some(Begun { times_s, measured: &was.values, simulated })
        });
        let words = other_zero(&output.channel, output.quantity.is_place(), &begun.collect::<Vec<_>>());
        words.iter().for_each(|words| eprintln!("warning: {words}"));
    }
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
    Run { file, ..Run::default() }
}

/// Curves of each run and channel, errors, and what was fitted.
fn page(
    heading: &str,
    report: &FitReport,
    figures: &[ComparedRun],
    runs: &[RecordedRun],
    fits: &[Vec<ChannelFit>],
) -> HtmlPage {
    let mut page = HtmlPage::new(heading);
    if report.parameters.is_empty() {
        page.paragraph("Nothing was fitted.");
    } else {
        page.paragraph("Fitted to the runs that are not held out:");
        page.table(&["parameter", "value", "95 % interval"], &fitted_rows(report));
    }
    page.chooser(&choices(figures), 0);
    page.heading("Errors");
    let rows: Vec<Vec<String>> =
        runs.iter().zip(fits).flat_map(|(run, fits)| fits.iter().map(|fit| error_row(&title(&run.run), fit))).collect();
    page.table(&["run", "channel", "RMSE", "noise sd", "RMSE / noise", "range", "samples"], &rows);
    page
}

fn fitted_rows(report: &FitReport) -> Vec<Vec<String>> {
    let row = |p: &smam::identify::FittedParameter| {
        let shown = |value: f64| quantity(&p.key, None, value);
        let interval = match p.ci95 {
            Some([low, high]) => format!("{} to {}", shown(low), shown(high)),
            None => "the runs do not show it".to_owned(),
        };
        vec![calibration_key(&p.key).into_owned(), shown(p.value), interval]
    };
    report.parameters.iter().map(row).collect()
}

fn error_row(run: &str, fit: &ChannelFit) -> Vec<String> {
    let or_dash = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| quantity("", None, v));
    let number = |value: f64| quantity("", None, value);
    vec![
        run.to_owned(),
        fit.column.clone(),
        number(fit.rmse),
        or_dash(fit.noise_sd),
        or_dash(fit.rmse_over_noise()),
        number(fit.range),
        fit.count.to_string(),
    ]
}

fn say_fit(report: &FitReport) {
    for p in &report.parameters {
        let bound = if p.on_bound { "   (on a bound of its range)" } else { "" };
        let interval = match p.ci95 {
            Some([low, high]) => format!("   95 %: {low:.4e} to {high:.4e}"),
            None => "   the runs do not show it".to_owned(),
        };
        say!("fitted {} = {:.6e}{interval}{bound}", calibration_key(&p.key), p.value);
    }
    if report.from_elsewhere {
        eprintln!(
            "note: from the scene's own values the fit stopped in a higher valley; this one began elsewhere in the ranges"
        );
    }
}

fn figure(runs: &[RecordedRun], simulated: &[Recording], fits: &[Vec<ChannelFit>]) -> Vec<ComparedRun> {
    let compared = runs.iter().zip(simulated).zip(fits).map(|((run, is), fits)| ComparedRun {
        name: title(&run.run),
        time_s: run.recording.time_s().to_vec(),
        channels: fits
            .iter()
            .filter_map(|fit| {
                Some(ComparedChannel {
                    column: fit.column.clone(),
                    measured: run.recording.find(&fit.column)?.values.clone(),
                    simulated: vec![("simulated", VERMILION, is.find(&fit.column)?.values.clone())],
                    noise_sd: fit.noise_sd,
                })
            })
            .collect(),
    });
    compared.collect()
}

/// Name of a run's file, and its use where recordings.toml states one.
fn title(run: &Run) -> String {
    let name = Path::new(&run.file).file_name().map_or(run.file.clone(), |n| n.to_string_lossy().into_owned());
    match run.run_use {
        Some(RunUse::Fit) => format!("{name} (fit)"),
        Some(RunUse::Holdout) => format!("{name} (holdout)"),
        None => name,
    }
}

/// Each channel over several runs: squares weighted by samples.
fn pool<'a>(fits: impl Iterator<Item = &'a Vec<ChannelFit>>) -> Vec<ChannelFit> {
    let mut pooled: Vec<ChannelFit> = Vec::new();
    // A run in which a channel's cells are all empty says nothing of it.
    for fit in fits.flatten().filter(|f| f.count > 0) {
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
    let intervals: serde_json::Map<_, _> = report.parameters.iter().map(|p| (p.key.clone(), json!(p.ci95))).collect();
    let holdout: Vec<&str> = runs.iter().filter(|r| is_holdout(r)).map(|r| r.run.file.as_str()).collect();
    json!({
        "format": 1,
        "scene": scene.file.name,
        "channels": by_channel(pooled),
        "runs": per_run,
        "holdout": holdout,
        "fitted": fitted,
        "fitted_ci95": intervals,
    })
}

fn is_holdout(run: &RecordedRun) -> bool {
    run.run.run_use == Some(RunUse::Holdout)
}

fn print_table(runs: &[RecordedRun], fits: &[Vec<ChannelFit>]) {
    let names: Vec<String> = runs.iter().map(|r| title(&r.run)).collect();
    let width = names.iter().map(|n| n.chars().count()).max().unwrap_or(0).max(12);
    let row = |name: &str, f: &ChannelFit| {
        let noise = f.noise_sd.map_or_else(|| format!("{:>12}", "?"), |n| format!("{n:>12.4}"));
        let ratio = f.rmse_over_noise().map_or_else(|| format!("{:>10}", "?"), |r| format!("{r:>10.2}"));
        say!("{name:<width$} {:<18} {:>12.4} {noise} {ratio} {:>12.4}", f.column, f.rmse, f.range);
    };
    say!("{:<width$} {:<18} {:>12} {:>12} {:>10} {:>12}", "run", "channel", "rmse", "noise sd", "rmse/noise", "range");
    for (name, fits) in names.iter().zip(fits) {
        fits.iter().for_each(|f| row(name, f));
    }
    let of = |holdout: bool| pool(runs.iter().zip(fits).filter(|(r, _)| is_holdout(r) == holdout).map(|(_, f)| f));
    let (fitted, held_out) = (of(false), of(true));
    // What was fitted to a run says little about it: the two kinds are never pooled in one figure here.
    if !fitted.is_empty() && !held_out.is_empty() {
        fitted.iter().for_each(|f| row("all others", f));
        held_out.iter().for_each(|f| row("all holdout", f));
    } else if runs.len() > 1 {
        fitted.iter().chain(&held_out).for_each(|f| row("all", f));
    }
}
