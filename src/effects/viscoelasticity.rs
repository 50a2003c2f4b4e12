//! Relaxation of the silicone.

use crate::scalar::Scalar;

/// A Maxwell branch beside the muscle: pull `E (e - e_i)`, `tau de_i/dt = e - e_i`; relaxed at the start.
///
/// `E` N/m, `tau` s > 0. Several branches make a spectrum. Source: generalised Maxwell (Wiechert) solid.
///
/// ```
/// use smam::effects::MaxwellBranch;
///
/// let branch = MaxwellBranch { stiffness_n_m: 6.0_f64, relaxation_time_s: 4.0 };
/// // Stretched at once by 10 mm it pulls with 60 mN, and yields at 2.5 mm/s; relaxed, it pulls no more.
/// assert!((branch.pull_n(0.01, 0.0) - 0.06).abs() < 1e-15);
/// assert!((branch.rate_m_s(0.01, 0.0) - 2.5e-3).abs() < 1e-15);
/// assert_eq!(branch.pull_n(0.01, 0.01), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaxwellBranch<D> {
    pub stiffness_n_m: D,
    pub relaxation_time_s: D,
}

impl<D: Scalar> MaxwellBranch<D> {
    /// Pull at elongation `e` with the dashpot at `e_i`, N.
    pub fn pull_n(&self, elongation_m: D, dashpot_m: D) -> D {
        self.stiffness_n_m * (elongation_m - dashpot_m)
    }

    /// Energy in the spring, J.
    pub fn energy_j(&self, elongation_m: D, dashpot_m: D) -> D {
        let stretch = elongation_m - dashpot_m;
        self.stiffness_n_m * stretch * stretch / 2.0
    }

    /// Heat in the dashpot, W.
    pub(crate) fn dissipation_w(&self, elongation_m: D, dashpot_m: D) -> D {
        self.pull_n(elongation_m, dashpot_m) * self.rate_m_s(elongation_m, dashpot_m)
    }

    /// `de_i/dt`, m/s.
    pub fn rate_m_s(&self, elongation_m: D, dashpot_m: D) -> D {
        (elongation_m - dashpot_m) / self.relaxation_time_s
    }
}
