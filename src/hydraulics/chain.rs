//! The lumped line: pressure nodes joined by flow segments, and the elimination its implicit step needs.

use super::{Fluid, Line};
use crate::scalar::Scalar;

/// The line between plunger and muscle: nodes `0..=N` with compliance, segments `1..=N` with resistance and inertance.
///
/// ```text
/// C_0 dp_0/dt = Q_in - Q_1
/// I dQ_j/dt   = p_(j-1) - p_j - R Q_j - q Q_j |Q_j|
/// C_j dp_j/dt = Q_j - Q_(j+1)          (Q_(N+1): what the muscle takes)
/// ```
/// Gauge pressures in Pa, flows in m³/s positive towards the muscle. A node at the vapour pressure keeps it and
/// grows a vapour volume instead, until that volume is taken up again.
#[derive(Clone, Debug)]
pub struct Chain<D> {
    /// Compliance of each node, m³/Pa; N + 1 entries, all > 0.
    pub compliance_m3_pa: Vec<D>,
    /// Resistance of one segment, Pa s/m³.
    pub resistance_pa_s_m3: D,
    /// Quadratic loss of one segment, `q Q |Q|`, Pa s²/m⁶.
    pub quadratic_pa_s2_m6: D,
    /// Inertance of one segment, Pa s²/m³.
    pub inertance_pa_s2_m3: D,
    /// Gauge pressure at which the fluid boils, Pa.
    pub cavitation_pressure_pa: f64,
}

/// Pressures, flows and vapour volumes of a [`Chain`].
#[derive(Clone, Debug, PartialEq)]
pub struct ChainState<D> {
    /// Gauge pressure of each node, Pa.
    pub pressure_pa: Vec<D>,
    /// Flow through each segment, m³/s.
    pub flow_m3_s: Vec<D>,
    /// Vapour volume at each node, m³.
    pub vapour_m3: Vec<D>,
    /// Whether a node boils: its pressure then stays and its vapour volume moves. Changed between steps only.
    pub boiling: Vec<bool>,
}

/// What hangs on the last node: the muscle.
#[derive(Clone, Copy, Debug)]
pub struct Port<D> {
    /// Flow that the muscle's motion takes, `A de/dt`, m³/s.
    pub outflow_m3_s: D,
    /// Compliance to add to the last node, m³/Pa: a wall off its coil, trapped air.
    pub compliance_m3_pa: D,
}

/// Time derivatives of a [`ChainState`], also used for the stages of the integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainRates<D> {
    pub pressure_pa_s: Vec<D>,
    pub flow_m3_s2: Vec<D>,
    pub vapour_m3_s: Vec<D>,
}

impl<D: Scalar> Chain<D> {
    /// The stock arrangement: `upstream` compliance before the line, `downstream` after it, the line's own
    /// compliance shared out over all nodes (half shares at the ends).
    pub fn new(line: &Line, fluid: &Fluid, upstream_m3_pa: D, downstream_m3_pa: D) -> Self {
        let n = line.segments;
        let share = line.compliance_m3_pa / n as f64;
        let mut compliance = vec![D::constant(share); n + 1];
        compliance[0] = upstream_m3_pa + share / 2.0;
        compliance[n] = downstream_m3_pa + share / 2.0;
        Self {
            compliance_m3_pa: compliance,
            resistance_pa_s_m3: D::constant(line.resistance_pa_s_m3(fluid) / n as f64),
            quadratic_pa_s2_m6: D::constant(0.0),
            inertance_pa_s2_m3: D::constant(line.inertance_pa_s2_m3(fluid) / n as f64),
            cavitation_pressure_pa: fluid.cavitation_gauge_pressure_pa(),
        }
    }

    /// Number of flow segments.
    pub fn segments(&self) -> usize {
        self.compliance_m3_pa.len() - 1
    }

    /// Everything at one pressure and at rest.
    pub fn at_rest(&self, pressure_pa: D) -> ChainState<D> {
        let zero = D::constant(0.0);
        ChainState {
            pressure_pa: vec![pressure_pa; self.segments() + 1],
            flow_m3_s: vec![zero; self.segments()],
            vapour_m3: vec![zero; self.segments() + 1],
            boiling: vec![false; self.segments() + 1],
        }
    }

