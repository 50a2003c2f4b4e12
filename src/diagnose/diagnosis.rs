//! What a diagnosis answers: the keys of diagnosis.json.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use crate::effects::catalogue;

/// The whole answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    pub format: u32,
    pub scene: String,
    pub recordings: Vec<String>,
    pub verdict: Verdict,
    /// Of unknown physics: whether a law was found for it, which scene.toml then has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub modelled: Option<bool>,
    /// The verdict in two sentences.
    pub summary: String,
    pub detection: Detection,
    pub location: Location,
    pub effects: Vec<NamedEffect>,
    /// What explains the open runs and is not put into scene.toml: held-out runs are predicted worse with it than without, or the full
    /// scene diverges.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub withheld: Vec<NamedEffect>,
    /// Further effects in scene.toml that describe what the named ones leave; that they are there is not claimed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub discrepancy: Vec<DiscrepancyTerm>,
    /// Values of the calibrated parameters with the effects in place, SI.
    pub calibration: BTreeMap<String, Estimate>,
    /// Where runs of several specimens are diagnosed together: the calibrated parameters of each.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub specimens: BTreeMap<String, SpecimenNumber>,
    pub fit: Proof,
    pub next_experiment: NextExperiment,
    pub warnings: Vec<String>,
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    Adequate,
    MissingPhysics,
    Ambiguous,
    UnknownPhysics,
    UnusableData,
}

/// As diagnosis.json has it.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.serialize(f)
    }
}

/// Is there more than noise?
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Detection {
    /// Misfit of the refitted baseline, in units of the noise's variance.
    pub excess_chi2_per_sample: f64,
    /// The same with the effects found in place.
    pub excess_chi2_per_sample_corrected: f64,
    /// Probability that noise alone leaves so much in the baseline, or more, by the excess and its standard error.
    pub p_value: f64,
    pub noise_sd: BTreeMap<String, f64>,
    /// Ratio of slow noise to white noise of the same deviation.
    pub noise_inflation: BTreeMap<String, f64>,
    /// The smallest size of each effect that would have been named.
    pub smallest_detectable: BTreeMap<String, f64>,
}

/// Where.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Location {
    pub element: Option<String>,
    pub ranked: Vec<(String, f64)>,
    /// File, from, to.
    pub time_windows_s: Vec<(String, f64, f64)>,
    pub state_region: String,
    /// Elements that the recorded channels cannot tell apart here.
    pub indistinguishable: Vec<Vec<String>>,
    /// Places at which something unknown may act, the likeliest first, and whether all else closes then.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub balances: Vec<Balance>,
}

/// What something unknown at one port, whatever it does over time, would leave of the open runs: if that is no more than noise, the
/// balances of all other elements close.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    pub port: String,
    pub element: String,
    /// Twice the logarithm of how much less likely the recordings are than with something unknown at the likeliest port.
    pub behind: f64,
    /// What is left of each run, in standard errors of what noise leaves, by file.
    pub left_sigma: BTreeMap<String, f64>,
    pub closes: bool,
}

/// What.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NamedEffect {
    pub name: String,
    pub element: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    pub probability: f64,
    pub rivals: Vec<String>,
    pub parameters: BTreeMap<String, Estimate>,
    /// Its numbers differ from run to run: `parameters` are their means, with intervals that hold those of all runs.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub differs_by_run: bool,
    /// Its first number as each run by itself would have it; as each has it, if they differ.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub size_by_run: BTreeMap<String, Estimate>,
    /// Its expression; of a law outside the catalogue with its parameters, and behind semicolons what it remembers.
    pub law: String,
    /// What a law outside the catalogue is called where it has a name: breakaway friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub known_as: Option<String>,
    /// Where it acts, `muscle_1.friction`, and whether it adds to the port or scales it.
    #[serde(default)]
    pub port: String,
    #[serde(default)]
    pub acts: String,
    /// What it depends on, by the names that laws use.
    #[serde(default)]
    pub variables: Vec<String>,
    /// Other shapes, and other places, that explain the recordings as well.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forms: Vec<Form>,
    /// The law over its first variable, as far as that was visited.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<Curve>,
    pub hypothetical: bool,
}

/// An effect that describes what the named ones leave.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DiscrepancyTerm {
    pub name: String,
    pub element: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub channel: Option<String>,
    /// Fitted together with the named effects, as scene.toml has them.
    pub parameters: BTreeMap<String, Estimate>,
    pub law: String,
}

/// Another law that the recordings cannot tell from the one named.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Form {
    pub port: String,
    pub acts: String,
    pub law: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub known_as: Option<String>,
    /// By how much its chi² is higher, in units of what the best leaves.
    pub score_difference: f64,
}

/// A calibrated number as each specimen has it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SpecimenNumber {
    pub values: BTreeMap<String, Estimate>,
    /// Whether two of them are further apart than chance allows.
    pub differs: bool,
}

