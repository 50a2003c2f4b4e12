//! Lines of the energy book that effects have: what each brings in, holds, and takes away.

use crate::hydraulics::Chain;

use super::plant::{Drive, InputSpan, Instant, MuscleForces, MusclePlant, Plant, dot};
use super::state::PlantState;

/// Which side of the book a flow of energy stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// Brought in by something outside the scene, or by a law that keeps no energy; either sign.
    Brought,
    /// Turned into heat, or gone with the fluid.
    Lost,
}

/// Flows of energy through effects.
#[derive(Clone, Copy, Debug)]
enum Flow {
    Gravity,
    Expansion,
    Coupling,
    Leak,
    Restriction,
    Relaxation,
    PlasticSet,
    Bearing,
    Tendon,
}

/// Name and side of each [`Flow`], in its order.
const FLOWS: [(&str, Side); 9] = [
    ("gravity_load_work", Side::Brought),
    ("thermal_expansion_work", Side::Brought),
    ("tendon_coupling_work", Side::Brought),
    ("lost_leak", Side::Lost),
    ("lost_line_restriction", Side::Lost),
    ("lost_relaxation", Side::Lost),
    ("lost_plastic_set", Side::Lost),
    ("lost_bearing_friction", Side::Lost),
    ("lost_tendon_friction", Side::Lost),
];

/// What effects hold. Softening takes from what the wall would give back and does not return it.
#[derive(Clone, Copy, Debug)]
enum Store {
    Air,
    Relaxation,
    Preload,
    Softening,
    Softened,
    Bearing,
    Walls,
}

/// Name of each [`Store`], in its order.
const STORES: [&str; 7] = [
    "stored_trapped_air",
    "stored_relaxation_springs",
    "stored_coil_preload",
    "stored_softened_wall",
    "lost_softening",
    "stored_bearing_presliding",
    "stored_contact_walls",
];

/// Powers (W), or their integrals (J), of all [`Flow`]s.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct EffectFlows([f64; FLOWS.len()]);

/// Energies of all [`Store`]s, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct EffectStores([f64; STORES.len()]);

impl EffectFlows {
    fn add(&mut self, flow: Flow, power_w: f64) {
        self.0[flow as usize] += power_w;
    }

    /// Adds `h` times the mean of two powers.
    pub fn integrate(&mut self, before: &Self, after: &Self, h: f64) {
        for ((sum, b), a) in self.0.iter_mut().zip(before.0).zip(after.0) {
            *sum += h * (b + a) / 2.0;
        }
    }

    /// What was brought in less what was lost.
    pub fn net(&self) -> f64 {
        let signed = self.0.iter().zip(FLOWS).map(|(x, (_, side))| if side == Side::Lost { -x } else { *x });
        signed.sum()
    }

    /// Lines of one side, those at zero left away.
    pub fn lines(&self, side: Side) -> impl Iterator<Item = (&'static str, f64)> {
        let all = FLOWS.into_iter().zip(self.0);
        all.filter(move |((_, s), x)| *s == side && *x != 0.0).map(|((name, _), x)| (name, x))
    }
}

impl EffectStores {
    fn add(&mut self, store: Store, energy_j: f64) {
        self.0[store as usize] += energy_j;
    }

    /// All together.
    pub fn total(&self) -> f64 {
        self.0.iter().sum()
    }

    /// Changes since a state whose names begin so, those at zero left away.
    pub fn lines(&self, since: &Self, beginning: &'static str) -> impl Iterator<Item = (&'static str, f64)> {
        let changes = std::array::from_fn::<f64, { STORES.len() }, _>(|i| self.0[i] - since.0[i]);
        let named = STORES.into_iter().zip(changes);
        named.filter(move |(name, change)| name.starts_with(beginning) && *change != 0.0)
    }
}

