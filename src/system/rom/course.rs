//! A run of the reduced-order model in progress.

use super::RomRun;
use crate::scalar::Scalar;
use crate::system::PlantState;
use crate::system::Stepper;
use crate::system::laws::{Acts, PlantLaws};
use crate::system::plant::{InputSpan, Instant, Plant};
use crate::system::posed;

/// State and inputs at one instant, and the integrator that carries them on.
#[derive(Clone, Debug)]
pub(super) struct Course<D> {
    pub state: PlantState<D>,
    pub spans: Vec<InputSpan>,
    stepper: Stepper<D>,
    /// For what laws do where a sample is.
    room: Option<Acts<D>>,
}

impl<D: Scalar> Course<D> {
    /// At a run's first sample.
    pub fn new(plant: &mut Plant<D>, mut state: PlantState<D>, run: &RomRun) -> Self {
        state.time_s = run.times_s.first().copied().unwrap_or(0.0);
        let spans: Vec<InputSpan> = run.inputs.iter().map(|x| InputSpan { value: x[0], slope: 0.0 }).collect();
        PlantLaws::begin(plant, &mut state, &spans);
        posed::renew(plant, &state, &spans);
        Self { stepper: Stepper::new(plant, &state), state, spans, room: None }
    }

    /// Advances over the interval that ends at sample `k`, in `steps` steps.
    pub fn advance(&mut self, plant: &mut Plant<D>, run: &RomRun, k: usize, steps: u16) {
        let (from, to) = (run.times_s[k - 1], run.times_s[k]);
        let h = (to - from) / f64::from(steps);
        for (span, values) in self.spans.iter_mut().zip(&run.inputs) {
            *span = InputSpan { value: values[k - 1], slope: (values[k] - values[k - 1]) / (to - from) };
        }
        self.stepper.plant_changed();
        self.state.time_s = from;
        posed::renew(plant, &self.state, &self.spans);
        let mut pulling = plant.pulling::<0>(&Instant::of(&self.state, &self.spans, 0.0), &mut self.room);
        for _ in 0..steps {
            self.stepper.advance(plant, &mut self.state, &mut self.spans, h, &mut pulling, &mut ());
            if posed::renew(plant, &self.state, &self.spans) {
                self.stepper.plant_changed();
            }
        }
        for (span, values) in self.spans.iter_mut().zip(&run.inputs) {
            span.value = values[k];
        }
    }

    /// Whether it has not diverged, and all laws are in their domain.
    pub fn is_sound(&mut self, plant: &Plant<D>) -> bool {
        let (state, spans, room) = (&self.state, &self.spans, &mut self.room);
        let mut is_lawful = || plant.laws.as_ref().is_none_or(|laws| laws.is_sound(plant, state, spans, room));
        state.y().iter().all(|y| y.is_finite()) && is_lawful()
    }
}
