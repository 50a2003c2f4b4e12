//! What a line may hold besides incompressible fluid.

use crate::scalar::Scalar;

/// Atmospheric pressure, Pa.
const ATMOSPHERE_PA: f64 = 101_325.0;
/// Where the law is cut off, as a share of the atmosphere above vacuum: the volume stays finite.
const VACUUM_SHARE: f64 = 0.02;

/// Air in the line, a polytropic gas of volume `V0` at `p = 0` gauge:
///
/// `V = V0 (p_atm/(p_atm + p))^(1/kappa)`, so `-dV/dp = V0/(kappa p_atm) (p_atm/(p_atm + p))^(1/kappa + 1)`.
///
/// `V0` m³, `kappa` 1 (isothermal) to 1.4 (adiabatic). Range: `p > -0.98 p_atm`; below, the compliance stays that
/// of the bound. Source: ideal gas.
///
/// ```
/// use smam::effects::TrappedAir;
///
/// let air = TrappedAir { free_volume_m3: 1e-9_f64, kappa: 1.0 };
/// let at_rest = air.compliance_m3_pa(0.0);
/// assert!((at_rest * 101_325.0 / 1e-9 - 1.0).abs() < 1e-12);
/// // Under twice the absolute pressure it yields a quarter as much.
/// assert!((air.compliance_m3_pa(101_325.0) / at_rest - 0.25).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrappedAir<D> {
    pub free_volume_m3: D,
    pub kappa: D,
}

impl<D: Scalar> TrappedAir<D> {
    /// `-dV/dp`, m³/Pa.
    pub fn compliance_m3_pa(&self, pressure_pa: D) -> D {
        let absolute = pressure_pa / ATMOSPHERE_PA + 1.0;
        let bound = D::constant(VACUUM_SHARE);
        let absolute = absolute.select_above(bound, absolute, bound);
        // The isothermal law needs no power; its derivative to kappa is not carried, as kappa is then not fitted.
        let share = if self.kappa.is_at(1.0) {
            (absolute * absolute).recip()
        } else {
            (-(absolute.ln() * (self.kappa.recip() + 1.0))).exp()
        };
        self.free_volume_m3 / (self.kappa * ATMOSPHERE_PA) * share
    }

    /// Energy taken up since `p = 0`, the integral of `p (-dV/dp)`, J: what the air and the atmosphere behind it hold.
    pub fn energy_j(&self, pressure_pa: D) -> D {
        let bound = D::constant((VACUUM_SHARE - 1.0) * ATMOSPHERE_PA);
        if pressure_pa.value() < bound.value() {
            // Below the bound the compliance is constant.
            let compliance = self.compliance_m3_pa(bound);
            return self.energy_j(bound) + compliance * (pressure_pa * pressure_pa - bound * bound) / 2.0;
        }
        let absolute = pressure_pa / ATMOSPHERE_PA + 1.0;
        let m = self.kappa.recip();
        let left = (-(absolute.ln() * m)).exp();
        let expansion = if m.is_at(1.0) { absolute.ln() } else { (absolute * left - 1.0) / (-m + 1.0) };
        self.free_volume_m3 * m * ATMOSPHERE_PA * (expansion + (left - 1.0) / m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn compliance_is_the_slope_of_the_volume() {
        for kappa in [1.0, 1.2, 1.4] {
            let air = TrappedAir { free_volume_m3: 2e-9, kappa };
            let volume = |p: f64| 2e-9 * (ATMOSPHERE_PA / (ATMOSPHERE_PA + p)).powf(1.0 / kappa);
            for p in [-5e4, 0.0, 3e5, 2e6] {
                let slope = (volume(p - 1.0) - volume(p + 1.0)) / 2.0;
                assert!((air.compliance_m3_pa(p) / slope - 1.0).abs() < 1e-5, "kappa {kappa}, p {p}");
            }
        }
    }

    #[test]
    fn energy_is_the_work_on_the_volume() {
        for kappa in [1.0, 1.2, 1.4] {
            let air = TrappedAir { free_volume_m3: 2e-9, kappa };
            assert_eq!(air.energy_j(0.0), 0.0);
            for p in [-1.005e5_f64, -9e4, -5e4, 3e5, 2e6] {
                let slope = (air.energy_j(p + 1.0) - air.energy_j(p - 1.0)) / 2.0;
                let work: f64 = p * air.compliance_m3_pa(p);
                assert!((slope / work - 1.0).abs() < 1e-4, "kappa {kappa}, p {p}: {slope} {work}");
            }
        }
    }
}
