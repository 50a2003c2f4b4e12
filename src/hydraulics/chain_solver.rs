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
    pub fn factorise(&mut self, chain: &Chain<D>, row: &[D], boils: &[bool], port: &Port<D>, g: f64) -> D {
        self.g = g;
        let n = chain.segments();
        let flow = ChainRow::of(row, n).flow_m3_s;
        let over_inertance = D::constant(g) / chain.inertance_pa_s2_m3;
        for j in 0..=n {
            if boils[j] {
                self.pivot_node[j] = D::constant(1.0);
                self.sigma[j] = D::constant(0.0);
            } else {
                let over_compliance = D::constant(g) / chain.node_compliance(j, port);
                let inner = if j == 0 { D::constant(0.0) } else { over_compliance * self.t[j - 1] };
                self.pivot_node[j] = (inner + 1.0).recip();
                self.sigma[j] = over_compliance * self.pivot_node[j];
            }
            if j < n {
                let slope = chain.resistance_pa_s_m3 + chain.quadratic_pa_s2_m6 * flow[j].abs() * 2.0;
                let pivot = over_inertance * (slope + self.sigma[j]) + 1.0;
                self.pivot_flow[j] = pivot.recip();
                self.t[j] = over_inertance * self.pivot_flow[j];
            }
        }
        self.sigma[n]
    }

    /// Forward pass with the right-hand side `r`; returns `rho_N`. `sigma_j k` per unit of `g/C_j` is reused.
    #[inline]
    pub fn eliminate(&mut self, r: &[D]) -> D {
        match self.s.len() {
            // The stock line: loops whose length the compiler sees.
            1 => self.eliminate_of(1, r),
            n => self.eliminate_of(n, r),
        }
    }

    #[inline(always)]
    fn eliminate_of(&mut self, n: usize, r: &[D]) -> D {
        let r = ChainRow::of(r, n);
        let (t, sigma, all_s, all_rho) = (&self.t[..n], &self.sigma[..=n], &mut self.s[..n], &mut self.rho[..=n]);
        let (pivot_flow, pivot_node) = (&self.pivot_flow[..n], &self.pivot_node[..=n]);
        let mut rho = r.pressure_pa[0] * pivot_node[0];
        all_rho[0] = rho;
        for j in 0..n {
            let s = r.flow_m3_s[j] * pivot_flow[j] + t[j] * rho;
            rho = r.pressure_pa[j + 1] * pivot_node[j + 1] + sigma[j + 1] * s;
            (all_s[j], all_rho[j + 1]) = (s, rho);
        }
        rho
    }

    /// Fills the stage `k` from the stage of the outflow; `r` is the right-hand side given to `eliminate`.
    #[inline]
    pub fn back_substitute(&self, k_out: D, r: &[D], boils: &[bool], k: &mut [D]) {
        match self.s.len() {
            1 => self.back_substitute_of(1, k_out, r, boils, k),
            n => self.back_substitute_of(n, k_out, r, boils, k),
        }
    }

    #[inline(always)]
    fn back_substitute_of(&self, n: usize, k_out: D, r: &[D], boils: &[bool], k: &mut [D]) {
        let (r, k, boils) = (ChainRow::of(r, n), ChainRowMut::of(k, n), &boils[..=n]);
        let (t, s, sigma, rho) = (&self.t[..n], &self.s[..n], &self.sigma[..=n], &self.rho[..=n]);
        let mut leaving = k_out;
        for j in (0..=n).rev() {
            let pressure = rho[j] - sigma[j] * leaving;
            let entering = if j == 0 { D::constant(0.0) } else { s[j - 1] - t[j - 1] * pressure };
            k.pressure_pa[j] = pressure;
            k.vapour_m3[j] = if boils[j] { r.vapour_m3[j] - (entering - leaving) * self.g } else { D::constant(0.0) };
            if j > 0 {
                k.flow_m3_s[j - 1] = entering;
            }
            leaving = entering;
        }
    }
}
