//! An effect of one's own, without touching the program: a spring beside the muscle that hardens with its cube.
//!
//! The law is asked every millisecond and acts on the joint as a load. `docs/extending.md` shows the other way: a law in
//! the catalogue, which a diagnosis can then find.
//!
//! ```text
//! cargo run --release --example custom_effect
//! ```

use std::error::Error;

use smam::scene::Scene;
use smam::system::Simulation;

const JOINT: &str = "slide";
const INTERVAL_S: f64 = 1e-3;

/// Pull of the added spring at an elongation, N: `k3 x^3`.
fn hardening_spring_n(elongation_m: f64, cubic_n_m3: f64) -> f64 {
    cubic_n_m3 * elongation_m.powi(3)
}

/// Greatest elongation of the bench in 10 s, m.
fn greatest_elongation_m(cubic_n_m3: f64) -> Result<f64, Box<dyn Error>> {
    let mut simulation = Simulation::new(Scene::load("muscle_bench", &[])?)?;
    let (mut pull_n, mut greatest_m) = (0.0, 0.0_f64);
    for step in 1..=10_000 {
        simulation.advance_to(f64::from(step) * INTERVAL_S)?;
        let elongation_m = simulation.joint_position(JOINT).ok_or("the bench has no such joint")?;
        greatest_m = greatest_m.max(elongation_m);
        // `add_load` counts from what is there already: pass on the change.
        let now_n = hardening_spring_n(elongation_m, cubic_n_m3);
        simulation.add_load(JOINT, pull_n - now_n)?;
        pull_n = now_n;
    }
    Ok(greatest_m)
}

fn main() -> Result<(), Box<dyn Error>> {
    for cubic_n_m3 in [0.0, 2e4, 1e5] {
        println!("k3 = {cubic_n_m3:8.1e} N/m3: {:.3} mm at most", 1e3 * greatest_elongation_m(cubic_n_m3)?);
    }
    Ok(())
}
