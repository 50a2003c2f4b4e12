//! One fine step of a [`Plant`]: a two-stage Rosenbrock method.
//!
//! ```text
//! (1 - g A) k1 = F(u_n)                          g = gamma h, gamma = 1 - 1/sqrt(2)
//! (1 - g A) k2 = F(u_n + h k1) - 2 k1
//! u_(n+1) = u_n + h (3 k1 + k2)/2
//! ```
//! (Verwer's ROS2.) L-stable, and of second order whatever matrix stands in for the Jacobian `A`: tangents may be
//! taken where they are cheap, only stability needs them near. One factorisation and two solves a step, no iteration,
//! so a step costs the same wherever the state is, and derivatives pass through it exactly.
//!
//! The tangents are therefore kept as long as the same cables pull and the same stops, contacts and vapour are met,
//! at most [`KEEP`] steps; this halves the work.
//!
//! The unknowns are eliminated down to the coordinates' accelerations: the line is tridiagonal ([`ChainSolver`]), the
//! friction states and the dashpots are local, so what remains is a symmetric matrix of the size of the mechanism.

use crate::scalar::Scalar;

use super::laws::Acts;
use super::plant::{Drive, InputSpan, Instant, Plant, add_scaled, dot};
use super::rates::{Seen, Switches, rates};
use super::state::{Layout, PlantState, sized, sized_mut};
use super::tangents::Tangents;

/// `1 - 1/sqrt(2)`: the smaller of the two values that make the method L-stable.
const GAMMA: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// Steps after which the tangents are taken anew even if nothing was switched.
const KEEP: u32 = 16;
/// And the time after which they are, s: the friction states have moved on.
const KEEP_S: f64 = 3.2e-3;

/// Buffers of the integrator; make one per plant and keep it.
///
/// Rates and stages are rows like the state's own, so that what is done to all numbers alike is one loop.
#[derive(Clone, Debug)]
pub struct Stepper<D> {
    /// Rates or right-hand side, and the stages.
    r: Vec<D>,
    k1: Vec<D>,
    k2: Vec<D>,
    /// Where the second stage is taken, and then where the step ends.
    ahead: Vec<D>,
    /// Speed of each piston over the step, m/s, and how far it is ahead of its plunger at the end, m.
    piston_m_s: Vec<D>,
    piston_ahead_m: Vec<D>,
    /// How far laws of the plunger move each piston in the step beyond what their rates tell, m.
    piston_lead_m: Vec<D>,
    seen: Seen<D>,
    /// For what laws do where a step ends.
    pub(super) room: Option<Acts<D>>,
    tangents: Tangents<D>,
    /// Everything one-sided where the tangents were taken, and how many steps ago and for which step that was.
    switches: Switches,
    age: u32,
    tangent_step_s: f64,
}

impl<D: Scalar> Stepper<D> {
    /// Buffers for `plant` and states shaped like `state`.
    pub fn new(plant: &Plant<D>, state: &PlantState<D>) -> Self {
        let muscles = 0..plant.muscles.len();
        let row = vec![D::constant(0.0); state.row.len()];
        Self {
            r: row.clone(),
            k1: row.clone(),
            k2: row.clone(),
            ahead: row,
            piston_m_s: vec![D::constant(0.0); muscles.len()],
            piston_ahead_m: vec![D::constant(0.0); muscles.len()],
            piston_lead_m: vec![D::constant(0.0); muscles.len()],
            seen: Seen::new(plant),
            room: None,
            tangents: Tangents::new(plant, state.segments(), state.parts().joint_z().len(), state.parts().slow().len()),
            switches: Switches::default(),
            age: KEEP,
            tangent_step_s: 0.0,
        }
    }

    /// Forgets the tangents: inertia, levers or weights of the plant have changed.
    pub(crate) fn plant_changed(&mut self) {
        self.age = KEEP;
    }

