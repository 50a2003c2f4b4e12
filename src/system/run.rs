//! Running a scene over its output instants.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::recording::{Channel, PiecewiseLinear, Recording};

use crate::scene::Program;

use super::channels::Channels;
use super::events::{ConcernsS, count_concerns};
use super::observe::Observer;
use super::{InputSource, Schedule, Simulation, SystemError, Warnings};

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
///
/// ```
/// use std::convert::Infallible;
/// use std::sync::atomic::AtomicBool;
///
/// use smam::scene::Scene;
/// use smam::system::observe::{Frame, Observer, SceneGraph};
/// use smam::system::{Schedule, Simulation, run};
///
/// /// The greatest pull of any muscle so far, N.
/// #[derive(Default)]
/// struct GreatestPull(f64);
///
/// impl Observer for GreatestPull {
///     type Error = Infallible;
///
///     fn begin(&mut self, _: &SceneGraph) -> Result<(), Infallible> {
///         Ok(())
///     }
///
///     fn frame(&mut self, frame: &Frame) -> Result<(), Infallible> {
///         self.0 = frame.muscles.iter().fold(self.0, |most, muscle| most.max(muscle.pull_n));
///         Ok(())
///     }
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut simulation = Simulation::new(Scene::load("muscle_bench", &[])?)?;
/// let mut pull = GreatestPull::default();
/// let never = AtomicBool::new(false);
/// let mut warnings = run(&mut simulation, &Schedule::even(1.0, 0.01), &never, &mut pull)?;
/// // The string's 0.05 N, which comes all at once; the fluid does not cavitate, and the coil does not yield.
/// assert!((0.05..0.15).contains(&pull.0));
/// assert!(warnings.summary(1.0).is_empty());
/// # Ok(())
/// # }
/// ```
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
    if let Some(first) = schedule.first_s() {
        simulation.start_at(first);
        simulation.check_laws()?;
    }
    observer.begin(&simulation.graph(&channels)).map_err(RunError::Observer)?;
    for time in schedule.iter() {
        if stop.load(Ordering::Relaxed) {
            break;
        }
        if time > simulation.time_s() {
            simulation.advance_to(time)?;
        }
        let events = warnings.look(simulation);
        let frame = simulation.frame(&mut channels, events);
        channels.check(simulation, &frame.channels)?;
        observer.frame(&frame).map_err(RunError::Observer)?;
    }
    Ok(warnings)
}

/// Someone who drives a run as it goes: a controller.
///
/// ```
/// use smam::scene::Scene;
/// use smam::system::{Driver, Schedule, Simulation, record_driven};
///
/// /// Moves the plunger until the muscle is as long as wanted.
/// struct Hold {
///     wanted_mm: f64,
///     plunger_m: f64,
/// }
///
/// impl Driver for Hold {
///     fn start(&self) -> Vec<(String, f64)> {
///         vec![("plunger_mm".to_owned(), self.plunger_m)]
///     }
///
///     fn watched(&self) -> &str {
///         "elongation_mm"
///     }
///
///     fn choose(&mut self, _next_s: f64, measured: f64) -> Vec<f64> {
///         self.plunger_m += 1e-5 * (self.wanted_mm - measured);
///         vec![self.plunger_m]
///     }
/// }
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut simulation = Simulation::new(Scene::load("muscle_bench", &[])?)?;
/// let mut hold = Hold { wanted_mm: 2.0, plunger_m: 0.0 };
/// let recording = record_driven(&mut simulation, &Schedule::even(3.0, 0.02), &mut hold)?;
/// assert!((recording.value_at("elongation_mm", 3.0)? - 2.0).abs() < 0.05);
/// # Ok(())
/// # }
/// ```
pub trait Driver {
    /// The inputs that are driven, with their values at the start, SI.
    fn start(&self) -> Vec<(String, f64)>;

    /// The output that is watched.
    fn watched(&self) -> &str;

    /// The driven inputs at `next_s`, SI, after the watched output read `measured` (in its column's unit) now; the
    /// inputs go straight there. As many values as inputs: an input without one stays where it is.
    fn choose(&mut self, next_s: f64, measured: f64) -> Vec<f64>;
}

