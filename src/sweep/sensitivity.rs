//! Sensitivities of a sweep as a table: one row for each measure and key.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

use serde::Serialize;

use super::SweepError;
use super::bootstrap::Estimate;
use super::morris::Trajectories;
use super::plan::Plan;
use super::sobol_indices::sobol_indices;
use super::spec::SamplingSpec;
use super::table::{Table, quoted};
use crate::files::write_whole;

/// What a key does to a measure.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    pub measure: String,
    pub key: String,
    /// Samples or trajectories that it rests on.
    pub samples: usize,
    /// In the order of [`Sensitivity::names`].
    pub numbers: Vec<Estimate>,
}

/// All influences of a sweep, by measure, then key.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// `first`, `total`, or `mu_star`, `sigma`, `mu`.
    pub names: Vec<&'static str>,
    pub influences: Vec<Influence>,
}

/// Sensitivities, if the sweep's points were chosen for them.
pub fn sensitivity(plan: &Plan, table: &Table) -> Option<Sensitivity> {
    let names = match plan.file.sampling {
        SamplingSpec::Saltelli { .. } => vec!["first", "total"],
        SamplingSpec::Morris { .. } => vec!["mu_star", "sigma", "mu"],
        _ => return None,
    };
    let mut influences = Vec::new();
    for measure in &plan.file.measure {
        let (samples, numbers) = of_values(plan, &table.by_index(&measure.name))?;
        for (at, key) in plan.file.vary.iter().enumerate() {
            influences.push(Influence {
                measure: measure.name.clone(),
                key: key.key.clone(),
                samples,
                numbers: numbers.iter().map(|n| n[at]).collect(),
            });
        }
    }
    Some(Sensitivity { names, influences })
}

/// Number of samples, and each number for all keys.
fn of_values(plan: &Plan, values: &[f64]) -> Option<(usize, Vec<Vec<Estimate>>)> {
    let keys = plan.design.keys();
    match plan.file.sampling {
        SamplingSpec::Saltelli { seed, .. } => {
            let found = sobol_indices(keys, values, seed);
            Some((found.samples, vec![found.first, found.total]))
        }
        SamplingSpec::Morris { levels, seed, .. } => {
            let found = Trajectories::new(keys, levels, seed).ok()?.effects(values);
            Some((found.trajectories, vec![found.mu_star, found.sigma, found.mu]))
        }
        _ => None,
    }
}

/// One influence as JSON; a number that is none is null.
#[derive(Serialize)]
struct JsonInfluence<'a> {
    measure: &'a str,
    key: &'a str,
    samples: usize,
    #[serde(flatten)]
    numbers: BTreeMap<&'a str, Estimate>,
}

impl Sensitivity {
    /// Writes `sensitivity.csv` and `sensitivity.json`.
    ///
    /// # Errors
    /// A folder that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), SweepError> {
        for (name, text) in [("sensitivity.csv", self.csv()), ("sensitivity.json", self.json())] {
            let file = folder.join(name);
            write_whole(&file, &text).map_err(|source| SweepError::Write { file, source })?;
        }
        Ok(())
    }

    fn csv(&self) -> String {
        let mut text = "measure,key,samples".to_owned();
        for name in &self.names {
            let _ = write!(text, ",{name},{name}_low,{name}_high");
        }
        for influence in &self.influences {
            let _ = write!(text, "\n{},{},{}", quoted(&influence.measure), quoted(&influence.key), influence.samples);
            for value in influence.numbers.iter().flat_map(|n| [n.value, n.low, n.high]) {
                let _ = if value.is_finite() { write!(text, ",{value}") } else { write!(text, ",") };
            }
        }
        text + "\n"
    }

    fn json(&self) -> String {
        let json = self.influences.iter().map(|i| JsonInfluence {
            measure: &i.measure,
            key: &i.key,
            samples: i.samples,
            numbers: self.names.iter().copied().zip(i.numbers.iter().copied()).collect(),
        });
        let all: Vec<JsonInfluence> = json.collect();
        // Text and numbers only: nothing in it that JSON could refuse.
        serde_json::to_string_pretty(&all).unwrap_or_default() + "\n"
    }
}
