//! What laws show to whoever watches a run.

use crate::laws::Symbol;
use crate::system::observe::{LawFrame, LawGraph};
use crate::system::plant::{InputSpan, Instant, Plant};
use crate::system::state::PlantState;

use super::{Instance, PlantLaws};

impl PlantLaws<f64> {
    /// Every law on every element, as it stays during a run.
    pub(crate) fn graphs(&self) -> Vec<LawGraph> {
        let graph = |(i, instance): (usize, &Instance)| {
            let law = &self.laws[instance.law];
            let same = |others: &[Instance]| others.iter().filter(|other| other.law == instance.law).count();
            let number = same(&self.instances[..=i]);
            let is_alone = same(&self.instances) == 1;
            LawGraph {
                name: if is_alone { law.name.clone() } else { format!("{}_{number}", law.name) },
                text: law.text(),
                variable: law.variables().first().map(|v| v.name()),
            }
        };
        self.instances.iter().enumerate().map(graph).collect()
    }

    /// The same at one instant.
    pub fn frames(&self, plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan]) -> Vec<LawFrame> {
        let now: Instant<f64> = Instant::of(state, inputs, 0.0);
        let mut acts = self.afresh(plant, &now);
        let mut frame = |instance: &Instance| {
            let law = &self.laws[instance.law];
            let first = law.symbols.iter().position(|s| matches!(s, Symbol::Variable(_)));
            let variable =
                first.map_or(f64::NAN, |i| self.read(instance.sources[i], instance, plant, &now, &acts.tension_n));
            LawFrame { value: self.value(instance, plant, &now, &mut acts), variable }
        };
        self.instances.iter().map(&mut frame).collect()
    }
}
