//! What is drawn of a case before anything is hidden: the rig's own numbers, noise, decoys, programmes.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::ConcealError;
use super::case::Decoy;
use super::noise::ChannelNoise;
use super::programme::{Drive, Wave, programme};
use super::size::{Sizing, Weighed, WeighedRun};
use super::stock::{Calibration, Rig};

/// The waveform that no diagnosis sees.
const HOLDOUT: Wave = Wave::TwoTone;
/// Least and greatest misfit per sample that a secret is given, in units of the noise's variance.
const EXCESS: (f64, f64) = (0.03, 30.0);

/// A case of which all but the secrets is drawn.
pub struct Begun {
    pub rig: Rig,
    pub decoys: Vec<Decoy>,
    pub calibration: Calibration,
    pub is_noise_coloured: bool,
    pub noise: Vec<ChannelNoise>,
    pub is_noise_stated: bool,
    pub waves: Vec<Wave>,
    /// What the plungers do, run by run.
    pub drives: Vec<Vec<Drive>>,
    pub unseen: Vec<Drive>,
    /// Misfit per sample that each secret is to leave.
    pub wanted_excess: f64,
}

impl Begun {
    /// Draws it from a seed; the generator goes on from there.
    pub fn draw(rig: Rig, seed: u64) -> (Self, ChaCha8Rng) {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let decoys = draw_decoys(rig, &mut random);
        let calibration = draw_calibration(decoys.contains(&Decoy::WrongPriors), &mut random);
        let is_noise_coloured = random.random_bool(0.4);
        let noise =
            rig.outputs().iter().map(|o| ChannelNoise::draw(o.noise_sd, is_noise_coloured, &mut random)).collect();
        let is_noise_stated = random.random_bool(0.6);
        let waves = draw_waves(&mut random);
        let drives = waves.iter().map(|w| programme(rig, *w, w.duration_s(), &mut random)).collect();
        let unseen = programme(rig, HOLDOUT, HOLDOUT.duration_s(), &mut random);
        let wanted_excess = log_uniform(EXCESS.0, EXCESS.1, &mut random);
        let begun = Self {
            rig,
            decoys,
            calibration,
            is_noise_coloured,
            noise,
            is_noise_stated,
            waves,
            drives,
            unseen,
            wanted_excess,
        };
        (begun, random)
    }

    /// What secrets do to the outputs that are recorded.
    ///
    /// # Errors
    /// A plant that the solver cannot follow.
    pub fn sizing(&self) -> Result<Sizing, ConcealError> {
        Sizing::new(self.weighed(self.noise.iter().map(|n| n.sd).collect()))
    }

    /// The same in units of what the noise amounts to against a slow signal.
    ///
    /// # Errors
    /// A plant that the solver cannot follow.
    pub fn sizing_for_slow_signals(&self) -> Result<Sizing, ConcealError> {
        Sizing::new(self.weighed_for_slow_signals())
    }

    /// The beginnings of its runs, nothing hidden yet, in units of what the noise amounts to against a slow signal.
    pub fn weighed_for_slow_signals(&self) -> Weighed {
        self.weighed(self.noise.iter().map(ChannelNoise::against_slow_signals).collect())
    }

    fn weighed(&self, unit: Vec<f64>) -> Weighed {
        let shown = self.rig.outputs().iter().map(|o| is_shown(o.column, &self.decoys)).collect();
        let runs = WeighedRun::beginnings(&self.drives);
        Weighed { rig: self.rig, calibration: self.calibration, runs, unit, shown, present: Vec::new() }
    }
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

pub(super) fn log_uniform(low: f64, high: f64, random: &mut ChaCha8Rng) -> f64 {
    low * (high / low).powf(random.random_range(0.0..1.0))
}

pub(super) fn is_shown(column: &str, decoys: &[Decoy]) -> bool {
    !(decoys.contains(&Decoy::NoPressure) && column.starts_with("pressure"))
}