/// Powers of the effects at a state.
pub(super) fn effect_flows(
    plant: &Plant<f64>,
    state: &PlantState<f64>,
    inputs: &[InputSpan],
    elapsed_s: f64,
) -> EffectFlows {
    let mut flows = EffectFlows::default();
    let now: Instant<f64> = Instant::of(state, inputs, elapsed_s);
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let forces = plant.stock_forces(i, &now);
        muscle_flows(muscle, &forces, muscle.slow(&state.parts()), state.greatest_j[i], &mut flows);
        if let Drive::Hydraulic { chain, .. } = &muscle.drive {
            flows.add(Flow::Restriction, restriction_w(muscle, chain, state.line(i).flow_m3_s));
        }
    }
    for (i, cable) in plant.cables.iter().enumerate() {
        let tension = plant.cable(i, state, inputs, elapsed_s).2;
        if let Some(friction) = &cable.friction {
            let sliding = state.parts().joint_z()[plant.mechanism.frictions.len() + i];
            let kept = |j: usize, share: f64| tension * (share - 1.0) * friction.far[j] * state.w()[j];
            friction.shares(state.y(), sliding, |j, share| flows.add(Flow::Tendon, kept(j, share)));
        }
        for coupling in plant.mechanism.couplings.iter().filter(|c| c.cable == i) {
            flows.add(Flow::Coupling, coupling.lever_m * tension * dot::<_, 0>(&coupling.direction, state.w()));
        }
    }
    for load in &plant.mechanism.loads {
        flows.add(Flow::Gravity, load.force * dot::<_, 0>(&load.direction, state.w()));
    }
    for (friction, z) in plant.mechanism.frictions.iter().zip(state.parts().joint_z()) {
        flows.add(Flow::Bearing, friction.law.dissipation_w(*z, dot::<_, 0>(&friction.direction, state.w()), 0.0));
    }
    flows
}

fn muscle_flows(
    muscle: &MusclePlant<f64>,
    f: &MuscleForces<f64>,
    slow: &[f64],
    greatest_j: f64,
    flows: &mut EffectFlows,
) {
    let x = &muscle.extras;
    let p = f.pressure_pa;
    flows.add(Flow::Leak, x.leak_m3_s_pa.map_or(0.0, |g| g * p * p));
    flows.add(Flow::Expansion, x.growth_m3_s.map_or(0.0, |q| q * p));
    for (branch, &dashpot) in x.branches.iter().zip(slow) {
        flows.add(Flow::Relaxation, branch.dissipation_w(f.elongation_m, dashpot));
    }
    if let Some(plastic) = &x.plastic {
        let seen = f.elongation_m - x.set_m(slow);
        let law = muscle.elastic.softened(seen, p, x.mullins.as_ref(), greatest_j);
        // What wall and coil pull with, the pressure's part left to the fluid's account.
        flows.add(Flow::PlasticSet, (law.pull_n + p * law.area_m2) * plastic.rate_m_s(f.elongation_m));
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
) -> EffectStores {
    let mut stores = EffectStores::default();
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let x = &muscle.extras;
        let elongation = dot::<_, 0>(&muscle.jacobian, state.y()) + muscle.elongation_0_m;
        let slow = muscle.slow(&state.parts());
        let pressure = plant.muscle_pressure(i, state, inputs, elapsed_s);
        stores.add(Store::Air, x.air.as_ref().map_or(0.0, |air| air.energy_j(pressure)));
        for (branch, &dashpot) in x.branches.iter().zip(slow) {
            stores.add(Store::Relaxation, branch.energy_j(elongation, dashpot));
        }
        stores.add(Store::Preload, x.preload.as_ref().map_or(0.0, |preload| preload.energy_j(elongation)));
        if let Some(mullins) = &x.mullins {
            let greatest = state.greatest_j[i];
            let wall = muscle.elastic.wall_energy_j(elongation - x.set_m(slow));
            let lost = mullins.lost_j(greatest);
            stores.add(Store::Softening, mullins.withheld_j(wall, greatest) - lost);
            stores.add(Store::Softened, lost);
        }
    }
    for (friction, z) in plant.mechanism.frictions.iter().zip(state.parts().joint_z()) {
        stores.add(Store::Bearing, friction.law.stored_energy_j(*z, 0.0));
    }
    for w in &plant.mechanism.walls {
        stores.add(Store::Walls, w.wall.energy_j(dot::<_, 0>(&w.direction, state.y())));
    }
    stores
}
