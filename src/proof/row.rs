//! One case with its truth and its answer.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::ProofError;
use super::campaign::Folders;
use super::decide::Decided;
use super::found_law::{FoundLaw, found_law};
use super::holdout::gap_on_holdout;
use super::settle::Settled;
use crate::conceal::{Decoy, Hiding, Rig, SEALED, Secret, Truth, seal};
use crate::diagnose::{Diagnosis, Verdict};

/// An effect as somebody named it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answered {
    pub name: String,
    pub element: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    pub probability: f64,
    /// Its first number with its 95 % interval, where one was given: value, from, to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub size: Option<[f64; 3]>,
}

impl Answered {
    /// Whether this is what was hidden.
    pub fn is(&self, secret: &Secret) -> bool {
        self.name == secret.name && self.element == secret.element && self.channel == secret.channel
    }
}

/// One case of a proof, opened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    pub name: String,
    pub rig: Rig,
    pub hiding: Hiding,
    pub secrets: Vec<Secret>,
    pub is_noise_coloured: bool,
    pub is_noise_stated: bool,
    pub decoys: Vec<Decoy>,
    pub verdict: Verdict,
    pub element: Option<String>,
    pub effects: Vec<Answered>,
    /// Misfit per sample of the refitted baseline, in units of the noise's variance.
    pub excess: f64,
    /// Share of the gap between baseline and noise that is closed on the recording kept back.
    pub gap_closed: Option<f64>,
    /// Of a drawn law: what was found of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub law: Option<FoundLaw>,
    /// What the proposed experiment made of an ambiguous answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settled: Option<Settled>,
    /// What further runs made of an answer that is not certain of the place of a drawn law.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decided: Option<Decided>,
    /// How long it took, where that is known.
    pub seconds: Option<f64>,
}

impl Row {
    /// Whether it was said that something is missing.
    pub fn is_detected(&self) -> bool {
        matches!(self.verdict, Verdict::MissingPhysics | Verdict::Ambiguous | Verdict::UnknownPhysics)
    }

    /// What makes it no row that a proof could have written, if anything does.
    pub fn fault(&self) -> Option<String> {
        let count = self.secrets.len();
        let fits = match self.hiding {
            Hiding::Nothing => count == 0,
            Hiding::One | Hiding::Unlisted | Hiding::Law => count == 1,
            Hiding::Several | Hiding::Laws => count > 1,
        };
        if !fits {
            return Some(format!("{}: {count} secrets where `hiding` is {:?}", self.name, self.hiding));
        }
        let odd = self.effects.iter().find(|e| !(0.0..=1.0).contains(&e.probability))?;
        Some(format!("{}: probability {} of {} is not between 0 and 1", self.name, odd.probability, odd.name))
    }

    /// Whether an answer says that something is missing and is certain of no place where a law may act.
    pub fn is_open_of_a_law(&self) -> bool {
        let is_hidden = |e: &Answered| self.secrets.iter().any(|s| e.is(s));
        self.law.is_some() && self.is_detected() && self.effects.iter().all(|e| e.probability < 0.9 || is_hidden(e))
    }

    /// Probability that the answer gives to a secret.
    pub fn probability_of(&self, secret: &Secret) -> f64 {
        self.effects.iter().filter(|e| e.is(secret)).map(|e| e.probability).fold(0.0, f64::max)
    }

    /// The most probable effect of the answer.
    pub fn first(&self) -> Option<&Answered> {
        self.effects.iter().max_by(|a, b| a.probability.total_cmp(&b.probability))
    }

    /// Whether an effect is named with confidence that is not there.
    pub fn is_confidently_wrong(&self) -> bool {
        let named = self.verdict == Verdict::MissingPhysics || self.verdict == Verdict::Ambiguous;
        let is_wrong = |e: &&Answered| e.probability > 0.9 && !self.secrets.iter().any(|s| e.is(s));
        named && self.effects.iter().any(|e| is_wrong(&e))
    }
}

