//! Step 8: the programme that would tell best what stays open, within the strokes and speeds that were recorded.

use std::borrow::Cow;

use super::answer::NextExperiment;
use super::case::{Case, CaseChannel, CaseRun};
use super::fit::{Fit, Problem};
use super::model::{Sides, simulate};
use super::noise::Noise;
use super::programme::{Stroke, chirp, held, sample, sine, strokes};
use super::search::title;
use crate::recording::{Recording, RecordingError};
use crate::system::TwinRun;

/// Length of a proposed run, s.
const DURATION_S: f64 = 60.0;
/// Separation from which an experiment settles a question, standard errors.
const SETTLES: f64 = 5.0;
/// An added sensor is worth a word when it multiplies the separation by this.
const SENSOR_WORTH: f64 = 1.5;
/// Noise that sensors have who knows nothing better, by unit of their column.
const TYPICAL_NOISE: [(&str, f64); 4] = [("_mm", 0.02), ("_kpa", 5.0), ("_deg", 0.15), ("_n", 0.02)];

/// A proposal with the inputs to play.
pub struct Experiment {
    pub next: NextExperiment,
    pub inputs: Option<Recording>,
}

/// One programme with what it would show.
struct Candidate {
    name: &'static str,
    inputs: Recording,
    run: CaseRun,
    separation: f64,
}

/// Ranks programmes by how far they would set two models apart beyond what either could imitate by its own numbers.
///
/// # Errors
/// Input columns without a known unit.
pub fn propose(
    case: &Case,
    noise: &[Noise],
    best: &Fit,
    rival: Option<&Fit>,
    is_open: bool,
) -> Result<Experiment, RecordingError> {
    let Some(rival) = rival else {
        let why = match best.model.effects.is_empty() {
            true => "nothing stays open that a rival could explain",
            false => "no other effect of the catalogue comes near",
        };
        return Ok(Experiment { next: NextExperiment::none(why), inputs: None });
    };
    let mut ranked = candidates(case, noise, best, rival)?;
    ranked.sort_by(|a, b| b.separation.total_cmp(&a.separation));
    let Some(winner) = ranked.into_iter().next() else {
        let why = "no programme within the recorded strokes can be simulated";
        return Ok(Experiment { next: NextExperiment::none(why), inputs: None });
    };
    let sensor = best_sensor(case, noise, best, rival, &winner);
    let next = NextExperiment {
        why: why(&winner, best, rival, is_open, sensor.as_ref()),
        file: Some("next_experiment.csv".to_owned()),
        separation_sigma: winner.separation,
        sensor: sensor.map(|(column, _)| column),
    };
    Ok(Experiment { next, inputs: Some(winner.inputs) })
}

fn why(winner: &Candidate, best: &Fit, rival: &Fit, is_open: bool, sensor: Option<&(String, f64)>) -> String {
    let (best, rival, sigma) = (title(&best.model), title(&rival.model), winner.separation);
    let open = match is_open {
        true => format!("{best} and {rival} explain these recordings about equally well"),
        false => format!("{best} is settled; the nearest rival is {rival}"),
    };
    let would = match sigma > SETTLES {
        true => format!("{} would set them {sigma:.1} standard errors apart", winner.name),
        false => format!("even {} would set them only {sigma:.1} standard errors apart", winner.name),
    };
    let sensor = sensor.map_or(String::new(), |(column, s)| format!("; with {column} recorded as well, {s:.1}"));
    format!("{open}; {would}{sensor}")
}

/// All programmes with their separation; one that cannot be simulated is left out.
fn candidates(case: &Case, noise: &[Noise], best: &Fit, rival: &Fit) -> Result<Vec<Candidate>, RecordingError> {
    let inputs = recorded_inputs(case);
    let strokes = strokes(&inputs);
    let fast_hz = fastest_hz(case, &strokes);
    let mut list = Vec::new();
    for (name, inputs) in programmes(&strokes, fast_hz)? {
        let Some(run) = play(case, noise, best, &inputs)? else { continue };
        let Some(separation) = separation(case, noise, best, rival, &run) else { continue };
        list.push(Candidate { name, inputs, run, separation });
    }
    Ok(list)
}

