//! `smam run --check-steps`.

use smam::recording::{Recording, parse_column};
use smam::system::{Schedule, Simulation, StepError, record, step_errors};

use super::CliError;

/// Share of a channel's range up to which its steps are short enough.
const ENOUGH: f64 = 1e-3;

/// Plays `halved`, the run's scene with half its steps, and prints how far every channel moves.
pub fn check_steps(run: &Recording, halved: &mut Simulation, schedule: &Schedule) -> Result<(), CliError> {
    let errors = step_errors(run, &record(halved, schedule)?);
    let step_s = 2.0 * halved.scene().file.simulation.step_s;
    say!("half of the {} ms of simulation.step_s moves:", 1e3 * step_s);
    for error in &errors {
        say!("{}", line(error)?);
    }
    if errors.iter().any(|e| e.share() > ENOUGH) {
        eprintln!(
            "warning: a channel moves by more than {} % of its range; remedy: halve simulation.step_s or double simulation.substeps, \
             until it stays",
            100.0 * ENOUGH
        );
    }
    Ok(())
}

fn line(error: &StepError) -> Result<String, CliError> {
    let unit = parse_column(&error.column)?.unit.symbol;
    let StepError { column, greatest, at_s, .. } = error;
    Ok(format!(
        "  {column:<26} by {greatest:>11.3e} {unit:<4} at {at_s:>9.3} s, {:.4} % of its range",
        100.0 * error.share()
    ))
}
