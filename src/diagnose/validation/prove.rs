//! Gain of the effects on runs that took no part in finding and fitting them.

use std::collections::BTreeMap;

use crate::diagnose::case::{Case, Noise};
use crate::diagnose::diagnosis::{ChannelProof, FullScene, Proof};
use crate::diagnose::fit::{Fit, Problem};

/// Length of bootstrap blocks, s: longer than the residual's correlation time.
const BLOCK_S: f64 = 2.0;
const DRAWS: usize = 2000;

/// Squared residuals of one block, baseline and corrected, in units of the noise, and its number of samples.
#[derive(Clone, Copy, Debug, Default)]
struct Block {
    baseline: f64,
    corrected: f64,
    samples: f64,
}

/// Compares two fits on the held-out runs.
pub(in crate::diagnose) fn prove(problem: &Problem, baseline: &Fit, corrected: &Fit, seed: u64) -> Option<Proof> {
    let before = problem.residuals(&baseline.model, &baseline.x)?;
    let after = problem.residuals(&corrected.model, &corrected.x)?;
    Some(compare(problem, &before, &after, seed))
}

/// Compares two sets of residuals of the held-out runs.
pub(super) fn compare(problem: &Problem, before: &[Vec<Vec<f64>>], after: &[Vec<Vec<f64>>], seed: u64) -> Proof {
    let blocks = blocks(problem, before, after);
    let gap = |blocks: &[Block]| {
        let sum = |f: fn(&Block) -> f64| blocks.iter().map(f).sum::<f64>();
        let (b, c, n) = (sum(|x| x.baseline), sum(|x| x.corrected), sum(|x| x.samples));
        if b > n { (b - c) / (b - n) } else { 0.0 }
    };
    let mut random = Random(seed ^ 0x9e37_79b9_7f4a_7c15);
    let mut drawn: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let sample: Vec<Block> = (0..blocks.len()).map(|_| blocks[random.below(blocks.len())]).collect();
            gap(&sample)
        })
        .collect();
    drawn.sort_by(f64::total_cmp);
    let quantile = |q: f64| drawn.get(((drawn.len() - 1) as f64 * q) as usize).copied().unwrap_or(0.0);
    Proof {
        holdout: problem.runs.iter().map(|r| r.file.clone()).collect(),
        channels: channels(problem.case, before, after, problem.noise),
        gap_closed: gap(&blocks),
        gain_ci95: [quantile(0.025), quantile(0.975)],
        placebo_gap_closed: Vec::new(),
        full_scene: FullScene::default(),
    }
}

fn blocks(problem: &Problem, before: &[Vec<Vec<f64>>], after: &[Vec<Vec<f64>>]) -> Vec<Block> {
    let mut blocks = Vec::new();
    for ((run, before), after) in problem.runs.iter().zip(before).zip(after) {
        let times = run.times_s();
        let count = times.last().map_or(0, |t| ((t - times[0]) / BLOCK_S) as usize + 1);
        let mut own = vec![Block::default(); count];
        for ((before, after), noise) in before.iter().zip(after).zip(problem.noise) {
            for (i, t) in times.iter().enumerate().filter(|(i, _)| before[*i].is_finite() && after[*i].is_finite()) {
                let block = &mut own[((t - times[0]) / BLOCK_S) as usize];
                block.baseline += (before[i] / noise.sd).powi(2);
                block.corrected += (after[i] / noise.sd).powi(2);
                block.samples += 1.0;
            }
        }
        blocks.extend(own.into_iter().filter(|b| b.samples > 0.0));
    }
    blocks
}

fn channels(
    case: &Case,
    before: &[Vec<Vec<f64>>],
    after: &[Vec<Vec<f64>>],
    noise: &[Noise],
) -> BTreeMap<String, ChannelProof> {
    let rmse = |residuals: &[Vec<Vec<f64>>], c: usize| {
        let finite: Vec<f64> = residuals.iter().flat_map(|r| r[c].iter().copied()).filter(|v| v.is_finite()).collect();
        (finite.iter().map(|r| r * r).sum::<f64>() / finite.len().max(1) as f64).sqrt()
    };
    let proof = |c: usize| ChannelProof {
        rmse_baseline: rmse(before, c),
        rmse_corrected: rmse(after, c),
        noise_sd: noise[c].sd,
    };
    // A sensor that was added for another run shows nothing here.
    let is_recorded = |c: usize| before.iter().any(|r| r[c].iter().any(|v| v.is_finite()));
    let recorded = case.channels.iter().enumerate().filter(|(c, _)| is_recorded(*c));
    recorded.map(|(c, channel)| (channel.column.clone(), proof(c))).collect()
}

/// Deterministic draws (SplitMix64).
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
}
