//! Figures that need runs of their own: how stiff a joint is, how fast it follows.

use std::f64::consts::{SQRT_2, TAU};

use super::SweepError;
use crate::recording::{PiecewiseLinear, Recording};
use crate::scene::{OutputSpec, Scene};
use crate::system::{InputSource, Schedule, Simulation, record};

/// Time over which plungers are moved to where they are held, and when all is taken to be at rest there.
const DRAWN_S: f64 = 1.0;
const SETTLED_S: f64 = 3.0;

/// Apparent stiffness of joints against a load of both signs, N m/rad (N/m of a slider), with every plunger moved by
/// `plunger_m` from its start and held: the load on each joint of an output over how far the output gives way.
///
/// The load rises and turns over seconds, so that inertia and viscosity have no part; what friction holds back belongs to it.
pub fn stiffness(scene: &Scene, channel: &str, load: f64, plunger_m: f64) -> Result<f64, SweepError> {
    let Some(output) = scene.file.output.iter().find(|o| o.channel == channel) else { return Ok(f64::NAN) };
    let mut simulation = held(scene, output, plunger_m)?;
    simulation.advance_to(SETTLED_S)?;
    give_way(&mut simulation, output, 0.0, load)?;
    // The first loading starts where friction has not turned yet: the second closes the loop.
    let there = give_way(&mut simulation, output, load, -load)?;
    let back = give_way(&mut simulation, output, -load, load)?;
    Ok(2.0 * load / (back - there))
}

/// A scene that shows one output, its plungers moved from their start and held.
fn held(scene: &Scene, output: &OutputSpec, plunger_m: f64) -> Result<Simulation, SweepError> {
    // No sensor of another output remembers, and what was added for figures is not read.
    let mut alone = scene.clone();
    alone.file.output = vec![output.clone()];
    let mut simulation = Simulation::new(alone)?;
    for (i, input) in scene.file.input.iter().enumerate() {
        let (start, end) = (start(scene, i), rest(scene, i, plunger_m));
        hold(&mut simulation, &input.channel, &[0.0, DRAWN_S], &[start, end]);
    }
    Ok(simulation)
}

fn start(scene: &Scene, input: usize) -> f64 {
    scene.programs[input].value(0.0)
}

/// Where an input is held: plungers moved, others where they start.
fn rest(scene: &Scene, input: usize, plunger_m: f64) -> f64 {
    let channel = &scene.file.input[input].channel;
    let is_plunger = scene.file.hydraulics.is_some() && scene.file.muscle.iter().any(|m| m.input == *channel);
    start(scene, input) + if is_plunger { plunger_m } else { 0.0 }
}

/// Changes the load on the joints of an output within a second, waits for another, and says where the output stands, SI.
fn give_way(simulation: &mut Simulation, output: &OutputSpec, from: f64, to: f64) -> Result<f64, SweepError> {
    const STEPS: u32 = 100;
    let start_s = simulation.time_s();
    for step in 1..=STEPS {
        for joint in &output.of {
            simulation.add_load(joint, (to - from) / f64::from(STEPS))?;
        }
        simulation.advance_to(start_s + f64::from(step) / f64::from(STEPS))?;
    }
    let recording = record(simulation, &Schedule::at(vec![start_s + 1.0, start_s + 2.0]))?;
    Ok(recording.si(&output.channel)?.last().copied().unwrap_or(f64::NAN))
}

/// A sine of one input about where it is held, and the output that is to follow it.
#[derive(Clone, Copy, Debug)]
pub struct Sine<'a> {
    pub input: &'a str,
    pub channel: &'a str,
    /// In the input's SI unit.
    pub amplitude: f64,
    /// By how much every plunger is moved from its start, m.
    pub plunger_m: f64,
}

/// Frequency at which an output follows an input with 1/sqrt(2) of its slow amplitude, Hz; NaN above 50 Hz, and where it
/// does not follow at all.
///
/// Slow is 0.1 Hz. Friction and slack make it depend on the amplitude.
pub fn bandwidth_hz(scene: &Scene, sine: Sine) -> Result<f64, SweepError> {
    const SLOW_HZ: f64 = 0.1;
    const FASTEST_HZ: f64 = 50.0;
    let limit = response(scene, sine, SLOW_HZ)? / SQRT_2;
    if limit.is_nan() || limit <= 0.0 {
        return Ok(f64::NAN);
    }
    let (mut low, mut high) = (SLOW_HZ, 2.0 * SLOW_HZ);
    while response(scene, sine, high)? > limit {
        (low, high) = (high, 2.0 * high);
        if low >= FASTEST_HZ {
            return Ok(f64::NAN);
        }
    }
    // To a hundredth.
    while high / low > 1.01 {
        let middle = (low * high).sqrt();
        if response(scene, sine, middle)? > limit { low = middle } else { high = middle }
    }
    Ok((low * high).sqrt())
}

