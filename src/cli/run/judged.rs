//! What is said of a run when it is over: its energy, and its scene's expectations.

use std::process::ExitCode;

use smam::files::write_whole;
use smam::recording::Recording;
use smam::system::{EnergyBalance, Simulation, Verdict, judge};

use super::RunArguments;
use crate::cli::{CliError, junit};

/// Share of the turnover that may be unaccounted for, %.
const MOST_UNACCOUNTED: f64 = 1.0;

/// Prints the energy balance, and warns of what is wrong with it.
pub(super) fn print_energy(balance: &EnergyBalance) {
    say!("energy balance, mJ:");
    for (name, joule) in balance.lines() {
        say!("  {name:<28} {:>14.6}", joule * 1e3);
    }
    let share = balance.unaccounted_j().abs() / balance.turnover_j().max(f64::MIN_POSITIVE) * 100.0;
    say!("  unaccounted: {share:.4} % of the plunger's turnover of {:.6} mJ", balance.turnover_j() * 1e3);
    for (line, joule) in balance.supplying_laws() {
        let name = line.strip_prefix("law_").unwrap_or(line);
        eprintln!(
            "warning: [[law]] \"{name}\" supplies {:.6} mJ at a port that only takes energy; remedy: look at its sign",
            joule * 1e3
        );
    }
    if share > MOST_UNACCOUNTED {
        eprintln!(
            "warning: more than {MOST_UNACCOUNTED} % of the turnover is unaccounted for: the steps are too long; remedy: see --check-steps"
        );
    }
}

/// Prints what the scene's expectations say; the exit code is 1 where one fails.
pub(super) fn check(
    arguments: &RunArguments,
    simulation: &Simulation,
    recording: &Recording,
) -> Result<ExitCode, CliError> {
    let scene = simulation.scene();
    let verdicts = judge(scene, recording)?;
    if verdicts.is_empty() {
        say!("{}: no [[expect]] in this scene", scene.file.name);
    }
    for verdict in &verdicts {
        say!("{}", line(verdict));
    }
    if let Some(path) = &arguments.junit {
        let text = junit::report(&scene.file.name, &verdicts);
        write_whole(path, &text).map_err(|source| CliError::Write { file: path.clone(), source })?;
    }
    let failed = verdicts.iter().filter(|v| !v.passed).count();
    say!("{}: {} passed, {failed} failed", scene.file.name, verdicts.len() - failed);
    Ok(if failed == 0 { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

fn line(v: &Verdict) -> String {
    let source = if v.source.is_empty() { String::new() } else { format!("   ({})", v.source) };
    let mark = if v.passed { "ok  " } else { "FAIL" };
    format!("{mark} {:<34} {:>12.5} {:<4} expected {}{source}", v.name, v.value, v.unit, v.bounds)
}
