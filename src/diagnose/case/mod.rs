//! The recordings of one rig beside the reduced-order model of their scene, read, decimated, one run held out; and their noise.
//!
//! May import `error`.

mod ablation;
mod decimate;
mod effort;
mod held_out;
mod instants;
mod load;
#[cfg(test)]
pub(super) mod made;
pub(super) mod noise;
mod specimen;

use std::borrow::Cow;
use std::cmp::Ordering;
use std::sync::Arc;

use rayon::prelude::*;

use crate::effects::Effect;
use crate::scene::Scene;
use crate::system::{Rom, RomParameter, RomRun, RomSetting};

pub use ablation::Step;
pub use effort::Effort;
pub(in crate::diagnose) use effort::Optional;
pub use noise::Noise;

/// An output that was recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseChannel {
    pub column: String,
    /// Its place among the outputs of the reduced-order model.
    pub output: usize,
    /// Standard deviation of its noise as stated, in its unit.
    pub stated_sd: Option<f64>,
    /// The recording's zero is arbitrary: each run has an offset of its own.
    pub has_free_zero: bool,
}

/// One recorded run.
#[derive(Clone, Debug)]
pub struct CaseRun {
    pub file: String,
    /// The scene under this run's conditions, and its reduced-order model.
    pub scene: Arc<Scene>,
    pub rom: Arc<Rom>,
    pub drive: RomRun,
    /// Instants at the start of `drive` that were not recorded: the way from rest to where the recording begins.
    pub lead_in: usize,
    /// Of each channel, its values at the recorded times; missing ones are NaN.
    pub measured: Vec<Vec<f64>>,
    /// Of each channel, the samples and values that were left out because next to nothing held the joint that they show.
    pub slack: Vec<Vec<(usize, f64)>>,
    /// Which sample, or set-up, it was recorded on, if that is stated.
    pub specimen: Option<String>,
    pub is_held_out: bool,
    /// For the held-out end of a run: the open part, which decides free zeros.
    pub open_part: Option<Vec<Vec<f64>>>,
}

impl CaseRun {
    /// Recorded times, s.
    pub fn times_s(&self) -> &[f64] {
        &self.drive.times_s[self.lead_in..]
    }

    /// How the first input moves at a recorded sample.
    pub fn direction(&self, sample: usize) -> Direction {
        let Some(input) = self.drive.inputs.first() else { return Direction::Resting };
        let at = self.lead_in + sample;
        let before = input[at.saturating_sub(1)];
        let after = input[(at + 1).min(input.len() - 1)];
        match after.total_cmp(&before) {
            Ordering::Less => Direction::Falling,
            Ordering::Equal => Direction::Resting,
            Ordering::Greater => Direction::Rising,
        }
    }
}

/// How an input moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    Falling,
    Rising,
    Resting,
}

impl Direction {
    pub const ALL: [Self; 3] = [Self::Rising, Self::Falling, Self::Resting];

    /// As it is said in figures.
    pub fn words(self) -> &'static str {
        match self {
            Self::Falling => "input falling",
            Self::Rising => "input rising",
            Self::Resting => "input at rest",
        }
    }
}

/// A calibrated parameter with its range.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseParameter {
    pub key: String,
    pub parameter: RomParameter,
    /// Where several were recorded: the specimen whose number it is.
    pub specimen: Option<String>,
    pub min: f64,
    pub max: f64,
    pub start: f64,
}

/// Doubling the steps may change a channel by this share of the noise over one sampling interval.
const STEP_TOLERANCE: f64 = 1e-2;

/// All input of a diagnosis.
#[derive(Clone, Debug)]
pub struct Case {
    pub scene: Scene,
    /// Effects that the scene has already.
    pub known_effects: Vec<Effect<f64>>,
    /// As the recordings name it.
    pub scene_name: String,
    pub folders: Vec<String>,
    pub channels: Vec<CaseChannel>,
    pub parameters: Vec<CaseParameter>,
    pub runs: Vec<CaseRun>,
    pub notes: Vec<String>,
    /// Whether the times of all runs are times, and no count of rows.
    pub has_clock: bool,
    /// What has been simulated so far.
    pub effort: Effort,
    /// A step of the diagnosis that is left out.
    without: Option<Step>,
}

