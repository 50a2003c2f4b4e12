//! What no equation can carry: values that are no numbers, coefficients that turn over.

use crate::laws::{Port, Symbol};
use crate::scalar::Scalar;
use crate::system::plant::{Drive, InputSpan, Instant, Plant};
use crate::system::state::PlantState;

use super::{Acts, Instance, PlantLaws};

/// A law that has left the range in which its port has a meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct LawFault {
    pub law: String,
    /// What is wrong, with the values of the variables.
    pub what: String,
}

impl<D: Scalar> PlantLaws<D> {
    /// Whether every law can be followed at a state.
    pub fn is_sound(
        &self,
        plant: &Plant<D>,
        state: &PlantState<D>,
        inputs: &[InputSpan],
        room: &mut Option<Acts<D>>,
    ) -> bool {
        if !state.parts().law_states().iter().all(|s| s.is_finite()) {
            return false;
        }
        // Evaluated only where there is a coefficient to look at: this is asked at every sample.
        if !self.instances.iter().any(|i| must_stay_positive(i.port)) {
            return true;
        }
        let acts = self.acting(plant, &Instant::<D>::of(state, inputs, 0.0), room);
        let is_positive =
            |port: Port, at: usize| self.coefficient(plant, acts, port, at).is_none_or(|c| c.is_above(0.0));
        self.instances.iter().all(|i| is_positive(i.port, i.at))
    }

    /// What a port's coefficient has become, where it must stay above zero.
    fn coefficient(&self, plant: &Plant<D>, acts: &Acts<D>, port: Port, at: usize) -> Option<D> {
        let act = acts.muscles.get(at).filter(|_| port <= Port::RestLength)?.at(port);
        let Drive::Hydraulic { chain, .. } = &plant.muscles[at].drive else { return None };
        match port {
            Port::Plunger => Some(chain.compliance_m3_pa[0] + act.add),
            Port::SyringeCompliance => Some(act.on(chain.compliance_m3_pa[0])),
            Port::LineCompliance => Some(act.on(chain.compliance_m3_pa[chain.segments()])),
            Port::Inertance => Some(act.on(chain.inertance_pa_s2_m3)),
            Port::Area => Some(act.scale),
            _ => None,
        }
    }
}

/// Whether a port's coefficient must stay above zero.
fn must_stay_positive(port: Port) -> bool {
    use Port as P;
    matches!(port, P::Plunger | P::SyringeCompliance | P::LineCompliance | P::Inertance | P::Area)
}

/// What is said of a coefficient that is not above zero.
fn turned_over(port: Port) -> &'static str {
    match port {
        Port::Plunger => "makes the drive yield against the pressure",
        Port::Inertance => "makes the fluid's inertia negative",
        Port::Area => "turns the muscle's area over",
        _ => "makes a compliance negative",
    }
}

impl PlantLaws<f64> {
    /// Whether a variable of a law is no number any more: then it is not the law's own fault.
    fn is_given_nonsense(&self, instance: &Instance, plant: &Plant<f64>, now: &Instant<f64>, acts: &Acts<f64>) -> bool {
        let variables = self.laws[instance.law].symbols.iter().zip(&instance.sources);
        let mut of_variables = variables.filter(|(symbol, _)| matches!(symbol, Symbol::Variable(_)));
        of_variables.any(|(_, source)| !self.read(*source, instance, plant, now, &acts.tension_n).is_finite())
    }

    /// The first law that cannot be followed at a state.
    pub fn fault(&self, plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan]) -> Option<LawFault> {
        let now: Instant<f64> = Instant::of(state, inputs, 0.0);
        let mut acts = self.afresh(plant, &now);
        for instance in &self.instances {
            let law = &self.laws[instance.law];
            let value = self.value(instance, plant, &now, &mut acts);
            let (at, port) = (instance.at, instance.port);
            let states = &now.at.law_states()[instance.state_at..][..law.states.len()];
            let is_turned = self.coefficient(plant, &acts, port, at).is_some_and(|c| c <= 0.0);
            if !value.is_finite() && self.is_given_nonsense(instance, plant, &now, &acts) {
                continue;
            }
            let turned = is_turned.then(|| turned_over(port));
            let fault = match (value.is_finite(), states.iter().position(|s| !s.is_finite()), turned) {
                (_, Some(i), _) => Some(format!("its state {} is {}", law.states[i].name, states[i])),
                (false, None, _) => Some(format!("its value is {value}")),
                (true, None, Some(words)) => Some(format!("its value {value:.4e} {words}")),
                (true, None, None) => None,
            };
            if let Some(what) = fault {
                let values = law.symbols.iter().enumerate().filter_map(|(i, symbol)| match symbol {
                    Symbol::Variable(v) => {
                        let value = self.read(instance.sources[i], instance, plant, &now, &acts.tension_n);
                        Some(format!("{} = {value:.4e}", v.name()))
                    }
                    _ => None,
                });
                let values = values.collect::<Vec<_>>().join(", ");
                let what = if values.is_empty() { what } else { format!("{what} at {values}") };
                return Some(LawFault { law: format!("{} ({})", law.name, law.address), what });
            }
        }
        None
    }
}
