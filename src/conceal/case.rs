//! One concealed case: what is drawn, and how it becomes recordings.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::ConcealError;
use super::noise::ChannelNoise;
use super::plant::Plant;
use super::programme::{Drive, SAMPLE_S, Wave, programme};
use super::secrets::{KINDS, Kind, Part, Secret};
use super::size::Sizing;
use super::solve::solve;
use super::stock::{Calibration, Rig};
use crate::recording::{Channel, Recording};

/// What kind of thing a case hides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hiding {
    Nothing,
    One,
    Several,
    /// Not in the catalogue.
    Unlisted,
}

impl Hiding {
    /// Of ten, two hide nothing, two something unlisted, three one effect and three several.
    pub fn drawn(seed: u64) -> Self {
        match ChaCha8Rng::seed_from_u64(!seed).random_range(0..10) {
            0..2 => Self::Nothing,
            2..4 => Self::Unlisted,
            4..7 => Self::One,
            _ => Self::Several,
        }
    }
}

/// The answer to a case: everything that was drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Truth {
    pub format: u32,
    pub name: String,
    /// Random text: without it the seal could be opened by trying answers.
    pub salt: String,
    pub seed: u64,
    pub rig: Rig,
    pub hiding: Hiding,
    pub secrets: Vec<Secret>,
    pub calibration: Calibration,
    pub noise: Vec<ChannelNoise>,
    pub is_noise_coloured: bool,
    pub is_noise_stated: bool,
    pub decoys: Vec<Decoy>,
    pub waves: Vec<Wave>,
    /// Misfit per sample that the secrets leave after the plant's own linear refit, as drawn.
    pub wanted_excess: f64,
}

/// Troubles that are no missing physics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Decoy {
    /// The rig's own numbers lie at the ends of the ranges that the scene allows.
    WrongPriors,
    NoPressure,
    Gaps,
    UnevenSampling,
}

/// A drawn case with its recordings, before they are written.
pub struct Drawn {
    pub truth: Truth,
    /// File name and contents.
    pub runs: Vec<(String, Recording)>,
    pub holdout: Recording,
}

/// The waveform that no diagnosis sees.
const HOLDOUT: Wave = Wave::TwoTone;
/// Least and greatest misfit per sample that a secret is given, in units of the noise's variance.
const EXCESS: (f64, f64) = (0.03, 30.0);

/// Draws a case and makes its recordings.
///
/// # Errors
/// A plant that the solver cannot follow.
pub fn draw(name: &str, rig: Rig, hiding: Hiding, seed: u64) -> Result<Drawn, ConcealError> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let decoys = draw_decoys(rig, &mut random);
    let calibration = draw_calibration(decoys.contains(&Decoy::WrongPriors), &mut random);
    let is_noise_coloured = random.random_bool(0.4);
    let noise: Vec<ChannelNoise> =
        rig.outputs().iter().map(|o| ChannelNoise::draw(o.noise_sd, is_noise_coloured, &mut random)).collect();
    let is_noise_stated = random.random_bool(0.6);
    let waves = draw_waves(&mut random);
    let drives: Vec<Vec<Drive>> = waves.iter().map(|w| programme(rig, *w, w.duration_s(), &mut random)).collect();
    let unseen = programme(rig, HOLDOUT, HOLDOUT.duration_s(), &mut random);
    let wanted_excess = log_uniform(EXCESS.0, EXCESS.1, &mut random);
    let mut secrets = draw_secrets(rig, hiding, decoys.contains(&Decoy::NoPressure), &mut random);
    if !secrets.is_empty() {
        let shown: Vec<bool> = rig.outputs().iter().map(|o| is_shown(o.column, &decoys)).collect();
        let sizing = Sizing::new(rig, calibration, &drives, &noise, &shown)?;
        for secret in &mut secrets {
            sizing.scale(secret, wanted_excess)?;
        }
    }
    let salt = format!("{:032x}", random.random::<u128>());
    let truth = Truth {
        format: 1,
        name: name.to_owned(),
        salt,
        seed,
        rig,
        hiding,
        secrets,
        calibration,
        noise,
        is_noise_coloured,
        is_noise_stated,
        decoys,
        waves,
        wanted_excess,
    };
    let mut begun_s = 0.0;
    let mut runs = Vec::new();
    for (wave, drives) in truth.waves.iter().zip(&drives) {
        let recording = record(&truth, drives, begun_s, &mut random)?;
        runs.push((format!("{}.csv", wave.name()), recording));
        begun_s += drives[0].positions_m.len() as f64 * SAMPLE_S;
    }
    let holdout =
        record(&Truth { decoys: pressure_only(&truth.decoys), ..truth.clone() }, &unseen, begun_s, &mut random)?;
    Ok(Drawn { truth, runs, holdout })
}

