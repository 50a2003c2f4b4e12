//! Lines of the energy balance that effects have: what each brings in, holds, and takes away.

use crate::hydraulics::Chain;

use super::plant::{Drive, InputSpan, Instant, MuscleForces, MusclePlant, Plant, dot};
use super::state::PlantState;

/// Lines of effects in the order of the balance: what something outside the scene, or a law that keeps no energy, brings in
/// (`_work`), what is held (`stored_`), what turns into heat or leaves with the fluid (`lost_`).
///
/// Softening takes from what the wall would give back and does not return it: that is lost once the wall is stretched.
const NAMES: [&str; 16] = [
    "gravity_load_work",
    "thermal_expansion_work",
    "tendon_coupling_work",
    "stored_trapped_air",
    "stored_relaxation_springs",
    "stored_coil_preload",
    "stored_softened_wall",
    "stored_bearing_presliding",
    "stored_contact_walls",
    "lost_leak",
    "lost_line_restriction",
    "lost_relaxation",
    "lost_plastic_set",
    "lost_bearing_friction",
    "lost_tendon_friction",
    "lost_softening",
];

/// What stands on each line: powers, W, or energies, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct EffectLines([f64; NAMES.len()]);

impl EffectLines {
    fn add(&mut self, line: &str, value: f64) {
        let at = NAMES.iter().position(|name| *name == line);
        debug_assert!(at.is_some(), "{line} is no line of the balance");
        if let Some(at) = at {
            self.0[at] += value;
        }
    }

    /// Adds so many times another.
    pub fn add_scaled(&mut self, other: &Self, scale: f64) {
        for (own, other) in self.0.iter_mut().zip(other.0) {
            *own += scale * other;
        }
    }

    /// What was brought in, less what is held and what was lost.
    pub fn net(&self) -> f64 {
        NAMES.iter().zip(self.0).map(|(name, x)| if name.ends_with("_work") { x } else { -x }).sum()
    }

    /// Lines whose names begin or end so, those at zero left away.
    pub fn lines(&self, part: &'static str) -> impl Iterator<Item = (&'static str, f64)> {
        let is_part = move |name: &str| name.starts_with(part) || name.ends_with(part);
        NAMES.into_iter().zip(self.0).filter(move |(name, x)| is_part(name) && *x != 0.0)
    }
}

/// Powers of the effects at a state.
pub(super) fn effect_flows(
    plant: &Plant<f64>,
    state: &PlantState<f64>,
    inputs: &[InputSpan],
    elapsed_s: f64,
) -> EffectLines {
    let mut flows = EffectLines::default();
    let now: Instant<f64> = Instant::of(state, inputs, elapsed_s);
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let forces = plant.stock_forces(i, &now);
        muscle_flows(muscle, &forces, muscle.slow(&state.parts()), state.greatest_j[i], &mut flows);
        if let Drive::Hydraulic { chain, .. } = &muscle.drive {
            flows.add("lost_line_restriction", restriction_w(muscle, chain, state.line(i).flow_m3_s));
        }
    }
    for (i, cable) in plant.cables.iter().enumerate() {
        let tension = plant.cable(i, state, inputs, elapsed_s).2;
        if let Some(friction) = &cable.friction {
            let sliding = state.parts().joint_z()[plant.mechanism.frictions.len() + i];
            let kept = |j: usize, share: f64| tension * (share - 1.0) * friction.far[j] * state.w()[j];
            friction.shares(state.y(), sliding, |j, share| flows.add("lost_tendon_friction", kept(j, share)));
        }
        for coupling in plant.mechanism.couplings.iter().filter(|c| c.cable == i) {
            flows.add("tendon_coupling_work", coupling.lever_m * tension * dot::<_, 0>(&coupling.direction, state.w()));
        }
    }
    for load in &plant.mechanism.loads {
        flows.add("gravity_load_work", load.force * dot::<_, 0>(&load.direction, state.w()));
    }
    for (friction, z) in plant.mechanism.frictions.iter().zip(state.parts().joint_z()) {
        flows.add(
            "lost_bearing_friction",
            friction.law.dissipation_w(*z, dot::<_, 0>(&friction.direction, state.w()), 0.0),
        );
    }
    flows
}

fn muscle_flows(
    muscle: &MusclePlant<f64>,
    f: &MuscleForces<f64>,
    slow: &[f64],
    greatest_j: f64,
    flows: &mut EffectLines,
) {
    let x = &muscle.extras;
    let p = f.pressure_pa;
    flows.add("lost_leak", x.leak_m3_s_pa.map_or(0.0, |g| g * p * p));
    flows.add("thermal_expansion_work", x.growth_m3_s.map_or(0.0, |q| q * p));
    for (branch, &dashpot) in x.branches.iter().zip(slow) {
        flows.add("lost_relaxation", branch.dissipation_w(f.elongation_m, dashpot));
    }
    if let Some(plastic) = &x.plastic {
        let seen = f.elongation_m - x.set_m(slow);
        let law = muscle.elastic.softened(seen, p, x.mullins.as_ref(), greatest_j);
        // What wall and coil pull with, the pressure's part left to the fluid's account.
        flows.add("lost_plastic_set", (law.pull_n + p * law.area_m2) * plastic.rate_m_s(f.elongation_m));
    }
}

/// What the line loses beyond its bore's own resistance, W.
pub(super) fn restriction_w(muscle: &MusclePlant<f64>, chain: &Chain<f64>, flow_m3_s: &[f64]) -> f64 {
    let Some(ratio) = muscle.extras.restriction_ratio else { return 0.0 };
    let added = chain.resistance_pa_s_m3 * ratio / (1.0 + ratio);
    flow_m3_s.iter().map(|q| (added + chain.quadratic_pa_s2_m6 * q.abs()) * q * q).sum()
}

/// Energies that the effects hold at a state.
pub(super) fn effect_stores(
    plant: &Plant<f64>,
    state: &PlantState<f64>,
    inputs: &[InputSpan],
    elapsed_s: f64,
) -> EffectLines {
    let mut stores = EffectLines::default();
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let x = &muscle.extras;
        let elongation = dot::<_, 0>(&muscle.jacobian, state.y()) + muscle.elongation_0_m;
        let slow = muscle.slow(&state.parts());
        let pressure = plant.muscle_pressure(i, state, inputs, elapsed_s);
        stores.add("stored_trapped_air", x.air.as_ref().map_or(0.0, |air| air.energy_j(pressure)));
        for (branch, &dashpot) in x.branches.iter().zip(slow) {
            stores.add("stored_relaxation_springs", branch.energy_j(elongation, dashpot));
        }
        stores.add("stored_coil_preload", x.preload.as_ref().map_or(0.0, |preload| preload.energy_j(elongation)));
        if let Some(mullins) = &x.mullins {
            let greatest = state.greatest_j[i];
            let wall = muscle.elastic.wall_energy_j(elongation - x.set_m(slow));
            let lost = mullins.lost_j(greatest);
            stores.add("stored_softened_wall", mullins.withheld_j(wall, greatest) - lost);
            stores.add("lost_softening", lost);
        }
    }
    for (friction, z) in plant.mechanism.frictions.iter().zip(state.parts().joint_z()) {
        stores.add("stored_bearing_presliding", friction.law.stored_energy_j(*z, 0.0));
    }
    for w in &plant.mechanism.walls {
        stores.add("stored_contact_walls", w.wall.energy_j(dot::<_, 0>(&w.direction, state.y())));
    }
    stores
}
