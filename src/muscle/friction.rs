//! Friction between tube and coil, in force form.

use super::error::{MuscleError, not_negative, positive};
use crate::scalar::Scalar;
use serde::{Deserialize, Serialize};

/// Rate-independent friction with presliding, of the asymmetric Bouc-Wen kind:
///
/// `F = (m0 + m1 max(p, 0)) z`, `u = e/x_pre`,
/// `dz/dt = |du/dt| (A sgn(du/dt) - nu |z|^(n-1) z + rho)`.
///
/// | symbol | field | unit | stock |
/// |---|---|---|---|
/// | `m0` | `m0_n` | N | 0.106 |
/// | `m1` | `m1_n_pa` | N/Pa | 0.222e-6 |
/// | `x_pre` | `presliding_length_m` | m | 5.2e-3 |
/// | `A`, `nu`, `n`, `rho` | `a`, `nu`, `n`, `rho` | 1 | 1, 1, 1, 0 |
///
/// The state `z` settles at `((A + rho)/nu)^(1/n)` stretching and `-((A - rho)/nu)^(1/n)` shortening.
/// Range: `nu > 0`, `n >= 1`, `|rho| < A` ([`Friction::check`]). With `rho = 0` it is passive at constant `p`
/// with the storage of [`Friction::stored_energy_j`]; with `rho` any *closed* loop still loses energy.
/// Source: the state of Thai et al. 2021, eq. (4), acting as a force.
///
/// ```
/// use smam::muscle::Friction;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let friction = Friction::dahl(0.106_f64, 0.222e-6, 5.2e-3);
/// // After a long way out, all of m0 + m1 p: 0.55 N at 2 MPa.
/// let out = friction.exact_step(0.0, 0.1).ok_or("n is 1")?;
/// assert!((friction.force_n(out, 2e6) - 0.55).abs() < 1e-6);
/// // Turned about, the state stands at 2/e - 1 one presliding length later.
/// let back = friction.exact_step(1.0, -5.2e-3).ok_or("n is 1")?;
/// assert!((back - (2.0 / std::f64::consts::E - 1.0)).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Friction<D> {
    pub m0_n: D,
    pub m1_n_pa: D,
    pub presliding_length_m: D,
    pub a: D,
    pub nu: D,
    pub n: D,
    pub rho: D,
}

/// Slopes of `dz/dt`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RateJacobian<D> {
    /// To `z`, 1/s.
    pub drate_dz: D,
    /// To `de/dt`, 1/m.
    pub drate_dv: D,
}

/// Presliding lengths a second below which sensitivities take it for rest.
const STILL_1_S: f64 = 0.02;

impl<D: Scalar> Friction<D> {
    /// The law with `A = nu = n = 1`, `rho = 0`: Dahl's friction with a pressure-dependent level.
    pub fn dahl(m0_n: D, m1_n_pa: D, presliding_length_m: D) -> Self {
        let one = D::constant(1.0);
        Self { m0_n, m1_n_pa, presliding_length_m, a: one, nu: one, n: one, rho: D::constant(0.0) }
    }

    /// Whether the state stays bounded, follows the motion and loses energy over every closed loop.
    pub fn check(&self) -> Result<(), MuscleError> {
        not_negative("m0_n", self.m0_n.value())?;
        not_negative("m1_n_pa", self.m1_n_pa.value())?;
        positive("presliding_length_m", self.presliding_length_m.value())?;
        positive("a", self.a.value())?;
        positive("nu", self.nu.value())?;
        not_negative("n - 1", self.n.value() - 1.0)?;
        let (rho, a) = (self.rho.value(), self.a.value());
        if rho.abs() < a {
            return Ok(());
        }
        Err(MuscleError::OneSidedFriction { rho, a })
    }

    /// Force level `m0 + m1 max(p, 0)`, N.
    pub(crate) fn level_n(&self, pressure_pa: D) -> D {
        pressure_pa.select_above(D::constant(0.0), self.m0_n + self.m1_n_pa * pressure_pa, self.m0_n)
    }

