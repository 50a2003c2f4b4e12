//! The ceiling of a proof: what somebody could know who knows the concealing plant.

use std::path::Path;

use rayon::prelude::*;
use smam::conceal::{Ceiling, Hiding, Secret, Settling, ceiling, settling};
use smam::proof::{Folders, LawCeiling, ProofError, Row, Told, VISIBLE, law_ceiling, open};
use smam::recording::read_csv;

use super::score::write_rows;
use crate::cli::CliError;

/// Computes the ceiling of the first `count` visible cases that hide one thing, writes ceiling.jsonl and prints the means.
pub fn write_ceiling(
    rows: &[Row],
    count: usize,
    seals: &[(String, String)],
    folders: &Folders,
    out: &Path,
) -> Result<(), CliError> {
    let is_single = |r: &&Row| matches!(r.hiding, Hiding::One | Hiding::Unlisted) && r.excess >= VISIBLE;
    let chosen: Vec<&Row> = rows.iter().filter(is_single).take(count).collect();
    let one = |row: &&Row| -> Result<Option<(Ceiling, Hiding)>, ProofError> {
        let Some(seal) = seal_of(row, seals) else { return Ok(None) };
        let found = ceiling(&open(&row.name, seal, folders)?)?;
        eprintln!("ceiling of {}", row.name);
        Ok(found.map(|c| (c, row.hiding)))
    };
    let found: Vec<Option<(Ceiling, Hiding)>> = chosen.par_iter().map(one).collect::<Result<_, _>>()?;
    let found: Vec<(Ceiling, Hiding)> = found.into_iter().flatten().collect();
    let ceilings: Vec<&Ceiling> = found.iter().map(|(c, _)| c).collect();
    write_rows(&ceilings, &out.join("ceiling.jsonl"))?;
    let mean = |is: &dyn Fn(Hiding) -> bool, value: &dyn Fn(&Ceiling) -> f64| {
        let own: Vec<f64> = found.iter().filter(|(_, h)| is(*h)).map(|(c, _)| value(c)).collect();
        mean_share(&own)
    };
    crate::cli::print_text(&format!(
        "\n### At best, for one who knows the plant\n\n| | |\n|---|---|\n| detected | {} |\n| effect right (one effect) | {} |\n| told from everything else (not listed) | {} |\n",
        mean(&|_| true, &|c| c.detection),
        mean(&|h| h == Hiding::One, &|c| c.naming),
        mean(&|h| h == Hiding::Unlisted, &|c| c.naming),
    ))
}

/// Computes what the proposed experiment could decide at best of every ambiguous answer that was put to one, writes settling.jsonl
/// and prints a table.
pub fn write_settling(rows: &[Row], seals: &[(String, String)], folders: &Folders, out: &Path) -> Result<(), CliError> {
    let one = |row: &&Row| -> Result<Option<(Settling, String)>, ProofError> {
        let Some(seal) = seal_of(row, seals) else { return Ok(None) };
        let Some(settled) = &row.settled else { return Ok(None) };
        let programme = read_csv(&folders.answers.join(&row.name).join("next_experiment.csv"))?;
        let sensor = settled.with_sensor.as_ref();
        let is_open = |s: &Secret| row.probability_of(s) < NAMED;
        let is_named = |s: &Secret| row.effects.iter().any(|e| e.is(s));
        let truth = open(&row.name, seal, folders)?;
        let found = settling(&truth, is_open, is_named, &programme, sensor.map(|s| s.column.as_str()))?;
        eprintln!("what the experiment for {} could decide", row.name);
        let promised = sensor.map_or(settled.promised_sigma, |s| s.promised_sigma);
        let outcome = if settled.as_proposed().is_right { "yes" } else { "no" };
        Ok(found.map(|f| {
            let line = format!(
                "| {} | {} | {} | {promised:.1} | {:.1} | {:.0} % | {outcome} |\n",
                f.name,
                f.hidden,
                f.rival,
                f.sigma,
                100.0 * f.is_right()
            );
            (f, line)
        }))
    };
    let found: Vec<Option<(Settling, String)>> = rows.par_iter().map(|r| one(&r)).collect::<Result<_, _>>()?;
    let found: Vec<(Settling, String)> = found.into_iter().flatten().collect();
    let settlings: Vec<&Settling> = found.iter().map(|(s, _)| s).collect();
    write_rows(&settlings, &out.join("settling.jsonl"))?;
    let table: String = found.iter().map(|(_, line)| line.as_str()).collect();
    let right: Vec<f64> = found.iter().map(|(s, _)| s.is_right()).collect();
    crate::cli::print_text(&format!(
        "\n### One more experiment, at best, for one who knows the plant\n\n\
         | case | hidden | taken for | promised, sigma | at best, sigma | right at best | settled |\n|---|---|---|---|---|---|---|\n\
         {table}\nRight at best: {}\n",
        mean_share(&right)
    ))
}

/// Holds the hidden laws of the first `count` detected cases against their answers, writes law_ceiling.jsonl and prints a table.
pub fn write_law_ceiling(
    rows: &[Row],
    count: usize,
    seals: &[(String, String)],
    folders: &Folders,
    out: &Path,
) -> Result<(), CliError> {
    let is_detected = |r: &&Row| matches!(r.hiding, Hiding::Law | Hiding::Laws) && r.is_detected();
    let chosen: Vec<&Row> = rows.iter().filter(is_detected).take(count).collect();
    let one = |row: &&Row| -> Result<Option<LawCeiling>, ProofError> {
        let Some(seal) = seal_of(row, seals) else { return Ok(None) };
        match law_ceiling(&open(&row.name, seal, folders)?, row, folders) {
            // A law so steep that the scene's steps cannot follow it is no case for this table.
            Err(ProofError::Diagnose(error)) => {
                eprintln!("{}: {error}", row.name);
                Ok(None)
            }
            found => found,
        }
    };
    let found: Vec<Option<LawCeiling>> = chosen.par_iter().map(one).collect::<Result<_, _>>()?;
    let found: Vec<LawCeiling> = found.into_iter().flatten().collect();
    write_rows(&found.iter().collect::<Vec<_>>(), &out.join("law_ceiling.jsonl"))?;
    let line = |c: &LawCeiling| {
        let rank = c.rank.map_or("-".to_owned(), |n| n.to_string());
        let told = match c.told() {
            Told::Found => "found",
            Told::Alike => "not told apart",
            Told::Missed => "missed",
        };
        format!("| {} | {:.0} | {:.1} | {rank} | {told} |\n", c.name, c.calibrated, c.corrected)
    };
    let table: String = found.iter().map(line).collect();
    crate::cli::print_text(&format!(
        "\n### Answers beside the laws themselves\n\nChi2 left beyond the scene with the hidden law:\n\n\
         | case | calibrated | corrected | port and variable | |\n|---|---|---|---|---|\n{table}"
    ))
}

/// The seal of a row's case.
fn seal_of<'a>(row: &Row, seals: &'a [(String, String)]) -> Option<&'a str> {
    seals.iter().find(|(name, _)| *name == row.name).map(|(_, seal)| seal.as_str())
}

/// Mean of shares in words.
fn mean_share(shares: &[f64]) -> String {
    if shares.is_empty() {
        return "no such case".to_owned();
    }
    format!("{:.1} % of {}", 100.0 * shares.iter().sum::<f64>() / shares.len() as f64, shares.len())
}

/// An effect of the answer with such a probability is not open.
const NAMED: f64 = 0.9;
