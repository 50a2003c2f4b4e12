//! The lumped line: pressure nodes joined by flow segments.

use super::{ChainRow, ChainRowMut, Fluid, Line};
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
///
/// ```
/// use smam::hydraulics::{Chain, ChainRow, Fluid, Line, Port};
///
/// let line = Line { length_m: 1.0, bore_m: 0.8e-3, segments: 1, compliance_m3_pa: 0.0, momentum_factor: 4.0 / 3.0 };
/// let water = Fluid::default();
/// let chain = Chain::new(&line, &water, 8.0e-15_f64, 2.6e-15);
/// // 10 uL/s in and out: steady when the pressures differ by Hagen and Poiseuille's drop, 1 kPa.
/// let flow_m3_s = 1e-8;
/// let drop_pa = line.resistance_pa_s_m3(&water) * flow_m3_s;
/// assert!((drop_pa - 997.0).abs() < 1.0);
/// let row = [1e5 + drop_pa, 1e5, flow_m3_s, 0.0, 0.0];
/// let muscle = Port { outflow_m3_s: flow_m3_s, compliance_m3_pa: 0.0 };
/// let mut rates = [0.0; 5];
/// chain.rates(&row, &[false; 2], flow_m3_s, &muscle, &mut rates);
/// assert_eq!(ChainRow::of(&rates, 1).pressure_pa, [0.0, 0.0]);
/// assert!(ChainRow::of(&rates, 1).flow_m3_s[0].abs() < 1e-15);
/// ```
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
    /// The line's own compliance in each of its end nodes, m³/Pa.
    pub end_share_m3_pa: f64,
}

