//! What the variables of laws go through in a run.

use crate::laws::{Law, Symbol};
use crate::system::plant::{InputSpan, Instant, Plant};
use crate::system::state::PlantState;

use super::{PlantLaws, Site};

/// Reads the first variable of each law, at the first element that the law acts on.
pub(in crate::system) struct Visit {
    probe: PlantLaws<f64>,
    /// Of each law its place in the probe; none where the rig cannot have it.
    places: Vec<Option<usize>>,
    pub series: Vec<Vec<f64>>,
}

impl Visit {
    pub fn new(plant: &Plant<f64>, site: &Site, laws: &[Law]) -> Self {
        let mut probe = PlantLaws::new(plant, site);
        let places = laws.iter().map(|law| {
            probe.add(law, law.values(), plant.cables.len()).ok()?;
            Some(probe.laws.len() - 1)
        });
        let places = places.collect();
        Self { probe, places, series: vec![Vec::new(); laws.len()] }
    }

    /// One instant more.
    pub fn see(&mut self, plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan]) {
        let now: Instant<f64> = Instant::of(state, inputs, 0.0);
        let mut acts = self.probe.room(plant);
        for (i, tension) in acts.tension_n.iter_mut().enumerate() {
            *tension = plant.cable(i, state, inputs, 0.0).2;
        }
        for (place, series) in self.places.iter().zip(&mut self.series) {
            let Some(law) = *place else { continue };
            let is_variable = |s: &Symbol| matches!(s, Symbol::Variable(_));
            let symbol = self.probe.laws[law].symbols.iter().position(is_variable);
            let instance = self.probe.instances.iter().find(|i| i.law == law);
            let (Some(symbol), Some(instance)) = (symbol, instance) else { continue };
            series.push(self.probe.read(instance.sources[symbol], instance, plant, &now, &acts.tension_n));
        }
    }
}