/// As [`record`], with a driver that chooses inputs from instant to instant.
///
/// # Errors
/// As [`record`]; a driver that drives or watches a channel the scene does not have.
pub fn record_driven(
    simulation: &mut Simulation,
    schedule: &Schedule,
    driver: &mut dyn Driver,
) -> Result<Recording, SystemError> {
    let mut now = driver.start();
    check_names(simulation, now.iter().map(|(name, _)| name.as_str()), driver.watched())?;
    for (channel, value) in &now {
        simulation.set_input(channel, InputSource::Program(Program::constant(*value)));
    }
    let (mut at, mut chosen) = (schedule.first_s().unwrap_or(0.0), Vec::new());
    record_steps(simulation, schedule, |simulation, next_s, channels, values| {
        let measured = channels.names.iter().position(|n| n == driver.watched()).map_or(f64::NAN, |i| values[i]);
        chosen = driver.choose(next_s, measured);
        for ((channel, before), after) in now.iter_mut().zip(&chosen) {
            if let Some(line) = PiecewiseLinear::new(&[at, next_s], &[*before, *after]) {
                simulation.set_input(channel, InputSource::Recorded(line));
            }
            *before = *after;
        }
        at = next_s;
    })
}

fn check_names<'a>(
    simulation: &Simulation,
    driven: impl Iterator<Item = &'a str>,
    watched: &str,
) -> Result<(), SystemError> {
    let file = &simulation.scene().file;
    let refuse = |table: &str, name: &str, known: Vec<&str>| SystemError::Name {
        file: simulation.scene().path.clone(),
        table: table.to_owned(),
        message: format!("there is no channel {name}"),
        remedy: format!("use one of: {}", known.join(", ")),
    };
    let inputs: Vec<&str> = file.input.iter().map(|i| i.channel.as_str()).collect();
    let outputs: Vec<&str> = file.output.iter().map(|o| o.channel.as_str()).collect();
    for name in driven {
        if !inputs.contains(&name) {
            return Err(refuse("[[input]]", name, inputs));
        }
    }
    if outputs.contains(&watched) { Ok(()) } else { Err(refuse("[[output]]", watched, outputs)) }
}

/// Runs over the schedule and returns the recording: inputs first, then outputs, in their columns' units.
///
/// ```
/// use smam::scene::Scene;
/// use smam::system::{Schedule, Simulation, record};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let schedule = Schedule::at(vec![0.0, 0.05, 0.2]);
/// let recording = record(&mut Simulation::new(Scene::load("muscle_bench", &[])?)?, &schedule)?;
/// assert_eq!(recording.columns(), ["plunger_mm", "elongation_mm", "pressure_kpa", "force_n"]);
/// assert_eq!(recording.time_s(), [0.0, 0.05, 0.2]);
/// # Ok(())
/// # }
/// ```
pub fn record(simulation: &mut Simulation, schedule: &Schedule) -> Result<Recording, SystemError> {
    record_steps(simulation, schedule, |_, _, _, _| {})
}

/// As [`record`], and how long the run was in each kind of trouble, by its state at the start of each interval.
///
/// # Errors
/// As [`record`].
pub fn record_watched(simulation: &mut Simulation, schedule: &Schedule) -> Result<(Recording, ConcernsS), SystemError> {
    let mut durations_s = ConcernsS::default();
    let recording = record_steps(simulation, schedule, |simulation, next_s, _, _| {
        count_concerns(simulation, next_s - simulation.time_s(), &mut durations_s);
    })?;
    // Sums of intervals as they are written: to a microsecond.
    Ok((recording, durations_s.map(|s| (s * 1e6).round() / 1e6)))
}

