//! Gas that leaks out of a closed rigid volume at constant temperature.

use crate::scalar::Scalar;

/// Longest step of the integration, s: a step of this length is short beside the fastest leak that the ranges allow.
const LONGEST_STEP_S: f64 = 0.1;
const MOST_STEPS: f64 = 1e4;

/// Ratio of absolute pressures below which the flow through an orifice is choked; that of a nozzle and air.
const CRITICAL_RATIO: f64 = 0.528;

/// How gas leaves a chamber of the absolute pressure `p` into surroundings of `pa`.
///
/// | law | rate of pressure | a leak that is |
/// |---|---|---|
/// | conductance | `dp/dt = -k (p - pa)` | a fixed volume flow of surrounding air per pressure difference; a porous or permeable wall |
/// | laminar | `dp/dt = -k (p² - pa²)/(2 pa)` | a long narrow gap: the gas expands on its way |
/// | orifice | `dp/dt = -k p psi(pa/p)` | a short hole: choked, `psi = 1`, up to `pa/p = 0.528`, then an ellipse down to 0 |
///
/// `k`, 1/s, is the conductance over the volume; a volume flow `G` (m³/s per Pa, at `pa`) out of a volume `V` has `k = G pa/V`. For
/// small differences the first two agree. Isothermal ideal gas, `p > 0`. Sources: gap, Poiseuille's law for a compressible gas;
/// orifice, ISO 6358-1.
///
/// ```
/// use smam::hydraulics::GasLeak;
///
/// // An excess of 700 kPa falls to 1/e of itself in 1/k.
/// let leak = GasLeak { rate_1_s: 0.01_f64, laminar_1_s: 0.0, orifice_1_s: 0.0 };
/// let excess_pa = leak.advance(801_325.0, 101_325.0, 100.0) - 101_325.0;
/// assert!((excess_pa / 700e3 - (-1.0f64).exp()).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasLeak<D> {
    pub rate_1_s: D,
    pub laminar_1_s: D,
    pub orifice_1_s: D,
}

impl<D: Scalar> GasLeak<D> {
    /// A tight chamber.
    pub fn none() -> Self {
        let zero = D::constant(0.0);
        Self { rate_1_s: zero, laminar_1_s: zero, orifice_1_s: zero }
    }

    /// `dp/dt` at an absolute pressure, Pa/s.
    pub(crate) fn pressure_rate_pa_s(&self, pressure_pa: D, ambient_pa: f64) -> D {
        let (p, pa) = (pressure_pa, ambient_pa);
        let laminar = (p * p - pa * pa) / (2.0 * pa);
        -(self.rate_1_s * (p - pa) + self.laminar_1_s * laminar + self.orifice_1_s * orifice_flow(p, pa))
    }

    /// The absolute pressure after a time (>= 0), by Runge and Kutta's fourth-order steps, Pa.
    pub fn advance(&self, pressure_pa: D, ambient_pa: f64, time_s: f64) -> D {
        let steps = (time_s / LONGEST_STEP_S).ceil().clamp(1.0, MOST_STEPS);
        let h = time_s / steps;
        let rate = |p: D| self.pressure_rate_pa_s(p, ambient_pa);
        let step = |p: D| {
            let k1 = rate(p);
            let k2 = rate(p + k1 * (h / 2.0));
            let k3 = rate(p + k2 * (h / 2.0));
            let k4 = rate(p + k3 * h);
            p + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)
        };
        (0..steps as usize).fold(pressure_pa, |p, _| step(p))
    }
}

/// `p psi(pa/p)` from the side of the higher pressure, positive outwards.
fn orifice_flow<D: Scalar>(p: D, pa: f64) -> D {
    let ambient = D::constant(pa);
    let upstream = p.select_above(ambient, p, ambient);
    let downstream = p.select_above(ambient, ambient, p);
    let past = (downstream / upstream - CRITICAL_RATIO) / (1.0 - CRITICAL_RATIO);
    let outwards = if p.is_above(pa) { 1.0 } else { -1.0 };
    if !past.is_above(0.0) {
        return upstream * outwards;
    }
    let squared = -(past * past) + 1.0;
    // At equal pressures the ellipse is upright: no flow, and no derivative that a fit could use.
    if squared.is_above(0.0) { upstream * squared.sqrt() * outwards } else { D::constant(0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PA: f64 = 101_325.0;

    fn leak(which: usize, k: f64) -> GasLeak<f64> {
        let rate = |i: usize| if i == which { k } else { 0.0 };
        GasLeak { rate_1_s: rate(0), laminar_1_s: rate(1), orifice_1_s: rate(2) }
    }

    #[test]
    fn each_law_empties_a_chamber_along_its_closed_form() {
        let (p0, k) = (8.0 * PA, 0.02);
        for t in [0.0, 1.0, 30.0, 300.0] {
            let exponential = PA + (p0 - PA) * (-k * t).exp();
            // dp/dt = -k (p² - pa²)/(2 pa) has the solution p = pa coth(k t/2 + c), coth c = p0/pa.
            let c = 0.5 * ((p0 + PA) / (p0 - PA)).ln();
            let laminar = PA / (k * t / 2.0 + c).tanh();
            for (which, expected) in [(0, exponential), (1, laminar)] {
                let found = leak(which, k).advance(p0, PA, t);
                assert!((found / expected - 1.0).abs() < 1e-6, "law {which} at {t} s: {found} {expected}");
            }
        }
        // Choked all the way down to pa/0.528: the absolute pressure falls exponentially.
        let found = leak(2, k).advance(p0, PA, 50.0);
        assert!((found / (p0 * (-1.0f64).exp()) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn all_laws_end_at_the_surroundings_from_either_side() {
        for which in 0..3 {
            for p0 in [0.5 * PA, 3.0 * PA] {
                let end = leak(which, 0.5).advance(p0, PA, 100.0);
                assert!((end / PA - 1.0).abs() < 1e-3, "law {which} from {p0}: {end}");
            }
        }
    }

    #[test]
    fn small_differences_tell_conductance_from_gap_no_more() {
        let rate = |which: usize| leak(which, 1.0).pressure_rate_pa_s(1.001 * PA, PA);
        assert!((rate(1) / rate(0) - 1.0).abs() < 1e-3);
        assert_eq!(GasLeak::none().advance(5.0 * PA, PA, 1e3), 5.0 * PA);
    }
}
