//! One concealed case: what is drawn, and how it becomes recordings.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::ConcealError;
use super::begin::{Begun, is_shown, log_uniform};
use super::drawn::DrawnLaw;
use super::noise::ChannelNoise;
use super::plant::Plant;
use super::programme::{Drive, SAMPLE_S, Wave};
use super::secrets::{KINDS, Kind, Secret};
use super::solve::solve;
use super::stock::{Calibration, Rig};
use crate::recording::{Channel, Recording};

/// What kind of thing a case hides.
///
/// ```
/// use smam::conceal::Hiding;
///
/// // What a seed hides does not change; of many seeds a fifth hide nothing.
/// assert_eq!(Hiding::drawn(7), Hiding::drawn(7));
/// let nothing = (0..2000).filter(|seed| Hiding::drawn(*seed) == Hiding::Nothing).count();
/// assert!((300..500).contains(&nothing));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Hiding {
    Nothing,
    One,
    Several,
    /// Not in the catalogue.
    Unlisted,
    /// One law that nobody chose.
    Law,
    /// Two of them, or one beside an effect of the catalogue.
    Laws,
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
    /// The same programme with more stroke, where a law is hidden and the rig can follow.
    pub larger: Option<Recording>,
}

/// Stroke of that programme over that of the others.
const LARGER: f64 = 1.5;
/// How many seeds are tried for a plant that can be followed, and how far apart they are: no stride of a campaign, whose next seed would
/// otherwise hold the same case again.
const MOST_SEEDS: u64 = 8;
const NEXT_SEED: u64 = 0x9e37_79b9_7f4a_7c15;

/// Draws a case and makes its recordings.
///
/// ```
/// use smam::conceal::{Hiding, Rig, draw, seal, write_case};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let drawn = draw("quiet", Rig::MuscleBench, Hiding::Nothing, 7)?;
/// assert!(drawn.truth.secrets.is_empty());
/// let published = write_case(&drawn, folder.path())?;
/// // What everyone may see, and beside it the answer that the published seal holds.
/// assert!(folder.path().join("quiet/recordings.toml").is_file());
/// let answer = std::fs::read_to_string(folder.path().join("sealed/quiet.json"))?;
/// assert_eq!(seal(&answer), published);
/// # Ok(())
/// # }
/// ```
///
/// A plant that the solver cannot follow (a law so steep that the rig flutters) is no rig that could have been recorded: the next seed's is
/// drawn in its place, and stands in the truth.
///
/// # Errors
/// A plant that the solver cannot follow, several seeds in a row.
pub fn draw(name: &str, rig: Rig, hiding: Hiding, seed: u64) -> Result<Drawn, ConcealError> {
    let mut drawn = draw_once(name, rig, hiding, seed);
    for further in 1..MOST_SEEDS {
        if !matches!(drawn, Err(ConcealError::Solver(_))) {
            break;
        }
        drawn = draw_once(name, rig, hiding, seed.wrapping_add(further.wrapping_mul(NEXT_SEED)));
    }
    drawn
}