/// A law over one variable, SI, with the ends of its 95 % band.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    pub variable: String,
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub low: Vec<f64>,
    pub high: Vec<f64>,
    /// What the recordings say of it whatever its shape.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub freehand: Option<Freehand>,
}

/// A law at a few values of its variable as the recordings have it, whatever its shape, SI, with the ends of 95 % intervals.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Freehand {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub low: Vec<f64>,
    pub high: Vec<f64>,
}

impl NamedEffect {
    /// The law's expression, and behind it, from its semicolon on, how what it remembers goes; nothing where it remembers nothing.
    pub(crate) fn law_and_memory(&self) -> (&str, &str) {
        self.law.split_at(self.law.find(';').unwrap_or(self.law.len()))
    }

    /// The key of the number that is its size; two laws may share a name.
    pub(crate) fn size_key(&self) -> &'static str {
        size_keys(&self.name).find(|key| self.parameters.contains_key(*key)).unwrap_or_else(|| size_key(&self.name))
    }
}

/// The key of the number that is the size of an effect of the catalogue; empty for what is none.
pub fn size_key(name: &str) -> &'static str {
    size_keys(name).next().unwrap_or("")
}

fn size_keys(name: &str) -> impl Iterator<Item = &'static str> {
    catalogue().filter(move |entry| entry.name == name).map(|entry| entry.entry().parameters[0].key.as_str())
}

/// A number with its interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    pub value: f64,
    pub ci95: [f64; 2],
}

/// How much better on held-out runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Proof {
    pub holdout: Vec<String>,
    pub channels: BTreeMap<String, ChannelProof>,
    /// Share of the gap between baseline and noise that the effects close on held-out runs.
    pub gap_closed: f64,
    pub gain_ci95: [f64; 2],
    /// Gain of twice the log-likelihood per sample, the size of each channel's misfit unknown but not below its noise: below zero the
    /// answer predicts worse, though the gap may be smaller.
    #[serde(default)]
    pub score_gain: f64,
    #[serde(default)]
    pub score_gain_ci95: [f64; 2],
    /// What wrong effects gained through the same door.
    pub placebo_gap_closed: Vec<(String, f64)>,
    pub full_scene: FullScene,
}

/// How far the reduced-order model, which the diagnosis works on, is from the full scene with the parameters found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FullScene {
    /// If not, the figures of the held-out runs are those of the full scene.
    pub agrees: bool,
    /// By channel, the greatest over the runs, in units of the noise.
    pub rms_difference_over_noise: BTreeMap<String, f64>,
}

impl FullScene {
    /// Whether it was played, and came out otherwise than the reduced-order model.
    pub fn differs(&self) -> bool {
        !self.agrees && !self.rms_difference_over_noise.is_empty()
    }
}

/// One channel of the held-out runs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChannelProof {
    pub rmse_baseline: f64,
    pub rmse_corrected: f64,
    pub noise_sd: f64,
}

/// What to record next.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct NextExperiment {
    pub why: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Standard errors by which the programme alone sets apart what it is for.
    pub separation_sigma: f64,
    /// What the file holds, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub programme: Option<String>,
    /// The answer, and the rival that is nearest to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between: Option<[String; 2]>,
    /// An output that was not recorded and would help much, if one would.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sensor: Option<String>,
    /// Standard errors with that sensor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sensor_sigma: Option<f64>,
}

/// Separation from which an experiment settles a question, standard errors.
pub const SETTLES_SIGMA: f64 = 5.0;

impl NextExperiment {
    /// None, and why.
    #[doc(hidden)]
    pub fn none(why: &str) -> Self {
        Self { why: why.to_owned(), ..Self::default() }
    }

    /// Whether it takes the sensor, and not only the programme.
    pub fn needs_sensor(&self) -> bool {
        self.separation_sigma <= SETTLES_SIGMA && self.sensor_sigma.is_some_and(|s| s > SETTLES_SIGMA)
    }

    /// What the programme promises, in words; none where none is proposed.
    pub fn promise(&self) -> Option<String> {
        let (programme, sigma) = (self.programme.as_ref()?, self.separation_sigma);
        Some(match sigma > SETTLES_SIGMA {
            _ if self.needs_sensor() => "no programme within the recorded strokes is sure to do by itself".to_owned(),
            true => format!("{programme} would set them {sigma:.1} standard errors apart"),
            false => format!("even {programme} would set them only {sigma:.1} standard errors apart"),
        })
    }

    /// What the sensor promises, in words; none where none is asked for.
    pub(crate) fn sensor_promise(&self) -> Option<String> {
        let (column, sigma) = (self.sensor.as_ref()?, self.sensor_sigma?);
        let programme = self.programme.as_ref().filter(|_| self.needs_sensor());
        let would = match programme {
            Some(programme) => format!("{programme} would set them {sigma:.1} standard errors apart"),
            None => format!("{sigma:.1}"),
        };
        Some(format!("with {column} recorded as well, {would}"))
    }
}
