//! A muscle's coil as a polyline along +z, from 0 to its rest length.

use std::f64::consts::TAU;

use crate::system::observe::MuscleGraph;

/// More turns than this run together on the screen.
const MAX_TURNS: f64 = 24.0;
const POINTS_PER_TURN: f64 = 16.0;

/// A coil as drawn: the turns are thinned out and the radius is widened until both can be seen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coil {
    pub(super) points_m: Vec<[f64; 3]>,
    pub(super) wire_radius_m: f64,
}

/// The coil of a muscle at rest; stretch it by scaling z.
pub(super) fn coil(muscle: &MuscleGraph) -> Coil {
    let length_m = muscle.rest_length_m.max(1e-6);
    let turns = muscle.coil_turns.clamp(3.0, MAX_TURNS);
    let pitch_m = length_m / turns;
    let radius_m = (0.5 * muscle.outer_diameter_m).max(0.7 * pitch_m);
    let count = (turns * POINTS_PER_TURN).ceil() as usize;
    let point = |n: usize| {
        let share = n as f64 / count as f64;
        let (sin, cos) = (TAU * turns * share).sin_cos();
        [radius_m * cos, radius_m * sin, length_m * share]
    };
    Coil { points_m: (0..=count).map(point).collect(), wire_radius_m: 0.16 * pitch_m }
}

/// Rotation (x, y, z, w) that takes +z to `direction`.
pub(super) fn z_towards(direction: [f64; 3]) -> [f64; 4] {
    let norm = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
    if norm.is_nan() || norm <= 0.0 {
        return [0.0, 0.0, 0.0, 1.0];
    }
    let [x, y, z] = direction.map(|d| d / norm);
    if z < -1.0 + 1e-12 {
        return [1.0, 0.0, 0.0, 0.0];
    }
    let w = (0.5 * (1.0 + z)).sqrt();
    [-y / (2.0 * w), x / (2.0 * w), 0.0, w]
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Quaternion, UnitQuaternion, Vector3};

    #[test]
    fn the_rotation_takes_z_to_the_direction() {
        for direction in [[1.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.3, 0.4, -0.5], [0.0, 0.0, -1.0]] {
            let [x, y, z, w] = z_towards(direction);
            let turned = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)) * Vector3::z();
            let wanted = Vector3::from(direction).normalize();
            assert!((turned - wanted).norm() < 1e-9, "{direction:?}: {turned}");
        }
    }

    #[test]
    fn the_coil_spans_the_rest_length() {
        let muscle = MuscleGraph {
            name: "m".into(),
            outer_diameter_m: 0.001,
            coil_turns: 200.0,
            rest_length_m: 0.12,
            anchor_m: [0.0; 3],
            direction: [0.0, 0.0, 1.0],
        };
        let coil = coil(&muscle);
        assert_eq!(coil.points_m.first().map(|p| p[2]), Some(0.0));
        assert_eq!(coil.points_m.last().map(|p| p[2]), Some(0.12));
    }
}