    /// Takes a step of `h` seconds from `state`; `inputs` start at its beginning. Where it ends is for
    /// [`Stepper::accept`].
    ///
    /// Whether everything one-sided acted alike at both stages: where it did not, the step is too long to be trusted.
    pub(super) fn step(&mut self, plant: &Plant<D>, state: &PlantState<D>, inputs: &[InputSpan], h: f64) -> bool {
        // The reduced-order model has few coordinates, and a step of it is made of loops over them.
        let dim = if state.layout.is_of_one_segment() { plant.dim() } else { 0 };
        match dim {
            1 => self.step_on::<1>(plant, state, inputs, h),
            2 => self.step_on::<2>(plant, state, inputs, h),
            3 => self.step_on::<3>(plant, state, inputs, h),
            4 => self.step_on::<4>(plant, state, inputs, h),
            5 => self.step_on::<5>(plant, state, inputs, h),
            _ => self.step_on::<0>(plant, state, inputs, h),
        }
    }

    fn step_on<const N: usize>(
        &mut self,
        plant: &Plant<D>,
        state: &PlantState<D>,
        inputs: &[InputSpan],
        h: f64,
    ) -> bool {
        let g = GAMMA * h;
        let layout = &state.layout;
        self.move_pistons(plant, state, inputs, h);
        let now = Instant::<D, N>::of(state, inputs, 0.0);
        let switches = rates(plant, &now, &self.piston_m_s, &mut self.seen, layout.parts_mut(&mut self.r));
        let turns = plant.laws.as_ref().is_some_and(|laws| laws.rubs());
        if switches != self.switches || h != self.tangent_step_s || turns || self.are_tangents_old(h) {
            self.tangents.take(plant, &now, &mut self.seen, g);
            (self.switches, self.age, self.tangent_step_s) = (switches, 0, h);
        }
        self.age += 1;
        solve::<D, N>(plant, state, &mut self.tangents, g, &self.r, &mut self.k1);
        for ((to, &from), &k) in self.ahead.iter_mut().zip(&state.row).zip(&self.k1) {
            *to = from + k * h;
        }
        let then = Instant { at: layout.parts(&self.ahead), elapsed_s: h, ..now };
        let ahead = rates(plant, &then, &self.piston_m_s, &mut self.seen, layout.parts_mut(&mut self.r));
        subtract_first_stage::<D, N>(plant, layout, &self.k1, &mut self.r);
        solve::<D, N>(plant, state, &mut self.tangents, g, &self.r, &mut self.k2);
        for (((to, &from), &k1), &k2) in self.ahead.iter_mut().zip(&state.row).zip(&self.k1).zip(&self.k2) {
            *to = from + (k1 * 3.0 + k2) * (0.5 * h);
        }
        ahead == switches
    }

    fn are_tangents_old(&self, h: f64) -> bool {
        self.age >= KEEP || f64::from(self.age) * h >= KEEP_S
    }

    /// What would pull at the end of the step that was taken last ([`Plant::pulling`]).
    pub(super) fn pulling_ahead(
        &mut self,
        plant: &Plant<D>,
        state: &PlantState<D>,
        inputs: &[InputSpan],
        elapsed_s: f64,
    ) -> u64 {
        let now = Instant { state, at: state.layout.parts(&self.ahead), inputs, elapsed_s };
        plant.pulling::<0>(&now, &mut self.room)
    }

    /// Moves `state` to the end of the step of `h` seconds that was taken from it; `inputs` are still those of its beginning.
    pub(super) fn accept(&mut self, plant: &Plant<D>, state: &mut PlantState<D>, inputs: &[InputSpan], h: f64) {
        std::mem::swap(&mut state.row, &mut self.ahead);
        for (i, muscle) in plant.muscles.iter().enumerate() {
            if let Drive::Hydraulic { chain, .. } = &muscle.drive {
                let (row, boils) = state.line_mut(i);
                chain.settle_vapour(row, boils);
            }
            if muscle.extras.backlash.is_some() {
                state.piston_ahead_m[i] = self.piston_ahead_m[i];
            }
        }
        remember_greatest(plant, state);
        if let (Some(laws), Some(acts)) = (&plant.laws, &mut self.seen.acts) {
            if laws.remembers() {
                laws.follow(plant, state, inputs, h);
            }
            if laws.moves_pistons() {
                // The row of the beginning has been exchanged for that of the end.
                laws.note_pistons(plant, &self.ahead, (state, inputs, h), (acts, &self.piston_lead_m));
            }
        }
        state.time_s += h;
    }

