//! A diagnosis with the data for report and scenes.

use crate::diagnose::case::{Case, Noise};
use crate::diagnose::diagnosis::Diagnosis;
use crate::diagnose::error::DiagnoseError;
use crate::diagnose::fit::{Fit, baseline};
use crate::diagnose::full::fitted_scene;
use crate::effects::Effect;
use crate::recording::Recording;
use crate::scene::SceneError;

/// A diagnosis with the data for report and scenes.
pub struct Outcome {
    pub diagnosis: Diagnosis,
    pub case: Case,
    /// The calibration alone and with the named effects, both fitted to the open runs.
    pub baseline: Option<Fit>,
    pub corrected: Option<Fit>,
    /// What the scene gets, fitted to all runs: the named effects, and those that describe what they leave.
    pub complete: Option<Fit>,
    /// Measured minus simulated of all runs: baseline, corrected.
    pub residuals: Option<[Vec<Vec<Vec<f64>>>; 2]>,
    pub noise: Vec<Noise>,
    /// Rejected models, with their chi².
    pub rivals: Vec<(String, f64)>,
    /// Every effect at its detection limit.
    pub just_visible: Vec<Effect<f64>>,
    /// Input trajectory of the next experiment, in the columns' units.
    pub next_inputs: Option<Recording>,
}

impl Outcome {
    /// The corrected scene as text.
    ///
    /// # Errors
    /// A fitted number that the scene's own checks refuse.
    pub fn scene_text(&self) -> Option<Result<String, SceneError>> {
        self.scene_text_of(self.case.specimens().first().copied())
    }

    /// The corrected scene of one of several specimens.
    ///
    /// # Errors
    /// A fitted number that the scene's own checks refuse.
    pub(crate) fn scene_text_of(&self, specimen: Option<&str>) -> Option<Result<String, SceneError>> {
        let fit = self.complete.as_ref()?;
        Some(fitted_scene(&self.case, fit, specimen, "corrected", &self.diagnosis.summary))
    }

    /// The calibrated scene with nothing added, as text, calibrated to the open runs. If nothing is named, it is the
    /// corrected scene.
    ///
    /// # Errors
    /// A fitted number that the scene's own checks refuse.
    pub fn baseline_text(&self) -> Option<Result<String, SceneError>> {
        let nothing_added = self.complete.as_ref().filter(|fit| fit.model.effects.is_empty());
        let fit = nothing_added.or(self.baseline.as_ref())?;
        Some(calibrated(&self.case, fit))
    }
}

/// A case's scene as text, its own calibration fitted to the open runs and nothing added: what a diagnosis begins with.
///
/// # Errors
/// A scene that diverges, and a fitted number that its own checks refuse.
pub fn calibrated_scene(mut case: Case) -> Result<String, DiagnoseError> {
    let base = baseline::baseline(&mut case)?;
    Ok(calibrated(&case, &base.fit)?)
}

fn calibrated(case: &Case, fit: &Fit) -> Result<String, SceneError> {
    fitted_scene(case, fit, case.specimens().first().copied(), "calibrated", "Calibrated, nothing added")
}