/// Records; before each interval `before` sees the instant at its end and the channels at its start.
fn record_steps(
    simulation: &mut Simulation,
    schedule: &Schedule,
    mut before: impl FnMut(&mut Simulation, f64, &Channels, &[f64]),
) -> Result<Recording, SystemError> {
    let mut channels = Channels::new(simulation)?;
    if let Some(first) = schedule.first_s() {
        simulation.start_at(first);
        simulation.check_laws()?;
    }
    let times_s = schedule.times();
    let mut columns: Vec<Vec<f64>> = vec![Vec::with_capacity(times_s.len()); channels.names.len()];
    let mut values = Vec::new();
    for &time in &times_s {
        if time > simulation.time_s() {
            before(simulation, time, &channels, &values);
            simulation.advance_to(time)?;
        }
        channels.read(simulation, &mut values);
        channels.check(simulation, &values)?;
        columns.iter_mut().zip(&values).for_each(|(column, value)| column.push(*value));
    }
    let named = channels.names.iter().zip(columns).map(|(name, values)| Channel::new(name.clone(), values));
    Ok(Recording::new(times_s, named.collect())?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Plays a scene's own programme back to it, step by step.
    struct Same(Program);

    impl Driver for Same {
        fn start(&self) -> Vec<(String, f64)> {
            vec![("plunger_mm".to_owned(), self.0.value(0.0))]
        }

        fn watched(&self) -> &str {
            "elongation_mm"
        }

        fn choose(&mut self, next_s: f64, _measured: f64) -> Vec<f64> {
            vec![self.0.value(next_s)]
        }
    }

    /// A hysteresis model keeps its branch while a driver changes its input at every instant.
    #[test]
    fn a_driven_run_is_the_run_of_the_same_inputs() {
        let scene = Scene::load("muscle_printed_model", &[]).expect("stock");
        let (schedule, program) = (Schedule::even(8.0, 0.02), scene.programs[0].clone());
        let alone = record(&mut Simulation::new(scene.clone()).expect("builds"), &schedule).expect("runs");
        let mut simulation = Simulation::new(scene).expect("builds");
        let driven = record_driven(&mut simulation, &schedule, &mut Same(program)).expect("runs");
        let column = |r: &Recording| r.channel("elongation_mm").expect("there").values.clone();
        let worst = column(&alone).iter().zip(column(&driven)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Straight between instants instead of along the sine.
        assert!(worst < 0.01, "{worst} mm");
    }

    /// Of a ramp that the logger joins late the rig has done the first part all the same.
    #[test]
    fn a_recording_that_lost_its_first_samples_is_played_from_zero() {
        let ramp = |first: usize| {
            let time_s: Vec<f64> = (first..200).map(|i| i as f64 * 0.01).collect();
            let plunger = time_s.iter().map(|t| 0.5 * t).collect();
            let recording = Recording::new(time_s.clone(), vec![Channel::new("plunger_mm", plunger)]).expect("rising");
            let mut simulation = Simulation::new(Scene::load("muscle_bench", &[]).expect("stock")).expect("builds");
            let line = recording.piecewise_si("plunger_mm").expect("there");
            simulation.set_input("plunger_mm", InputSource::Recorded(line));
            let run = record(&mut simulation, &Schedule::at(time_s)).expect("runs");
            run.channel("elongation_mm").expect("there").values.clone()
        };
        let (whole, late) = (ramp(0), ramp(5));
        let worst = whole[5..].iter().zip(&late).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-6, "{worst} mm");
    }

    #[test]
    fn a_driver_of_an_unknown_channel_is_refused() {
        let scene = Scene::load("muscle_bench", &[]).expect("stock");
        let watched = Same(Program::constant(0.0));
        struct Wrong(Same);
        impl Driver for Wrong {
            fn start(&self) -> Vec<(String, f64)> {
                vec![("piston_mm".to_owned(), 0.0)]
            }
            fn watched(&self) -> &str {
                self.0.watched()
            }
            fn choose(&mut self, next_s: f64, measured: f64) -> Vec<f64> {
                self.0.choose(next_s, measured)
            }
        }
        let refused = record_driven(
            &mut Simulation::new(scene).expect("builds"),
            &Schedule::even(0.1, 0.05),
            &mut Wrong(watched),
        );
        assert!(refused.unwrap_err().to_string().contains("piston_mm"));
    }
}