/// Amplitude of an output's fundamental in the third period of a sine.
fn response(scene: &Scene, sine: Sine, frequency_hz: f64) -> Result<f64, SweepError> {
    const SAMPLES: u32 = 64;
    const PERIODS: u32 = 3;
    let Some(at) = scene.file.input.iter().position(|i| i.channel == sine.input) else { return Ok(f64::NAN) };
    let Some(output) = scene.file.output.iter().find(|o| o.channel == sine.channel) else { return Ok(f64::NAN) };
    let mut simulation = held(scene, output, sine.plunger_m)?;
    let phases = (0..=SAMPLES * PERIODS).map(|i| f64::from(i) / f64::from(SAMPLES));
    let (mut times, mut values) = (vec![0.0, DRAWN_S], vec![start(scene, at), rest(scene, at, sine.plunger_m)]);
    for phase in phases {
        times.push(SETTLED_S + phase / frequency_hz);
        values.push(rest(scene, at, sine.plunger_m) + sine.amplitude * (TAU * phase).sin());
    }
    hold(&mut simulation, sine.input, &times, &values);
    let recording = record(&mut simulation, &Schedule::at(times))?;
    fundamental(&recording, sine.channel, SAMPLES as usize)
}

/// Amplitude of the first harmonic of a series' last period, in the channel's unit.
fn fundamental(recording: &Recording, channel: &str, samples: usize) -> Result<f64, SweepError> {
    let values = &recording.channel(channel)?.values;
    let last = &values[values.len().saturating_sub(samples)..];
    let phase = |i: usize| TAU * i as f64 / samples as f64;
    let sine: f64 = last.iter().enumerate().map(|(i, v)| v * phase(i).sin()).sum();
    let cosine: f64 = last.iter().enumerate().map(|(i, v)| v * phase(i).cos()).sum();
    Ok(2.0 * sine.hypot(cosine) / samples as f64)
}

/// Drives an input through points, the ends held.
fn hold(simulation: &mut Simulation, channel: &str, time_s: &[f64], value: &[f64]) {
    if let Some(line) = PiecewiseLinear::new(time_s, value) {
        simulation.set_input(channel, InputSource::Recorded(line));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Override, Quantity};

    /// A muscle known by its stiffness alone, on a slider of 0.105 kg, driven by pressure.
    fn linear(set: &[&str]) -> Scene {
        let set: Vec<Override> = set.iter().map(|s| Override::parse(s).expect("an override")).collect();
        let mut scene = Scene::load("pressure_muscle", &set).expect("a stock scene");
        scene.file.output = vec![OutputSpec {
            channel: "x_m".to_owned(),
            quantity: Quantity::JointPosition,
            of: vec![scene.file.muscle[0].joint.clone().expect("a joint")],
            arc_length_m: None,
            counts_from_start: false,
        }];
        scene
    }

    #[test]
    fn a_joint_is_as_stiff_as_the_muscle_on_it() {
        let found = stiffness(&linear(&["muscles.linear.stiffness_n_m=150.0"]), "x_m", 0.1, 0.0).expect("it runs");
        assert!((found / 150.0 - 1.0).abs() < 1e-3, "{found}");
    }

    #[test]
    fn bandwidth_of_a_spring_mass_and_damper() {
        let (k, c, m) = (200.0f64, 20.0f64, 0.105f64);
        let scene = linear(&["muscles.damping_n_s_m=20.0"]);
        let sine = Sine { input: "pressure_kpa", channel: "x_m", amplitude: 1e4, plunger_m: 0.0 };
        let found = bandwidth_hz(&scene, sine).expect("it runs");
        // |k - m w^2 + i c w| = sqrt(2) k
        let b = c * c - 2.0 * k * m;
        let w2 = (-b + (b * b + 4.0 * m * m * k * k).sqrt()) / (2.0 * m * m);
        assert!((found / (w2.sqrt() / TAU) - 1.0).abs() < 0.02, "{found} {}", w2.sqrt() / TAU);
    }
}
