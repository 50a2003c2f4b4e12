//! `smam reproduce`.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use smam::report::figure_svg;
use smam::reproduce::{FIGURES, Figure, Made, ReproduceError, Standing, cells, json, page};

use crate::cli::CliError;
use crate::cli::files::{Together, take_folder};

/// Of the pictures, px.
const SIZE: (f64, f64) = (720.0, 300.0);

/// Arguments of `smam reproduce`.
#[derive(Args)]
#[command(after_help = "Examples:
  smam reproduce                      every figure of the paper, one page
  smam reproduce 4a 8 --out out/two   two of them")]
pub struct ReproduceArguments {
    /// Figures, for example 4a 5; all of them if none is named
    #[arg(value_name = "FIG")]
    figures: Vec<String>,
    /// Folder for reproduce.html, reproduce.json and a picture of each figure
    #[arg(long, value_name = "DIR", default_value = "out/reproduce")]
    out: PathBuf,
}

/// Makes the figures in parallel and writes one page; the table is printed too.
pub fn reproduce(arguments: &ReproduceArguments) -> Result<ExitCode, CliError> {
    let wanted = wanted(&arguments.figures)?;
    // A folder that cannot be made is better said before the work than after it.
    let _held = take_folder(&arguments.out)?;
    let progress = ProgressBar::new(wanted.len() as u64);
    progress.set_style(
        ProgressStyle::with_template("{bar:30} {pos}/{len} figures {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let made: Result<Vec<Made>, ReproduceError> = wanted
        .into_par_iter()
        .map(|figure| {
            let chapter = (figure.make)()?;
            progress.set_message(figure.name);
            progress.inc(1);
            Ok((figure, chapter))
        })
        .collect();
    progress.finish_and_clear();
    let made = made?;
    print(&made);
    let text = serde_json::to_string_pretty(&json(&made))
        .map_err(|source| CliError::Write { file: arguments.out.join("reproduce.json"), source: source.into() })?;
    let mut files = Together::default();
    files.text(&arguments.out.join("reproduce.json"), &text)?;
    files.page(&arguments.out, "reproduce.html", &page(&made))?;
    for (figure, chapter) in made.iter().filter(|(_, chapter)| !chapter.panels.is_empty()) {
        let svg = figure_svg(&chapter.panels, SIZE.0, SIZE.1);
        files.text(&arguments.out.join(format!("{}.svg", figure.name)), &svg)?;
    }
    files.place()?;
    say!("{}", arguments.out.join("reproduce.html").display());
    Ok(ExitCode::SUCCESS)
}

fn wanted(names: &[String]) -> Result<Vec<&'static Figure>, CliError> {
    if names.is_empty() {
        return Ok(FIGURES.iter().collect());
    }
    let find = |name: &String| {
        FIGURES.iter().find(|f| f.name == name).ok_or_else(|| {
            let known: Vec<String> = FIGURES.iter().map(|f| format!("{} ({})", f.name, f.title)).collect();
            CliError::Usage(format!("there is no figure {name}\n  remedy: name one of {}", known.join(", ")))
        })
    };
    names.iter().map(find).collect()
}

fn print(made: &[Made]) {
    let count = |standing| made.iter().flat_map(|(_, c)| &c.rows).filter(|r| r.standing == standing).count();
    for (figure, chapter) in made {
        say!("{}: {}", figure.name, figure.title);
        for row in &chapter.rows {
            let cells = cells(figure, row);
            say!("  {:<8} {:<62} paper {:>14}  ours {:>14}  {}", cells[5], cells[1], cells[2], cells[3], cells[6]);
        }
    }
    say!(
        "{} met, {} not met, {} tuned to, {} given, {} shown",
        count(Standing::Met),
        count(Standing::NotMet),
        count(Standing::Tuned),
        count(Standing::Given),
        count(Standing::Shown)
    );
}