fn draw_once(name: &str, rig: Rig, hiding: Hiding, seed: u64) -> Result<Drawn, ConcealError> {
    let (begun, mut random) = Begun::draw(rig, seed);
    let mut secrets = draw_secrets(rig, hiding, begun.decoys.contains(&Decoy::NoPressure), &mut random);
    if !secrets.is_empty() {
        let sizing = begun.sizing()?;
        for secret in &mut secrets {
            sizing.scale(secret, begun.wanted_excess)?;
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
        calibration: begun.calibration,
        noise: begun.noise,
        is_noise_coloured: begun.is_noise_coloured,
        is_noise_stated: begun.is_noise_stated,
        decoys: begun.decoys,
        waves: begun.waves,
        wanted_excess: begun.wanted_excess,
    };
    let mut begun_s = 0.0;
    let mut runs = Vec::new();
    for (wave, drives) in truth.waves.iter().zip(&begun.drives) {
        let recording = record(&truth, drives, begun_s, None, &mut random)?;
        runs.push((format!("{}.csv", wave.name()), recording));
        begun_s += drives[0].positions_m.len() as f64 * SAMPLE_S;
    }
    let whole = Truth { decoys: pressure_only(&truth.decoys), ..truth.clone() };
    let holdout = record(&whole, &begun.unseen, begun_s, None, &mut random)?;
    let is_law = matches!(hiding, Hiding::Law | Hiding::Laws);
    let longer: Vec<Drive> = begun.unseen.iter().map(|d| d.scaled(LARGER)).collect();
    let larger = is_law.then(|| record(&whole, &longer, begun_s, None, &mut random).ok()).flatten();
    Ok(Drawn { truth, runs, holdout, larger })
}

/// The holdout is whole; what the rig does not record it does not record there either.
fn pressure_only(decoys: &[Decoy]) -> Vec<Decoy> {
    decoys.iter().copied().filter(|d| *d == Decoy::NoPressure).collect()
}

fn draw_secrets(rig: Rig, hiding: Hiding, no_pressure: bool, random: &mut ChaCha8Rng) -> Vec<Secret> {
    let count = match hiding {
        Hiding::Law | Hiding::Laws => return draw_laws(rig, hiding == Hiding::Laws, no_pressure, random),
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

/// One law; or two at different places, or one beside an effect of the catalogue.
fn draw_laws(rig: Rig, is_several: bool, no_pressure: bool, random: &mut ChaCha8Rng) -> Vec<Secret> {
    let mut secrets = vec![DrawnLaw::draw(rig, random)];
    if !is_several {
        return secrets;
    }
    if random.random_bool(0.5) {
        secrets.extend(draw_secrets(rig, Hiding::One, no_pressure, random));
    }
    while secrets.len() < 2 {
        let second = DrawnLaw::draw(rig, random);
        secrets.extend((second.name != secrets[0].name).then_some(second));
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
    let mut secret = Secret::typical(kind, rig, muscle, channel);
    if kind.is_signed && random.random_bool(0.5) {
        secret.size = -secret.size;
    }
    secret.is_altered = kind.in_catalogue && random.random_bool(0.4);
    secret.second = log_uniform(kind.second.0, kind.second.1 * (1.0 + 1e-12), random);
    secret
}

/// The plant with what a case hides.
pub fn plant_of(truth: &Truth, begun_s: f64) -> Plant {
    let mut plant = Plant::new(truth.rig, truth.calibration);
    plant.begun_s = begun_s;
    truth.secrets.iter().for_each(|s| s.install(&mut plant));
    plant
}

/// Noise of a sensor that a rig has without showing it, or can be given; `None` of one that it cannot.
pub fn sensor_noise(truth: &Truth, column: &str) -> Option<ChannelNoise> {
    let own = truth.rig.outputs().iter().zip(&truth.noise).find(|(o, _)| o.column == column);
    let more = truth.rig.more_sensors().iter().find(|o| o.column == column);
    own.map(|(_, noise)| *noise).or(more.map(|o| ChannelNoise::white(o.noise_sd)))
}

/// Plays a programme on the hiding plant and records it with the rig's sensors, and with one more if one is asked for.
///
/// # Errors
/// A plant that the solver cannot follow.
pub fn record(
    truth: &Truth,
    drives: &[Drive],
    begun_s: f64,
    sensor: Option<&str>,
    random: &mut ChaCha8Rng,
) -> Result<Recording, ConcealError> {
    let plant = plant_of(truth, begun_s);
    let mut series = solve(&plant, drives)?;
    let mut more = series.split_off(truth.rig.outputs().len());
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
    // Drawn last: what else a seed makes of a case is the same with and without that sensor.
    for (output, series) in truth.rig.more_sensors().iter().zip(&mut more).filter(|(o, _)| sensor == Some(o.column)) {
        let noise = ChannelNoise::white(output.noise_sd).series(count, random);
        series.iter_mut().zip(noise).for_each(|(x, n)| *x += n);
    }
    let is_shown = |column: &str| is_shown(column, &truth.decoys) || sensor == Some(column);
    let own = truth.rig.outputs().iter().zip(&series).filter(|(o, _)| is_shown(o.column));
    let more = truth.rig.more_sensors().iter().zip(&more).filter(|(o, _)| sensor == Some(o.column));
    for (output, series) in own.chain(more) {
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
