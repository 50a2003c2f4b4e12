//! Gain of the effects on runs that took no part in finding and fitting them.

use std::collections::BTreeMap;

use crate::diagnose::case::{Case, Noise};
use crate::diagnose::diagnosis::{ChannelProof, FullScene, Proof};
use crate::diagnose::fit::{Fit, Problem};

/// Length of bootstrap blocks, s: longer than the residual's correlation time.
const BLOCK_S: f64 = 2.0;
const DRAWS: usize = 2000;

/// Squared residuals, baseline and corrected, in units of the noise, and their number.
#[derive(Clone, Copy, Debug, Default)]
struct Squares {
    baseline: f64,
    corrected: f64,
    samples: f64,
}

/// Those of one block: of all channels, and of each.
#[derive(Clone, Debug, Default)]
struct Block {
    all: Squares,
    channels: Vec<Squares>,
}

impl Squares {
    fn add(&mut self, other: &Self) {
        self.baseline += other.baseline;
        self.corrected += other.corrected;
        self.samples += other.samples;
    }

    /// Share of the gap between baseline and noise that is closed.
    fn gap_closed(&self) -> f64 {
        let (b, c, n) = (self.baseline, self.corrected, self.samples);
        if b > n { (b - c) / (b - n) } else { 0.0 }
    }

    /// Gain of twice the log-likelihood, the variance of each model's misfit unknown, but not below the noise's. Where both
    /// models are off by many noises, a channel that is predicted twice as well counts as much whatever its noise.
    fn score_gain(&self) -> f64 {
        let cost = |squares: f64| {
            let mean = squares / self.samples;
            if mean > 1.0 { 1.0 + mean.ln() } else { mean }
        };
        if self.samples > 0.0 { self.samples * (cost(self.baseline) - cost(self.corrected)) } else { 0.0 }
    }
}

impl Block {
    fn of(channels: usize) -> Self {
        Self { all: Squares::default(), channels: vec![Squares::default(); channels] }
    }

    fn sum<'a>(blocks: impl Iterator<Item = &'a Self>) -> Self {
        let mut sum = Self::default();
        for block in blocks {
            sum.all.add(&block.all);
            sum.channels.resize(block.channels.len(), Squares::default());
            sum.channels.iter_mut().zip(&block.channels).for_each(|(sum, own)| sum.add(own));
        }
        sum
    }

    /// Gain of the score per sample.
    fn score_gain(&self) -> f64 {
        self.channels.iter().map(Squares::score_gain).sum::<f64>() / self.all.samples.max(1.0)
    }
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
    let whole = Block::sum(blocks.iter());
    let mut random = Random(seed ^ 0x9e37_79b9_7f4a_7c15);
    let mut draw = || Block::sum((0..blocks.len()).map(|_| &blocks[random.below(blocks.len())]));
    let (gaps, scores) = (0..DRAWS).map(|_| draw()).map(|drawn| (drawn.all.gap_closed(), drawn.score_gain())).unzip();
    Proof {
        holdout: problem.runs.iter().map(|r| r.file.clone()).collect(),
        channels: channels(problem.case, before, after, problem.noise),
        gap_closed: whole.all.gap_closed(),
        gain_ci95: ci95(gaps),
        score_gain: whole.score_gain(),
        score_gain_ci95: ci95(scores),
        placebo_gap_closed: Vec::new(),
        full_scene: FullScene::default(),
    }
}

fn ci95(mut drawn: Vec<f64>) -> [f64; 2] {
    drawn.sort_by(f64::total_cmp);
    [0.025, 0.975].map(|q| drawn.get(((drawn.len() - 1) as f64 * q) as usize).copied().unwrap_or(0.0))
}

fn blocks(problem: &Problem, before: &[Vec<Vec<f64>>], after: &[Vec<Vec<f64>>]) -> Vec<Block> {
    let mut blocks = Vec::new();
    for ((run, before), after) in problem.runs.iter().zip(before).zip(after) {
        let times = run.times_s();
        let count = times.last().map_or(0, |t| ((t - times[0]) / BLOCK_S) as usize + 1);
        let mut own = vec![Block::of(problem.noise.len()); count];
        for (channel, ((before, after), noise)) in before.iter().zip(after).zip(problem.noise).enumerate() {
            for (i, t) in times.iter().enumerate().filter(|(i, _)| before[*i].is_finite() && after[*i].is_finite()) {
                let block = &mut own[((t - times[0]) / BLOCK_S) as usize];
                let [baseline, corrected] = [before[i], after[i]].map(|residual| (residual / noise.sd).powi(2));
                let squares = Squares { baseline, corrected, samples: 1.0 };
                block.all.add(&squares);
                block.channels[channel].add(&squares);
            }
        }
        blocks.extend(own.into_iter().filter(|b| b.all.samples > 0.0));
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

#[cfg(test)]
mod tests {
    use super::*;

    fn squares(baseline: f64, corrected: f64) -> Squares {
        Squares { baseline: 100.0 * baseline, corrected: 100.0 * corrected, samples: 100.0 }
    }

    fn block(channels: &[Squares]) -> Block {
        let mut all = Squares::default();
        channels.iter().for_each(|own| all.add(own));
        Block { all, channels: channels.to_vec() }
    }

    /// A channel that is four times as far off as the noise afterwards is not made good by another that stays ten off.
    #[test]
    fn what_one_channel_gains_far_from_noise_does_not_make_good_what_another_loses_near_it() {
        let traded = block(&[squares(400.0, 200.0), squares(1.3, 5.2)]);
        assert!(traded.all.gap_closed() > 0.4 && traded.score_gain() < 0.0, "{}", traded.score_gain());
        let gained = block(&[squares(400.0, 200.0), squares(1.3, 1.3)]);
        assert!(gained.score_gain() > 0.3);
    }

    /// Within the noise it is the plain sum of squares; of one channel it has the sign of the gap.
    #[test]
    fn near_the_noise_and_of_one_channel_it_says_what_the_squares_say() {
        let near = block(&[squares(1.0, 0.9), squares(0.9, 1.0)]);
        assert!(near.score_gain().abs() < 1e-12);
        for (before, after) in [(3.0, 2.0), (2.0, 3.0), (500.0, 499.0)] {
            let one = block(&[squares(before, after)]);
            assert_eq!(one.score_gain() > 0.0, one.all.gap_closed() > 0.0);
        }
    }
}