    /// `dF/dp`, N/Pa (0 below gauge zero).
    pub(crate) fn force_per_pressure(&self, z: D, pressure_pa: D) -> D {
        let zero = D::constant(0.0);
        pressure_pa.select_above(zero, self.m1_n_pa * z, zero)
    }

    /// Friction force, N, added to the muscle's pull.
    pub fn force_n(&self, z: D, pressure_pa: D) -> D {
        self.level_n(pressure_pa) * z
    }

    /// `dz/dt`, 1/s, at `de/dt = velocity_m_s`.
    pub fn rate(&self, z: D, velocity_m_s: D) -> D {
        let pace = velocity_m_s.abs_about_rest(self.presliding_length_m * STILL_1_S);
        (self.a * velocity_m_s + pace * self.pull_back(z)) / self.presliding_length_m
    }

    /// Slopes of [`Friction::rate`] for an implicit integrator; at rest the mean of the two sides.
    pub(crate) fn rate_jacobian(&self, z: D, velocity_m_s: D) -> RateJacobian<D> {
        let restoring = -(self.nu * self.n * power(z.abs(), self.n - 1.0));
        RateJacobian {
            drate_dz: velocity_m_s.abs() * restoring / self.presliding_length_m,
            drate_dv: (self.a + self.pull_back(z) * direction(velocity_m_s)) / self.presliding_length_m,
        }
    }

    /// `z` after the elongation moved by `step_m` without turning; none unless `n = 1`.
    ///
    /// `z = z0 + (A sgn(de) + rho - nu z0) (1 - exp(-nu |du|))/nu`. Derivatives to `n` are not carried.
    pub fn exact_step(&self, z: D, step_m: D) -> Option<D> {
        if !self.n.is_at(1.0) {
            return None;
        }
        let travel = step_m.abs() / self.presliding_length_m;
        let drive = self.a * direction(step_m) + self.rho - self.nu * z;
        Some(z + drive * faded(travel, self.nu))
    }

    /// Energy held in presliding at constant pressure, `(m0 + m1 p) x_pre z^2/(2 A)`, J.
    pub fn stored_energy_j(&self, z: D, pressure_pa: D) -> D {
        self.level_n(pressure_pa) * self.presliding_length_m * z * z / (self.a * 2.0)
    }

    /// Heat `F v - dS/dt` at constant pressure, W: `(m0 + m1 p) |v| (nu |z|^(n+1) - rho z)/A`.
    pub(crate) fn dissipation_w(&self, z: D, velocity_m_s: D, pressure_pa: D) -> D {
        -(self.level_n(pressure_pa) * velocity_m_s.abs() * z * self.pull_back(z)) / self.a
    }

    /// What a changing pressure adds to the stored energy, W (either sign): the energy balance's
    /// 'pressure-friction exchange'.
    pub(crate) fn pressure_exchange_w(&self, z: D, pressure_pa: D, pressure_rate_pa_s: D) -> D {
        self.force_per_pressure(z, pressure_pa) * z * self.presliding_length_m / (self.a * 2.0) * pressure_rate_pa_s
    }

    /// `rho - nu |z|^(n-1) z`, the part of the rate that does not know the direction.
    fn pull_back(&self, z: D) -> D {
        self.rho - self.nu * z * power(z.abs(), self.n - 1.0)
    }
}

/// -1, 0 or 1.
fn direction<D: Scalar>(x: D) -> D {
    let [minus, zero, plus] = [-1.0, 0.0, 1.0].map(D::constant);
    x.select_above(zero, plus, zero.select_above(x, minus, zero))
}

/// `base^exponent` for a base >= 0, its derivatives finite where the power is constant or the base zero.
fn power<D: Scalar>(base: D, exponent: D) -> D {
    if exponent.is_at(0.0) {
        D::constant(1.0)
    } else if base.is_at(0.0) {
        D::constant(0.0)
    } else {
        base.powd(exponent)
    }
}

/// `(1 - exp(-nu u))/nu`, finite at `nu = 0`.
fn faded<D: Scalar>(travel: D, nu: D) -> D {
    let x = travel * nu;
    if x.abs().is_below(1e-5) {
        return travel * (-(x * (-(x / 3.0) + 1.0)) * 0.5 + 1.0);
    }
    -(-x).exp_m1() / nu
}
