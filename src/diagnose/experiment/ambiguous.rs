//! For an ambiguous answer: the input trajectory, and the sensor if needed, that would decide.

use super::design::{
    Candidate, DURATION_S, Experiment, Promise, Sensed, Standing, best_sensor, candidates, first, none_to_play,
    proposal,
};
use super::discrimination::{More, Question};
use crate::diagnose::diagnosis::{NextExperiment, SETTLES_SIGMA};
use crate::diagnose::fit::{Fit, Problem};
use crate::diagnose::verdict::Open;
use crate::recording::RecordingError;

/// Durations tried one after the other until one is certain to decide, s.
const DURATIONS_S: [f64; 3] = [DURATION_S, 180.0, 300.0];
/// Number of one-minute trajectories that are also tried with longer durations.
const PLAYED_LONGER: usize = 3;
/// Separation to aim at, standard errors: what just decides on paper often does not on a rig, because of model
/// discrepancy.
const SURE_SIGMA: f64 = 2.0 * SETTLES_SIGMA;

/// The input trajectory with the greatest least separation between the answer and all open alternatives, existing
/// recordings included. One minute long, or longer if that is more certain; if none is certain to decide, the best pair
/// of trajectory and sensor.
///
/// # Errors
/// Input columns without a known unit.
pub fn settle<'a>(whole: &Problem, best: &'a Fit, open: &Open<'a>) -> Result<Experiment, RecordingError> {
    let Some(mut question) = Question::of_open(whole, best, open) else { return Ok(none_to_play()) };
    let minute = candidates(whole, best, &question, DURATION_S, |_, _| true)?;
    let alike = leave_out_alike(&mut question, &minute);
    let untold = (!alike.is_empty()).then(|| untold(&alike));
    if let Some(untold) = untold.as_ref().filter(|_| question.is_empty()) {
        let why = format!("{} explains these recordings as well as others do, and {untold}", best.model.title());
        return Ok(Experiment { next: NextExperiment::none(&why), inputs: None });
    }
    let mut experiment = settle_what_can_be(whole, best, &question, minute)?;
    experiment.next.why.extend(untold.map(|untold| format!("; {untold}")));
    Ok(experiment)
}

fn untold(alike: &[&Fit]) -> String {
    let titles: Vec<String> = alike.iter().map(|fit| fit.model.title()).collect();
    format!("nothing that can be played and recorded here tells it from {}", titles.join(", "))
}

/// Alternatives that no one-minute trajectory separates by this many standard errors, with every output of the scene
/// recorded, are equivalent here: five minutes would little more than double it.
const ALIKE_SIGMA: f64 = 1.0;

fn leave_out_alike<'a>(question: &mut Question<'a>, minute: &[Candidate]) -> Vec<&'a Fit> {
    let seen: Vec<Vec<f64>> = minute.iter().map(|c| question.separations(&c.foreseen, More::Everything)).collect();
    question.count_only(|rival| seen.is_empty() || seen.iter().any(|sigmas| sigmas[rival] >= ALIKE_SIGMA))
}

fn settle_what_can_be(
    whole: &Problem,
    best: &Fit,
    question: &Question,
    minute: Vec<Candidate>,
) -> Result<Experiment, RecordingError> {
    let mut tried = vec![minute];
    let mut firsts = Vec::from_iter(first(question, &tried[0]));
    let worth_longer = worth_longer(question, &tried[0]);
    for duration_s in &DURATIONS_S[1..] {
        if firsts.last().is_none_or(|(_, promise)| promise.sigma > SURE_SIGMA) {
            break;
        }
        tried.push(candidates(whole, best, question, *duration_s, |_, name| worth_longer.contains(&name))?);
        match first(question, &tried[tried.len() - 1]) {
            Some(longer) => firsts.push(longer),
            None => break,
        }
    }
    let Some(at) = surest(firsts.iter().map(|(_, promise)| promise.sigma)) else { return Ok(none_to_play()) };
    let (winner, promise) = firsts[at];
    if promise.sigma > SURE_SIGMA {
        let winner = tried.swap_remove(at).swap_remove(winner);
        let sensor = best_sensor(question, std::slice::from_ref(&winner), promise.sigma);
        return Ok(proposal(best, Standing::Open, (winner, promise), sensor));
    }
    let sensed = sensed(question, &tried, &firsts).filter(|(_, sensor)| sensor.sigma > promise.sigma);
    Ok(match sensed {
        None => proposal(best, Standing::Open, (tried.swap_remove(at).swap_remove(winner), promise), None),
        Some((at, sensor)) => {
            let same = tried.swap_remove(at).swap_remove(sensor.candidate);
            let alone = first(question, std::slice::from_ref(&same)).map_or(promise, |(_, alone)| alone);
            proposal(best, Standing::Open, (same, alone), Some(sensor))
        }
    })
}