    /// Where the pistons are at the end of the step, and how fast they go there.
    fn move_pistons(&mut self, plant: &Plant<D>, state: &PlantState<D>, inputs: &[InputSpan], h: f64) {
        for (i, muscle) in plant.muscles.iter().enumerate() {
            let Drive::Hydraulic { plunger, .. } = &muscle.drive else { continue };
            let span = inputs[*plunger];
            let Some(play) = &muscle.extras.backlash else {
                self.piston_m_s[i] = D::constant(span.slope);
                continue;
            };
            let before = state.piston_ahead_m[i];
            let after = play.follow(before, h * span.slope);
            self.piston_m_s[i] = (after - before) / h + span.slope;
            self.piston_ahead_m[i] = after;
        }
        if let (Some(laws), Some(acts)) = (&plant.laws, &mut self.seen.acts)
            && laws.moves_pistons()
        {
            let out = (&mut self.piston_m_s[..], &mut self.piston_lead_m[..]);
            laws.lead_pistons(plant, (state, inputs, h), acts, out);
        }
    }
}

/// One stage: `k` from the right-hand side `r`.
fn solve<D: Scalar, const N: usize>(
    plant: &Plant<D>,
    state: &PlantState<D>,
    tangents: &mut Tangents<D>,
    g: f64,
    r: &[D],
    k: &mut [D],
) {
    let (r, mut k) = (state.layout.parts::<D, N>(r), state.layout.parts_mut::<D, N>(k));
    let (k_y, k_w) = k.y_and_w();
    let (r_y, r_w) = (r.y(), r.w());
    let n = r_y.len();
    for i in 0..n {
        let springs = sized::<N, _>(&tangents.springs[i * n..(i + 1) * n]);
        k_w[i] = springs.iter().zip(r_y).fold(r_w[i], |sum, (&s, &y)| sum - s * y);
    }
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let t = &tangents.muscles[i];
        let rho = tangents.lines[i].eliminate(r.line(i));
        add_scaled::<_, N>(k_w, &muscle.jacobian, t.pull_per_rho * rho - t.friction.force_per_r * r.z(i));
    }
    if !tangents.frictions.is_empty() {
        push_dry_frictions(plant, tangents, r.joint_z(), k_w);
    }
    if !tangents.dashpots.is_empty() {
        push_dashpots(plant, tangents, g, r.slow(), k_w);
    }
    if let Some(laws) = tangents.laws.as_ref().filter(|laws| laws.remember()) {
        laws.push_states(plant, g, r.law_states(), k_w);
    }
    tangents.ldl.solve::<N>(k_w);
    for i in 0..n {
        k_y[i] = r_y[i] + k_w[i] * g;
    }
    for (i, muscle) in plant.muscles.iter().enumerate() {
        let t = &tangents.muscles[i];
        let acceleration = dot::<_, N>(&muscle.jacobian, k.w());
        *k.z(i) = t.friction.stage(r.z(i), acceleration);
        tangents.lines[i].back_substitute(t.area * acceleration, r.line(i), state.boiling_of::<N>(i), k.line(i));
    }
    if !tangents.frictions.is_empty() {
        let (speeds, states) = k.w_and_joint_z();
        stages_of_dry_frictions(plant, tangents, r.joint_z(), speeds, states);
    }
    if !tangents.dashpots.is_empty() {
        let (coordinates, states) = k.y_and_slow();
        stages_of_dashpots(plant, tangents, r.slow(), coordinates, states);
    }
    if let Some(laws) = tangents.laws.as_ref().filter(|laws| laws.remember()) {
        let (moving, states) = k.moving_and_law_states();
        laws.stages(plant, g, r.law_states(), moving, states);
    }
}

/// Kept apart: a stock scene has none.
#[inline(never)]
fn push_dry_frictions<D: Scalar>(plant: &Plant<D>, tangents: &Tangents<D>, r: &[D], forces: &mut [D]) {
    for ((t, direction), &r) in tangents.frictions.iter().zip(dry_frictions(plant)).zip(r) {
        add_scaled::<_, 0>(forces, direction, -(t.force_per_r * r));
    }
}

