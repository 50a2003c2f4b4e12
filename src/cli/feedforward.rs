//! `smam feedforward`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::Args;
use serde::Deserialize;
use smam::feedforward::{Limits, programme};
use smam::hysteresis::HysteresisModel;
use smam::recording::{Channel, LoadedRun, Recording, RecordingError};

use super::CliError;
use super::files::{Files, read_input, refuse_dash};

/// Arguments of `smam feedforward`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam identify rig/loop --model maxwell-slip
  smam feedforward out/identify_loop/maxwell-slip.toml wanted.csv --out programme.csv")]
pub struct FeedforwardArguments {
    /// Identified model, as `smam identify` writes it
    model: PathBuf,
    /// Recording with the wanted output over time (CSV or Parquet)
    wanted: PathBuf,
    /// Column of the wanted output, a length
    #[arg(long, value_name = "COLUMN", default_value = "elongation_mm")]
    column: String,
    /// Column of the programme, in mm
    #[arg(long, value_name = "COLUMN", default_value = "plunger_mm")]
    input: String,
    /// Least plunger position, mm; the muscle rests at 0
    #[arg(long, value_name = "MM", default_value_t = 0.0, allow_negative_numbers = true)]
    least: f64,
    /// Greatest plunger position, mm
    #[arg(long, value_name = "MM", default_value_t = 3.0, allow_negative_numbers = true)]
    most: f64,
    /// Greatest speed of the plunger, mm/s
    #[arg(long, value_name = "MM/S", default_value_t = 20.0)]
    speed: f64,
    /// Slopes of the model below this share of its mean slope are taken to be this large
    #[arg(long, value_name = "SHARE", default_value_t = 0.15)]
    least_slope: f64,
    /// The programme
    #[arg(long, value_name = "CSV", default_value = "out/programme.csv")]
    out: PathBuf,
}

/// The part of a model file that counts.
#[derive(Deserialize)]
struct ModelFile {
    muscles: Muscles,
}

#[derive(Deserialize)]
struct Muscles {
    displacement: HysteresisModel<f64>,
}

/// Writes the plunger's programme for a wanted output, with what the model makes of it beside.
pub fn feedforward(a: &FeedforwardArguments) -> Result<ExitCode, CliError> {
    let model = read_model(&a.model)?;
    let limits = limits(a)?;
    let LoadedRun { recording, notes } = read_input(&a.wanted)?;
    notes.iter().for_each(|n| eprintln!("note: {}: {n}", a.wanted.display()));
    refuse_dash("--out", &a.out, "name a file")?;
    let mut read = Files::default();
    read.extend([a.model.clone(), a.wanted.clone()]);
    read.refuse_over("--out", &a.out)?;
    let in_file = |e: RecordingError| e.in_file(a.wanted.display().to_string());
    let unit = recording.channel(&a.column).and_then(Channel::unit).map_err(in_file)?;
    if unit.si_suffix != "m" {
        return Err(CliError::Usage(format!(
            "{}: column \"{}\" is no length\n  remedy: name a column that ends in a unit of length with --column",
            a.wanted.display(),
            a.column
        )));
    }
    let wanted_mm: Vec<f64> = recording.si(&a.column)?.iter().map(|y| y * 1e3).collect();
    let missing = wanted_mm.iter().filter(|y| !y.is_finite()).count();
    if missing > 0 {
        return Err(CliError::Usage(format!(
            "{}: column \"{}\": {missing} of {} samples are missing\n  remedy: fill them in; a programme must know what is \
             wanted at every time",
            a.wanted.display(),
            a.column,
            wanted_mm.len()
        )));
    }
    let found = programme(&model, limits, 0.0f64.clamp(a.least, a.most), recording.time_s(), &wanted_mm);
    let expected = model.follow(recording.time_s(), &found.input_mm);
    let worst = expected.iter().zip(&wanted_mm).map(|(y, w)| (y - w).abs()).fold(0.0, f64::max);
    let columns = vec![Channel::new(a.input.clone(), found.input_mm), Channel::new("expected_mm", expected)];
    Recording::new(recording.time_s().to_vec(), columns)?.write_csv(&a.out)?;
    say!("{}: at most {worst:.3} mm from what is wanted, by the model", a.out.display());
    if found.clipped_s > 0.0 {
        say!("  note: held back for {:.2} s by a limit, or where the model turns", found.clipped_s);
    }
    Ok(ExitCode::SUCCESS)
}

fn read_model(path: &Path) -> Result<HysteresisModel<f64>, CliError> {
    let refuse = |message: String| {
        CliError::Usage(format!(
            "{}: {message}\n  remedy: give a model file that `smam identify` wrote, with a table [muscles.displacement]",
            path.display()
        ))
    };
    let text = smam::stock::read_text(path).map_err(|e| refuse(format!("cannot be read: {e}")))?;
    let file: ModelFile = toml::from_str(&text).map_err(|e| refuse(e.to_string().trim_end().to_owned()))?;
    let model = file.muscles.displacement;
    model.check().map_err(|e| {
        let remedy = "choose numbers with which the state stays bounded";
        CliError::Usage(format!("{}: [muscles.displacement]: {e}\n  remedy: {remedy}", path.display()))
    })?;
    Ok(model)
}

fn limits(a: &FeedforwardArguments) -> Result<Limits, CliError> {
    let refuse = |message: String| Err(CliError::Usage(message));
    if !(a.least.is_finite() && a.most.is_finite() && a.least < a.most) {
        return refuse(format!(
            "--least {} must lie below --most {}\n  remedy: give the plunger's range in mm",
            a.least, a.most
        ));
    }
    if !a.input.ends_with("_mm") {
        return refuse(format!(
            "--input {}: the programme is in mm\n  remedy: give a name that ends in _mm, such as plunger_mm",
            a.input
        ));
    }
    if !(a.speed > 0.0 && a.speed.is_finite()) {
        return refuse(format!("--speed {} must be above 0\n  remedy: give the greatest speed in mm/s", a.speed));
    }
    if !(a.least_slope > 0.0 && a.least_slope <= 1.0) {
        return refuse(format!(
            "--least-slope {} must lie between 0 and 1\n  remedy: leave it out for 0.15",
            a.least_slope
        ));
    }
    Ok(Limits { input_mm: [a.least, a.most], speed_mm_s: a.speed, least_slope: a.least_slope })
}
