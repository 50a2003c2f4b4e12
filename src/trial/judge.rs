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
    /// Of everything that was drawn for the case.
    pub seed: u64,
    pub effect: String,
    pub element: String,
    pub size: String,
    pub value: f64,
    pub excess_chi2_per_sample: f64,
    pub judgement: Judgement,
    pub verdict: Verdict,
    /// What was named, with probabilities.
    pub answer: Vec<(String, f64)>,
    /// The size found for the effect with its 95 % interval, and whether the true one lies in it.
    pub found: Option<f64>,
    #[serde(default)]
    pub ci95: Option<[f64; 2]>,
    pub covered: Option<bool>,
    pub gap_closed: f64,
    pub seconds: f64,
}

/// Compares an answer with what was put in.
pub fn judge(case: &TrialCase, outcome: &Outcome, seconds: f64) -> Row {
    let d = &outcome.diagnosis;
    let truth = case.effect.as_ref();
    let named = truth.and_then(|t| d.effects.iter().find(|e| is_same(e, t)));
    let estimate = truth.zip(named).and_then(|(t, e)| e.parameters.get(&t.entry.parameters[0].key));
    let value = truth.map_or(0.0, |t| t.values[0]);
    Row {
        name: case.name.clone(),
        scene: case.scene.clone(),
        seed: case.seed,
        effect: truth.map_or("nothing", |t| &t.entry.name).to_owned(),
        element: truth.map_or(String::new(), |t| t.channel.clone().unwrap_or_else(|| t.element.to_string())),
        size: case.size.map_or(String::new(), |s| format!("{s:?}").to_lowercase()),
        value,
        excess_chi2_per_sample: d.detection.excess_chi2_per_sample,
        judgement: judgement(truth, d.verdict, &d.effects),
        verdict: d.verdict,
        answer: d.effects.iter().map(|e| (words(e), e.probability)).collect(),
        found: estimate.map(|e| e.value),
        ci95: estimate.map(|e| e.ci95),
        covered: estimate.map(|e| e.ci95[0] <= value && value <= e.ci95[1]),
        gap_closed: d.fit.gap_closed,
        seconds,
    }
}

fn judgement(truth: Option<&Effect<f64>>, verdict: Verdict, effects: &[NamedEffect]) -> Judgement {
    let Some(truth) = truth else {
        return if verdict == Verdict::Adequate { Judgement::Right } else { Judgement::Wrong };
    };
    let is_among = effects.iter().any(|e| is_same(e, truth));
    // A rival of a few percent stands beside an answer; it is none.
    let mut said = effects.iter().filter(|e| e.probability > 0.5);
    let is_alone = said.next().is_some_and(|e| is_same(e, truth)) && said.next().is_none();
    match verdict {
        Verdict::Adequate => Judgement::Missed,
        Verdict::UnknownPhysics | Verdict::UnusableData => Judgement::Unknown,
        Verdict::MissingPhysics if is_alone => Judgement::Right,
        Verdict::Ambiguous if is_among => Judgement::Among,
        Verdict::MissingPhysics | Verdict::Ambiguous => Judgement::Wrong,
    }
}

fn is_same(named: &NamedEffect, truth: &Effect<f64>) -> bool {
    named.name == truth.entry.name && named.element == truth.element.to_string() && named.channel == truth.channel
}

fn words(e: &NamedEffect) -> String {
    format!("{} {}", e.name, e.channel.as_ref().unwrap_or(&e.element))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{Element, ElementKind, find};

    #[test]
    fn a_rival_of_a_few_percent_makes_no_answer_wrong() {
        let element = Element::of(ElementKind::Line, 0, 1);
        let truth =
            Effect { entry: find("leak").expect("of the catalogue"), element, channel: None, values: vec![1e-17] };
        let named = |name: &str, probability: f64| NamedEffect {
            name: name.to_owned(),
            element: "line".to_owned(),
            probability,
            ..NamedEffect::default()
        };
        let judged = |verdict, first: f64| {
            judgement(Some(&truth), verdict, &[named("leak", first), named("thermal_expansion", 1.0 - first)])
        };
        assert_eq!(judged(Verdict::MissingPhysics, 0.94), Judgement::Right);
        assert_eq!(judged(Verdict::MissingPhysics, 0.06), Judgement::Wrong);
        assert_eq!(judged(Verdict::Ambiguous, 0.7), Judgement::Among);
        let both = [named("leak", 1.0), named("trapped_air", 1.0)];
        assert_eq!(judgement(Some(&truth), Verdict::MissingPhysics, &both), Judgement::Wrong);
        assert_eq!(judgement(None, Verdict::Adequate, &[]), Judgement::Right);
    }
}
