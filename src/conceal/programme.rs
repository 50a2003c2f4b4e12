//! What the plungers of a concealed rig do.

use std::f64::consts::TAU;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::plant::Plunger;
use super::stock::Rig;

/// Interval between samples, s.
pub const SAMPLE_S: f64 = 0.01;

/// Position of one plunger at even times, straight between them, m.
#[derive(Clone, Debug)]
pub struct Drive {
    pub positions_m: Vec<f64>,
}

impl Drive {
    /// The same with so many times the stroke.
    pub fn scaled(&self, by: f64) -> Self {
        Self { positions_m: self.positions_m.iter().map(|x| by * x).collect() }
    }

    /// The plunger so long after sample `k`, within the interval that begins there.
    pub fn after(&self, k: usize, since_s: f64) -> Plunger {
        let speed_m_s = (self.positions_m[k + 1] - self.positions_m[k]) / SAMPLE_S;
        Plunger { position_m: self.positions_m[k] + speed_m_s * since_s, speed_m_s }
    }
}

/// A programme's waveform.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Wave {
    Sine,
    Steps,
    Chirp,
    Triangle,
    Wander,
    TwoTone,
}

impl Wave {
    pub fn name(self) -> &'static str {
        match self {
            Self::Sine => "sine",
            Self::Steps => "steps",
            Self::Chirp => "chirp",
            Self::Triangle => "triangle",
            Self::Wander => "wander",
            Self::TwoTone => "two_tone",
        }
    }

    /// How long a recorded run of it is, s.
    pub fn duration_s(self) -> f64 {
        match self {
            Self::Sine | Self::Triangle => 42.0,
            Self::Steps => 66.0,
            Self::Chirp | Self::Wander => 50.0,
            Self::TwoTone => 40.0,
        }
    }
}

/// One programme for all plungers of a rig.
pub fn programme(rig: Rig, wave: Wave, duration_s: f64, random: &mut ChaCha8Rng) -> Vec<Drive> {
    let count = (duration_s / SAMPLE_S) as usize + 1;
    let first = shares(wave, count, random);
    let by_itself = if rig == Rig::BendingCatheter { Some(shares(wave, count, random)) } else { None };
    let cocontraction = random.random_range(-0.05..0.05);
    rig.strokes_m()
        .iter()
        .enumerate()
        .map(|(i, (low, high))| {
            let share = |k: usize| match (i, rig, &by_itself) {
                (0, _, _) => first[k],
                (_, Rig::AntagonisticPulley, _) => 1.0 - first[k] + cocontraction * (1.0 - (-(k as f64) / 300.0).exp()),
                (_, _, Some(own)) => own[k],
                _ => first[k],
            };
            let rest = if *low < 0.0 && *high > 0.0 { 0.5 } else { f64::from(*high <= 0.0) };
            let at = |k: usize| {
                let entered = (k as f64 * SAMPLE_S / 2.0).min(1.0);
                // From rest into the programme without a jump of the speed.
                let entered = entered * entered * (3.0 - 2.0 * entered);
                low + (high - low) * (rest + entered * (share(k) - rest))
            };
            Drive { positions_m: (0..count).map(at).collect() }
        })
        .collect()
}

/// The waveform as shares of the stroke, 0 to 1.
fn shares(wave: Wave, count: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    let times = (0..count).map(|k| k as f64 * SAMPLE_S);
    match wave {
        Wave::Sine => {
            let hz = random.random_range(0.08..0.15);
            times.map(|t| 0.5 - 0.5 * (TAU * hz * t).cos()).collect()
        }
        Wave::Triangle => {
            let hz = random.random_range(0.05..0.1);
            times.map(|t| 2.0 * ((hz * t).fract() - 0.5).abs()).map(|x| 1.0 - x).collect()
        }
        Wave::Chirp => {
            let (from, to) = (0.04, random.random_range(0.6..1.1));
            times.map(|t| 0.5 - 0.5 * (TAU * (from * t + (to - from) * t * t / 100.0)).cos()).collect()
        }
        Wave::TwoTone => {
            let (a, b) = (random.random_range(0.1..0.2), random.random_range(0.25..0.45));
            times.map(|t| 0.5 - 0.3 * (TAU * a * t).cos() - 0.18 * (TAU * b * t).sin()).collect()
        }
        Wave::Steps => held_levels(count, random),
        Wave::Wander => wander(count, random),
    }
}

/// Levels held for six seconds with smooth ramps of 1.5 s between them.
fn held_levels(count: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    let levels: Vec<f64> = (0..=count / 600 + 1).map(|_| random.random_range(0.05..0.97)).collect();
    let at = |k: usize| {
        let (index, since_s) = (k / 600, (k % 600) as f64 * SAMPLE_S);
        let way = (since_s / 1.5).min(1.0);
        levels[index] + (levels[index + 1] - levels[index]) * way * way * (3.0 - 2.0 * way)
    };
    (0..count).map(at).collect()
}

/// A sum of slow sines of random phase.
fn wander(count: usize, random: &mut ChaCha8Rng) -> Vec<f64> {
    let tones: Vec<(f64, f64)> = (1..=6)
        .map(|i| (0.035 * f64::from(i) + random.random_range(0.0..0.02), random.random_range(0.0..TAU)))
        .collect();
    let raw = |k: usize| tones.iter().map(|(hz, phase)| (TAU * hz * k as f64 * SAMPLE_S + phase).sin()).sum::<f64>();
    (0..count).map(|k| (0.5 + 0.13 * raw(k)).clamp(0.02, 0.98)).collect()
}
