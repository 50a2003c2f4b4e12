//! One muscle on the bench, played from code: its loop, and what more friction between tube and coil makes of it.
//!
//! ```text
//! cargo run --release --example one_muscle
//! ```

use std::error::Error;

use smam::recording::figures;
use smam::scene::{Override, Scene};
use smam::system::{Schedule, Simulation, record};

const INTERVAL_S: f64 = 0.01;
/// The stock programme is a sine of 0.1 Hz: from 10 s on, a round of it.
const SECOND_ROUND: std::ops::Range<usize> = 1000..2000;

fn main() -> Result<(), Box<dyn Error>> {
    for friction_n in [0.05, 0.106, 0.2] {
        // Any key that `smam check muscle_bench --keys` lists may be changed.
        let scene = Scene::load("muscle_bench", &[Override::number("muscles.friction.m0_n", friction_n)])?;
        let mut simulation = Simulation::new(scene)?;
        simulation.keep_energy_balance();
        let recording = record(&mut simulation, &Schedule::even(20.0, INTERVAL_S))?;
        let plunger_mm = &recording.channel("plunger_mm")?.values[SECOND_ROUND];
        let elongation_mm = &recording.channel("elongation_mm")?.values[SECOND_ROUND];
        println!(
            "friction {friction_n:5.3} N: elongation over {:.3} mm, loop of {:.3} mm2",
            figures::range(elongation_mm),
            figures::enclosed(plunger_mm, elongation_mm).abs()
        );
        if let Some(balance) = simulation.energy_balance() {
            println!("  energy unaccounted for: {:.1e} J of {:.3} J", balance.unaccounted_j(), balance.turnover_j());
        }
    }
    Ok(())
}
