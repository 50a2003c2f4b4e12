//! A bench that hides something, without noise, and the fits of its scene, for tests.

use super::model::Model;
use super::problem::{Fit, Problem};
use crate::diagnose::case::{Case, Noise, RunSet, made};
use crate::scene::Override;

/// Recordings of elongation and pressure, and the scene without calibrated parameters: nothing can absorb what is hidden.
pub(in crate::diagnose) struct Bench {
    pub case: Case,
    pub noise: [Noise; 2],
}

impl Bench {
    pub const CHANNELS: [&str; 2] = ["elongation_mm", "pressure_kpa"];

    /// The stock bench, played with some keys changed.
    pub fn with(changed: &[Override]) -> Self {
        let mut case = made::recorded("muscle_bench", changed, &["plunger_mm"], &Self::CHANNELS);
        case.parameters.clear();
        Self { case, noise: [0.01, 1.0].map(Noise::white) }
    }

    /// The same with a law, as `--law` takes it.
    pub fn hiding(law: &str) -> Self {
        Self::with(&[Override::law(law, "hidden").expect("a law")])
    }

    pub fn open(&self) -> Problem<'_> {
        Problem { case: &self.case, runs: self.case.subset(RunSet::Open), noise: &self.noise }
    }

    pub fn fit(&self, model: &Model) -> Fit {
        let problem = self.open();
        problem.fit(model, &problem.start(model, None)).expect("it does not diverge")
    }

    pub fn baseline(&self) -> Fit {
        self.fit(&Model::baseline())
    }
}