#[inline(never)]
fn stages_of_dry_frictions<D: Scalar>(
    plant: &Plant<D>,
    tangents: &Tangents<D>,
    r: &[D],
    accelerations: &[D],
    stages: &mut [D],
) {
    for (i, (t, direction)) in tangents.frictions.iter().zip(dry_frictions(plant)).enumerate() {
        stages[i] = t.stage(r[i], dot::<_, 0>(direction, accelerations));
    }
}

/// What the dashpots of relaxing muscles give way to.
#[inline(never)]
fn push_dashpots<D: Scalar>(plant: &Plant<D>, tangents: &Tangents<D>, g: f64, r: &[D], forces: &mut [D]) {
    for muscle in plant.muscles.iter().filter(|m| !m.extras.branches.is_empty()) {
        let dashpots = tangents.dashpots[muscle.slow_at..].iter().zip(&r[muscle.slow_at..]);
        let pull: D =
            muscle.extras.branches.iter().zip(dashpots).map(|(b, (t, &r))| b.stiffness_n_m * t.damper * r).sum();
        add_scaled::<_, 0>(forces, &muscle.jacobian, pull * g);
    }
}

/// Plastic sets have no tangent: they act back only through the forces, which are evaluated in full.
#[inline(never)]
fn stages_of_dashpots<D: Scalar>(
    plant: &Plant<D>,
    tangents: &Tangents<D>,
    r: &[D],
    coordinates: &[D],
    stages: &mut [D],
) {
    for muscle in plant.muscles.iter().filter(|m| m.extras.slow_states() > 0) {
        let elongation = dot::<_, 0>(&muscle.jacobian, coordinates);
        for i in muscle.slow_at..muscle.slow_at + muscle.extras.slow_states() {
            let tangent = &tangents.dashpots[i];
            stages[i] = (r[i] + tangent.gain * elongation) * tangent.damper;
        }
    }
}

/// Turns `F(u + h k1)` into the right-hand side of the second stage.
#[inline]
fn subtract_first_stage<D: Scalar, const N: usize>(plant: &Plant<D>, layout: &Layout, k1: &[D], r: &mut [D]) {
    let accelerations = layout.parts::<D, N>(k1).w();
    let n = accelerations.len();
    // The rates of the speeds are forces.
    for (i, force) in layout.parts_mut::<D, N>(r).w().iter_mut().enumerate() {
        let inertia = sized::<N, _>(&plant.coordinates.inertia[i * n..(i + 1) * n]);
        let inertial = inertia.iter().zip(accelerations).fold(D::constant(0.0), |sum, (&m, &a)| sum + m * a);
        *force -= inertial * 2.0;
    }
    for (r, &k) in sized_mut::<N, _>(&mut r[..n]).iter_mut().zip(k1) {
        *r -= k * 2.0;
    }
    for (r, &k) in r[2 * n..].iter_mut().zip(&k1[2 * n..]) {
        *r -= k * 2.0;
    }
}

/// Directions of the dry frictions, in the order of their states.
fn dry_frictions<D>(plant: &Plant<D>) -> impl Iterator<Item = &[f64]> {
    let joints = plant.mechanism.frictions.iter().map(|f| f.direction.as_slice());
    joints.chain(plant.cables.iter().map(|c| c.friction.as_ref().map_or(&[][..], |f| f.far.as_slice())))
}

/// Keeps the greatest energy of walls that soften.
fn remember_greatest<D: Scalar>(plant: &Plant<D>, state: &mut PlantState<D>) {
    for (i, muscle) in plant.muscles.iter().enumerate().filter(|(_, m)| m.extras.mullins.is_some()) {
        let at = state.parts();
        let elongation = muscle.elongation_m::<0>(at.y()) - muscle.extras.set_m(muscle.slow(&at));
        let energy = muscle.elastic.wall_energy_j(elongation);
        let before = state.greatest_j[i];
        state.greatest_j[i] = energy.select_above(before, energy, before);
    }
}
