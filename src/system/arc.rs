//! The tip of a slender rod that is bent to an arc.

use crate::scalar::Scalar;
use crate::scene::Quantity;

/// Below this angle, rad, the arc's formulas are replaced by their series: the next term is below 1e-10 of the length.
const SMALL_RAD: f64 = 1e-2;

/// Which coordinate of the tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ArcSide {
    Sideways,
    Along,
}

impl ArcSide {
    /// That of an output quantity, if it is one of the tip's.
    pub fn of(quantity: Quantity) -> Option<Self> {
        match quantity {
            Quantity::ArcTipX => Some(Self::Sideways),
            Quantity::ArcTipZ => Some(Self::Along),
            _ => None,
        }
    }

    /// Coordinate of the tip of a rod of length `L`, clamped along z and bent by the angle `t` to a constant curvature, m:
    ///
    /// ```text
    /// x = L (1 - cos t)/t,    z = L sin(t)/t
    /// ```
    ///
    /// Source: Webster and Jones, Int. J. Robotics Research 29(13), 2010.
    pub fn of_tip<D: Scalar>(self, length_m: f64, angle: D) -> D {
        let square = angle * angle;
        let share = match (self, angle.abs().is_below(SMALL_RAD)) {
            (Self::Sideways, true) => angle * (-(square / 24.0) + 0.5),
            (Self::Sideways, false) => (-angle.cos() + 1.0) / angle,
            (Self::Along, true) => -(square / 6.0) + 1.0 + square * square / 120.0,
            (Self::Along, false) => angle.sin() / angle,
        };
        share * length_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_half_circle_and_a_quarter_end_where_they_must() {
        let (x, z) = (ArcSide::Sideways, ArcSide::Along);
        // Half a circle of length 1 has the diameter 2/pi.
        assert!((x.of_tip(1.0, PI) - 2.0 / PI).abs() < 1e-12 && z.of_tip(1.0, PI).abs() < 1e-12);
        assert!(
            (x.of_tip(1.0, -PI / 2.0) + 2.0 / PI).abs() < 1e-12 && (z.of_tip(1.0, PI / 2.0) - 2.0 / PI).abs() < 1e-12
        );
    }

    #[test]
    fn the_series_meet_the_formulas() {
        for side in [ArcSide::Sideways, ArcSide::Along] {
            let (below, above) =
                (side.of_tip(1.0, SMALL_RAD * (1.0 - 1e-9)), side.of_tip(1.0, SMALL_RAD * (1.0 + 1e-9)));
            assert!((below - above).abs() < 1e-10, "{side:?}: {below} {above}");
        }
    }
}
