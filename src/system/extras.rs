//! What effects add to a [`super::Plant`]. All of it is absent from a stock scene and then costs next to nothing.

use crate::effects::{Backlash, CoilPreload, MaxwellBranch, Mullins, PlasticSet, TendonFriction, TrappedAir, Wall};
use crate::muscle::Friction;
use crate::scalar::Scalar;

use super::plant::dot;

/// Additions to one muscle and its line.
#[derive(Clone, Debug)]
pub struct MuscleExtras<D> {
    /// Whether any of the following but the backlash is there: what a stock scene need not ask one by one. Kept by
    /// [`MuscleExtras::count`].
    pub(super) acts: bool,
    pub backlash: Option<Backlash<D>>,
    pub air: Option<TrappedAir<D>>,
    /// Conductance of a leak after the line, m³/(s Pa).
    pub leak_m3_s_pa: Option<D>,
    /// How much of the line's own resistance a restriction adds, 1; the chain has it in its numbers already.
    pub restriction_ratio: Option<D>,
    /// Growth of the fluid's volume, m³/s.
    pub growth_m3_s: Option<D>,
    pub branches: Vec<MaxwellBranch<D>>,
    pub mullins: Option<Mullins<D>>,
    pub preload: Option<CoilPreload<D>>,
    pub plastic: Option<PlasticSet<D>>,
}

impl<D> Default for MuscleExtras<D> {
    fn default() -> Self {
        Self {
            acts: false,
            backlash: None,
            air: None,
            leak_m3_s_pa: None,
            restriction_ratio: None,
            growth_m3_s: None,
            branches: Vec::new(),
            mullins: None,
            preload: None,
            plastic: None,
        }
    }
}

impl<D: Scalar> MuscleExtras<D> {
    /// Sees what is there: to be called once everything has been put in.
    pub(super) fn count(&mut self) {
        let acts_on_line = self.air.is_some() || self.leak_m3_s_pa.is_some() || self.growth_m3_s.is_some();
        let pulls = self.mullins.is_some() || self.preload.is_some();
        self.acts = acts_on_line || pulls || self.slow_states() > 0;
    }

    /// Number of slow states: one per branch, one for the plastic set.
    pub(super) fn slow_states(&self) -> usize {
        self.branches.len() + usize::from(self.plastic.is_some())
    }

    /// Lasting elongation, m.
    pub(super) fn set_m(&self, slow: &[D]) -> D {
        if self.plastic.is_some() { slow[self.branches.len()] } else { D::constant(0.0) }
    }

    /// Pull (N) and stiffness (N/m) of branches and preload.
    pub(super) fn pull_and_stiffness(&self, elongation_m: D, slow: &[D]) -> (D, D) {
        let (mut pull, mut stiffness) = (D::constant(0.0), D::constant(0.0));
        for (branch, &dashpot) in self.branches.iter().zip(slow) {
            pull += branch.pull_n(elongation_m, dashpot);
            stiffness += branch.stiffness_n_m;
        }
        if let Some(preload) = &self.preload {
            let (f, k) = preload.pull_and_stiffness(elongation_m);
            pull += f;
            stiffness += k;
        }
        (pull, stiffness)
    }

    /// Rates of the slow states.
    pub(super) fn slow_rates(&self, elongation_m: D, slow: &[D], out: &mut [D]) {
        for ((branch, &dashpot), out) in self.branches.iter().zip(slow).zip(&mut *out) {
            *out = branch.rate_m_s(elongation_m, dashpot);
        }
        if let Some(plastic) = &self.plastic {
            out[self.branches.len()] = plastic.rate_m_s(elongation_m);
        }
    }

    /// Compliance (m³/Pa) and flow (m³/s) that the line's end loses to air, leak and growth.
    pub(super) fn line_load(&self, pressure_pa: D) -> (D, D) {
        let zero = D::constant(0.0);
        let compliance = self.air.as_ref().map_or(zero, |a| a.compliance_m3_pa(pressure_pa));
        let leak = self.leak_m3_s_pa.map_or(zero, |g| g * pressure_pa);
        (compliance, leak - self.growth_m3_s.unwrap_or(zero))
    }
}

/// Dry friction on a combination of coordinates.
#[derive(Clone, Debug)]
pub struct JointFriction<D> {
    pub direction: Vec<f64>,
    pub law: Friction<D>,
}

/// A cable's tension that also acts elsewhere: generalised force `lever T` along a direction.
#[derive(Clone, Debug)]
pub struct Coupling<D> {
    pub cable: usize,
    pub direction: Vec<f64>,
    pub lever_m: D,
}

/// A one-sided spring on a combination of coordinates.
#[derive(Clone, Debug)]
pub struct AngleWall<D> {
    pub direction: Vec<f64>,
    pub wall: Wall<D>,
}

/// A constant generalised force.
#[derive(Clone, Debug)]
pub struct ConstantLoad<D> {
    pub direction: Vec<f64>,
    pub force: D,
}

/// Additions to the mechanism.
#[derive(Clone, Debug)]
pub struct MechanismExtras<D> {
    pub frictions: Vec<JointFriction<D>>,
    pub couplings: Vec<Coupling<D>>,
    pub walls: Vec<AngleWall<D>>,
    pub loads: Vec<ConstantLoad<D>>,
}

impl<D> Default for MechanismExtras<D> {
    fn default() -> Self {
        Self { frictions: Vec::new(), couplings: Vec::new(), walls: Vec::new(), loads: Vec::new() }
    }
}

/// Friction of one cable along its wrap.
#[derive(Clone, Debug)]
pub struct CableFriction<D> {
    pub law: TendonFriction<D>,
    /// The cable's levers on the mechanism's joints: its jacobian without the muscle's end.
    pub far: Vec<f64>,
    /// How many equal hinges in series each coordinate stands for.
    pub hinges: Vec<usize>,
}

impl<D: Scalar> CableFriction<D> {
    /// Speed at which the far part is drawn in, m/s.
    pub(super) fn sliding_m_s(&self, w: &[D]) -> D {
        -dot::<_, 0>(&self.far, w)
    }

    /// Calls `with(coordinate, share)` for each joint: tension there over tension at the near end.
    pub(super) fn shares(&self, y: &[D], sliding: D, mut with: impl FnMut(usize, D)) {
        let mut wrap = D::constant(0.0);
        for (i, _) in self.far.iter().enumerate().filter(|(_, lever)| **lever != 0.0) {
            let step = y[i].abs() / self.hinges[i] as f64;
            let mut sum = D::constant(0.0);
            for _ in 0..self.hinges[i] {
                wrap += step;
                sum += self.law.transmission(sliding, wrap);
            }
            with(i, sum / self.hinges[i] as f64);
        }
    }

    /// What the friction takes from the pull along the far levers, N, and its slope to the sliding state, N.
    pub(super) fn slope_n(&self, y: &[D], tension_n: D) -> D {
        let turned: D = self.far.iter().zip(y).filter(|(l, _)| **l != 0.0).map(|(_, &y)| y.abs()).sum();
        tension_n * self.law.friction_coefficient * (turned * 0.5 + self.law.fixed_wrap_rad)
    }
}
