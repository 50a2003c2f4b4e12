//! Recordings made on the stock rig, and models identified from them.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::identify::loops::{Form, Identification, LoopRun, SearchOptions, identify};
use crate::recording::figures;

use super::ReproduceError;
use super::error::lacking;

/// Noise of a recording over its range.
pub const NOISE_SHARE: f64 = 1e-3;

/// A run as it would be recorded: the output with white noise, seeded.
pub fn recorded(name: &str, time_s: &[f64], input_mm: &[f64], output_mm: &[f64], seed: u64) -> LoopRun {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let sd = NOISE_SHARE * figures::range(output_mm);
    let mut noise = || -> f64 { StandardNormal.sample(&mut rng) };
    LoopRun {
        name: name.to_owned(),
        time_s: time_s.to_vec(),
        input_mm: input_mm.to_vec(),
        output_mm: output_mm.iter().map(|y| y + sd * noise()).collect(),
    }
}

/// A form identified by the hybrid search.
pub fn fitted(figure: &'static str, runs: &[LoopRun], form: Form) -> Result<Identification, ReproduceError> {
    identify(runs, form, &SearchOptions::default()).map_err(|e| lacking(figure, e.to_string()))
}