impl Case {
    /// Plans the reduced-order model's steps at a setting for each run, with errors far below the noise. `None` if the
    /// model diverges.
    pub(crate) fn plan_steps(&mut self, settings: &[RomSetting<f64>], noise: &[Noise]) -> Option<()> {
        let count = self.scene.file.output.len();
        let mut tolerance = vec![None; count];
        for (channel, noise) in self.channels.iter().zip(noise) {
            tolerance[channel.output] = Some(STEP_TOLERANCE * noise.sd);
        }
        let plan = |(run, setting): (&mut CaseRun, &RomSetting<f64>)| -> Option<()> {
            run.drive.plan = Some(run.rom.plan(&run.drive, setting, &tolerance)?);
            Some(())
        };
        self.runs.par_iter_mut().zip(settings).map(plan).collect()
    }

    /// Excludes samples of slack joints, at a setting for each run. `None` if the reduced-order model diverges.
    pub(crate) fn leave_out_slack(&mut self, settings: &[RomSetting<f64>]) -> Option<()> {
        let slack: Vec<_> = self
            .runs
            .par_iter()
            .zip(settings)
            .map(|(r, s)| r.rom.slack_joints(&r.drive, s))
            .collect::<Option<Vec<_>>>()?;
        for (run, slack) in self.runs.iter_mut().zip(&slack) {
            run.slack.resize(self.channels.len(), Vec::new());
            for (c, channel) in self.channels.iter().enumerate() {
                run.slack[c].extend(leave_out(&mut run.measured[c], &slack[channel.output][run.lead_in..]));
            }
        }
        Some(())
    }

    /// Whether joints were slack somewhere.
    pub(crate) fn goes_slack(&self) -> bool {
        self.runs.iter().any(|r| r.slack.iter().any(|samples| !samples.is_empty()))
    }

    /// Lets the search begin every step, whatever that costs. Otherwise those that it can do without do not begin any more once it has cost
    /// some two minutes, which the answer's warnings then say.
    pub fn search_thoroughly(&mut self) {
        self.effort.be_thorough();
    }

    /// How the recordings were treated, for the reader of the answer.
    #[doc(hidden)]
    pub fn notes(&self) -> Vec<String> {
        let counted = |r: &CaseRun| -> Vec<String> {
            let left_out = self.channels.iter().zip(&r.slack).filter(|(_, samples)| !samples.is_empty());
            left_out.map(|(c, samples)| slack_note(&r.file, &c.column, samples.len())).collect()
        };
        self.notes.iter().cloned().chain(self.runs.iter().flat_map(counted)).collect()
    }

    /// The open runs, the held-out runs, or all.
    pub(crate) fn subset(&self, runs: RunSet) -> Vec<Cow<'_, CaseRun>> {
        let wanted = |r: &&CaseRun| match runs {
            RunSet::Open => !r.is_held_out,
            RunSet::HeldOut => r.is_held_out,
            RunSet::All => true,
        };
        self.runs.iter().filter(wanted).map(Cow::Borrowed).collect()
    }
}

fn slack_note(file: &str, column: &str, count: usize) -> String {
    format!(
        "{file}: {count} samples of {column} are left out: the cables hardly hold the joint there, and the smallest force decides \
         where it lies"
    )
}

/// Which runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunSet {
    Open,
    HeldOut,
    All,
}

/// Neighbouring samples excluded with a slack one: cables go taut for moments while the joint swings.
const AROUND_SLACK: usize = 10;

/// Excludes slack samples and their neighbours; returns their values. Nothing if most samples would be excluded.
fn leave_out(measured: &mut [f64], slack: &[bool]) -> Vec<(usize, f64)> {
    let near = |i: usize| {
        let (from, to) = (i.saturating_sub(AROUND_SLACK), (i + AROUND_SLACK + 1).min(slack.len()));
        slack[from..to].contains(&true)
    };
    let blank: Vec<usize> = (0..measured.len()).filter(|&i| measured[i].is_finite() && near(i)).collect();
    let there = measured.iter().filter(|m| m.is_finite()).count();
    if 2 * blank.len() > there {
        return Vec::new();
    }
    blank.into_iter().map(|i| (i, std::mem::replace(&mut measured[i], f64::NAN))).collect()
}
