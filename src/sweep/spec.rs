//! A sweep as a file.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SweepError;
use crate::scene::OutputSpec;
use crate::system::Concern;

/// What SWEEP.toml holds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SweepFile {
    pub format: u32,
    pub name: String,
    #[serde(default)]
    pub title: String,
    /// Path or stock name of the scene.
    pub scene: String,
    /// Length of each run instead of the scene's, s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration_s: Option<f64>,
    #[serde(default)]
    pub sampling: SamplingSpec,
    pub vary: Vec<VarySpec>,
    pub measure: Vec<MeasureSpec>,
    /// What is to be greatest or least: the best points are those that no other one beats in all of them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub objective: Vec<ObjectiveSpec>,
    /// What a point must keep to be among the best.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub limit: Vec<LimitSpec>,
    /// Kinds of trouble that a point may be in and still be among the best.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub allow: Vec<Concern>,
    /// Outputs that the scene gets besides its own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub output: Vec<OutputSpec>,
    /// Keys set to one value in every run: `"muscles.damping_n_s_m=0.2"`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub set: Vec<String>,
}

/// Column of the time in a kind of trouble, s.
pub fn concern_column(concern: Concern) -> String {
    format!("warning_{}_s", concern.word())
}

/// How points are chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "snake_case", deny_unknown_fields)]
pub enum SamplingSpec {
    /// Every combination of the values; the last key changes fastest.
    #[default]
    Grid,
    /// One sample in each of `count` equal parts of every key's range.
    LatinHypercube { count: u64, seed: u32 },
    /// Sobol's sequence, Owen-scrambled by the seed.
    Sobol { count: u64, seed: u32 },
    /// Independent draws, each from its own stream of the seed.
    MonteCarlo { count: u64, seed: u32 },
    /// Samples for Sobol indices: `count` times two independent points of all keys and their mixtures, `count (keys + 2)`
    /// points.
    Saltelli { count: u64, seed: u32 },
    /// Morris' trajectories: one key changed at a time, `trajectories (keys + 1)` points.
    Morris {
        trajectories: u64,
        #[serde(default = "four")]
        levels: u64,
        seed: u32,
    },
    /// Optimisation by NSGA-II towards the `[[objective]]`s: `population generations` points, each generation chosen by
    /// what those before it have shown.
    Nsga2 { population: u64, generations: u64, seed: u32 },
}

fn four() -> u64 {
    4
}

/// A key with its range, values or distribution.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VarySpec {
    /// A scene key as `smam check SCENE --keys` lists it, or several joined by `+` that get the same value.
    pub key: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<f64>,
    /// Values of a grid between `from` and `to`, both included.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub count: Option<u64>,
    /// Equal ratios instead of equal steps.
    #[serde(default)]
    pub logarithmic: bool,
    /// Values of a grid, instead of a range.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<f64>,
    /// Values to be marked in pictures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mark: Vec<Mark>,
    /// Normal distribution, for samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sd: Option<f64>,
}

/// A value of a key that a picture marks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mark {
    pub at: f64,
    pub label: String,
}

/// A number taken from each run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasureSpec {
    /// Column of the table, with its unit: `angle_range_deg`.
    pub name: String,
    /// `max(angle_deg) - min(angle_deg)`.
    pub of: String,
}

/// A measure to be as great or as small as can be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ObjectiveSpec {
    pub measure: String,
    pub goal: Goal,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    Maximise,
    Minimise,
}

/// Bounds of a measure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitSpec {
    pub measure: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
    /// What it means to be beyond them, in pictures: `coil closes`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub label: String,
}

impl SweepFile {
    /// Reads a sweep; unknown keys are refused.
    ///
    /// # Errors
    /// A file that is none, or not a sweep.
    pub fn load(path: &Path) -> Result<Self, SweepError> {
        let syntax = |message: String| SweepError::Syntax { file: path.to_owned(), message };
        let text =
            crate::stock::read_text(path).map_err(|source| SweepError::Read { file: path.to_owned(), source })?;
        let mut file: Self = toml::from_str(&text).map_err(|e| match is_scene(&text) {
            true => SweepError::IsScene { file: path.to_owned() },
            false => syntax(e.to_string().trim_end().to_owned()),
        })?;
        if file.format != 1 {
            return Err(syntax(format!("format = {} is unknown: this program reads format = 1", file.format)));
        }
        // A scene's path is relative to the sweep; a stock name is no path.
        let beside = path.parent().unwrap_or(Path::new(".")).join(&file.scene);
        if beside.is_file() {
            file.scene = beside.display().to_string();
        }
        Ok(file)
    }
}

/// Whether a text is a scene's: every scene has these tables, no sweep does.
fn is_scene(text: &str) -> bool {
    text.parse::<toml::Table>().is_ok_and(|table| table.contains_key("simulation") && table.contains_key("input"))
}
