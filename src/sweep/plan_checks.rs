//! Whether a sweep can be run, before anything is.

use std::path::PathBuf;

use super::SweepError;
use super::spec::{LimitSpec, SamplingSpec, SweepFile, VarySpec, concern_column};
use crate::nearest::did_you_mean;
use crate::scene::{Override, Scene, calibration_key};
use crate::system::Concern;

/// The scene's own check of its duration, on that of the sweep.
pub(super) fn check_duration(file: &SweepFile, set: &[Override]) -> Result<(), SweepError> {
    let Some(duration_s) = file.duration_s else { return Ok(()) };
    let longer = Override::number("simulation.duration_s", duration_s);
    Scene::load(&file.scene, &[set, &[longer]].concat())?;
    Ok(())
}

/// The sweep's name becomes a folder's; keys and measures become columns, each of its own.
pub(super) fn check_names(file: &SweepFile) -> Result<(), SweepError> {
    let is_plain = |c: char| c.is_alphanumeric() || ['-', '_', '.'].contains(&c);
    if file.name.is_empty() || file.name.starts_with('.') || !file.name.chars().all(is_plain) {
        return Err(SweepError::Table {
            file: PathBuf::from(format!("name = \"{}\"", file.name)),
            message: "the name of a sweep becomes that of a folder".to_owned(),
            remedy: "give letters, digits, - _ . and no dot at the beginning".to_owned(),
        });
    }
    for (i, vary) in file.vary.iter().enumerate() {
        if file.vary[..i].iter().any(|v| v.key == vary.key) {
            let remedy = "vary each key once".to_owned();
            return Err(SweepError::Vary { key: vary.key.clone(), message: "it stands twice".to_owned(), remedy });
        }
    }
    for (i, measure) in file.measure.iter().enumerate() {
        let is_taken = ["index", "error"].contains(&measure.name.as_str())
            || Concern::ALL.into_iter().any(|concern| concern_column(concern) == measure.name)
            || file.measure[..i].iter().any(|m| m.name == measure.name)
            || file.vary.iter().any(|v| v.key == measure.name);
        if is_taken {
            return Err(SweepError::Measure {
                measure: measure.name.clone(),
                message: "another column has this name".to_owned(),
                remedy: "give it a name of its own".to_owned(),
            });
        }
    }
    Ok(())
}

/// Whether objectives and limits name measures, and an optimisation has somewhere to go.
pub(super) fn check_goals(file: &SweepFile) -> Result<(), SweepError> {
    let names: Vec<&str> = file.measure.iter().map(|m| m.name.as_str()).collect();
    let refuse = |table: &str, measure: &str, message: String, remedy: String| {
        Err(SweepError::Goal { table: table.to_owned(), measure: measure.to_owned(), message, remedy })
    };
    let objectives = file.objective.iter().map(|o| ("objective", &o.measure));
    for (table, measure) in objectives.chain(file.limit.iter().map(|l| ("limit", &l.measure))) {
        if !names.contains(&measure.as_str()) {
            let message = format!("the sweep has no such measure{}", did_you_mean(measure, &names));
            return refuse(table, measure, message, format!("its measures are {}", names.join(", ")));
        }
    }
    if let Some(limit) = file.limit.iter().find(|l| l.min.is_none() && l.max.is_none()) {
        return refuse("limit", &limit.measure, "it has no bound".to_owned(), "give min, max or both".to_owned());
    }
    let is_empty = |l: &&LimitSpec| {
        let (min, max) = (l.min.unwrap_or(f64::NEG_INFINITY), l.max.unwrap_or(f64::INFINITY));
        min.is_nan() || max.is_nan() || min > max
    };
    if let Some(limit) = file.limit.iter().find(is_empty) {
        let message = "no value lies between its bounds".to_owned();
        return refuse("limit", &limit.measure, message, "give min below max".to_owned());
    }
    if matches!(file.sampling, SamplingSpec::Nsga2 { .. }) && file.objective.is_empty() {
        let remedy = "add [[objective]] with measure and goal = \"maximise\" or \"minimise\"".to_owned();
        return Err(SweepError::Sampling { message: "nsga2 has nothing to optimise".to_owned(), remedy });
    }
    Ok(())
}

/// Whether the scene has every key that is varied, and it is a number.
pub(super) fn check_keys(file: &SweepFile, base: &Scene) -> Result<(), SweepError> {
    let known = base.keys();
    let names: Vec<&str> = known.iter().map(|(key, _)| key.as_str()).collect();
    for key in file.vary.iter().flat_map(VarySpec::keys) {
        let refuse = |message: String, remedy: &str| {
            Err(SweepError::Vary { key: key.to_owned(), message, remedy: remedy.to_owned() })
        };
        // What differs for one muscle need not stand there: it is what all have.
        let common = || base.number(key).map(|number| number.to_string());
        let Some(value) = base.value(&calibration_key(key)).or_else(common) else {
            let message = format!("the scene has no such key{}", did_you_mean(key, &names));
            return refuse(message, "`smam check SCENE --keys` lists them");
        };
        if value.parse::<f64>().is_err() {
            return refuse(format!("it is no number but {value}"), "vary a number; set words in `set`");
        }
    }
    Ok(())
}
