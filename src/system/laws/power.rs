//! What laws bring into the energy balance, W: all that they change against the plant without them.

use crate::laws::{Carrier, Port};
use crate::system::plant::{Drive, InputSpan, Instant, Plant};
use crate::system::rates::all_rates;
use crate::system::state::PlantState;

use super::apply::{along, joint_force};
use super::{Acts, PlantLaws};

/// Power that each law brings in (> 0) or takes away, W. Laws on one element are counted in the order of the scene; what
/// pistons do is work over a way, not a power: see [`PlantLaws::pistons`].
pub fn law_powers(plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan], elapsed_s: f64) -> Vec<f64> {
    let Some(laws) = &plant.laws else { return Vec::new() };
    let now: Instant<f64> = Instant::of(state, inputs, elapsed_s);
    let row = all_rates(plant, &now);
    let moving = state.layout.parts::<f64, 0>(&row);
    let mut acts = laws.room(plant);
    let mut before = 0.0;
    let brought = (1..=laws.laws.len()).map(|count| {
        laws.act_first(count, plant, &now, &mut acts);
        let all: f64 = (0..plant.muscles.len())
            .map(|i| laws.muscle_power(i, plant, &now, (&acts, moving.line(i))))
            .chain((0..plant.cables.len()).map(|i| laws.cable_power(i, plant, &now, &acts)))
            .chain(laws.joint_sites().map(|site| laws.joint_power(site, plant, &now, &acts)))
            .sum();
        let own = all - before;
        before = all;
        own
    });
    brought.collect()
}

impl PlantLaws<f64> {
    /// On a muscle with its line and syringe; `rates` are those of its line.
    fn muscle_power(
        &self,
        i: usize,
        plant: &Plant<f64>,
        now: &Instant<f64>,
        (acts, rates): (&Acts<f64>, &[f64]),
    ) -> f64 {
        if self.instances.iter().all(|x| x.at != i || x.carrier != Carrier::Muscle) {
            return 0.0;
        }
        let own = &acts.muscles[i];
        let stock = plant.stock_forces(i, now);
        let under = plant.forces_seen(i, now, Some(acts));
        let pressure = stock.pressure_pa;
        let mut power = -(under.pull_n() - stock.pull_n()) * stock.speed_m_s;
        let Drive::Hydraulic { chain, .. } = &plant.muscles[i].drive else {
            // The line of the input counts the stock volume alone: what more there is comes by the law.
            return power;
        };
        let n = chain.segments();
        let (line, is_boiling) = (now.state.layout.parts::<f64, 0>(now.at.row()).line(i), now.state.boiling(i));
        let (first, flows, flow_rates) = (line[0], &line[n + 1..2 * n + 1], &rates[n + 1..2 * n + 1]);
        power -= (under.port.outflow_m3_s - stock.port.outflow_m3_s) * pressure;
        power -= own.at(Port::SyringeFlow).add * first;
        let upstream = chain.compliance_m3_pa[0] - chain.end_share_m3_pa;
        let before = own.at(Port::SyringeCompliance).on(upstream) - upstream;
        let after = under.port.compliance_m3_pa - stock.port.compliance_m3_pa;
        for (added, node) in [(before, 0), (after, n)] {
            power -= if is_boiling[node] { 0.0 } else { added * line[node] * rates[node] };
        }
        let inertia =
            own.at(Port::Inertance).on(chain.inertance_pa_s2_m3 * n as f64) / n as f64 - chain.inertance_pa_s2_m3;
        for (flow, rate) in flows.iter().zip(flow_rates) {
            let resistance = chain.resistance_pa_s_m3 + chain.quadratic_pa_s2_m6 * flow.abs();
            let drop = line_drop(own, chain.resistance_pa_s_m3, resistance, *flow, n);
            power -= flow * (drop - resistance * flow) + inertia * flow * rate;
        }
        power
    }

    fn cable_power(&self, i: usize, plant: &Plant<f64>, now: &Instant<f64>, acts: &Acts<f64>) -> f64 {
        if !self.on_cables() {
            return 0.0;
        }
        let cable = &plant.cables[i];
        let (_, stock_rate, stock) = cable.pull(now);
        let pull = self.cable(i, plant, now, acts);
        let lever = acts.cables[i].at(Port::Lever);
        let driven: f64 = stock_rate - along(&cable.jacobian, now.at.w());
        let taken: f64 = (0..now.at.w().len())
            .map(|j| {
                let tension = if j < self.joints { pull.far_n } else { pull.tension_n };
                tension * cable.lever_under(lever, j, self.joints) * now.at.w()[j]
            })
            .sum();
        stock * stock_rate - taken - pull.tension_n * driven
    }

    fn joint_power(&self, site: usize, plant: &Plant<f64>, now: &Instant<f64>, acts: &Acts<f64>) -> f64 {
        let direction = &self.rig.directions[site].direction;
        let each = direction.iter().enumerate().filter(|(_, share)| **share != 0.0);
        each.map(|(i, share)| share * joint_force(plant, now, &acts.joints[site], i) * now.at.w()[i]).sum()
    }
}

/// Viscous pressure drop of one of `n` segments under the laws of resistance and drop, Pa.
pub(in crate::system) fn line_drop<D: crate::scalar::Scalar>(
    acts: &super::MuscleActs<D>,
    resistance_pa_s_m3: D,
    with_quadratic_pa_s_m3: D,
    flow_m3_s: D,
    n: usize,
) -> D {
    let count = n as f64;
    let resistance = acts.at(Port::Resistance).on(resistance_pa_s_m3 * count) / count;
    let drop = (resistance + (with_quadratic_pa_s_m3 - resistance_pa_s_m3)) * flow_m3_s;
    acts.at(Port::PressureDrop).on(drop * count) / count
}
