//! The input trajectory that discriminates best between open alternatives, within recorded strokes and speeds.

use super::discrimination::{Foreseen, More, Question};
use super::programme::{INTERVAL_S, Stroke, chirp, held, sample, sine, strokes};
use crate::diagnose::case::{Case, CaseRun, Noise};
use crate::diagnose::diagnosis::NextExperiment;
use crate::diagnose::fit::{Fit, Problem};
use crate::parallel;
use crate::recording::{Recording, RecordingError};
use crate::system::RomRun;

/// Length of a proposed run, s.
pub(super) const DURATION_S: f64 = 60.0;
/// Share of the stroke that counts as its end: effects near rest, or at the far end only, show there.
const END: f64 = 0.15;

/// A proposal with the inputs to play.
pub struct Experiment {
    pub next: NextExperiment,
    pub inputs: Option<Recording>,
}

/// One trajectory with its predicted separation.
pub(super) struct Candidate {
    pub name: &'static str,
    inputs: Recording,
    pub foreseen: Foreseen,
}

impl Candidate {
    fn words(&self) -> String {
        let seconds = self.inputs.time_s().len() as f64 * INTERVAL_S;
        if seconds > DURATION_S { format!("{seconds:.0} s of {}", self.name) } else { self.name.to_owned() }
    }
}

/// The trajectory that best separates the answer from its closest alternative, for answers that are not ambiguous.
/// `leaves_a_part`: no trajectory settles an answer that does not explain the recordings.
///
/// # Errors
/// Input columns without a known unit.
pub fn confirm<'a>(
    whole: &Problem,
    best: &Fit,
    rivals: impl Iterator<Item = &'a Fit>,
    leaves_a_part: bool,
) -> Result<Experiment, RecordingError> {
    // Another law under the same name would be the same answer.
    let own_title = best.model.title();
    let others = rivals.filter(|rival| rival.model.title() != own_title);
    let Some(nearest) = others.min_by(|a, b| a.cost.total_cmp(&b.cost)) else {
        let why = match best.model.effects.is_empty() {
            true if leaves_a_part => {
                "nothing that is known here explains what is left, so no run decides anything: look where it is located"
            }
            true => "nothing stays open that a rival could explain",
            false => "no other effect of the catalogue comes near",
        };
        return Ok(Experiment { next: NextExperiment::none(why), inputs: None });
    };
    let question = Question::of_nearest(whole, best, nearest);
    let mut programmes = candidates(whole, best, &question, DURATION_S, |i, _| i < USUAL)?;
    let Some((at, promise)) = first(&question, &programmes) else { return Ok(none_to_play()) };
    let winner = programmes.swap_remove(at);
    let sensor = best_sensor(&question, std::slice::from_ref(&winner), promise.sigma);
    let standing = if leaves_a_part { Standing::InPart } else { Standing::Settled };
    Ok(proposal(best, standing, (winner, promise), sensor))
}

/// How the answer stands to its nearest alternative.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Standing {
    /// Both explain the recordings.
    Open,
    Settled,
    /// It is ahead, and explains the recordings in part.
    InPart,
}

/// Least separation, and the alternative that has it.
#[derive(Clone, Copy)]
pub(super) struct Promise<'a> {
    pub sigma: f64,
    rival: &'a Fit,
}

/// The trajectory with the greatest separation.
pub(super) fn first<'a>(question: &Question<'a>, programmes: &[Candidate]) -> Option<(usize, Promise<'a>)> {
    let promised = |(at, c): (usize, &Candidate)| {
        let (sigma, rival) = question.least(&c.foreseen, More::Nothing)?;
        Some((at, Promise { sigma, rival }))
    };
    // Of equal ones the first.
    let all = programmes.iter().enumerate().filter_map(promised);
    all.rev().max_by(|(_, a), (_, b)| a.sigma.total_cmp(&b.sigma))
}

/// Trajectories of every proposal; the others look closely at the ends of the stroke.
const USUAL: usize = 6;

pub(super) fn none_to_play() -> Experiment {
    let why = "no programme within the recorded strokes can be simulated";
    Experiment { next: NextExperiment::none(why), inputs: None }
}

