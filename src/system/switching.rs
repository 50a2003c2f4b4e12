//! Steps in which something one-sided switches are taken again in small parts.

use crate::scalar::Scalar;

use super::plant::{InputSpan, Instant, Plant};
use super::rosenbrock::Stepper;
use super::state::PlantState;

/// Parts of a step in which a cable, a stop or a friction switches: the fast swing after it is followed, not overshot.
const SWITCH_STEPS: usize = 16;

/// Sees every part that is taken, from its beginning and at its end.
pub trait Watch<D> {
    fn begin(&mut self, plant: &Plant<D>, state: &PlantState<D>, inputs: &[InputSpan]);
    /// `inputs` are still those of the part's beginning.
    fn end(&mut self, plant: &Plant<D>, state: &PlantState<D>, inputs: &[InputSpan], h: f64);
}

/// Nobody watches.
impl<D> Watch<D> for () {
    fn begin(&mut self, _: &Plant<D>, _: &PlantState<D>, _: &[InputSpan]) {}
    fn end(&mut self, _: &Plant<D>, _: &PlantState<D>, _: &[InputSpan], _: f64) {}
}

impl<D: Scalar> Stepper<D> {
    /// Advances state and inputs by `h` seconds: in one step, or in parts when something switches on the way.
    ///
    /// `pulling` is what pulls at the beginning (`Plant::pulling`), and becomes what pulls at the end.
    pub fn advance(
        &mut self,
        plant: &Plant<D>,
        state: &mut PlantState<D>,
        inputs: &mut [InputSpan],
        h: f64,
        pulling: &mut u64,
        watch: &mut impl Watch<D>,
    ) {
        watch.begin(plant, state, inputs);
        if self.step(plant, state, inputs, h) && self.pulling_ahead(plant, state, inputs, h) == *pulling {
            self.accept(plant, state, inputs, h);
            watch.end(plant, state, inputs, h);
            inputs.iter_mut().for_each(|s| s.value += h * s.slope);
            return;
        }
        self.advance_in_parts(plant, state, inputs, h, watch);
        *pulling = plant.pulling::<0>(&Instant::of(state, inputs, 0.0), &mut self.room);
    }

    #[cold]
    fn advance_in_parts(
        &mut self,
        plant: &Plant<D>,
        state: &mut PlantState<D>,
        inputs: &mut [InputSpan],
        h: f64,
        watch: &mut impl Watch<D>,
    ) {
        let ends: Vec<f64> = inputs.iter().map(|s| s.value + h * s.slope).collect();
        let part = h / SWITCH_STEPS as f64;
        for _ in 0..SWITCH_STEPS {
            watch.begin(plant, state, inputs);
            self.step(plant, state, inputs, part);
            self.accept(plant, state, inputs, part);
            watch.end(plant, state, inputs, part);
            inputs.iter_mut().for_each(|s| s.value += part * s.slope);
        }
        inputs.iter_mut().zip(ends).for_each(|(s, end)| s.value = end);
    }
}
