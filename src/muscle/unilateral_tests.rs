//! Contract: the wall that may leave the coil is the uniaxial tube without pressure, the held one with enough of it,
//! and between the two all its forces, volumes and slopes come from one energy.

use super::wall_tests::{COIL, SILICONE, STOCK, near, ogden, stock};
use num_dual::{Dual64, first_derivative};
use proptest::prelude::*;

/// Uniaxial Yeoh tube: `F = A0 2 (lambda - lambda^-2) (C1 + 2 C2 (I1 - 3))`.
fn uniaxial(lambda: f64) -> f64 {
    let wall_area = STOCK.silicone_volume_m3() / STOCK.rest_length_m;
    let j = lambda * lambda + 2.0 / lambda - 3.0;
    wall_area * 2.0 * (lambda - lambda.powi(-2)) * (0.255e6 + 2.0 * 0.0155e6 * j)
}

#[test]
fn val_no_pressure_is_the_uniaxial_tube() {
    for lambda in [1.001, 1.1, 1.7, 2.4, 3.5, 4.6] {
        let state = stock().unilateral((lambda - 1.0) * 0.05, 0.0);
        near(state.pull_n, uniaxial(lambda), 1e-11);
        near(state.outer_radius_m, 0.525e-3 / f64::sqrt(lambda), 1e-11);
        near(state.volume_m3, std::f64::consts::PI * 0.255e-3f64.powi(2) * 0.05, 1e-10);
    }
}

#[test]
fn val_paper_blocked_force() {
    let force = stock().unilateral(0.125, 0.0).pull_n + COIL.pull_n(0.125);
    near(force, 6.07, 0.002);
    println!("free wall and coil at 175 mm: {force:.4} N");
}

#[test]
fn val_small_strain_stiffness_of_the_free_tube() {
    let state = stock().unilateral(1e-9, 0.0);
    let area = STOCK.silicone_volume_m3() / STOCK.rest_length_m;
    near(state.dpull_de, 6.0 * 0.255e6 * area / 0.05, 1e-6);
}

#[test]
fn enough_pressure_holds_the_wall() {
    for pressure in [2.0e6, 6e6] {
        let (free, held) = (stock().unilateral(0.03, pressure), stock().held(0.03, pressure));
        near(free.pull_n, held.pull_n, 1e-9);
        near(free.volume_m3, held.volume_m3, 1e-12);
        near(free.energy_j, held.energy_j, 1e-9);
        near(free.dpull_de, held.dpull_de, 1e-6);
        near(free.dpull_dp, -STOCK.coil_area_m2(), 1e-14);
        assert_eq!(free.dvolume_dp, 0.0);
    }
}

#[test]
fn pull_is_continuous_at_the_touch() {
    let (mut low, mut high) = (0.0, 6e6);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stock().unilateral(0.05, middle).dvolume_dp > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    println!("the wall meets the coil at {:.4} MPa (lambda = 2)", high * 1e-6);
    let (off, on) = (stock().unilateral(0.05, low), stock().unilateral(0.05, high));
    near(off.pull_n, on.pull_n, 1e-8);
    near(off.volume_m3, on.volume_m3, 1e-8);
}

#[test]
fn dual_numbers_give_the_same_slopes() {
    let dual = stock().with_material(SILICONE.map(Dual64::from));
    for (e, p) in [(0.03, 2e5), (0.08, 1e5), (0.04, 4e6)] {
        let state = stock().unilateral(e, p);
        let (_, to_e) = first_derivative(|e| dual.unilateral(e, Dual64::from(p)).pull_n, e);
        let (_, to_p) = first_derivative(|p| dual.unilateral(Dual64::from(e), p).pull_n, p);
        let (_, swell) = first_derivative(|p| dual.unilateral(Dual64::from(e), p).volume_m3, p);
        near(state.dpull_de, to_e, 1e-9);
        near(state.dpull_dp, to_p, 1e-9);
        assert!((state.dvolume_dp - swell).abs() <= 1e-9 * state.dvolume_dp.abs());
    }
}

proptest! {
    /// `F = dPi/dL`, `V = -dPi/dp`, and so `dF/dp = -dV/dL`, with `Pi = U - p V`.
    #[test]
    fn one_energy_behind_it(e in 0.0005f64..0.16, p in -1e4f64..4e6) {
        for material in [SILICONE, ogden()] {
            let wall = stock().with_material(material);
            let pi = |e, p| { let s = wall.unilateral(e, p); s.energy_j - p * s.volume_m3 };
            let state = wall.unilateral(e, p);
            let (he, hp) = (1e-6, 20.0);
            let (left, right) = (wall.unilateral(e - he, p), wall.unilateral(e + he, p));
            let (under, over) = (wall.unilateral(e, p - hp), wall.unilateral(e, p + hp));
            // Slopes jump at the touch: look only where both neighbours are on the same side.
            let sides = [&left, &right, &under, &over].map(|s| s.dvolume_dp > 0.0);
            prop_assume!(sides.iter().all(|s| *s == sides[0]));
            // Near its pressure maximum an inflating wall runs away: there no step is small.
            prop_assume!((over.dvolume_dp - under.dvolume_dp).abs() <= 0.01 * state.dvolume_dp);
            let pull = (pi(e + he, p) - pi(e - he, p)) / (2.0 * he);
            prop_assert!((pull - state.pull_n).abs() < 1e-6 * (1.0 + pull.abs()));
            let volume = (pi(e, p - hp) - pi(e, p + hp)) / (2.0 * hp);
            prop_assert!((volume - state.volume_m3).abs() < 1e-4 * volume.abs());
            let area = (right.volume_m3 - left.volume_m3) / (2.0 * he);
            // The area passes through zero where a longer tube holds no more: there the bore's is the measure.
            const BORE_AREA_M2: f64 = 2.0e-7;
            prop_assert!((area + state.dpull_dp).abs() < 1e-5 * (area.abs() + BORE_AREA_M2));
            let stiffness = (right.pull_n - left.pull_n) / (2.0 * he);
            prop_assert!((stiffness - state.dpull_de).abs() < 1e-5 * (10.0 + stiffness.abs()));
            let swell = (over.volume_m3 - under.volume_m3) / (2.0 * hp);
            prop_assert!((swell - state.dvolume_dp).abs() <= 1e-4 * swell.abs() + 1e-20);
        }
    }

    #[test]
    fn the_coil_is_never_passed(e in -0.005f64..0.16, p in -1e5f64..6e6) {
        let state = stock().unilateral(e, p);
        prop_assert!(state.outer_radius_m <= 0.525e-3);
        prop_assert!(state.volume_m3 > 0.0 || p < 0.0);
    }
}