pub(super) fn proposal(
    best: &Fit,
    standing: Standing,
    (winner, promise): (Candidate, Promise),
    sensor: Option<Sensed>,
) -> Experiment {
    let [of_best, of_rival] = [best.model.title(), promise.rival.model.title()];
    let question = match standing {
        Standing::Open => format!("{of_best} and {of_rival} explain these recordings about equally well"),
        Standing::Settled => format!("{of_best} is settled; the nearest rival is {of_rival}"),
        Standing::InPart => format!("{of_best} comes nearer than {of_rival}, and neither explains the recordings"),
    };
    let (sensor, sensor_sigma) = sensor.map(|s| (s.column, s.sigma)).unzip();
    let mut next = NextExperiment {
        why: String::new(),
        file: Some("next_experiment.csv".to_owned()),
        separation_sigma: promise.sigma,
        programme: Some(winner.words()),
        between: Some([of_best, of_rival]),
        sensor,
        sensor_sigma,
    };
    let said = [Some(question), next.promise(), next.sensor_promise()];
    next.why = said.into_iter().flatten().collect::<Vec<_>>().join("; ");
    Experiment { next, inputs: Some(winner.inputs) }
}

/// Trajectories of a duration that are `wanted` by place and name, with their predicted separation; those that diverge
/// are skipped.
pub(super) fn candidates(
    whole: &Problem,
    best: &Fit,
    question: &Question,
    duration_s: f64,
    wanted: impl Fn(usize, &str) -> bool,
) -> Result<Vec<Candidate>, RecordingError> {
    let case = whole.case;
    let inputs = recorded_inputs(case);
    let strokes = strokes(&inputs);
    let programmes = programmes(&strokes, fastest_hz(case, &strokes), duration_s)?;
    let candidate = |(name, inputs): &(&'static str, Recording)| -> Result<Option<Candidate>, RecordingError> {
        let run = play(case, whole.noise, best, inputs)?;
        let foreseen = run.and_then(|run| question.foresee(&run));
        Ok(foreseen.map(|foreseen| Candidate { name, inputs: inputs.clone(), foreseen }))
    };
    let wanted = programmes.into_iter().enumerate().filter(|(i, (name, _))| wanted(*i, name));
    let wanted: Vec<_> = wanted.map(|(_, programme)| programme).collect();
    let all: Vec<_> = parallel::map(&wanted, candidate).into_iter().collect::<Result<_, _>>()?;
    Ok(all.into_iter().flatten().collect())
}

/// Trajectories of a duration, the usual ones first.
fn programmes(
    strokes: &[Stroke],
    fast_hz: f64,
    duration_s: f64,
) -> Result<Vec<(&'static str, Recording)>, RecordingError> {
    let levels =
        [[0.2, 0.9, 0.5, 1.0, 0.1, 0.7, 0.3, 0.8, 0.0, 0.6], [0.7, 0.3, 0.8, 0.0, 0.6, 0.2, 0.9, 0.5, 1.0, 0.1]];
    let minutes = (duration_s / DURATION_S).ceil() as usize;
    let levels = levels.map(|levels| levels.repeat(minutes));
    let rate = |own: usize| [1.0, 0.7][own];
    let grown = |t: f64, own: usize| (t / duration_s) * sine(t, 0.2 * rate(own));
    let swept = |t: f64, own: usize| chirp(t, 0.04 * rate(own), fast_hz * rate(own), duration_s);
    let played = |wave: &dyn Fn(f64, usize) -> f64| sample(strokes, duration_s, wave);
    Ok(vec![
        ("a slow sine over the whole stroke", played(&|t, own| sine(t, 0.05 * rate(own)))?),
        ("a fast sine over the whole stroke", played(&|t, own| sine(t, fast_hz * rate(own)))?),
        ("levels held for six seconds", played(&|t, own| held(&levels[own], t))?),
        (if minutes > 1 { "one level held" } else { "one level held for a minute" }, played(&|t, _| held(&[0.95], t))?),
        ("loops that grow from nothing to the whole stroke", played(&grown)?),
        ("a chirp", played(&swept)?),
        ("small steps near rest", played(&|t, own| END * held(&levels[own], t))?),
        ("a slow sine near rest", played(&|t, own| END * sine(t, 0.1 * rate(own)))?),
        ("a slow sine near the far end", played(&|t, own| 1.0 - END * sine(t, 0.1 * rate(own)))?),
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
            // The way from zero to where the recording begins was not recorded.
            let samples = r.drive.inputs[i][r.lead_in..].windows(2).zip(r.drive.times_s[r.lead_in..].windows(2));
            samples.map(|(x, t)| ((x[1] - x[0]) / (t[1] - t[0])).abs())
        });
        speeds.fold(0.0, f64::max) / (std::f64::consts::PI * (stroke.high - stroke.low))
    };
    // What never moves limits nothing.
    let moved = strokes.iter().enumerate().filter(|(_, s)| s.high > s.low);
    moved.map(of).fold(1.0, f64::min).max(0.05)
}