    /// Derivatives for a flow `inflow` from the plunger, m³/s, and the muscle at `port`.
    pub fn rates(&self, state: &ChainState<D>, inflow: D, port: Port<D>, out: &mut ChainRates<D>) {
        let n = self.segments();
        for j in 0..=n {
            let entering = if j == 0 { inflow } else { state.flow_m3_s[j - 1] };
            let leaving = if j == n { port.outflow_m3_s } else { state.flow_m3_s[j] };
            let net = entering - leaving;
            if state.boiling[j] {
                out.pressure_pa_s[j] = D::constant(0.0);
                out.vapour_m3_s[j] = -net;
            } else {
                out.pressure_pa_s[j] = net / self.node_compliance(j, &port);
                out.vapour_m3_s[j] = D::constant(0.0);
            }
        }
        for j in 0..n {
            let drop = state.pressure_pa[j] - state.pressure_pa[j + 1];
            let flow = state.flow_m3_s[j];
            let resistance = self.resistance_pa_s_m3 + self.quadratic_pa_s2_m6 * flow.abs();
            out.flow_m3_s2[j] = (drop - resistance * flow) / self.inertance_pa_s2_m3;
        }
    }

    fn node_compliance(&self, node: usize, port: &Port<D>) -> D {
        let own = self.compliance_m3_pa[node];
        if node == self.segments() { own + port.compliance_m3_pa } else { own }
    }

    /// Turns pressures below the vapour pressure into vapour of the same missing volume, and vapour that has been
    /// used up back into pressure. Volume is kept exactly.
    pub fn settle_vapour(&self, state: &mut ChainState<D>) {
        for (j, &compliance) in self.compliance_m3_pa.iter().enumerate() {
            let vapour = state.vapour_m3[j];
            let below = D::constant(self.cavitation_pressure_pa) - state.pressure_pa[j];
            if state.boiling[j] && vapour.value() <= 0.0 {
                state.pressure_pa[j] -= vapour / compliance;
                state.vapour_m3[j] = D::constant(0.0);
                state.boiling[j] = false;
            } else if !state.boiling[j] && below.value() > 0.0 {
                state.vapour_m3[j] = below * compliance;
                state.pressure_pa[j] = D::constant(self.cavitation_pressure_pa);
                state.boiling[j] = true;
            }
        }
    }

    /// Energy stored in compliances and moving fluid, `sum C p²/2 + sum I Q²/2`, J.
    pub fn energy_j(&self, state: &ChainState<D>) -> D {
        let elastic = self.compliance_m3_pa.iter().zip(&state.pressure_pa).map(|(&c, &p)| c * p * p / 2.0).sum::<D>();
        let kinetic = state.flow_m3_s.iter().map(|&q| self.inertance_pa_s2_m3 * q * q / 2.0).sum::<D>();
        elastic + kinetic
    }

    /// Power lost to viscosity, `sum (R + q |Q|) Q²`, W.
    pub fn dissipation_w(&self, state: &ChainState<D>) -> D {
        let resistance = |q: D| self.resistance_pa_s_m3 + self.quadratic_pa_s2_m6 * q.abs();
        state.flow_m3_s.iter().map(|&q| resistance(q) * q * q).sum()
    }
}

impl<D: Scalar> ChainState<D> {
    /// `self + h * rates` into `out`.
    pub fn moved_by(&self, rates: &ChainRates<D>, h: f64, out: &mut ChainState<D>) {
        out.copy_from(self);
        out.move_by(rates, h);
    }

    /// Copies without allocating; both states belong to the same chain.
    pub fn copy_from(&mut self, other: &Self) {
        self.pressure_pa.copy_from_slice(&other.pressure_pa);
        self.flow_m3_s.copy_from_slice(&other.flow_m3_s);
        self.vapour_m3.copy_from_slice(&other.vapour_m3);
        self.boiling.copy_from_slice(&other.boiling);
    }

    /// Adds `h * rates`.
    pub fn move_by(&mut self, rates: &ChainRates<D>, h: f64) {
        for (x, &r) in self.pressure_pa.iter_mut().zip(&rates.pressure_pa_s) {
            *x += r * h;
        }
        for (x, &r) in self.flow_m3_s.iter_mut().zip(&rates.flow_m3_s2) {
            *x += r * h;
        }
        for (x, &r) in self.vapour_m3.iter_mut().zip(&rates.vapour_m3_s) {
            *x += r * h;
        }
    }

    /// Zero rates of matching size.
    pub fn zero_rates(&self) -> ChainRates<D> {
        let zero = D::constant(0.0);
        ChainRates {
            pressure_pa_s: vec![zero; self.pressure_pa.len()],
            flow_m3_s2: vec![zero; self.flow_m3_s.len()],
            vapour_m3_s: vec![zero; self.vapour_m3.len()],
        }
    }
}

impl<D: Scalar> ChainRates<D> {
    /// `self - 2 * other`, the right-hand side of the integrator's second stage.
    pub fn subtract_twice(&mut self, other: &Self) {
        for (x, &o) in self.pressure_pa_s.iter_mut().zip(&other.pressure_pa_s) {
            *x -= o * 2.0;
        }
        for (x, &o) in self.flow_m3_s2.iter_mut().zip(&other.flow_m3_s2) {
            *x -= o * 2.0;
        }
        for (x, &o) in self.vapour_m3_s.iter_mut().zip(&other.vapour_m3_s) {
            *x -= o * 2.0;
        }
    }
}

