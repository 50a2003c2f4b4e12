//! Lasting elongation.

use crate::scalar::Scalar;

/// A shift of rest that grows while the muscle is long: `de_p/dt = k max(0, e - e_lim)`; wall and coil see `e - e_p`.
///
/// `k` 1/s, `e_lim` m. It never recovers. Source: viscoplastic flow with a threshold (Bingham), in strain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlasticSet<D> {
    pub set_rate_1_s: D,
    pub threshold_m: D,
}

impl<D: Scalar> PlasticSet<D> {
    /// `de_p/dt`, m/s.
    pub fn rate_m_s(&self, elongation_m: D) -> D {
        let beyond = elongation_m - self.threshold_m;
        let zero = D::constant(0.0);
        beyond.select_above(zero, self.set_rate_1_s * beyond, zero)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flows_beyond_the_threshold_only() {
        let law = PlasticSet { set_rate_1_s: 0.01f64, threshold_m: 0.02 };
        assert_eq!(law.rate_m_s(0.02), 0.0);
        assert!((law.rate_m_s(0.03) - 1e-4).abs() < 1e-18);
    }
}
