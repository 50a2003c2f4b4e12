//! The ceiling of a proof: what somebody could know who knows the concealing plant.

use std::path::Path;

use rayon::prelude::*;
use smam::conceal::{Ceiling, Hiding, ceiling};
use smam::proof::{Folders, ProofError, Row, VISIBLE, open};

use super::CliError;
use super::files::write;

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
        let Some((_, seal)) = seals.iter().find(|(name, _)| *name == row.name) else { return Ok(None) };
        let found = ceiling(&open(&row.name, seal, folders)?)?;
        eprintln!("ceiling of {}", row.name);
        Ok(found.map(|c| (c, row.hiding)))
    };
    let found: Vec<Option<(Ceiling, Hiding)>> = chosen.par_iter().map(one).collect::<Result<_, _>>()?;
    let found: Vec<(Ceiling, Hiding)> = found.into_iter().flatten().collect();
    let json = |e: serde_json::Error| CliError::Failed(format!("a ceiling cannot be written as JSON: {e}"));
    let lines: Result<Vec<String>, serde_json::Error> = found.iter().map(|(c, _)| serde_json::to_string(c)).collect();
    write(&out.join("ceiling.jsonl"), &format!("{}\n", lines.map_err(json)?.join("\n")))?;
    let mean = |is: &dyn Fn(Hiding) -> bool, value: &dyn Fn(&Ceiling) -> f64| {
        let own: Vec<f64> = found.iter().filter(|(_, h)| is(*h)).map(|(c, _)| value(c)).collect();
        format!("{:.1} % of {}", 100.0 * own.iter().sum::<f64>() / own.len() as f64, own.len())
    };
    super::print_text(&format!(
        "\n### At best, for one who knows the plant\n\n| | |\n|---|---|\n| detected | {} |\n| effect right (one effect) | {} |\n| told from everything else (not listed) | {} |\n",
        mean(&|_| true, &|c| c.detection),
        mean(&|h| h == Hiding::One, &|c| c.naming),
        mean(&|h| h == Hiding::Unlisted, &|c| c.naming),
    ))
}