/// Opens the seal of a case; `published` is what was published before anyone answered.
///
/// # Errors
/// An answer under the seal that is not the one that was sealed.
pub fn open(name: &str, published: &str, folders: &Folders) -> Result<Truth, ProofError> {
    let path = folders.cases.join(SEALED).join(format!("{name}.json"));
    let text = read(&path)?;
    if seal(&text) != published {
        return Err(ProofError::Broken { file: path, name: name.to_owned() });
    }
    serde_json::from_str(&text).map_err(|e| ProofError::Format { file: path, message: e.to_string() })
}

/// The row of a case that was answered.
///
/// # Errors
/// Files that are not there or hold something else.
pub fn row(truth: &Truth, folders: &Folders) -> Result<Row, ProofError> {
    let mut row = row_of_answer(truth, folders)?;
    let folder = folders.answers.join(&truth.name);
    if truth.hiding != Hiding::Nothing && folder.join("scene.toml").is_file() {
        row.gap_closed = Some(gap_on_holdout(truth, &folder, &folders.holdout(&truth.name))?);
        row.law = found_law(truth, &folder, &folders.larger(&truth.name))?;
    }
    Ok(row)
}

/// The row of a case without what its scenes are worth on the recording kept back.
pub(super) fn row_of_answer(truth: &Truth, folders: &Folders) -> Result<Row, ProofError> {
    let folder = folders.answers.join(&truth.name);
    let path = folder.join("diagnosis.json");
    let diagnosis: Diagnosis = serde_json::from_str(&read(&path)?)
        .map_err(|e| ProofError::Format { file: path.clone(), message: e.to_string() })?;
    Ok(Row {
        name: truth.name.clone(),
        rig: truth.rig,
        hiding: truth.hiding,
        secrets: truth.secrets.clone(),
        is_noise_coloured: truth.is_noise_coloured,
        is_noise_stated: truth.is_noise_stated,
        decoys: truth.decoys.clone(),
        verdict: diagnosis.verdict,
        element: diagnosis.location.element.clone(),
        effects: diagnosis.effects.iter().map(|e| answered(e, truth)).collect(),
        excess: diagnosis.detection.excess_chi2_per_sample,
        gap_closed: None,
        law: None,
        settled: None,
        decided: None,
        seconds: folders.seconds(&truth.name),
    })
}

fn answered(e: &crate::diagnose::NamedEffect, truth: &Truth) -> Answered {
    let mut answered = Answered {
        name: e.name.clone(),
        element: e.element.clone(),
        channel: e.channel.clone(),
        probability: e.probability,
        size: None,
    };
    let secret = truth.secrets.iter().find(|s| answered.is(s));
    let number = secret.and_then(|s| e.parameters.get(&s.key));
    answered.size = number.map(|n| [n.value, n.ci95[0], n.ci95[1]]);
    answered
}

pub(super) fn read(path: &Path) -> Result<String, ProofError> {
    fs::read_to_string(path).map_err(|source| ProofError::Read { file: path.to_path_buf(), source })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_that_no_proof_writes_are_named() {
        let row = |hiding: &str, effects: &str| -> Row {
            let text = format!(
                r#"{{"name":"a","rig":"muscle_bench","hiding":"{hiding}","secrets":[],"is_noise_coloured":false,"is_noise_stated":true,
                    "decoys":[],"verdict":"adequate","element":null,"effects":[{effects}],"excess":0.0,"gap_closed":null,"seconds":1.0}}"#
            );
            serde_json::from_str(&text).expect("a row")
        };
        assert_eq!(row("nothing", "").fault(), None);
        assert_eq!(row("one", "").fault().as_deref(), Some("a: 0 secrets where `hiding` is One"));
        let leak = r#"{"name":"leak","element":"line","probability":7.5}"#;
        assert!(row("nothing", leak).fault().is_some_and(|f| f.contains("probability 7.5 of leak")));
    }
}
