//! The wall that may leave the coil.

use super::{Wall, WallState};
use crate::muscle::section::SectionEnergy;
use crate::scalar::Scalar;

/// Newton's method has settled when the squared radius moves by less than this share.
const SETTLED: f64 = 1e-13;
/// Bisection alone would be down to rounding after this many steps.
const MOST_STEPS: usize = 80;

impl<D: Scalar> Wall<D> {
    /// The wall whose coil only pushes: the outer radius `a <= R_c` minimises `U(lambda, a) - p V(lambda, a)`.
    ///
    /// With `y = (a/R_c)^2`, `u = U/(pi R_c^2 L0)` and `V/(pi R_c^2 L0) = lambda y - (1 - (r0/R_c)^2)`:
    /// off the coil `du/dy = p lambda`; on it `y = 1` and `du/dy < p lambda`. At `p = 0` the tube is the
    /// uniaxial one, `y = 1/lambda`. The pull is continuous at the touch, its slopes are not.
    /// Range: `p` above the pressure at which the tube would buckle inwards (not modelled); materials whose
    /// inflation has a pressure maximum are followed on the first branch found.
    pub fn unilateral(&self, elongation_m: D, pressure_pa: D) -> WallState<D> {
        let lambda = self.stretch(elongation_m);
        let on_coil = D::constant(1.0);
        let held = self.section_energy(lambda, on_coil);
        if held.u_y.value() <= (pressure_pa * lambda).value() {
            return self.assemble(lambda, on_coil, pressure_pa, &held, D::constant(0.0));
        }
        let y = self.free_squared_radius(lambda, pressure_pa);
        let free = self.section_energy(lambda, y);
        let softness = free.u_yy.recip();
        self.assemble(lambda, y, pressure_pa, &free, softness)
    }

    /// Zero of `du/dy - p lambda` between the closed bore and the coil: Newton, kept in the bracket.
    fn free_squared_radius(&self, lambda: D, pressure: D) -> D {
        let closed = (1.0 - self.shared.section.sigma_bore()) / lambda.value();
        let (mut low, mut high) = (closed, 1.0);
        let mut y = D::constant(lambda.value().recip().clamp(closed, 1.0));
        for _ in 0..MOST_STEPS {
            let energy = self.section_energy(lambda, y);
            let excess = energy.u_y - pressure * lambda;
            if excess.value() > 0.0 {
                high = y.value();
            } else {
                low = y.value();
            }
            let next = y - excess / energy.u_yy;
            let step = (next.value() - y.value()).abs();
            if step <= SETTLED * y.value() {
                y = next;
                break;
            }
            y = if low < next.value() && next.value() < high { next } else { D::constant(0.5 * (low + high)) };
        }
        self.polish(lambda, pressure, y)
    }

    /// Further Newton steps, one per order of derivative the number carries: each makes one more exact.
    fn polish(&self, lambda: D, pressure: D, start: D) -> D {
        (0..D::DERIVATIVES).fold(start, |y, _| {
            let energy = self.section_energy(lambda, y);
            y - (energy.u_y - pressure * lambda) / energy.u_yy
        })
    }

    /// Pull, volume and slopes; `softness` is `1/u_yy` off the coil and 0 on it.
    fn assemble(&self, lambda: D, y: D, pressure: D, energy: &SectionEnergy<D>, softness: D) -> WallState<D> {
        let area = self.geometry.coil_area_m2();
        let rest = self.geometry.rest_length_m;
        let mixed = energy.u_ly - pressure;
        WallState {
            pull_n: (energy.u_l - pressure * y) * area,
            volume_m3: (lambda * y) * (area * rest) - self.geometry.silicone_volume_m3(),
            energy_j: energy.u * (area * rest),
            outer_radius_m: y.sqrt() * self.geometry.outer_radius_m,
            dpull_de: (energy.u_ll - mixed * mixed * softness) * (area / rest),
            dpull_dp: (lambda * mixed * softness - y) * area,
            dvolume_dp: lambda * lambda * softness * (area * rest),
        }
    }
}