fn programmes(strokes: &[Stroke], fast_hz: f64) -> Result<Vec<(&'static str, Recording)>, RecordingError> {
    let levels =
        [[0.2, 0.9, 0.5, 1.0, 0.1, 0.7, 0.3, 0.8, 0.0, 0.6], [0.7, 0.3, 0.8, 0.0, 0.6, 0.2, 0.9, 0.5, 1.0, 0.1]];
    let rate = |own: usize| [1.0, 0.7][own];
    let grown = |t: f64, own: usize| (t / DURATION_S) * sine(t, 0.2 * rate(own));
    Ok(vec![
        ("a slow sine over the whole stroke", sample(strokes, DURATION_S, |t, own| sine(t, 0.05 * rate(own)))?),
        ("a fast sine over the whole stroke", sample(strokes, DURATION_S, |t, own| sine(t, fast_hz * rate(own)))?),
        ("levels held for six seconds", sample(strokes, DURATION_S, |t, own| held(&levels[own], t))?),
        ("one level held for a minute", sample(strokes, DURATION_S, |t, _| held(&[0.95], t))?),
        ("loops that grow from nothing to the whole stroke", sample(strokes, DURATION_S, grown)?),
        ("a chirp", sample(strokes, DURATION_S, |t, own| chirp(t, 0.04 * rate(own), fast_hz * rate(own), DURATION_S))?),
    ])
}

/// All inputs of all runs, one after the other.
fn recorded_inputs(case: &Case) -> Vec<(String, Vec<f64>)> {
    let all = |i: usize| case.runs.iter().flat_map(|r| r.drive.inputs[i].iter().copied()).collect();
    case.scene.file.input.iter().enumerate().map(|(i, input)| (input.channel.clone(), all(i))).collect()
}

/// The frequency at which a sine over the whole stroke is as fast as the fastest that was recorded; at most 1 Hz.
fn fastest_hz(case: &Case, strokes: &[Stroke]) -> f64 {
    let of = |(i, stroke): (usize, &Stroke)| {
        let speeds = case.runs.iter().flat_map(|r| {
            let samples = r.drive.inputs[i].windows(2).zip(r.drive.times_s.windows(2));
            samples.map(|(x, t)| ((x[1] - x[0]) / (t[1] - t[0])).abs())
        });
        speeds.fold(0.0, f64::max) / (std::f64::consts::PI * (stroke.high - stroke.low).max(f64::MIN_POSITIVE))
    };
    strokes.iter().enumerate().map(of).fold(1.0, f64::min).max(0.05)
}

/// The run that the best model would give; its rig is that of the first recorded one. `None` when it diverges.
fn play(case: &Case, noise: &[Noise], best: &Fit, inputs: &Recording) -> Result<Option<CaseRun>, RecordingError> {
    let mut series = Vec::new();
    for input in &case.scene.file.input {
        series.push(inputs.si(&input.channel)?);
    }
    let drive = TwinRun { times_s: inputs.time_s().to_vec(), inputs: series, plan: None };
    let mut alone = case.clone();
    let blank = vec![vec![f64::NAN; drive.times_s.len()]; case.channels.len()];
    alone.runs.truncate(1);
    let Some(run) = alone.runs.first_mut() else { return Ok(None) };
    (run.drive, run.lead_in, run.measured, run.open_part) = (drive, 0, blank, None);
    let setting = best.model.setting(case, &best.x);
    Ok(alone.plan_steps(&setting, noise).and_then(|()| alone.runs.pop()))
}

/// Distance between two models on a run in standard errors, what the best could imitate by other numbers taken off.
fn separation(case: &Case, noise: &[Noise], best: &Fit, rival: &Fit, run: &CaseRun) -> Option<f64> {
    let mut run = run.clone();
    run.measured = simulate(case, &run, &rival.model, &rival.x)?;
    let problem = Problem { case, runs: vec![Cow::Owned(run)], noise };
    let rows = problem.rows(&best.model, &best.x, 0..best.x.len(), Sides::One)?;
    let basis = rows.slopes.qr().q();
    Some((&rows.residual - &basis * basis.tr_mul(&rows.residual)).norm())
}

/// The output of the scene that was not recorded and would help most, with the separation that it brings.
fn best_sensor(case: &Case, noise: &[Noise], best: &Fit, rival: &Fit, winner: &Candidate) -> Option<(String, f64)> {
    let mut found: Option<(String, f64)> = None;
    for (output, spec) in case.scene.file.output.iter().enumerate() {
        let sd = TYPICAL_NOISE.iter().find(|(unit, _)| spec.channel.ends_with(unit)).map(|(_, sd)| *sd);
        let Some(sd) = sd.filter(|_| case.channels.iter().all(|c| c.output != output)) else { continue };
        let mut wider = case.clone();
        let (column, has_free_zero) = (spec.channel.clone(), spec.counts_from_start);
        wider.channels.push(CaseChannel { column, output, stated_sd: Some(sd), has_free_zero });
        let mut run = winner.run.clone();
        run.measured.push(vec![f64::NAN; run.drive.times_s.len()]);
        let noise: Vec<Noise> = noise.iter().copied().chain([Noise::white(sd)]).collect();
        let Some(separation) = separation(&wider, &noise, best, rival, &run) else { continue };
        if separation > SENSOR_WORTH * winner.separation && found.as_ref().is_none_or(|(_, s)| separation > *s) {
            found = Some((spec.channel.clone(), separation));
        }
    }
    found
}
