//! Measured and simulated channels over time, what is left between them, and where that is more than noise.

use rerun::{EntityPath, RecordingStream, Scalars, StateChange, StateConfiguration, TextLog};

use super::colour::{AXIS, CALIBRATED, CORRECTED, MEASURED, Rgb, SLACK, opaque};
use super::error::ViewError;
use super::layer::{path, time_column};
use super::scalars::named_line;
use crate::system::observe::{MeasuredChannel, SideBySide};

/// Lanes of the state view, by entity.
const RUN_LANE: &str = "run";
const MISMATCH_LANE: &str = "calibrated_scene";
/// Lines are drawn in the order of their names: what was measured lies below what is compared with it.
const MEASURED_LINE: &str = "as_measured";
const AS_MEASURED: &str = "as measured";
const OFF: &str = "off by more than noise";
/// An empty state ends the one before.
const NONE: &str = "";
/// Lines are cut between runs, this long after the last sample, s.
const CUT_S: f64 = 1e-3;

/// What has been said once: lines, names, colours.
pub(super) struct Comparison {
    columns: Vec<String>,
}

impl Comparison {
    /// Names the lines of every recorded channel.
    pub(super) fn begin(out: &RecordingStream, run: &SideBySide) -> Result<Self, ViewError> {
        let columns: Vec<String> = run.measured.iter().map(|m| run.graph.channels[m.channel].clone()).collect();
        for column in &columns {
            let traces: [(&str, Rgb, f32); 3] =
                [(MEASURED_LINE, MEASURED, 4.0), ("calibrated", CALIBRATED, 1.5), ("corrected", CORRECTED, 1.5)];
            for (kind, colour, width) in traces {
                named_line(out, &trace(column, kind), &kind.replace('_', " "), colour, width)?;
            }
            let residuals: [(&str, &str, Rgb, f32); 4] = [
                ("calibrated", "measured - calibrated", CALIBRATED, 1.5),
                ("corrected", "measured - corrected", CORRECTED, 1.5),
                ("noise_above", "+ 2 noise sd", AXIS, 1.0),
                ("noise_below", "- 2 noise sd", AXIS, 1.0),
            ];
            for (kind, text, colour, width) in residuals {
                named_line(out, &residual(column, kind), text, colour, width)?;
            }
        }
        let colours = [opaque(SLACK), opaque(CALIBRATED)];
        let lane = StateConfiguration::new().with_values([AS_MEASURED, OFF]).with_colors(colours);
        out.log_static(state(MISMATCH_LANE), &lane)?;
        Ok(Comparison { columns })
    }
}

/// Logs a run whose clock is moved by `shift_s`.
pub(super) fn log_comparison(
    out: &RecordingStream,
    comparison: &mut Comparison,
    run: &SideBySide,
    shift_s: f64,
) -> Result<(), ViewError> {
    let times_s: Vec<f64> = run.calibrated.iter().map(|frame| frame.time_s + shift_s).collect();
    let Some((&start_s, &end_s)) = times_s.first().zip(times_s.last()) else { return Ok(()) };
    for (column, measured) in comparison.columns.iter().zip(&run.measured) {
        log_channel(out, column, measured, run, &times_s)?;
    }
    log_states(out, RUN_LANE, &[(start_s, run.run.as_str()), (end_s, NONE)])?;
    let mut lane = vec![(start_s, AS_MEASURED)];
    for (from, to) in &run.windows_s {
        lane.push(((from + shift_s).max(start_s), OFF));
        lane.push(((to + shift_s).min(end_s), AS_MEASURED));
    }
    lane.push((end_s, NONE));
    log_states(out, MISMATCH_LANE, &lane)?;
    log_events(out, run, shift_s, start_s)
}

fn log_channel(
    out: &RecordingStream,
    column: &str,
    measured: &MeasuredChannel,
    run: &SideBySide,
    times_s: &[f64],
) -> Result<(), ViewError> {
    let calibrated: Vec<f64> = run.calibrated.iter().map(|frame| frame.channels[measured.channel]).collect();
    let corrected: Vec<f64> = run.corrected.iter().map(|frame| frame.channels[measured.channel]).collect();
    let left = |simulated: &[f64]| -> Vec<f64> { measured.values.iter().zip(simulated).map(|(m, s)| m - s).collect() };
    log_line(out, residual(column, "calibrated"), times_s, left(&calibrated))?;
    log_line(out, residual(column, "corrected"), times_s, left(&corrected))?;
    log_line(out, trace(column, MEASURED_LINE), times_s, measured.values.clone())?;
    log_line(out, trace(column, "calibrated"), times_s, calibrated)?;
    log_line(out, trace(column, "corrected"), times_s, corrected)?;
    let ends_s = [times_s[0], times_s[times_s.len() - 1]];
    for (kind, sign) in [("noise_above", 2.0), ("noise_below", -2.0)] {
        log_line(out, residual(column, kind), &ends_s, vec![sign * measured.noise_sd; 2])?;
    }
    Ok(())
}

/// A line that ends with the run: a missing value after it keeps it apart from the next.
fn log_line(out: &RecordingStream, entity: EntityPath, times_s: &[f64], mut values: Vec<f64>) -> Result<(), ViewError> {
    values.push(f64::NAN);
    let end_s = times_s.last().map(|t| t + CUT_S);
    let columns = Scalars::new(values).columns_of_unit_batches()?;
    out.send_columns(entity, [time_column(times_s.iter().copied().chain(end_s))], columns)?;
    Ok(())
}

fn log_states(out: &RecordingStream, lane: &str, changes: &[(f64, &str)]) -> Result<(), ViewError> {
    let states = StateChange::update_fields().with_state(changes.iter().map(|(_, state)| *state));
    let times = time_column(changes.iter().map(|(time_s, _)| *time_s));
    out.send_columns(state(lane), [times], states.columns_of_unit_batches()?)?;
    Ok(())
}

fn log_events(out: &RecordingStream, run: &SideBySide, shift_s: f64, start_s: f64) -> Result<(), ViewError> {
    let mut events = vec![(start_s, format!("{} begins", run.run))];
    for (from, to) in &run.windows_s {
        let text = format!("{}: calibrated scene {OFF} from {from:.1} to {to:.1} s of the run", run.run);
        events.push(((from + shift_s).max(start_s), text));
    }
    let log = TextLog::update_fields().with_many_text(events.iter().map(|(_, text)| text.as_str()));
    let times = time_column(events.iter().map(|(time_s, _)| *time_s));
    out.send_columns("events", [times], log.columns_of_unit_batches()?)?;
    Ok(())
}

fn trace(column: &str, kind: &str) -> EntityPath {
    path(["traces", column, kind])
}

fn residual(column: &str, kind: &str) -> EntityPath {
    path(["residuals", column, kind])
}

fn state(lane: &str) -> EntityPath {
    path(["states", lane])
}
