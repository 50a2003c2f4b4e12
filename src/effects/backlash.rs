//! Play between the recorded plunger and the piston.

use crate::scalar::Scalar;

/// The play operator: the piston follows the plunger with a dead zone of total width `b`, m:
///
/// `x = min(max(x, u - b/2), u + b/2)`, `u` the recorded position; starts centred, `x = u`.
///
/// Range: `b >= 0`. Source: Krasnosel'skii and Pokrovskii, Systems with Hysteresis.
///
/// ```
/// use smam::effects::Backlash;
///
/// let play = Backlash { width_m: 4e-5_f64 };
/// // Half of the width behind the plunger going out, half of it ahead coming back.
/// let ahead_m = play.follow(0.0, 1e-3);
/// assert_eq!(ahead_m, -2e-5);
/// assert_eq!(play.follow(ahead_m, -1e-3), 2e-5);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Backlash<D> {
    pub width_m: D,
}

impl<D: Scalar> Backlash<D> {
    /// How far the piston is ahead of the plunger after the plunger went on by `step_m`, from being `ahead_m`.
    pub fn follow(&self, ahead_m: D, step_m: f64) -> D {
        let half = self.width_m * 0.5;
        let ahead = ahead_m - step_m;
        (-half).select_above(ahead, -half, ahead.select_above(half, half, ahead))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_lost_over_the_width() {
        let play = Backlash { width_m: 0.2 };
        let way = [0.0, 1.0, 0.9, 0.8, 0.5, 0.6, 1.0];
        let mut ahead = 0.0;
        let followed: Vec<f64> = way
            .windows(2)
            .map(|u| {
                ahead = play.follow(ahead, u[1] - u[0]);
                u[1] + ahead
            })
            .collect();
        for (x, expected) in followed.iter().zip([0.9, 0.9, 0.9, 0.6, 0.6, 0.9]) {
            assert!((x - expected).abs() < 1e-15, "{followed:?}");
        }
    }
}