/// The one-minute trajectories with the best separation, and the best one with an additional sensor: only these are
/// tried for longer.
fn worth_longer(question: &Question, minute: &[Candidate]) -> Vec<&'static str> {
    let sigma = |c: &Candidate| question.least(&c.foreseen, More::Nothing).map_or(0.0, |(sigma, _)| sigma);
    let mut best: Vec<&Candidate> = minute.iter().collect();
    best.sort_by(|a, b| sigma(b).total_cmp(&sigma(a)));
    let sensed = best_sensor(question, minute, 0.0).map(|sensed| &minute[sensed.candidate]);
    best.into_iter().take(PLAYED_LONGER).chain(sensed).map(|c| c.name).collect()
}

/// The first that is certain to decide; else the best that should; else the first.
fn surest(separations: impl Iterator<Item = f64>) -> Option<usize> {
    let all: Vec<f64> = separations.collect();
    let greatest = (0..all.len()).max_by(|a, b| all[*a].total_cmp(&all[*b]))?;
    let first_sure = all.iter().position(|s| *s > SURE_SIGMA);
    Some(first_sure.unwrap_or(if all[greatest] > SETTLES_SIGMA { greatest } else { 0 }))
}

/// The best pair of sensor and one-minute trajectory, and its duration: longer if more certain. `None` if no sensor is
/// worth it.
fn sensed(question: &Question, tried: &[Vec<Candidate>], firsts: &[(usize, Promise)]) -> Option<(usize, Sensed)> {
    let minute = best_sensor(question, &tried[0], firsts.first()?.1.sigma)?;
    let name = tried[0][minute.candidate].name;
    let mut found = vec![(0, minute)];
    for (at, programmes) in tried.iter().enumerate().skip(1) {
        if found.last().is_some_and(|(_, sensed)| sensed.sigma > SURE_SIGMA) {
            break;
        }
        let Some(same) = programmes.iter().position(|c| c.name == name) else { continue };
        let Some((_, alone)) = first(question, &programmes[same..=same]) else { continue };
        let sensed = best_sensor(question, &programmes[same..=same], alone.sigma);
        found.extend(sensed.map(|sensed| (at, Sensed { candidate: same, ..sensed })));
    }
    let at = surest(found.iter().map(|(_, sensed)| sensed.sigma))?;
    Some(found.swap_remove(at))
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;
    use crate::diagnose::case::{Noise, RunSet, made};
    use crate::diagnose::fit::{Model, Placed};
    use crate::effects::{Element, ElementKind, find};

    #[test]
    fn the_shortest_that_is_sure_comes_first() {
        let chosen = |separations: &[f64]| surest(separations.iter().copied());
        assert_eq!(chosen(&[4.0, 12.0, 30.0]), Some(1));
        assert_eq!(chosen(&[6.0, 9.0, 8.0]), Some(1));
        // What would not do in five minutes either is not worth the time.
        assert_eq!(chosen(&[2.0, 3.0, 4.0]), Some(0));
        assert_eq!(chosen(&[]), None);
    }

    /// An alternative that is equivalent to the answer is named and skipped; another is separated.
    #[test]
    fn what_says_the_same_is_left_out() {
        let case = made::recorded("muscle_bench", &[], &["plunger_mm"], &["elongation_mm"]);
        let noise = [Noise::white(0.02)];
        let whole = Problem { case: &case, runs: case.subset(RunSet::All), noise: &noise };
        let fit = |id, element, values: &[f64]| {
            let entry = find(id).expect("of the catalogue");
            let model = Model::baseline().plus(&Placed { entry, element, channel: None }, values);
            let x = whole.start(&model, None);
            let parameters = x.len();
            Fit { model, x, cost: 1.0, covariance: DMatrix::zeros(parameters, parameters), on_bound: Vec::new() }
        };
        let leak = fit("leak", Element::of(ElementKind::Line, 0, 1), &[1e-17]);
        let creep = fit("viscoelasticity", Element::of(ElementKind::Muscle, 0, 1), &[4.0, 2.0, 0.0]);
        let answer = |rivals: Vec<&Fit>| settle(&whole, &leak, &Open { rivals, unit: 1.0 }).expect("known units");
        let none = answer(vec![&leak]);
        assert!(none.inputs.is_none() && none.next.file.is_none());
        assert!(none.next.why.ends_with("nothing that can be played and recorded here tells it from leak in line"));
        let next = answer(vec![&leak, &creep]).next;
        assert!(next.file.is_some() && next.separation_sigma > SETTLES_SIGMA, "{next:?}");
        assert!(next.between.is_some_and(|[_, rival]| rival == "viscoelasticity in muscle"));
        assert!(next.why.ends_with("tells it from leak in line"), "{}", next.why);
    }
}
