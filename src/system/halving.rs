//! How far a run depends on its steps.

use crate::recording::Recording;
use crate::scene::{Scene, SceneError};

/// By how much one channel moves when the steps are halved.
#[derive(Clone, Debug, PartialEq)]
pub struct StepError {
    pub column: String,
    /// Greatest difference between the two runs and when it is met, in the channel's unit and s.
    pub greatest: f64,
    pub at_s: f64,
    /// The channel's range in the run, in its unit.
    pub range: f64,
}

impl StepError {
    /// The difference as a share of the channel's range; 0 for a channel that does not move and agrees.
    pub fn share(&self) -> f64 {
        if self.greatest == 0.0 { 0.0 } else { self.greatest / self.range.max(f64::MIN_POSITIVE) }
    }
}

/// The scene with engine steps and fine steps of half the length.
///
/// # Errors
/// As for loading: steps that are too short.
pub fn with_half_steps(scene: &Scene) -> Result<Scene, SceneError> {
    let mut file = scene.file.clone();
    file.simulation.step_s /= 2.0;
    Scene::from_file(file, &scene.path)
}

/// Compares a run with that of [`with_half_steps`], channel by channel; both at the same times.
///
/// The method is of second order: what is left of a smooth run's error at half the step is a third of the difference.
///
/// ```
/// use smam::scene::Scene;
/// use smam::system::{Schedule, Simulation, record, step_errors, with_half_steps};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let scene = Scene::load("muscle_bench", &[])?;
/// let schedule = Schedule::even(2.0, 0.01);
/// let halved = record(&mut Simulation::new(with_half_steps(&scene)?)?, &schedule)?;
/// let errors = step_errors(&record(&mut Simulation::new(scene)?, &schedule)?, &halved);
/// let elongation = errors.iter().find(|e| e.column == "elongation_mm").ok_or("a channel")?;
/// assert!(elongation.greatest > 0.0 && elongation.share() < 1e-4);
/// # Ok(())
/// # }
/// ```
pub fn step_errors(run: &Recording, halved: &Recording) -> Vec<StepError> {
    let compared = |channel: &crate::recording::Channel| {
        let other = halved.find(&channel.column)?;
        let pairs = run.time_s().iter().zip(channel.values.iter().zip(&other.values));
        let (at_s, greatest) = pairs
            .map(|(t, (a, b))| (*t, (a - b).abs()))
            .fold((0.0, 0.0), |worst, here| if here.1 > worst.1 { here } else { worst });
        let range = crate::recording::figures::range(&channel.values);
        Some(StepError { column: channel.column.clone(), greatest, at_s, range })
    };
    run.channels().iter().filter_map(compared).collect()
}
