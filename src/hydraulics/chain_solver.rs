//! The elimination that the implicit step of a line needs.

use super::{Chain, ChainRow, ChainRowMut, Port};
use crate::scalar::Scalar;

/// Solves `(1 - g J) k = r` for the chain, `J` its Jacobian, `g` a time in s, leaving the muscle's outflow open.
///
/// The chain is tridiagonal in the order `p_0, Q_1, p_1, ..., p_N`, so one forward pass gives
/// `k_pN = rho - sigma * k_out` with `k_out` the stage of the muscle's outflow; the mechanics are solved with that,
/// then [`ChainSolver::back_substitute`] fills in the rest.
#[derive(Clone, Debug)]
pub struct ChainSolver<D> {
    g: f64,
    /// Flow lost per pressure at the first and the last node, m³/(s Pa).
    conductance_m3_s_pa: [D; 2],
    nodes: Vec<Node<D>>,
    flows: Vec<Flow<D>>,
}

/// `k_pj = rho - sigma k_Q(j+1)`.
#[derive(Clone, Copy, Debug)]
struct Node<D> {
    pivot: D,
    sigma: D,
    rho: D,
}

/// `k_Qj = s - t k_pj`; `t` is `g/I` over the pivot.
#[derive(Clone, Copy, Debug)]
struct Flow<D> {
    pivot: D,
    t: D,
    s: D,
}

impl<D: Scalar> ChainSolver<D> {
    /// Buffers for a chain of `segments` segments.
    pub fn new(segments: usize) -> Self {
        let zero = D::constant(0.0);
        Self {
            g: 0.0,
            conductance_m3_s_pa: [zero; 2],
            nodes: vec![Node { pivot: zero, sigma: zero, rho: zero }; segments + 1],
            flows: vec![Flow { pivot: zero, t: zero, s: zero }; segments],
        }
    }

    /// Flow that the first and the last node lose per pressure, m³/(s Pa): a leak; none unless it is set.
    pub(crate) fn set_conductance(&mut self, first_and_last_m3_s_pa: [D; 2]) {
        self.conductance_m3_s_pa = first_and_last_m3_s_pa;
    }

    /// Factorises for the step parameter `g`; returns `sigma_N`, the response of the last node to the outflow.
    pub(crate) fn factorise(&mut self, chain: &Chain<D>, row: &[D], boils: &[bool], port: &Port<D>, g: f64) -> D {
        self.g = g;
        let n = chain.segments();
        let at = ChainRow::of(row, n);
        let over_inertance = D::constant(g) / chain.inertance_pa_s2_m3;
        let mut inner = self.conductance_m3_s_pa[0];
        for (j, node) in self.nodes.iter_mut().enumerate() {
            if boils[j] {
                (node.pivot, node.sigma) = (D::constant(1.0), D::constant(0.0));
            } else {
                let over_compliance = D::constant(g) / chain.node_compliance(j, port);
                node.pivot = (over_compliance * inner + 1.0).recip();
                node.sigma = over_compliance * node.pivot;
            }
            if j < n {
                let slope = chain.resistance_pa_s_m3 + chain.quadratic_pa_s2_m6 * at.flow_m3_s[j].abs() * 2.0;
                let flow = &mut self.flows[j];
                flow.pivot = (over_inertance * (slope + node.sigma) + 1.0).recip();
                flow.t = over_inertance * flow.pivot;
                inner = if j + 1 == n { flow.t + self.conductance_m3_s_pa[1] } else { flow.t };
            }
        }
        self.nodes[n].sigma
    }

    /// Forward pass with the right-hand side `r`; returns `rho_N`. `sigma_j k` per unit of `g/C_j` is reused.
    #[inline]
    pub fn eliminate(&mut self, r: &[D]) -> D {
        match self.flows.len() {
            // The stock line: loops whose length the compiler sees.
            1 => self.eliminate_of(1, r),
            n => self.eliminate_of(n, r),
        }
    }

    #[inline(always)]
    fn eliminate_of(&mut self, n: usize, r: &[D]) -> D {
        let r = ChainRow::of(r, n);
        let (nodes, flows) = (&mut self.nodes[..=n], &mut self.flows[..n]);
        let mut rho = r.pressure_pa[0] * nodes[0].pivot;
        nodes[0].rho = rho;
        for j in 0..n {
            let s = r.flow_m3_s[j] * flows[j].pivot + flows[j].t * rho;
            rho = r.pressure_pa[j + 1] * nodes[j + 1].pivot + nodes[j + 1].sigma * s;
            (flows[j].s, nodes[j + 1].rho) = (s, rho);
        }
        rho
    }

    /// Fills the stage `k` from the stage of the outflow; `r` is the right-hand side given to `eliminate`.
    #[inline]
    pub fn back_substitute(&self, k_out: D, r: &[D], boils: &[bool], k: &mut [D]) {
        match self.flows.len() {
            1 => self.back_substitute_of(1, k_out, r, boils, k),
            n => self.back_substitute_of(n, k_out, r, boils, k),
        }
    }

    #[inline(always)]
    fn back_substitute_of(&self, n: usize, k_out: D, r: &[D], boils: &[bool], k: &mut [D]) {
        let (r, k, boils) = (ChainRow::of(r, n), ChainRowMut::of(k, n), &boils[..=n]);
        let (nodes, flows) = (&self.nodes[..=n], &self.flows[..n]);
        let mut leaving = k_out;
        for j in (0..=n).rev() {
            let pressure = nodes[j].rho - nodes[j].sigma * leaving;
            let entering = if j == 0 { D::constant(0.0) } else { flows[j - 1].s - flows[j - 1].t * pressure };
            k.pressure_pa[j] = pressure;
            k.vapour_m3[j] = if boils[j] { r.vapour_m3[j] - (entering - leaving) * self.g } else { D::constant(0.0) };
            if j > 0 {
                k.flow_m3_s[j - 1] = entering;
            }
            leaving = entering;
        }
    }
}
