//! The terms of the energy balance at one state: powers, and what is stored.

use crate::system::coordinates::CoordinateStop;
use crate::system::effect_energy::restriction_w;
use crate::system::elastic::Elastic;
use crate::system::plant::{Drive, InputSpan, Instant, Plant, dot};
use crate::system::rates::pressure_rates;
use crate::system::state::PlantState;

/// Powers at one state, W.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Powers {
    /// By plungers, recorded pressures and driven cable ends, into the system.
    pub input: f64,
    /// By constant forces on the coordinates: loads, weights.
    pub loads: f64,
    pub line_viscosity: f64,
    pub muscle_damping: f64,
    pub muscle_friction: f64,
    pub pressure_friction: f64,
    pub cable_damping: f64,
    pub joint_damping: f64,
    pub stop_damping: f64,
}

/// Powers at an instant.
pub(super) fn powers(plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan], elapsed_s: f64) -> Powers {
    let c = &plant.coordinates;
    let mut p = Powers { loads: c.force.iter().zip(state.w()).map(|(f, w)| f * w).sum(), ..Powers::default() };
    p.joint_damping = c.damping.iter().zip(state.w()).map(|(d, w)| d * w * w).sum();
    for stop in &c.stops {
        let (y, w) = (state.y()[stop.coordinate], state.w()[stop.coordinate]);
        let (depth, force) = CoordinateStop::force(stop, y, w);
        if depth > 0.0 {
            p.stop_damping += (stop.side * stop.stiffness * depth - force) * w;
        }
    }
    let now: Instant<f64> = Instant::of(state, inputs, elapsed_s);
    for (i, cable) in plant.cables.iter().enumerate() {
        // What laws do to a cable stands in their own lines.
        let (stretch, rate, tension) = cable.pull(&now);
        if stretch > 0.0 {
            p.cable_damping += (tension - cable.stiffness_n_m * stretch) * rate;
        }
        if let Some((input, gain)) = cable.drive {
            p.input += plant.cable(i, state, inputs, elapsed_s).2 * gain * inputs[input].slope;
        }
    }
    let rates = plant.laws.as_ref().map(|_| pressure_rates(plant, &now));
    for i in 0..plant.muscles.len() {
        muscle_powers(plant, i, (state, &now), rates.as_ref().map(|r| r[i]), &mut p);
    }
    p
}

fn muscle_powers(
    plant: &Plant<f64>,
    i: usize,
    (state, now): (&PlantState<f64>, &Instant<f64>),
    rate_under_laws: Option<f64>,
    p: &mut Powers,
) {
    let (muscle, inputs) = (&plant.muscles[i], now.inputs);
    let f = plant.stock_forces(i, now);
    p.muscle_damping += f.damping_n * f.speed_m_s;
    if let Some(stop) = &muscle.stop
        && f.elongation_m < 0.0
    {
        p.stop_damping += (-stop.stiffness_n_m * f.elongation_m - f.stop_n) * f.speed_m_s;
    }
    let pressure_rate = match &muscle.drive {
        Drive::Hydraulic { chain, syringe_area_m2, plunger } => {
            let s = state.line(i);
            p.input += s.pressure_pa[0] * syringe_area_m2 * inputs[*plunger].slope;
            p.line_viscosity += chain.dissipation_w(state.parts().line(i)) - restriction_w(muscle, chain, s.flow_m3_s);
            let n = chain.segments();
            let net = s.flow_m3_s[n - 1] - f.port.outflow_m3_s;
            let rate = || net / (chain.compliance_m3_pa[n] + f.port.compliance_m3_pa);
            if state.boiling(i)[n] { 0.0 } else { rate_under_laws.unwrap_or_else(rate) }
        }
        Drive::Pressure { pressure } => {
            p.input += f.pressure_pa * f.port.outflow_m3_s;
            inputs[*pressure].slope
        }
    };
    if let Some(friction) = &muscle.friction {
        p.muscle_friction += friction.dissipation_w(state.parts().z(i), f.speed_m_s, f.pressure_pa);
        p.pressure_friction += friction.pressure_exchange_w(state.parts().z(i), f.pressure_pa, pressure_rate);
    }
}

/// Energy stored at an instant, J.
pub(super) fn stored(plant: &Plant<f64>, state: &PlantState<f64>, inputs: &[InputSpan], elapsed_s: f64) -> f64 {
    let c = &plant.coordinates;
    let n = plant.dim();
    let mut energy = 0.0;
    for i in 0..n {
        energy += 0.5 * c.stiffness[i] * (state.y()[i] - c.rest[i]).powi(2);
        energy += 0.5 * state.w()[i] * (0..n).map(|j| c.inertia[i * n + j] * state.w()[j]).sum::<f64>();
    }
    for stop in &c.stops {
        let depth = ((stop.position - state.y()[stop.coordinate]) * stop.side).max(0.0);
        energy += 0.5 * stop.stiffness * depth * depth;
    }
    let now: Instant<f64> = Instant::of(state, inputs, elapsed_s);
    for cable in &plant.cables {
        energy += 0.5 * cable.stiffness_n_m * cable.stretch_and_rate(&now).0.max(0.0).powi(2);
    }
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let e = dot::<_, 0>(&muscle.jacobian, state.y()) + muscle.elongation_0_m;
        let p = plant.muscle_pressure(i, state, inputs, elapsed_s);
        energy += elastic_energy(&muscle.elastic, e - muscle.extras.set_m(muscle.slow(&state.parts())), p);
        energy += muscle.stop.as_ref().map_or(0.0, |s| s.energy_j(e));
        energy += muscle.friction.as_ref().map_or(0.0, |f| f.stored_energy_j(state.parts().z(i), p));
        if let Drive::Hydraulic { chain, .. } = &muscle.drive {
            energy += chain.energy_j(state.parts().line(i));
            energy -= chain.cavitation_pressure_pa * state.line(i).vapour_m3.iter().sum::<f64>();
        }
    }
    energy
}

/// Energy of wall and coil; for a wall that may leave its coil `U(e, p)` at its own radius.
fn elastic_energy(elastic: &Elastic<f64>, e: f64, p: f64) -> f64 {
    match elastic {
        Elastic::Tube { wall, condition, coil, .. } => {
            let wall_energy = match condition {
                crate::muscle::WallCondition::Held => wall.energy_j(e),
                crate::muscle::WallCondition::Unilateral => wall.unilateral(e, p).energy_j,
            };
            wall_energy + coil.energy_j(e)
        }
        Elastic::Linear { stiffness_n_m, .. } => 0.5 * stiffness_n_m * e * e,
    }
}
