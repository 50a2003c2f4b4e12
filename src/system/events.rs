//! Guards at run time: what a reader of the recording should be warned of.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::mechanism::Contact;
use crate::muscle::YIELD_STRETCH;

use super::Simulation;

/// What kind of trouble a condition is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Concern {
    /// A cable hangs.
    Slack,
    /// The fluid boils.
    Cavitation,
    /// A coil is beyond its yield.
    Yield,
    /// Bodies are inside each other.
    Penetration,
    /// A joint is beyond its limits in the URDF.
    JointLimit,
}

impl Concern {
    pub const ALL: [Self; 5] = [Self::Slack, Self::Cavitation, Self::Yield, Self::Penetration, Self::JointLimit];

    /// Its name in files.
    #[doc(hidden)]
    pub fn word(self) -> &'static str {
        match self {
            Self::Slack => "slack",
            Self::Cavitation => "cavitation",
            Self::Yield => "yield",
            Self::Penetration => "penetration",
            Self::JointLimit => "joint_limit",
        }
    }
}

/// How long a run was in each kind of trouble, in any of its parts, s; in the order of [`Concern::ALL`].
pub type ConcernsS = [f64; Concern::ALL.len()];

/// Adds the next interval's length where the state at its start is in trouble.
pub(super) fn count_concerns(simulation: &Simulation, interval_s: f64, durations_s: &mut ConcernsS) {
    let present = conditions(simulation);
    for (concern, duration_s) in Concern::ALL.into_iter().zip(durations_s) {
        if present.iter().any(|(kind, _)| *kind == concern) {
            *duration_s += interval_s;
        }
    }
}

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
        let present: Vec<String> = conditions(simulation).into_iter().map(|(_, words)| words).collect();
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

/// Depth from which bodies are said to be inside each other, m: contacts of the stock scenes stay below a tenth of it.
const DEEP_M: f64 = 1e-4;

/// Slack from which a cable is said to hang, m: one that is just not pulled at the start is none.
const HANGING_M: f64 = 5e-5;

/// Conditions worth a warning that hold now.
fn conditions(simulation: &Simulation) -> Vec<(Concern, String)> {
    let mut present = muscle_conditions(simulation);
    let (built, spans) = (&simulation.built, simulation.end_spans());
    for (i, spec) in simulation.scene.file.cable.iter().enumerate() {
        if built.plant.cable(i, &built.state, &spans, 0.0).0 < -HANGING_M {
            present.push((Concern::Slack, format!("{}: slack by more than {} mm", spec.name, 1e3 * HANGING_M)));
        }
    }
    if let Some(mechanism) = &simulation.mechanism {
        let name = |link: usize| mechanism.link_names().get(link).map_or("a body", String::as_str);
        let deep = |c: &Contact| (c.penetration_m > DEEP_M).then(|| (name(c.link_a), name(c.link_b)));
        for (a, b) in mechanism.contacts().iter().filter_map(deep) {
            let words =
                (Concern::Penetration, format!("{a} and {b}: inside each other by more than {} mm", 1e3 * DEEP_M));
            if !present.contains(&words) {
                present.push(words);
            }
        }
        let beyond = |joint: &str| format!("joint {joint}: beyond its limit in the URDF, where the scene has no stop");
        present.extend(mechanism.beyond_limits().map(|joint| (Concern::JointLimit, beyond(joint))));
    }
    present
}

fn muscle_conditions(simulation: &Simulation) -> Vec<(Concern, String)> {
    let mut present = Vec::new();
    let state = &simulation.built.state;
    for (i, spec) in simulation.scene.file.muscle.iter().enumerate() {
        let Some(m) = simulation.built.muscle_index[i] else { continue };
        if state.boiling(m).iter().any(|b| *b) {
            present.push((Concern::Cavitation, format!("{}: the fluid cavitates", spec.name)));
        }
        let elongation = simulation.built.plant.muscle_forces(m, state, &simulation.end_spans(), 0.0).elongation_m;
        let tube = Some(&simulation.scene.makes[i]).filter(|make| make.tube.is_some());
        if tube.is_some_and(|make| 1.0 + elongation / make.rest_length_m > YIELD_STRETCH + 1e-9) {
            present.push((Concern::Yield, format!("{}: the coil is beyond its yield at 350 %", spec.name)));
        }
    }
    present
}
