//! Whether the recordings can be diagnosed.

use crate::diagnose::case::{Case, CaseRun};
use crate::diagnose::fit::{Model, Problem};
use crate::recording::figures::{correlation, spread};
use crate::recording::{Begun, BySize, PiecewiseLinear, noise_sd, other_zero, parse_column, strays, unit_by_size};
use crate::scene::{InputSpec, Scene};
use crate::system::{InputSource, Schedule, Simulation, SystemError, record};

/// Minimum number of samples.
const LEAST_SAMPLES: usize = 200;
/// Share of samples at one end value from which a channel is saturated.
const SATURATED_SHARE: f64 = 0.2;

/// Held-out runs go farther than the open ones if they exceed their range by this share of it.
const FARTHER: f64 = 0.1;

/// Reasons for refusing, and warnings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preflight {
    pub unusable: Vec<String>,
    pub warnings: Vec<String>,
}

/// Checks the recordings alone, and their scale against the uncalibrated scene.
///
/// # Errors
/// A law of the scene that has no value somewhere on the way.
pub(in crate::diagnose) fn preflight(case: &Case, problem: &Problem) -> Result<Preflight, SystemError> {
    let mut found = Preflight::default();
    let samples = problem.samples();
    if samples < LEAST_SAMPLES {
        found.unusable.push(format!("only {samples} samples: record at least some ten seconds at 50 Hz"));
    }
    inputs(case, &mut found);
    channels(case, &mut found);
    if found.unusable.is_empty() {
        found.warnings.extend(goes_farther_held_out(case));
    }
    // A scene that nothing drives stands still: its spread says nothing of units.
    if found.unusable.is_empty() && !case.scene.file.input.is_empty() {
        scales(case, problem, &mut found)?;
    }
    Ok(found)
}

fn inputs(case: &Case, found: &mut Preflight) {
    // Time alone drives a scene without inputs.
    if case.scene.file.input.is_empty() {
        return;
    }
    // The way to where a recording begins was not recorded.
    let recorded = |run: &CaseRun, input: usize| ends(&run.drive.inputs[input][run.lead_in..]);
    let moves = |run: &CaseRun| {
        (0..run.drive.inputs.len()).any(|i| {
            let (low, high) = recorded(run, i);
            high > low
        })
    };
    if !case.runs.iter().any(moves) {
        found.unusable.push("no input ever moves: record a programme that uses most of the stroke".to_owned());
    }
    for (i, input) in case.scene.file.input.iter().enumerate() {
        let stroke = case.runs.iter().map(|r| recorded(r, i)).fold(0.0f64, |m, (l, h)| m.max(h - l));
        let stray = |r: &CaseRun| !strays(&r.drive.inputs[i][r.lead_in..]).is_empty();
        if let Some(run) = case.runs.iter().find(|r| stray(r)) {
            found.unusable.push(format!(
                "{}: samples of {} lie far outside all others; leave cells empty where nothing was measured",
                run.file, input.channel
            ));
        }
        let is_plunger = input.channel.contains("plunger");
        if is_plunger && stroke > 0.2 {
            found.unusable.push(format!(
                "{} moves by {stroke:.2} m, farther than a syringe is long: say in its [[channel]] which unit the numbers have (unit = \"um\")",
                input.channel
            ));
        } else if is_plunger && stroke > 0.0 && stroke < 2e-5 {
            found.unusable.push(format!(
                "{} moves by {:.4} mm only: a wrong unit, or too quiet a programme",
                input.channel,
                stroke * 1e3
            ));
        }
    }
}

/// Inputs that leave, in held-out runs, what the open ones went through: nothing there was fitted.
fn goes_farther_held_out(case: &Case) -> Vec<String> {
    let words = |(i, input): (usize, &InputSpec)| {
        let values = |is_held_out: bool| -> Vec<f64> {
            let runs = case.runs.iter().filter(|run| run.is_held_out == is_held_out);
            runs.flat_map(|run| run.drive.inputs[i][run.lead_in..].iter().copied()).collect()
        };
        let ([low, high], [lowest, highest]) = (ends(&values(false)).into(), ends(&values(true)).into());
        let beyond = FARTHER * (high - low);
        let (to, end) = match (lowest < low - beyond, highest > high + beyond) {
            (true, _) => (lowest, low),
            (false, true) => (highest, high),
            (false, false) => return None,
        };
        let unit = parse_column(&input.channel).ok()?.unit;
        Some(format!(
            "{}: goes to {:.4} where it is held out, and to {:.4} where it is fitted: the held-out error there says how the answer extrapolates",
            input.channel,
            unit.from_si(to),
            unit.from_si(end)
        ))
    };
    case.scene.file.input.iter().enumerate().filter_map(words).collect()
}

fn channels(case: &Case, found: &mut Preflight) {
    for (c, channel) in case.channels.iter().enumerate() {
        let values: Vec<f64> =
            case.runs.iter().flat_map(|r| r.measured[c].iter().copied()).filter(|v| v.is_finite()).collect();
        let (low, high) = ends(&values);
        if values.is_empty() {
            found.unusable.push(format!(
                "{}: no value was recorded in any run; record it in one, or take the channel out of recordings.toml",
                channel.column
            ));
        } else if high <= low {
            found.unusable.push(format!("{}: constant at {low}; the sensor was off or saturated", channel.column));
        } else {
            let at = |end: f64| values.iter().filter(|v| **v == end).count() as f64 / values.len() as f64;
            if at(low).max(at(high)) > SATURATED_SHARE {
                found.warnings.push(format!(
                    "{}: {:.0} % of its samples stand at one end value: saturated?",
                    channel.column,
                    100.0 * at(low).max(at(high))
                ));
            }
        }
    }
}

