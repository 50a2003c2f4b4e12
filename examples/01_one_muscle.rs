//! One muscle on the bench, played from code: its loop, with the stock line and with three times of it.
//!
//! ```text
//! cargo run --release --example one_muscle
//! ```

use std::error::Error;

use smam::recording::figures;
use smam::scene::{Override, Scene};
use smam::system::{Schedule, Simulation, record};

fn main() -> Result<(), Box<dyn Error>> {
    for line_m in [1.0, 3.0] {
        // Any key that `smam check muscle_bench --keys` lists may be changed.
        let scene = Scene::load("muscle_bench", &[Override::number("hydraulics.line.length_m", line_m)])?;
        let mut simulation = Simulation::new(scene)?;
        simulation.keep_energy_book();
        let recording = record(&mut simulation, &Schedule::even(30.0, 0.01))?;
        let elongation_mm = &recording.channel("elongation_mm")?.values;
        let pressure_kpa = &recording.channel("pressure_kpa")?.values;
        println!(
            "line of {line_m} m: elongation over {:.3} mm, pressure over {:.1} kPa",
            figures::range(elongation_mm),
            figures::range(pressure_kpa)
        );
        if let Some(book) = simulation.energy_book() {
            println!("  energy unaccounted for: {:.1e} J of {:.3} J", book.unaccounted_j(), book.turnover_j());
        }
    }
    Ok(())
}
