//! Step 8 for an ambiguous answer: what would settle it, programme and sensor together.

use super::answer::{NextExperiment, SETTLES_SIGMA};
use super::apart::{Known, with_every_sensor};
use super::case::CaseRun;
use super::experiment::{
    ALL, Apart, Candidate, DURATION_S, Experiment, Sensed, best_sensor, none_to_play, playable, proposal, ranked,
};
use super::fit::{Fit, Problem};
use super::search::title;
use super::verdict::Open;
use crate::recording::RecordingError;

/// Durations that are looked at, one after the other, until one is sure to settle what is open, s.
const DURATIONS_S: [f64; 3] = [DURATION_S, 180.0, 300.0];
/// Separation to aim at, standard errors: laws are idealisations, and what just settles on paper often does not on a rig.
const SURE_SIGMA: f64 = 2.0 * SETTLES_SIGMA;

/// The programme that would set apart the answer and all rivals that stand beside it: that whose least separation is
/// greatest, counted with the recordings that there are. A minute long, or longer where that is surer; where none is sure
/// to do, the programme and the sensor that together would.
///
/// # Errors
/// Input columns without a known unit.
pub fn settle<'a>(whole: &Problem, best: &'a Fit, open: &Open<'a>) -> Result<Experiment, RecordingError> {
    let (open, alike) = &told_apart(whole, best, open)?;
    let untold = (!alike.is_empty()).then(|| untold(alike));
    if let Some(untold) = untold.as_ref().filter(|_| open.rivals.is_empty()) {
        let why = format!("{} explains these recordings as well as others do, and {untold}", title(&best.model));
        return Ok(Experiment { next: NextExperiment::none(&why), inputs: None });
    }
    let mut experiment = settle_what_can_be(whole, best, open)?;
    experiment.next.why.extend(untold.map(|untold| format!("; {untold}")));
    Ok(experiment)
}

fn untold(alike: &[&Fit]) -> String {
    let titles: Vec<String> = alike.iter().map(|fit| title(&fit.model)).collect();
    format!("nothing that can be played and recorded here tells it from {}", titles.join(", "))
}

/// Rivals that no programme of a minute sets apart by so much as this, in standard errors, every output of the scene recorded,
/// say the same here: five minutes would make little more than twice of it.
const ALIKE_SIGMA: f64 = 1.0;

/// What could be told from the best, and the rivals that say the same.
fn told_apart<'a>(whole: &Problem, best: &Fit, open: &Open<'a>) -> Result<(Open<'a>, Vec<&'a Fit>), RecordingError> {
    let (mut told, mut alike) = (Open { rivals: Vec::new(), unit: open.unit }, Vec::new());
    let Some(known) = Known::of(whole, best, open) else { return Ok((open.clone(), alike)) };
    let mut most = vec![0.0_f64; open.rivals.len()];
    for (_, _, run) in playable(whole, best, (ALL, DURATION_S))? {
        let seen = with_every_sensor(whole, &run, |problem, run| known.separations(problem, best, open, run));
        most.iter_mut().zip(seen.unwrap_or_default()).for_each(|(most, seen)| *most = most.max(seen));
    }
    for (rival, most) in open.rivals.iter().zip(most) {
        if most < ALIKE_SIGMA { alike.push(*rival) } else { told.rivals.push(*rival) }
    }
    Ok((told, alike))
}

fn settle_what_can_be<'a>(whole: &Problem, best: &'a Fit, open: &Open<'a>) -> Result<Experiment, RecordingError> {
    let known = Known::of(whole, best, open);
    let apart = |problem: &Problem, run: &CaseRun| known.as_ref()?.least_separation(problem, best, open, run);
    let mut tried = Vec::new();
    for duration_s in DURATIONS_S {
        let programmes = ranked(whole, best, (ALL, duration_s), &apart)?;
        let Some(first) = programmes.first() else { break };
        let is_sure = first.separation > SURE_SIGMA;
        tried.push(programmes);
        if is_sure {
            break;
        }
    }
    let Some(at) = surest(tried.iter().map(|programmes| programmes[0].separation)) else {
        return Ok(none_to_play());
    };
    if tried[at][0].separation > SURE_SIGMA {
        let winner = tried.swap_remove(at).swap_remove(0);
        let sensor = best_sensor(whole, std::slice::from_ref(&winner), &apart);
        return Ok(proposal(best, true, winner, sensor));
    }
    let by_itself = tried[at][0].separation;
    let sensed = sensed(whole, &tried, &apart).filter(|(_, _, sensor)| sensor.separation > by_itself);
    let (at, candidate, sensor) = sensed.map_or((at, 0, None), |(at, candidate, sensor)| (at, candidate, Some(sensor)));
    Ok(proposal(best, true, tried.swap_remove(at).swap_remove(candidate), sensor))
}

/// The first that is sure to settle; else the greatest that should; else the first.
fn surest(separations: impl Iterator<Item = f64>) -> Option<usize> {
    let all: Vec<f64> = separations.collect();
    let greatest = (0..all.len()).max_by(|a, b| all[*a].total_cmp(&all[*b]))?;
    let first_sure = all.iter().position(|s| *s > SURE_SIGMA);
    Some(first_sure.unwrap_or(if all[greatest] > SETTLES_SIGMA { greatest } else { 0 }))
}

/// The duration, the programme and the sensor that together set the best apart most, of programmes of a minute; longer,
/// if that is surer. None where no sensor is worth it.
fn sensed(whole: &Problem, tried: &[Vec<Candidate>], apart: &Apart) -> Option<(usize, usize, Sensed)> {
    let minute = best_sensor(whole, tried.first()?, apart)?;
    let name = tried[0][minute.candidate].name;
    let mut found = vec![(0, minute.candidate, minute)];
    for (at, ranked) in tried.iter().enumerate().skip(1) {
        if found.last().is_some_and(|(_, _, sensed)| sensed.separation > SURE_SIGMA) {
            break;
        }
        let Some(same) = ranked.iter().position(|c| c.name == name) else { continue };
        let sensed = best_sensor(whole, &ranked[same..=same], apart);
        found.extend(sensed.map(|sensed| (at, same, sensed)));
    }
    let at = surest(found.iter().map(|(_, _, sensed)| sensed.separation))?;
    Some(found.swap_remove(at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_that_is_sure_comes_first() {
        let chosen = |separations: &[f64]| surest(separations.iter().copied());
        assert_eq!(chosen(&[4.0, 12.0, 30.0]), Some(1));
        assert_eq!(chosen(&[6.0, 9.0, 8.0]), Some(1));
        // What would not do in five minutes either is not worth the time.
        assert_eq!(chosen(&[2.0, 3.0, 4.0]), Some(0));
        assert_eq!(chosen(&[]), None);
    }
}
