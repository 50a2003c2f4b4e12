//! `smam conceal`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, ValueEnum};
use smam::conceal::{Hiding, Rig, Truth, draw, is_another_there, write_case};

use super::score::{read_seals, write_seals};
use crate::cli::CliError;
use crate::cli::files::make_folder;

/// Arguments of `smam conceal`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam conceal --seed 7 --hiding one --out out/blind     a bench with one thing hidden; the answer under seal
  smam diagnose out/blind/case_7                         then look for it
  smam score out/blind --answers out/answers             and open the seal")]
pub struct ConcealArguments {
    /// Of everything that is drawn; the same seed hides the same
    #[arg(long)]
    seed: u64,
    /// Cases to draw, with seeds counting up from that one
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..=100_000))]
    count: u64,
    /// The rig
    #[arg(long, value_enum, default_value_t = RigName::MuscleBench)]
    rig: RigName,
    /// What kind of thing to hide [default: drawn]
    #[arg(long, value_enum)]
    hiding: Option<HidingName>,
    /// Where to write NAME/, NAME.holdout.csv, sealed/NAME.json and seals.txt
    #[arg(long, value_name = "DIR", default_value = "out/concealed")]
    out: PathBuf,
}

/// Rigs by the names of their scenes.
#[derive(Clone, Copy, ValueEnum)]
#[value(rename_all = "snake_case")]
enum RigName {
    MuscleBench,
    AntagonisticPulley,
    BendingCatheter,
}

/// What may be hidden.
#[derive(Clone, Copy, ValueEnum)]
#[value(rename_all = "snake_case")]
enum HidingName {
    /// Nothing is missing
    Nothing,
    /// One effect of the catalogue
    One,
    /// Two or three of them
    Several,
    /// Something that the catalogue does not hold
    Unlisted,
    /// A law that nobody chose: port, variable, form and size are drawn
    Law,
    /// Two of them, or one beside an effect of the catalogue
    Laws,
}

/// Runs the command.
pub fn conceal(arguments: &ConcealArguments) -> Result<ExitCode, CliError> {
    let rig = match arguments.rig {
        RigName::MuscleBench => Rig::MuscleBench,
        RigName::AntagonisticPulley => Rig::AntagonisticPulley,
        RigName::BendingCatheter => Rig::BendingCatheter,
    };
    let last = arguments.seed.checked_add(arguments.count - 1).ok_or_else(|| {
        let (seed, count) = (arguments.seed, arguments.count);
        CliError::Usage(format!(
            "--seed {seed}: {count} seeds from there on are more than there are, up to {}\n  remedy: begin at a smaller seed",
            u64::MAX
        ))
    })?;
    make_folder(&arguments.out)?;
    let path = arguments.out.join("seals.txt");
    // Seals of cases that lie there already stay.
    let mut seals = if path.is_file() { read_seals(&path)? } else { Vec::new() };
    for seed in arguments.seed..=last {
        let drawn = draw(&format!("case_{seed}"), rig, hiding(arguments.hiding, seed), seed)?;
        refuse_another(&drawn.truth, &arguments.out)?;
        let seal = write_case(&drawn, &arguments.out)?;
        say!("{} {seal}", drawn.truth.name);
        seals.retain(|(name, _)| *name != drawn.truth.name);
        seals.push((drawn.truth.name, seal));
        write_seals(&path, &seals)?;
    }
    eprintln!("written: {}; the answers lie in sealed/", arguments.out.display());
    Ok(ExitCode::SUCCESS)
}

/// A case that is there under the same name stays, unless it is the same.
fn refuse_another(truth: &Truth, out: &Path) -> Result<(), CliError> {
    match is_another_there(truth, out) {
        true => Err(CliError::Usage(format!(
            "{}: another case of this name is there, it would be lost\n  remedy: give another folder with --out, or another --seed",
            out.join(&truth.name).display()
        ))),
        false => Ok(()),
    }
}

/// Two of ten hide nothing, two something unlisted, three one effect, three several.
fn hiding(asked: Option<HidingName>, seed: u64) -> Hiding {
    match asked {
        Some(HidingName::Nothing) => Hiding::Nothing,
        Some(HidingName::One) => Hiding::One,
        Some(HidingName::Several) => Hiding::Several,
        Some(HidingName::Unlisted) => Hiding::Unlisted,
        Some(HidingName::Law) => Hiding::Law,
        Some(HidingName::Laws) => Hiding::Laws,
        None => Hiding::drawn(seed),
    }
}
