//! A diagnosis with all that its report and its scenes are made of.

use crate::diagnose::case::{Case, Noise};
use crate::diagnose::diagnosis::Diagnosis;
use crate::diagnose::fit::Fit;
use crate::diagnose::full::fitted_scene;
use crate::effects::Effect;
use crate::recording::Recording;

/// A diagnosis with what its report and its scene are made of.
pub struct Outcome {
    pub diagnosis: Diagnosis,
    pub case: Case,
    /// The calibration alone and with the effects, both fitted to the open runs.
    pub baseline: Option<Fit>,
    pub corrected: Option<Fit>,
    /// The corrected fit renewed on all runs: what the scene gets.
    pub complete: Option<Fit>,
    /// Measured minus simulated of all runs: baseline, corrected.
    pub residuals: Option<[Vec<Vec<Vec<f64>>>; 2]>,
    pub noise: Vec<Noise>,
    /// Models that were refitted and lost, with their chi².
    pub rivals: Vec<(String, f64)>,
    /// Every effect at the size from which these recordings would show it.
    pub just_visible: Vec<Effect<f64>>,
    /// The programme to play next: time and inputs, in the columns' units.
    pub next_inputs: Option<Recording>,
}

impl Outcome {
    /// The corrected scene as text.
    ///
    /// # Errors
    /// A fitted number that the scene's own checks refuse.
    pub fn scene_text(&self) -> Option<Result<String, crate::scene::SceneError>> {
        self.scene_text_of(self.case.specimens().first().copied())
    }

    /// The corrected scene of one of several specimens.
    ///
    /// # Errors
    /// A fitted number that the scene's own checks refuse.
    pub(crate) fn scene_text_of(&self, specimen: Option<&str>) -> Option<Result<String, crate::scene::SceneError>> {
        let fit = self.complete.as_ref()?;
        Some(fitted_scene(&self.case, fit, specimen, "corrected", &self.diagnosis.summary))
    }

    /// The calibrated scene with nothing added, as text: calibrated to the open runs, as what was found is compared with it there. Where
    /// nothing was found it is the corrected scene: what is not named corrects nothing.
    ///
    /// # Errors
    /// A fitted number that the scene's own checks refuse.
    pub fn baseline_text(&self) -> Option<Result<String, crate::scene::SceneError>> {
        let nothing_added = self.complete.as_ref().filter(|fit| fit.model.effects.is_empty());
        let fit = nothing_added.or(self.baseline.as_ref())?;
        let specimen = self.case.specimens().first().copied();
        Some(fitted_scene(&self.case, fit, specimen, "calibrated", "Calibrated, nothing added"))
    }
}