/// A channel with a spread below this many noise standard deviations shows only noise, and nothing about units.
const NOISE_ALONE: f64 = 3.0;

/// Compares each channel's spread with that of the scene as it stands.
fn scales(case: &Case, problem: &Problem, found: &mut Preflight) -> Result<(), SystemError> {
    let model = Model::baseline();
    let start = problem.start(&model, None);
    let Some(residuals) = problem.residuals(&model, &start) else {
        refuse_faulty_law(case)?;
        found.unusable.push("the scene cannot follow the recorded inputs: it diverges".to_owned());
        return Ok(());
    };
    for (c, channel) in case.channels.iter().enumerate() {
        let mut measured = Vec::new();
        let mut simulated = Vec::new();
        for (run, residual) in problem.runs.iter().zip(&residuals) {
            for (m, r) in run.measured[c].iter().zip(&residual[c]).filter(|(m, r)| m.is_finite() && r.is_finite()) {
                measured.push(*m);
                simulated.push(m - r);
            }
        }
        let noise = problem.runs.iter().filter_map(|r| noise_sd(r.times_s(), &r.measured[c])).fold(0.0, f64::max);
        // A scene whose calibrated parameters all start at zero shows nothing to compare with.
        if spread(&measured) < NOISE_ALONE * noise || spread(&simulated) < 1e-9 * spread(&measured) {
            continue;
        }
        let ratio = spread(&measured) / spread(&simulated).max(f64::MIN_POSITIVE);
        let correlation = correlation(&measured, &simulated);
        let column = &channel.column;
        let by_size = unit_by_size(column, ratio);
        if let Some(BySize::Wrong(words)) = by_size {
            found.unusable.push(words);
        } else if correlation < -0.8 {
            found.unusable.push(format!("{column}: runs against the scene: sign or channel swapped?"));
        } else if correlation < 0.3 {
            found
                .warnings
                .push(format!("{column}: hardly follows the scene (correlation {correlation:.2}): channels swapped?"));
        } else {
            if let Some(BySize::Odd(words)) = by_size {
                found.warnings.push(words);
            }
            found.warnings.extend(has_other_zero(problem, &residuals, c));
        }
    }
    Ok(())
}

/// That a channel counts from another zero than the scene, by the runs that begin with their inputs at zero.
fn has_other_zero(problem: &Problem, residuals: &[Vec<Vec<f64>>], channel: usize) -> Option<String> {
    let own = &problem.case.channels[channel];
    let at_zero = problem.runs.iter().zip(residuals).filter(|(run, _)| run.lead_in == 0);
    let begun = at_zero.map(|(run, residual)| Begun {
        times_s: run.times_s(),
        measured: &run.measured[channel],
        simulated: run.measured[channel].iter().zip(&residual[channel]).map(|(m, r)| m - r).collect(),
    });
    let is_place = problem.case.scene.file.output[own.output].quantity.is_place();
    other_zero(&own.column, is_place, &begun.collect::<Vec<_>>())
}

/// If a law of the scene has no value somewhere, the law is wrong and not the recordings: the full scene tells which,
/// and when.
fn refuse_faulty_law(case: &Case) -> Result<(), SystemError> {
    let at_fault = case.runs.iter().filter(|run| !run.scene.laws.is_empty()).find_map(|run| played(run).err());
    at_fault.filter(|error| matches!(error, SystemError::Law { .. })).map_or(Ok(()), Err)
}

fn played(run: &CaseRun) -> Result<(), SystemError> {
    let mut simulation = Simulation::new(Scene::clone(&run.scene))?;
    for (input, values) in run.scene.file.input.iter().zip(&run.drive.inputs) {
        if let Some(line) = PiecewiseLinear::new(run.times_s(), values) {
            simulation.set_input(&input.channel, InputSource::Recorded(line));
        }
    }
    record(&mut simulation, &Schedule::at(run.times_s().to_vec())).map(drop)
}

fn ends(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::case::made;

    #[test]
    fn a_held_out_run_that_goes_farther_is_said_in_the_unit_of_its_column() {
        let mut case = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        assert!(case.runs.iter().any(|run| run.is_held_out) && goes_farther_held_out(&case).is_empty());
        let open = case.runs.iter().filter(|run| !run.is_held_out).flat_map(|run| &run.drive.inputs[0]);
        let (low, high) = open.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        let held_out = case.runs.iter_mut().find(|run| run.is_held_out).expect("one is held out");
        let last = held_out.drive.inputs[0].last_mut().expect("samples");
        *last = high + 0.2 * (high - low);
        let said = goes_farther_held_out(&case);
        let expected = format!("plunger_mm: goes to {:.4} where it is held out", 1e3 * (high + 0.2 * (high - low)));
        assert!(said.len() == 1 && said[0].starts_with(&expected), "{said:?} {expected}");
    }
}
