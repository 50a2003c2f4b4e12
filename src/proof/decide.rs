//! Whether further runs decide what an answer leaves open of a law that nobody chose.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::ProofError;
use super::campaign::Folders;
use super::found_law::is_certain_of_the_law;
use super::settle::{Sensor, answer_with, parse};
use crate::conceal::{Further, Truth, record_asked, record_drawn};
use crate::diagnose::Diagnosis;
use crate::recording::{Recording, read_csv};

/// Runs that are added, one after the other, until one decides.
const PROGRAMMES: usize = 2;

/// What one run after the other made of an answer that is not certain of where a law acts: the runs that each answer proposed, and as
/// many of the same length with a waveform that was drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decided {
    /// Standard errors by which the first programme was said to set the alternatives apart, its sensor included.
    pub promised_sigma: f64,
    pub proposed: Vec<Step>,
    pub drawn: Vec<Step>,
}

/// An answer with one run more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Step {
    /// Length of the run, s.
    pub added_s: f64,
    /// The sensor that it has and the case's own runs do not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor: Option<String>,
    /// The answer is certain of the place of the hidden law.
    pub is_right: bool,
    /// The first place that it names, and how probable it is.
    pub port: String,
    pub probability: f64,
}

impl Decided {
    /// Whether some of the first runs decided it, the proposed ones and the drawn ones.
    pub fn is_decided(&self, runs: usize) -> [bool; 2] {
        [&self.proposed, &self.drawn].map(|steps| steps.iter().take(runs).any(|s| s.is_right))
    }

    /// Time on the rig, s, until it was decided or given up.
    pub fn rig_s(&self) -> [f64; 2] {
        [&self.proposed, &self.drawn].map(|steps| steps.iter().map(|s| s.added_s).sum())
    }
}

/// Adds runs to a case as its answer proposes, and drawn ones; none where no run is proposed.
///
/// # Errors
/// Files that cannot be read or written, a plant that cannot be integrated.
pub fn decide(truth: &Truth, folders: &Folders, out: &Path) -> Result<Option<Decided>, ProofError> {
    let Some(first) = Proposal::of(truth, folders)? else { return Ok(None) };
    let chain = |name, is_proposed| Chain { truth, out, name, first: &first, is_proposed }.runs(folders);
    let (proposed, drawn) = (chain("decided", true)?, chain("drawn", false)?);
    Ok(Some(Decided { promised_sigma: first.promised_sigma, proposed, drawn }))
}

/// Runs that are added one after the other.
struct Chain<'a> {
    truth: &'a Truth,
    out: &'a Path,
    name: &'a str,
    /// What the case's own answer proposes; its sensor is that of all runs added, and its length that of drawn ones.
    first: &'a Proposal,
    /// As each answer proposes, or drawn.
    is_proposed: bool,
}

impl Chain<'_> {
    /// Adds runs until an answer is right, nothing is proposed, or enough was tried.
    fn runs(&self, folders: &Folders) -> Result<Vec<Step>, ProofError> {
        let (truth, sensor) = (self.truth, self.first.sensor.as_deref());
        let (mut from, mut steps, mut run) = (folders.clone(), Vec::<Step>::new(), Further::default());
        while steps.len() < PROGRAMMES && !steps.last().is_some_and(|s| s.is_right) {
            let asked = if self.is_proposed { Proposal::of(truth, &from)? } else { None };
            if self.is_proposed && asked.is_none() {
                break;
            }
            let added = || match &asked {
                Some(proposal) => record_asked(truth, &proposal.inputs, sensor, run),
                None => record_drawn(truth, length_s(&self.first.inputs), sensor, run),
            };
            let to = Folders::below(&self.out.join(format!("{}_{}", self.name, steps.len() + 1)));
            let file = format!("added_{}.csv", steps.len() + 1);
            // What the first added run has is a channel already.
            let new = sensor.filter(|_| steps.is_empty()).and_then(|column| Sensor::of(truth, column));
            answer_with(truth, [&from, &to], (&file, new.as_ref()), &added)?;
            let recording = read_csv(&to.cases.join(&truth.name).join(&file))?;
            let step = self.step(&to, length_s(&recording))?;
            run = Further { before: run.before + 1, after_s: run.after_s + step.added_s };
            steps.push(step);
            from = to;
        }
        Ok(steps)
    }

    fn step(&self, folders: &Folders, added_s: f64) -> Result<Step, ProofError> {
        let diagnosis: Diagnosis = parse(&folders.answers.join(&self.truth.name).join("diagnosis.json"))?;
        let first = diagnosis.effects.iter().max_by(|a, b| a.probability.total_cmp(&b.probability));
        Ok(Step {
            added_s,
            sensor: self.first.sensor.clone(),
            is_right: is_certain_of_the_law(self.truth, &diagnosis),
            port: first.map_or(String::new(), |e| e.port.clone()),
            probability: first.map_or(0.0, |e| e.probability),
        })
    }
}

/// The run that an answer proposes.
struct Proposal {
    inputs: Recording,
    promised_sigma: f64,
    /// A sensor that is asked for and that the rig can be given.
    sensor: Option<String>,
}

impl Proposal {
    fn of(truth: &Truth, folders: &Folders) -> Result<Option<Self>, ProofError> {
        let answer = folders.answers.join(&truth.name);
        let file = answer.join("next_experiment.csv");
        if !file.is_file() {
            return Ok(None);
        }
        let diagnosis: Diagnosis = parse(&answer.join("diagnosis.json"))?;
        let next = diagnosis.next_experiment;
        let sensor = next.sensor.filter(|column| Sensor::of(truth, column).is_some());
        let promised_sigma = next.sensor_sigma.filter(|_| sensor.is_some()).unwrap_or(next.separation_sigma);
        Ok(Some(Self { inputs: read_csv(&file)?, promised_sigma, sensor }))
    }
}

fn length_s(recording: &Recording) -> f64 {
    recording.time_s().last().copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_decides_first_ends_the_chain() {
        let step = |is_right| Step { added_s: 60.0, sensor: None, is_right, port: String::new(), probability: 0.5 };
        let decided = Decided { promised_sigma: 8.0, proposed: vec![step(true)], drawn: vec![step(false), step(true)] };
        assert_eq!((decided.is_decided(1), decided.is_decided(2)), ([true, false], [true, true]));
        assert_eq!(decided.rig_s(), [60.0, 120.0]);
    }
}