/// The holdout is whole; what the rig does not record it does not record there either.
fn pressure_only(decoys: &[Decoy]) -> Vec<Decoy> {
    decoys.iter().copied().filter(|d| *d == Decoy::NoPressure).collect()
}

fn draw_decoys(rig: Rig, random: &mut ChaCha8Rng) -> Vec<Decoy> {
    let mut decoys = Vec::new();
    for (decoy, share) in
        [(Decoy::WrongPriors, 0.15), (Decoy::NoPressure, 0.12), (Decoy::Gaps, 0.15), (Decoy::UnevenSampling, 0.1)]
    {
        let possible = decoy != Decoy::NoPressure || rig == Rig::MuscleBench;
        if random.random_bool(share) && possible {
            decoys.push(decoy);
        }
    }
    decoys
}

fn draw_calibration(at_the_ends: bool, random: &mut ChaCha8Rng) -> Calibration {
    let mut factor = || {
        if at_the_ends {
            let far: f64 = random.random_range(0.3..0.38);
            1.0 + if random.random_bool(0.5) { far } else { -far }
        } else {
            random.random_range(0.8..1.2)
        }
    };
    Calibration::STOCK.scaled(std::array::from_fn(|_| factor()))
}

/// Held levels always, between two of the others.
fn draw_waves(random: &mut ChaCha8Rng) -> Vec<Wave> {
    let mut others = vec![Wave::Sine, Wave::Chirp, Wave::Triangle, Wave::Wander];
    let first = others.remove(random.random_range(0..others.len()));
    let second = others.remove(random.random_range(0..others.len()));
    vec![first, Wave::Steps, second]
}

fn draw_secrets(rig: Rig, hiding: Hiding, no_pressure: bool, random: &mut ChaCha8Rng) -> Vec<Secret> {
    let count = match hiding {
        Hiding::Nothing => 0,
        Hiding::One | Hiding::Unlisted => 1,
        Hiding::Several => {
            if random.random_bool(0.8) {
                2
            } else {
                3
            }
        }
    };
    let mut secrets: Vec<Secret> = Vec::new();
    while secrets.len() < count {
        let in_catalogue = hiding != Hiding::Unlisted;
        let possible: Vec<&Kind> = KINDS.iter().filter(|k| k.fits(rig) && k.in_catalogue == in_catalogue).collect();
        let kind = possible[random.random_range(0..possible.len())];
        let secret = place(kind, rig, no_pressure, random);
        if secrets.iter().all(|s| s.name != secret.name) {
            secrets.push(secret);
        }
    }
    secrets
}

