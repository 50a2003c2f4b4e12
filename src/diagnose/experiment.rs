//! Step 8: the programme that would tell best what stays open, within the strokes and speeds that were recorded.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use super::answer::NextExperiment;
use super::case::{Case, CaseChannel, CaseRun};
use super::fit::{Fit, Problem};
use super::model::{Sides, simulate};
use super::noise::Noise;
use super::normal::Rows;
use super::programme::{INTERVAL_S, Stroke, chirp, held, sample, sine, strokes};
use super::search::title;
use super::verdict::Open;
use crate::recording::{Recording, RecordingError};
use crate::system::TwinRun;

/// Length of a proposed run, s.
const DURATION_S: f64 = 60.0;
/// And of those that may be tried where shorter ones would not settle what is open, s.
const LONGER_S: [f64; 2] = [180.0, 300.0];
/// Separation from which an experiment settles a question, standard errors.
const SETTLES: f64 = 5.0;
/// Share of the stroke that is its end: where what acts near rest, or at the far end alone, shows itself.
const END: f64 = 0.15;
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
struct Candidate<'a> {
    name: &'static str,
    inputs: Recording,
    run: CaseRun,
    separation: f64,
    /// The rival that it sets apart least.
    rival: &'a Fit,
}

/// The programme that would set the nearest of the rivals apart best, where nothing is open.
///
/// # Errors
/// Input columns without a known unit.
pub fn confirm<'a>(
    whole: &Problem,
    best: &Fit,
    rivals: impl Iterator<Item = &'a Fit>,
) -> Result<Experiment, RecordingError> {
    let Some(nearest) = rivals.min_by(|a, b| a.cost.total_cmp(&b.cost)) else {
        let why = match best.model.effects.is_empty() {
            true => "nothing stays open that a rival could explain",
            false => "no other effect of the catalogue comes near",
        };
        return Ok(Experiment { next: NextExperiment::none(why), inputs: None });
    };
    let (case, noise) = (whole.case, whole.noise);
    let apart = |run: &CaseRun| Some((separation(case, noise, best, nearest, run)?, nearest));
    propose(whole, best, (USUAL, DURATION_S), false, apart)
}

/// The programme that would set apart the answer and all rivals that stand beside it: that whose least separation is
/// greatest, counted with the recordings that there are. A minute long, or longer where that settles what a minute would not.
///
/// # Errors
/// Input columns without a known unit.
pub fn settle<'a>(whole: &Problem, best: &'a Fit, open: &Open<'a>) -> Result<Experiment, RecordingError> {
    let known = Known::of(whole, best, open);
    let apart = |run: &CaseRun| known.as_ref()?.least_separation(whole, best, open, run);
    let minute = propose(whole, best, (ALL, DURATION_S), true, apart)?;
    if minute.next.separation_sigma > SETTLES {
        return Ok(minute);
    }
    for duration_s in LONGER_S {
        let longer = propose(whole, best, (ALL, duration_s), true, apart)?;
        if longer.next.separation_sigma > SETTLES {
            return Ok(longer);
        }
    }
    // What would not do either is not worth the time.
    Ok(minute)
}

/// Programmes that every proposal looks at, and those that look closely at the ends of the stroke as well.
const USUAL: usize = 6;
const ALL: usize = usize::MAX;

/// Ranks programmes by how far they set the best apart from a rival, which `apart` names.
fn propose<'a>(
    whole: &Problem,
    best: &Fit,
    (most, duration_s): (usize, f64),
    is_open: bool,
    apart: impl Fn(&CaseRun) -> Option<(f64, &'a Fit)>,
) -> Result<Experiment, RecordingError> {
    let (case, noise) = (whole.case, whole.noise);
    let mut ranked = candidates(case, noise, best, (most, duration_s), apart)?;
    ranked.sort_by(|a, b| b.separation.total_cmp(&a.separation));
    let Some(winner) = ranked.into_iter().next() else {
        let why = "no programme within the recorded strokes can be simulated";
        return Ok(Experiment { next: NextExperiment::none(why), inputs: None });
    };
    let sensor = best_sensor(case, noise, best, &winner);
    let next = NextExperiment {
        why: why(&winner, best, is_open, sensor.as_ref()),
        file: Some("next_experiment.csv".to_owned()),
        separation_sigma: winner.separation,
        sensor: sensor.map(|(column, _)| column),
    };
    Ok(Experiment { next, inputs: Some(winner.inputs) })
}

fn why(winner: &Candidate, best: &Fit, is_open: bool, sensor: Option<&(String, f64)>) -> String {
    let (best, rival, sigma) = (title(&best.model), title(&winner.rival.model), winner.separation);
    let open = match is_open {
        true => format!("{best} and {rival} explain these recordings about equally well"),
        false => format!("{best} is settled; the nearest rival is {rival}"),
    };
    let seconds = winner.inputs.time_s().len() as f64 * INTERVAL_S;
    let programme = match seconds > DURATION_S {
        true => format!("{seconds:.0} s of {}", winner.name),
        false => winner.name.to_owned(),
    };
    let would = match sigma > SETTLES {
        true => format!("{programme} would set them {sigma:.1} standard errors apart"),
        false => format!("even {programme} would set them only {sigma:.1} standard errors apart"),
    };
    let sensor = sensor.map_or(String::new(), |(column, s)| format!("; with {column} recorded as well, {s:.1}"));
    format!("{open}; {would}{sensor}")
}

