//! Running a scene over its output instants.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::recording::{Channel, Recording};

use super::channels::Channels;
use super::observe::Observer;
use super::{Simulation, SystemError, Warnings};

/// The instants at which a run is recorded, s; increasing, the first one is the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule(pub Vec<f64>);

impl Schedule {
    /// Equal intervals from 0 to `duration_s`, both ends included.
    pub fn even(duration_s: f64, interval_s: f64) -> Self {
        let count = (duration_s / interval_s + 1e-9).floor() as usize;
        let mut times: Vec<f64> = (0..=count).map(|i| i as f64 * interval_s).collect();
        if duration_s - count as f64 * interval_s > 1e-9 * interval_s.max(1e-3) {
            times.push(duration_s);
        }
        Self(times)
    }
}

/// Why a run ended early: the simulation, or whoever watches it.
#[derive(Debug, thiserror::Error)]
pub enum RunError<E: std::error::Error + 'static> {
    #[error(transparent)]
    System(#[from] SystemError),
    #[error(transparent)]
    Observer(E),
}

/// Runs over the schedule, showing every instant to the observer; `stop` ends the run after the present instant.
///
/// Returns the warnings of the run. What was shown before an error or a stop stays shown.
pub fn run<O: Observer>(
    simulation: &mut Simulation,
    schedule: &Schedule,
    stop: &AtomicBool,
    observer: &mut O,
) -> Result<Warnings, RunError<O::Error>>
where
    O::Error: std::error::Error + 'static,
{
    let mut channels = Channels::new(simulation)?;
    let mut warnings = Warnings::default();
    if let Some(&first) = schedule.0.first() {
        simulation.start_at(first);
    }
    observer.begin(&simulation.graph(&channels)).map_err(RunError::Observer)?;
    for &time in &schedule.0 {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        if time > simulation.time_s() {
            simulation.advance_to(time)?;
        }
        let events = warnings.look(simulation);
        observer.frame(&simulation.frame(&mut channels, events)).map_err(RunError::Observer)?;
    }
    Ok(warnings)
}

/// Runs over the schedule and returns the recording: inputs first, then outputs, in their columns' units.
pub fn record(simulation: &mut Simulation, schedule: &Schedule) -> Result<Recording, SystemError> {
    let mut channels = Channels::new(simulation)?;
    if let Some(&first) = schedule.0.first() {
        simulation.start_at(first);
    }
    let mut columns: Vec<Vec<f64>> = vec![Vec::with_capacity(schedule.0.len()); channels.names.len()];
    let mut values = Vec::new();
    for &time in &schedule.0 {
        if time > simulation.time_s() {
            simulation.advance_to(time)?;
        }
        channels.read(simulation, &mut values);
        columns.iter_mut().zip(&values).for_each(|(column, value)| column.push(*value));
    }
    let named = channels.names.iter().zip(columns).map(|(name, values)| Channel::new(name.clone(), values));
    Ok(Recording::new(schedule.0.clone(), named.collect())?)
}