fn place(kind: &Kind, rig: Rig, no_pressure: bool, random: &mut ChaCha8Rng) -> Secret {
    let muscle = random.random_range(0..rig.muscles());
    let channels = if no_pressure { 1 } else { rig.outputs().len() };
    let mut channel = random.random_range(0..channels);
    if kind.name == "jaw_play" {
        channel = 1;
    }
    let column = rig.outputs()[channel].column;
    let sign = if kind.is_signed && random.random_bool(0.5) { -1.0 } else { 1.0 };
    let (low, high) = kind.second;
    // A sensor's error is counted in its channel's unit.
    let unit = if kind.part == Part::Sensor && kind.key != "time_constant_s" && kind.key != "gain_error" {
        rig.outputs()[channel].noise_sd / 0.02
    } else {
        1.0
    };
    let part = if kind.name == "jaw_play" { Part::Mechanism } else { kind.part };
    Secret {
        name: kind.name.to_owned(),
        element: part.on(rig, muscle),
        channel: (kind.part == Part::Sensor).then(|| column.to_owned()),
        in_catalogue: kind.in_catalogue,
        is_altered: kind.in_catalogue && random.random_bool(0.4),
        key: kind.key.to_owned(),
        size: sign * kind.typical * unit,
        second: log_uniform(low, high * (1.0 + 1e-12), random),
        muscle,
    }
}

fn log_uniform(low: f64, high: f64, random: &mut ChaCha8Rng) -> f64 {
    low * (high / low).powf(random.random_range(0.0..1.0))
}

fn is_shown(column: &str, decoys: &[Decoy]) -> bool {
    !(decoys.contains(&Decoy::NoPressure) && column.starts_with("pressure"))
}

/// The plant with what a case hides.
pub fn plant_of(truth: &Truth, begun_s: f64) -> Plant {
    let mut plant = Plant::new(truth.rig, truth.calibration);
    plant.begun_s = begun_s;
    truth.secrets.iter().for_each(|s| s.install(&mut plant));
    plant
}

/// Plays a programme on the hiding plant and records it with the rig's sensors.
///
/// # Errors
/// A plant that the solver cannot follow.
pub fn record(
    truth: &Truth,
    drives: &[Drive],
    begun_s: f64,
    random: &mut ChaCha8Rng,
) -> Result<Recording, ConcealError> {
    let plant = plant_of(truth, begun_s);
    let mut series = solve(&plant, drives)?;
    let count = drives[0].positions_m.len();
    for ((output, series), noise) in truth.rig.outputs().iter().zip(&mut series).zip(&truth.noise) {
        for secret in truth.secrets.iter().filter(|s| s.channel.as_deref() == Some(output.column)) {
            secret.corrupt(series, SAMPLE_S, begun_s);
        }
        series.iter_mut().zip(noise.series(count, random)).for_each(|(x, n)| *x += n);
    }
    if truth.decoys.contains(&Decoy::Gaps) {
        open_gaps(&mut series, random);
    }
    let kept: Vec<usize> =
        (0..count).filter(|_| !truth.decoys.contains(&Decoy::UnevenSampling) || random.random_bool(0.85)).collect();
    let pick = |from: &dyn Fn(usize) -> f64| kept.iter().map(|&k| from(k)).collect::<Vec<f64>>();
    let mut channels: Vec<Channel> = Vec::new();
    for (column, drive) in truth.rig.inputs().iter().zip(drives) {
        channels.push(Channel::new(*column, pick(&|k| rounded(1e3 * drive.positions_m[k]))));
    }
    for (output, series) in truth.rig.outputs().iter().zip(&series).filter(|(o, _)| is_shown(o.column, &truth.decoys)) {
        channels.push(Channel::new(output.column, pick(&|k| rounded(series[k]))));
    }
    Ok(Recording::new(pick(&|k| k as f64 * SAMPLE_S), channels)?)
}

/// To five places, as files hold them.
fn rounded(x: f64) -> f64 {
    (x * 1e5).round() / 1e5
}

/// A sensor drops out now and then.
fn open_gaps(series: &mut [Vec<f64>], random: &mut ChaCha8Rng) {
    for channel in series {
        for _ in 0..random.random_range(1..4) {
            let from = random.random_range(0..channel.len());
            let to = (from + random.random_range(10..150)).min(channel.len());
            channel[from..to].fill(f64::NAN);
        }
    }
}
