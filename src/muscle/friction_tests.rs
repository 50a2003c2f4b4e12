//! Contract: the friction loses energy over every closed loop at constant pressure, its closed form solves its rate,
//! and its Jacobian is the rate's.

use super::wall_tests::near;
use super::*;
use num_dual::{Dual64, first_derivative};
use proptest::prelude::*;

fn stock() -> Friction<f64> {
    Friction::dahl(0.106, 0.222e-6, 5.2e-3)
}

fn dual(f: Friction<f64>) -> Friction<Dual64> {
    Friction {
        m0_n: f.m0_n.into(),
        m1_n_pa: f.m1_n_pa.into(),
        presliding_length_m: f.presliding_length_m.into(),
        a: f.a.into(),
        nu: f.nu.into(),
        n: f.n.into(),
        rho: f.rho.into(),
    }
}

/// `z` and the work `integral of F de` over a path, by the classical Runge-Kutta method.
fn walk(law: &Friction<f64>, mut z: f64, legs_m: &[f64], pressure_pa: f64) -> (f64, f64) {
    let mut work = 0.0;
    for &leg in legs_m {
        let steps = 200;
        let h = leg / f64::from(steps);
        let way = leg.signum();
        let slope = |z: f64| law.rate(z, way) * way;
        for _ in 0..steps {
            let k1 = slope(z);
            let k2 = slope(z + 0.5 * h * k1);
            let k3 = slope(z + 0.5 * h * k2);
            let k4 = slope(z + h * k3);
            let middle = z + 0.25 * h * (k1 + k2);
            let next = z + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            let force = |z: f64| law.force_n(z, pressure_pa);
            work += h / 6.0 * (force(z) + 4.0 * force(middle) + force(next));
            z = next;
        }
    }
    (z, work)
}

#[test]
fn val_dahl_settles_at_its_level() {
    let z = stock().exact_step(0.0, 0.1).unwrap();
    near(z, 1.0, 1e-8);
    near(stock().force_n(z, 1e6), 0.106 + 0.222, 1e-8);
    near(stock().force_n(z, -1e5), 0.106, 1e-8);
    near(stock().exact_step(0.0, 5.2e-3).unwrap(), 1.0 - (-1.0f64).exp(), 1e-14);
}

#[test]
fn val_closed_form_is_the_rates_integral() {
    let law = Friction { a: 1.3, nu: 0.7, rho: -0.4, ..stock() };
    for leg in [2e-3, -9e-3, 30e-3] {
        near(walk(&law, 0.4, &[leg], 0.0).0, law.exact_step(0.4, leg).unwrap(), 2e-8);
    }
    let free = Friction { nu: 0.0, ..stock() };
    near(free.exact_step(0.1, 5.2e-3).unwrap(), 1.1, 1e-14);
    assert_eq!(Friction { n: 1.2, ..stock() }.exact_step(0.0, 1e-3), None);
}

#[test]
fn jacobian_is_the_rates() {
    for n in [1.0, 1.035, 2.0] {
        let law = Friction { n, rho: -0.2, ..stock() };
        for (z, v) in [(0.3, 0.01), (-0.7, 0.02), (0.5, -0.03), (-0.2, -0.01)] {
            let jacobian = law.rate_jacobian(z, v);
            let (_, dz) = first_derivative(|z| dual(law).rate(z, Dual64::from(v)), z);
            let (_, dv) = first_derivative(|v| dual(law).rate(Dual64::from(z), v), v);
            near(jacobian.drate_dz, dz, 1e-12);
            near(jacobian.drate_dv, dv, 1e-12);
        }
    }
    assert_eq!(stock().rate(0.5, 0.0), 0.0);
    assert_eq!(dual(stock()).rate(Dual64::from(0.0), Dual64::from(0.0)).eps, 0.0);
}

#[test]
fn refuses_what_does_not_settle() {
    assert!(stock().check().is_ok());
    assert!(Friction { rho: 1.0, ..stock() }.check().is_err());
    assert!(Friction { nu: 0.0, ..stock() }.check().is_err());
    assert!(Friction { n: 0.5, ..stock() }.check().is_err());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]

    /// Passive at constant pressure, with the storage it claims, for any zigzag and any exponent.
    #[test]
    fn work_covers_the_stored_energy(
        legs in prop::collection::vec(-0.02f64..0.02, 1..8),
        z in -0.9f64..0.9, n in 1.0f64..2.5, nu in 0.5f64..1.2, p in 0.0f64..3e6,
    ) {
        let law = Friction { n, nu, ..stock() };
        let (end, work) = walk(&law, z, &legs, p);
        let stored = law.stored_energy_j(end, p) - law.stored_energy_j(z, p);
        prop_assert!(work - stored >= -1e-9 * law.level_n(p));
    }

    /// Even with `rho`: a loop that repeats loses energy.
    #[test]
    fn a_closed_loop_loses_energy(
        stroke in 1e-4f64..0.04, n in 1.0f64..2.5, a in 0.5f64..3.0, nu in 0.5f64..3.0,
        skew in -0.95f64..0.95, p in 0.0f64..3e6,
    ) {
        let law = Friction { n, a, nu, rho: skew * a, ..stock() };
        prop_assert!(law.check().is_ok());
        let cycle = [stroke, -stroke];
        let (mut z, mut work, mut drift) = (0.0, 0.0, 1.0);
        for _ in 0..200 {
            let (next, lost) = walk(&law, z, &cycle, p);
            (drift, work, z) = ((next - z).abs(), lost, next);
            if drift < 1e-12 { break; }
        }
        prop_assume!(drift < 1e-12);
        prop_assert!(work >= -1e-12, "{work}");
    }

    #[test]
    fn the_books_close(z in -1.0f64..1.0, v in -0.1f64..0.1, p in 0.0f64..3e6, rho in -0.9f64..0.9) {
        let law = Friction { rho, n: 1.3, ..stock() };
        let power = law.force_n(z, p) * v;
        let storing = law.level_n(p) * law.presliding_length_m * z * law.rate(z, v) / law.a;
        prop_assert!((power - storing - law.dissipation_w(z, v, p)).abs() < 1e-12);
    }
}