/// Solves `(1 - g J) k = r` for the chain, `J` its Jacobian, `g` a time in s, leaving the muscle's outflow open.
///
/// The chain is tridiagonal in the order `p_0, Q_1, p_1, ..., p_N`, so one forward pass gives
/// `k_pN = rho - sigma * k_out` with `k_out` the stage of the muscle's outflow; the mechanics are solved with that,
/// then [`ChainSolver::back_substitute`] fills in the rest.
#[derive(Clone, Debug)]
pub struct ChainSolver<D> {
    g: f64,
    /// `g/I` of each segment over its pivot: `k_Qj = s_j - t_j k_pj`.
    t: Vec<D>,
    s: Vec<D>,
    /// `k_pj = rho_j - sigma_j k_Q(j+1)`.
    rho: Vec<D>,
    sigma: Vec<D>,
    pivot_flow: Vec<D>,
    pivot_node: Vec<D>,
}

impl<D: Scalar> ChainSolver<D> {
    /// Buffers for a chain of `segments` segments.
    pub fn new(segments: usize) -> Self {
        let zero = D::constant(0.0);
        Self {
            g: 0.0,
            t: vec![zero; segments],
            s: vec![zero; segments],
            rho: vec![zero; segments + 1],
            sigma: vec![zero; segments + 1],
            pivot_flow: vec![zero; segments],
            pivot_node: vec![zero; segments + 1],
        }
    }

    /// Factorises for the step parameter `g`; returns `sigma_N`, the response of the last node to the outflow.
    pub fn factorise(&mut self, chain: &Chain<D>, state: &ChainState<D>, port: &Port<D>, g: f64) -> D {
        self.g = g;
        let n = chain.segments();
        let over_inertance = D::constant(g) / chain.inertance_pa_s2_m3;
        for j in 0..=n {
            if state.boiling[j] {
                self.pivot_node[j] = D::constant(1.0);
                self.sigma[j] = D::constant(0.0);
            } else {
                let over_compliance = D::constant(g) / chain.node_compliance(j, port);
                let inner = if j == 0 { D::constant(0.0) } else { over_compliance * self.t[j - 1] };
                self.pivot_node[j] = (inner + 1.0).recip();
                self.sigma[j] = over_compliance * self.pivot_node[j];
            }
            if j < n {
                let slope = chain.resistance_pa_s_m3 + chain.quadratic_pa_s2_m6 * state.flow_m3_s[j].abs() * 2.0;
                let pivot = over_inertance * (slope + self.sigma[j]) + 1.0;
                self.pivot_flow[j] = pivot.recip();
                self.t[j] = over_inertance * self.pivot_flow[j];
            }
        }
        self.sigma[n]
    }

    /// Forward pass with the right-hand side `r`; returns `rho_N`. `sigma_j k` per unit of `g/C_j` is reused.
    pub fn eliminate(&mut self, r: &ChainRates<D>) -> D {
        let n = self.s.len();
        for j in 0..=n {
            self.rho[j] = if j == 0 {
                r.pressure_pa_s[0] * self.pivot_node[0]
            } else {
                r.pressure_pa_s[j] * self.pivot_node[j] + self.sigma[j] * self.s[j - 1]
            };
            if j < n {
                self.s[j] = r.flow_m3_s2[j] * self.pivot_flow[j] + self.t[j] * self.rho[j];
            }
        }
        self.rho[n]
    }

    /// Fills the stage `k` from the stage of the outflow; `r` is the right-hand side given to `eliminate`.
    pub fn back_substitute(&self, k_out: D, r: &ChainRates<D>, boiling: &[bool], k: &mut ChainRates<D>) {
        let n = self.s.len();
        k.pressure_pa_s[n] = self.rho[n] - self.sigma[n] * k_out;
        for j in (0..n).rev() {
            k.flow_m3_s2[j] = self.s[j] - self.t[j] * k.pressure_pa_s[j + 1];
            k.pressure_pa_s[j] = self.rho[j] - self.sigma[j] * k.flow_m3_s2[j];
        }
        for (j, &boils) in boiling.iter().enumerate() {
            k.vapour_m3_s[j] = if boils {
                let entering = if j == 0 { D::constant(0.0) } else { k.flow_m3_s2[j - 1] };
                let leaving = if j == n { k_out } else { k.flow_m3_s2[j] };
                r.vapour_m3_s[j] - (entering - leaving) * self.g
            } else {
                D::constant(0.0)
            };
        }
    }
}