/// What hangs on the last node: the muscle.
#[derive(Clone, Copy, Debug)]
pub struct Port<D> {
    /// Flow that the muscle's motion takes, `A de/dt`, m³/s.
    pub outflow_m3_s: D,
    /// Compliance to add to the last node, m³/Pa: a wall off its coil, trapped air.
    pub compliance_m3_pa: D,
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
            end_share_m3_pa: share / 2.0,
        }
    }

    /// Puts another compliance before the line; the first node keeps its share of the line's own.
    pub(crate) fn set_upstream(&mut self, upstream_m3_pa: D) {
        self.compliance_m3_pa[0] = upstream_m3_pa + self.end_share_m3_pa;
    }

    /// Puts another compliance behind the line; the last node keeps its share of the line's own.
    pub(crate) fn set_downstream(&mut self, downstream_m3_pa: D) {
        let last = self.segments();
        self.compliance_m3_pa[last] = downstream_m3_pa + self.end_share_m3_pa;
    }

    /// Number of flow segments.
    pub fn segments(&self) -> usize {
        self.compliance_m3_pa.len() - 1
    }

    /// The row of everything at one pressure and at rest.
    pub fn at_rest(&self, pressure_pa: D) -> Vec<D> {
        let mut row = vec![D::constant(0.0); ChainRow::<D>::len_of(self.segments())];
        row[..=self.segments()].fill(pressure_pa);
        row
    }

    /// Derivatives for a flow `inflow` from the plunger, m³/s, and the muscle at `port`.
    ///
    /// A node that `boils` keeps its pressure while its vapour volume moves.
    #[inline]
    pub fn rates(&self, row: &[D], boils: &[bool], inflow: D, port: &Port<D>, out: &mut [D]) {
        match self.segments() {
            // The stock line: loops whose length the compiler sees.
            1 => self.rates_of(1, row, boils, inflow, port, out),
            n => self.rates_of(n, row, boils, inflow, port, out),
        }
    }

    #[inline(always)]
    fn rates_of(&self, n: usize, row: &[D], boils: &[bool], inflow: D, port: &Port<D>, out: &mut [D]) {
        let (at, out, boils) = (ChainRow::of(row, n), ChainRowMut::of(out, n), &boils[..=n]);
        let compliance = &self.compliance_m3_pa[..=n];
        let mut entering = inflow;
        for j in 0..=n {
            let leaving = if j == n { port.outflow_m3_s } else { at.flow_m3_s[j] };
            let net = entering - leaving;
            (out.pressure_pa[j], out.vapour_m3[j]) = if boils[j] {
                (D::constant(0.0), -net)
            } else {
                let added = if j == n { port.compliance_m3_pa } else { D::constant(0.0) };
                (net / (compliance[j] + added), D::constant(0.0))
            };
            entering = leaving;
        }
        for j in 0..n {
            let drop = at.pressure_pa[j] - at.pressure_pa[j + 1];
            let flow = at.flow_m3_s[j];
            let resistance = self.resistance_pa_s_m3 + self.quadratic_pa_s2_m6 * flow.abs();
            out.flow_m3_s[j] = (drop - resistance * flow) / self.inertance_pa_s2_m3;
        }
    }

    pub(super) fn node_compliance(&self, node: usize, port: &Port<D>) -> D {
        let own = self.compliance_m3_pa[node];
        if node == self.segments() { own + port.compliance_m3_pa } else { own }
    }

    /// Turns pressures below the vapour pressure into vapour of the same missing volume, and vapour that has been
    /// used up back into pressure. Volume is kept exactly.
    ///
    /// ```
    /// use smam::hydraulics::{Chain, ChainRow, Fluid, Line};
    ///
    /// let line =
    ///     Line { length_m: 1.0, bore_m: 0.8e-3, segments: 1, compliance_m3_pa: 0.0, momentum_factor: 4.0 / 3.0 };
    /// let chain = Chain::new(&line, &Fluid::default(), 8.0e-15_f64, 2.6e-15);
    /// let (mut row, mut boils) = (chain.at_rest(-1.5e5), [false; 2]);
    /// chain.settle_vapour(&mut row, &mut boils);
    /// let settled = ChainRow::of(&row, 1);
    /// assert_eq!((boils, settled.pressure_pa[0]), ([true; 2], -99_025.0));
    /// // C times the 51 kPa that liquid cannot hold.
    /// assert!((settled.vapour_m3[0] / (8.0e-15 * 50_975.0) - 1.0).abs() < 1e-9);
    /// ```
    pub fn settle_vapour(&self, row: &mut [D], boils: &mut [bool]) {
        let at = ChainRowMut::of(row, self.segments());
        for (j, &compliance) in self.compliance_m3_pa.iter().enumerate() {
            let vapour = at.vapour_m3[j];
            let below = D::constant(self.cavitation_pressure_pa) - at.pressure_pa[j];
            if boils[j] && !vapour.is_above(0.0) {
                at.pressure_pa[j] -= vapour / compliance;
                at.vapour_m3[j] = D::constant(0.0);
                boils[j] = false;
            } else if !boils[j] && below.is_above(0.0) {
                at.vapour_m3[j] = below * compliance;
                at.pressure_pa[j] = D::constant(self.cavitation_pressure_pa);
                boils[j] = true;
            }
        }
    }

    /// Energy stored in compliances and moving fluid, `sum C p²/2 + sum I Q²/2`, J.
    pub fn energy_j(&self, row: &[D]) -> D {
        let at = ChainRow::of(row, self.segments());
        let elastic = self.compliance_m3_pa.iter().zip(at.pressure_pa).map(|(&c, &p)| c * p * p / 2.0).sum::<D>();
        let kinetic = at.flow_m3_s.iter().map(|&q| self.inertance_pa_s2_m3 * q * q / 2.0).sum::<D>();
        elastic + kinetic
    }

    /// Power lost to viscosity, `sum (R + q |Q|) Q²`, W.
    pub(crate) fn dissipation_w(&self, row: &[D]) -> D {
        let resistance = |q: D| self.resistance_pa_s_m3 + self.quadratic_pa_s2_m6 * q.abs();
        ChainRow::of(row, self.segments()).flow_m3_s.iter().map(|&q| resistance(q) * q * q).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_put_in_again_leaves_the_chain_as_it_was() {
        let line =
            Line { length_m: 1.0, bore_m: 8e-4, segments: 2, compliance_m3_pa: 8e-15, momentum_factor: 4.0 / 3.0 };
        let chain = Chain::new(&line, &Fluid::default(), 8e-15_f64, 2.6e-15);
        let mut again = chain.clone();
        again.set_upstream(8e-15);
        again.set_downstream(2.6e-15);
        assert_eq!(again.compliance_m3_pa, chain.compliance_m3_pa);
    }
}