/// The first `most` programmes with their separation; one that cannot be simulated is left out.
fn candidates<'a>(
    case: &Case,
    noise: &[Noise],
    best: &Fit,
    (most, duration_s): (usize, f64),
    apart: impl Fn(&CaseRun) -> Option<(f64, &'a Fit)>,
) -> Result<Vec<Candidate<'a>>, RecordingError> {
    let inputs = recorded_inputs(case);
    let strokes = strokes(&inputs);
    let fast_hz = fastest_hz(case, &strokes);
    let mut list = Vec::new();
    for (name, inputs) in programmes(&strokes, fast_hz, duration_s)?.into_iter().take(most) {
        let Some(run) = play(case, noise, best, &inputs)? else { continue };
        let Some((separation, rival)) = apart(&run) else { continue };
        list.push(Candidate { name, inputs, run, separation, rival });
    }
    Ok(list)
}

/// Programmes of a duration, the usual ones first.
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
    let alone = Problem { case, runs: Vec::new(), noise };
    Some(beyond(played(&alone, best, rival, run)?))
}

/// What a run would show if a rival were true: residuals of the best, and the derivatives to its numbers.
fn played(problem: &Problem, best: &Fit, rival: &Fit, run: &CaseRun) -> Option<Rows> {
    let (case, noise) = (problem.case, problem.noise);
    let mut run = run.clone();
    run.measured = simulate(case, &run, &rival.model, &rival.x)?;
    let problem = Problem { case, runs: vec![Cow::Owned(run)], noise };
    problem.rows(&best.model, &best.x, 0..best.x.len(), Sides::One)
}

/// Length of the residual less what the slopes can make of it.
fn beyond(rows: Rows) -> f64 {
    let basis = rows.slopes.qr().q();
    (&rows.residual - &basis * basis.tr_mul(&rows.residual)).norm()
}

/// What the recordings that there are say about the difference between the best and its rivals.
struct Known {
    /// Derivatives to the best's numbers, sample by sample.
    slopes: DMatrix<f64>,
    /// Rival minus best, of each rival.
    apart: Vec<DVector<f64>>,
}

impl Known {
    fn of(whole: &Problem, best: &Fit, open: &Open) -> Option<Self> {
        let rows = whole.rows(&best.model, &best.x, 0..best.x.len(), Sides::One)?;
        let of = |rival: &&Fit| Some(&rows.residual - whole.weighted_residual(&rival.model, &rival.x)?);
        let apart = open.rivals.iter().map(of).collect::<Option<Vec<_>>>()?;
        Some(Self { slopes: rows.slopes, apart })
    }

    /// Distance in standard errors from the rival that a run sets apart least, after the best's numbers have been fitted to
    /// that rival on all there would then be.
    fn least_separation<'a>(
        &self,
        whole: &Problem,
        best: &Fit,
        open: &Open<'a>,
        run: &CaseRun,
    ) -> Option<(f64, &'a Fit)> {
        let mut least: Option<(f64, &'a Fit)> = None;
        for (rival, known) in open.rivals.iter().zip(&self.apart) {
            let rows = played(whole, best, rival, run)?;
            let all = Rows::stack(&[Rows { slopes: self.slopes.clone(), residual: known.clone() }, rows])?;
            let separation = beyond(all) / open.unit.sqrt();
            if least.is_none_or(|(s, _)| separation < s) {
                least = Some((separation, *rival));
            }
        }
        least
    }
}

/// The output of the scene that was not recorded and would help most, with the separation that it brings.
fn best_sensor(case: &Case, noise: &[Noise], best: &Fit, winner: &Candidate) -> Option<(String, f64)> {
    let mut found: Option<(String, f64)> = None;
    let without = separation(case, noise, best, winner.rival, &winner.run)?;
    for (output, spec) in case.scene.file.output.iter().enumerate() {
        let sd = TYPICAL_NOISE.iter().find(|(unit, _)| spec.channel.ends_with(unit)).map(|(_, sd)| *sd);
        let Some(sd) = sd.filter(|_| case.channels.iter().all(|c| c.output != output)) else { continue };
        let mut wider = case.clone();
        let (column, has_free_zero) = (spec.channel.clone(), spec.counts_from_start);
        wider.channels.push(CaseChannel { column, output, stated_sd: Some(sd), has_free_zero });
        let mut run = winner.run.clone();
        run.measured.push(vec![f64::NAN; run.drive.times_s.len()]);
        let noise: Vec<Noise> = noise.iter().copied().chain([Noise::white(sd)]).collect();
        let Some(with) = separation(&wider, &noise, best, winner.rival, &run) else { continue };
        let separation = winner.separation * (with / without);
        if separation > SENSOR_WORTH * winner.separation && found.as_ref().is_none_or(|(_, s)| separation > *s) {
            found = Some((spec.channel.clone(), separation));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programmes_stay_within_the_strokes_and_last_as_long_as_asked() {
        let moved = vec![1.0e-3, 4.0e-3, 2.5e-3];
        let strokes = strokes(&[("plunger_mm".to_owned(), moved)]);
        for duration_s in [DURATION_S, LONGER_S[0], LONGER_S[1]] {
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

    #[test]
    fn what_the_best_can_imitate_separates_nothing() {
        let slopes = DMatrix::from_column_slice(4, 1, &[1.0, 1.0, 0.0, 0.0]);
        let rows = |residual: [f64; 4]| Rows { slopes: slopes.clone(), residual: DVector::from_row_slice(&residual) };
        assert!(beyond(rows([2.0, 2.0, 0.0, 0.0])) < 1e-12);
        assert!((beyond(rows([2.0, 2.0, 3.0, 4.0])) - 5.0).abs() < 1e-12);
    }
}
