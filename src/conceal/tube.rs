//! The held tube by quadrature over its wall.

use std::f64::consts::PI;

use super::stock::{INNER_RADIUS_M, OUTER_RADIUS_M, REST_LENGTH_M, YEOH_C2_PA};

/// Gauss-Legendre points on -1..1 and their weights.
const GAUSS: [(f64, f64); 6] = [
    (-0.932_469_514_203_152, 0.171_324_492_379_17),
    (-0.661_209_386_466_265, 0.360_761_573_048_139),
    (-0.238_619_186_083_197, 0.467_913_934_572_691),
    (0.238_619_186_083_197, 0.467_913_934_572_691),
    (0.661_209_386_466_265, 0.360_761_573_048_139),
    (0.932_469_514_203_152, 0.171_324_492_379_17),
];

/// Pull `dU/dL` (N) and energy `U` (J) of the held Yeoh tube: `U = L0 pi integral of W dq`, `q = B²` from bore to coil.
pub fn pull_and_energy(c1_pa: f64, elongation_m: f64) -> (f64, f64) {
    let lambda = 1.0 + elongation_m / REST_LENGTH_M;
    let (q0, q1) = (INNER_RADIUS_M * INNER_RADIUS_M, OUTER_RADIUS_M * OUTER_RADIUS_M);
    let (middle, half) = (0.5 * (q1 + q0), 0.5 * (q1 - q0));
    let (mut pull, mut energy) = (0.0, 0.0);
    for (x, weight) in GAUSS {
        let q = middle + half * x;
        let outward = q1 - q;
        let hoop = (q1 - outward / lambda) / q;
        let radial = 1.0 / (lambda * lambda * hoop);
        let strain = lambda * lambda + hoop + radial - 3.0;
        let hoop_slope = outward / (lambda * lambda * q);
        let slope = 2.0 * lambda + hoop_slope - radial * (2.0 / lambda + hoop_slope / hoop);
        pull += weight * (c1_pa + 2.0 * YEOH_C2_PA * strain) * slope;
        energy += weight * (c1_pa + YEOH_C2_PA * strain) * strain;
    }
    (PI * half * pull, PI * half * energy * REST_LENGTH_M)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::stock::COIL_STIFFNESS_N_M;

    /// The force that holds the stock muscle at 175 mm is printed: 6.31 N with coil and held wall.
    #[test]
    fn the_held_muscle_pulls_as_the_paper_says_and_force_is_the_slope_of_energy() {
        let (pull, _) = pull_and_energy(0.255e6, 0.125);
        assert!((pull + COIL_STIFFNESS_N_M * 0.125 - 6.31).abs() < 0.01, "{pull}");
        let energy = |e: f64| pull_and_energy(0.255e6, e).1;
        let slope = (energy(0.0301) - energy(0.0299)) / 2e-4;
        assert!((slope / pull_and_energy(0.255e6, 0.03).0 - 1.0).abs() < 1e-6);
    }
}