/// The run predicted by the best model, with the rig of the first recorded one. `None` if it diverges.
fn play(case: &Case, noise: &[Noise], best: &Fit, inputs: &Recording) -> Result<Option<CaseRun>, RecordingError> {
    let mut series = Vec::new();
    for input in &case.scene.file.input {
        series.push(inputs.si(&input.channel)?);
    }
    let drive = RomRun { times_s: inputs.time_s().to_vec(), inputs: series, plan: None };
    let mut alone = case.clone();
    let blank = vec![vec![f64::NAN; drive.times_s.len()]; case.channels.len()];
    alone.runs.truncate(1);
    let Some(run) = alone.runs.first_mut() else { return Ok(None) };
    (run.drive, run.lead_in, run.measured, run.open_part) = (drive, 0, blank, None);
    let settings = best.model.settings(&alone, &best.x);
    Ok(alone.plan_steps(&settings, noise).and_then(|()| alone.runs.pop()))
}

/// An added sensor is worth naming if it multiplies the separation by this.
const SENSOR_WORTH: f64 = 1.5;

/// Benefit of one more sensor.
pub(super) struct Sensed {
    pub column: String,
    pub sigma: f64,
    /// Index of the trajectory to record with it.
    pub candidate: usize,
}

/// The best pair of sensor and trajectory, if worth a sensor: the trajectory alone separates by `alone_sigma`.
pub(super) fn best_sensor(question: &Question, programmes: &[Candidate], alone_sigma: f64) -> Option<Sensed> {
    let mut found: Option<Sensed> = None;
    for (candidate, programme) in programmes.iter().enumerate() {
        for (at, column) in question.sensors().enumerate() {
            let Some((sigma, _)) = question.least(&programme.foreseen, More::Sensor(at)) else { continue };
            if found.as_ref().is_none_or(|f| sigma > f.sigma) {
                found = Some(Sensed { column: column.to_owned(), sigma, candidate });
            }
        }
    }
    found.filter(|f| f.sigma > SENSOR_WORTH * alone_sigma)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programmes_stay_within_the_strokes_and_last_as_long_as_asked() {
        let moved = vec![1.0e-3, 4.0e-3, 2.5e-3];
        let strokes = strokes(&[("plunger_mm".to_owned(), moved)]);
        for duration_s in [DURATION_S, 300.0] {
            let programmes = programmes(&strokes, 0.5, duration_s).expect("a known unit");
            assert!(programmes.len() > USUAL);
            for (name, inputs) in programmes {
                let plunger_mm = &inputs.channel("plunger_mm").expect("the input").values;
                assert_eq!(plunger_mm.len(), (duration_s / INTERVAL_S) as usize, "{name}");
                assert!(plunger_mm.iter().all(|x| (-1e-9..=4.0 + 1e-9).contains(x)), "{name}");
                // Moving to the end, not only through its first minute.
                let last = &plunger_mm[plunger_mm.len() - 2000..];
                let range = crate::recording::figures::range(last);
                assert!(range > 0.1 || name.starts_with("one level"), "{name} rests over its last 20 s");
            }
        }
    }
}
