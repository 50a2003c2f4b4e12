//! Whether a diagnosis found what was put in.

use serde::{Deserialize, Serialize};

use crate::diagnose::{NamedEffect, Outcome, Verdict};
use crate::effects::Effect;

use super::plan::TrialCase;

/// What an answer is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Judgement {
    /// The effect alone is named, or nothing where there is nothing.
    Right,
    /// Several are offered, the effect among them.
    Among,
    /// Nothing is said to be missing, though something is.
    Missed,
    /// It is said that the catalogue does not hold it.
    Unknown,
    /// Another effect is named, or one where there is nothing.
    Wrong,
}

/// One case with its answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub name: String,
    pub scene: String,
    pub effect: String,
    pub element: String,
    pub size: String,
    pub value: f64,
    pub excess_chi2_per_sample: f64,
    pub judgement: Judgement,
    pub verdict: Verdict,
    /// What was named, with probabilities.
    pub answer: Vec<(String, f64)>,
    /// The size found for the effect, and whether the true one lies in its interval.
    pub found: Option<f64>,
    pub covered: Option<bool>,
    pub gap_closed: f64,
    pub seconds: f64,
}

/// Compares an answer with what was put in.
pub fn judge(case: &TrialCase, outcome: &Outcome, seconds: f64) -> Row {
    let d = &outcome.diagnosis;
    let truth = case.effect.as_ref();
    let named = truth.and_then(|t| d.effects.iter().find(|e| is_same(e, t)));
    let estimate = truth.zip(named).and_then(|(t, e)| e.parameters.get(t.spec().parameters[0].key));
    let value = truth.map_or(0.0, |t| t.values[0]);
    Row {
        name: case.name.clone(),
        scene: case.scene.clone(),
        effect: truth.map_or("nothing", |t| t.spec().name).to_owned(),
        element: truth.map_or(String::new(), |t| t.channel.clone().unwrap_or_else(|| t.element.to_string())),
        size: case.size.map_or(String::new(), |s| format!("{s:?}").to_lowercase()),
        value,
        excess_chi2_per_sample: d.detection.excess_chi2_per_sample,
        judgement: judgement(truth, d.verdict, named, d.effects.len()),
        verdict: d.verdict,
        answer: d.effects.iter().map(|e| (words(e), e.probability)).collect(),
        found: estimate.map(|e| e.value),
        covered: estimate.map(|e| e.ci95[0] <= value && value <= e.ci95[1]),
        gap_closed: d.fit.gap_closed,
        seconds,
    }
}

fn judgement(truth: Option<&Effect<f64>>, verdict: Verdict, named: Option<&NamedEffect>, count: usize) -> Judgement {
    match (truth, verdict) {
        (None, Verdict::Adequate) => Judgement::Right,
        (None, _) => Judgement::Wrong,
        (Some(_), Verdict::Adequate) => Judgement::Missed,
        (Some(_), Verdict::UnknownPhysics | Verdict::UnusableData) => Judgement::Unknown,
        (Some(_), Verdict::MissingPhysics) if named.is_some() && count == 1 => Judgement::Right,
        (Some(_), Verdict::Ambiguous) if named.is_some() => Judgement::Among,
        _ => Judgement::Wrong,
    }
}

fn is_same(named: &NamedEffect, truth: &Effect<f64>) -> bool {
    named.name == truth.spec().name && named.element == truth.element.to_string() && named.channel == truth.channel
}

fn words(e: &NamedEffect) -> String {
    format!("{} {}", e.name, e.channel.as_ref().unwrap_or(&e.element))
}
