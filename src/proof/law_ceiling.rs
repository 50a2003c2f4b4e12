//! What the recordings say for a drawn law against the answer: chi² with the law itself in the scene, beside chi² of the
//! corrected scene.
//!
//! Both scenes are calibrated to the open runs; their laws keep their parameters. Who was given the true form could know
//! as much, not more: where the two are within a few units, the recordings do not tell the answer from the truth.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::ProofError;
use super::campaign::Folders;
use super::row::{Row, read};
use crate::conceal::{Secret, Truth};
use crate::diagnose::{Calibrated, Case, chi2_beyond};
use crate::files::write_whole;

/// Units of chi² within which recordings do not tell two scenes apart: odds of one to twenty, `2 ln(20)`.
const ALIKE: f64 = 6.0;

/// What the hidden law explains beyond the answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LawCeiling {
    pub name: String,
    /// Chi² that the calibrated scene, and the corrected one, leave beyond the scene with the hidden law. Negative where
    /// the answer explains more than the law as it was written.
    pub calibrated: f64,
    pub corrected: f64,
    pub port_rank: Option<usize>,
    pub rank: Option<usize>,
}

/// What became of a drawn law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Told {
    /// Port and variable are among the forms that the answer calls equally good; of two laws, those of the first.
    Found,
    /// They are not, and the recordings do not tell the answer from the truth.
    Alike,
    /// The truth explains more than the answer: a better search would have found it.
    Missed,
}

impl LawCeiling {
    /// ```
    /// use smam::proof::{LawCeiling, Told};
    ///
    /// let case = |corrected, rank| LawCeiling {
    ///     name: String::new(), calibrated: 900.0, corrected, port_rank: rank, rank,
    /// };
    /// assert_eq!(case(40.0, Some(2)).told(), Told::Found);
    /// // Odds of one to twenty are 2 ln(20) = 6 units of chi².
    /// assert_eq!(case(5.0, None).told(), Told::Alike);
    /// assert_eq!(case(40.0, None).told(), Told::Missed);
    /// ```
    pub fn told(&self) -> Told {
        match self.rank {
            Some(_) => Told::Found,
            None if self.corrected <= ALIKE => Told::Alike,
            None => Told::Missed,
        }
    }
}

/// Holds the answer of a case against its law; `None` where something else than laws is hidden, or nothing.
///
/// # Errors
/// Files that are not there or hold something else, scenes that diverge.
pub fn law_ceiling(truth: &Truth, row: &Row, folders: &Folders) -> Result<Option<LawCeiling>, ProofError> {
    let laws: Option<Vec<String>> =
        truth.secrets.iter().enumerate().map(|(i, secret)| table(truth, secret, i)).collect();
    let Some(laws) = laws.filter(|laws| !laws.is_empty()) else { return Ok(None) };
    let answer = folders.answers.join(&truth.name);
    let hidden = answer.join("hidden.toml");
    let text = read(&answer.join("baseline.toml"))? + &laws.concat();
    write_whole(&hidden, &text).map_err(|source| ProofError::Write { file: hidden.clone(), source })?;
    let recordings = folders.cases.join(&truth.name);
    let calibrated = |scene: &Path| -> Result<Calibrated, ProofError> {
        let scene = scene.display().to_string();
        Ok(Calibrated::of(Case::load(&[recordings.as_path()], Some(&scene), &[])?)?)
    };
    let own = calibrated(&hidden)?;
    let beyond = |scene: &str| Ok::<_, ProofError>(chi2_beyond(&calibrated(&answer.join(scene))?, &own));
    Ok(Some(LawCeiling {
        name: truth.name.clone(),
        calibrated: beyond("baseline.toml")?,
        corrected: beyond("scene.toml")?,
        port_rank: row.law.as_ref().and_then(|law| law.port_rank),
        rank: row.law.as_ref().and_then(|law| law.rank),
    }))
}

/// A law as a table of a scene, under a name of its own.
fn table(truth: &Truth, secret: &Secret, index: usize) -> Option<String> {
    let text = secret.law?.table(truth.rig, secret.muscle, secret.size);
    Some(format!("\n[[law]]\n{}", text.replacen("\"hidden\"", &format!("\"hidden_{}\"", index + 1), 1)))
}
