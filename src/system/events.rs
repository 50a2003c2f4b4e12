//! Guards at run time: what a reader of the recording should be warned of.

use std::collections::BTreeMap;

use crate::muscle::YIELD_STRETCH;

use super::Simulation;

/// Begin and end of conditions, and how long each lasted in all.
#[derive(Clone, Debug, Default)]
pub struct Warnings {
    active: BTreeMap<String, f64>,
    total_s: BTreeMap<String, (f64, f64)>,
}

impl Warnings {
    /// Looks at the present state; returns what began or ended since the last look, in words.
    pub(super) fn look(&mut self, simulation: &Simulation) -> Vec<String> {
        let now = simulation.time_s();
        let present = conditions(simulation);
        let mut events = Vec::new();
        for condition in &present {
            if !self.active.contains_key(condition) {
                self.active.insert(condition.clone(), now);
                self.total_s.entry(condition.clone()).or_insert((now, 0.0));
                events.push(format!("{condition}: begins"));
            }
        }
        let ended: Vec<String> = self.active.keys().filter(|c| !present.contains(c)).cloned().collect();
        for condition in ended {
            self.close(&condition, now);
            events.push(format!("{condition}: ends"));
        }
        events
    }

    fn close(&mut self, condition: &str, now: f64) {
        if let (Some(begun), Some(entry)) = (self.active.remove(condition), self.total_s.get_mut(condition)) {
            entry.1 += now - begun;
        }
    }

    /// One line per condition: first time and duration.
    pub fn summary(&mut self, end_s: f64) -> Vec<String> {
        let open: Vec<String> = self.active.keys().cloned().collect();
        open.iter().for_each(|c| self.close(c, end_s));
        self.total_s
            .iter()
            .map(|(c, (first, total))| format!("{c}: first at {first:.3} s, {total:.3} s in all"))
            .collect()
    }
}

/// Conditions worth a warning that hold now.
fn conditions(simulation: &Simulation) -> Vec<String> {
    let mut present = Vec::new();
    let state = &simulation.built.state;
    for (i, spec) in simulation.scene.file.muscle.iter().enumerate() {
        let Some(m) = simulation.built.muscle_index[i] else { continue };
        if state.boiling(m).iter().any(|b| *b) {
            present.push(format!("{}: the fluid cavitates", spec.name));
        }
        let elongation = simulation.built.plant.muscle_forces(m, state, &simulation.end_spans(), 0.0).elongation_m;
        let tube = simulation.scene.file.muscles.as_ref().filter(|make| make.tube.is_some());
        if tube.is_some_and(|make| 1.0 + elongation / make.rest_length_m > YIELD_STRETCH + 1e-9) {
            present.push(format!("{}: the coil is beyond its yield at 350 %", spec.name));
        }
    }
    present
}
