//! Two muscles turn a pulley against each other: what their pre-elongation does to the angle that they reach.
//!
//! ```text
//! cargo run --release --example pulley
//! ```

use std::error::Error;

use smam::recording::figures;
use smam::scene::{Override, Scene};
use smam::system::{Schedule, Simulation, record};

fn main() -> Result<(), Box<dyn Error>> {
    println!("pre-elongation   angle, deg     slack, % of the time");
    for ratio in [0.2, 0.35, 0.5, 0.7] {
        let scene = Scene::load("antagonistic_pulley", &[Override::number("muscles.pre_elongation_ratio", ratio)])?;
        let duration_s = scene.file.simulation.duration_s;
        let recording = record(&mut Simulation::new(scene)?, &Schedule::even(duration_s, 0.01))?;
        let angle_deg = &recording.channel("angle_deg")?.values;
        let slack = |channel: &str| -> Result<usize, Box<dyn Error>> {
            Ok(recording.channel(channel)?.values.iter().filter(|t| **t <= 0.0).count())
        };
        let slack_percent = 100.0 * (slack("tension_1_n")? + slack("tension_2_n")?) as f64 / angle_deg.len() as f64;
        println!(
            "{ratio:14.2}   {:6.1} to {:5.1}   {slack_percent:.1}",
            figures::least(angle_deg),
            figures::greatest(angle_deg)
        );
    }
    Ok(())
}
