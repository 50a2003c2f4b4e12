//! Whether a proposed experiment settles what was ambiguous: played on the concealing plant, diagnosed anew with it.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::ProofError;
use super::campaign::Folders;
use super::row::{Row, read, row_of_answer};
use crate::conceal::{ConcealError, Further, Hiding, Truth, record_asked, record_drawn, sensor_noise};
use crate::diagnose::{Case, Options, Verdict, diagnose, write_answer};
use crate::files::write_whole;
use crate::recording::{Recording, read_csv};

/// What one more run made of an ambiguous answer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settled {
    pub name: String,
    /// Standard errors by which the programme alone was said to set the rivals apart.
    pub promised_sigma: f64,
    pub proposed: After,
    /// With a waveform that was drawn, of the same length.
    pub random: After,
    /// With the sensor that the proposal asks for, if it asks for one that the rig can be given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub with_sensor: Option<WithSensor>,
}

/// The same runs with one more sensor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WithSensor {
    pub column: String,
    /// Standard errors that were promised with it.
    pub promised_sigma: f64,
    pub proposed: After,
    pub random: After,
}

impl Settled {
    /// What came of the experiment as it was proposed, sensor included.
    pub fn as_proposed(&self) -> &After {
        self.with_sensor.as_ref().map_or(&self.proposed, |s| &s.proposed)
    }

    /// And of a drawn one, with the same sensors.
    pub fn as_drawn(&self) -> &After {
        self.with_sensor.as_ref().map_or(&self.random, |s| &s.random)
    }
}

/// An answer with one run more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct After {
    pub verdict: Verdict,
    /// No longer ambiguous, and every effect named is one that was hidden; of what is not listed, that it is unknown.
    pub is_right: bool,
}

/// Adds the proposed run, and a drawn one, to a case that was answered ambiguously; none where nothing was proposed.
///
/// # Errors
/// Files that cannot be read or written, a plant that cannot be integrated.
pub fn settle(truth: &Truth, folders: &Folders, out: &Path) -> Result<Option<Settled>, ProofError> {
    let answer = folders.answers.join(&truth.name);
    let proposal = answer.join("next_experiment.csv");
    if !proposal.is_file() {
        return Ok(None);
    }
    let asked = read_csv(&proposal)?;
    let duration_s = asked.time_s().last().copied().unwrap_or(0.0);
    let diagnosis: crate::diagnose::Diagnosis = parse(&answer.join("diagnosis.json"))?;
    let both = |sensor: Option<&Sensor>, folder: &str| -> Result<[After; 2], ProofError> {
        let column = sensor.map(|s| s.column);
        let after = |which: &str, run: &dyn Fn() -> Result<Recording, ConcealError>| {
            let own = Folders::below(&out.join(format!("{which}{folder}")));
            answer_with(truth, [folders, &own], ("added.csv", sensor), run)?;
            let row = row_of_answer(truth, &own)?;
            Ok::<After, ProofError>(After { verdict: row.verdict, is_right: is_right(&row) })
        };
        let proposed = after("proposed", &|| record_asked(truth, &asked, column, Further::default()))?;
        Ok([proposed, after("random", &|| record_drawn(truth, duration_s, column, Further::default()))?])
    };
    let next = &diagnosis.next_experiment;
    let [proposed, random] = both(None, "")?;
    let with_sensor = match next.sensor.as_deref().and_then(|column| Sensor::of(truth, column)) {
        None => None,
        Some(sensor) => {
            let [proposed, random] = both(Some(&sensor), "_with_sensor")?;
            let promised_sigma = next.sensor_sigma.unwrap_or(next.separation_sigma);
            Some(WithSensor { column: sensor.column.to_owned(), promised_sigma, proposed, random })
        }
    };
    let promised_sigma = next.separation_sigma;
    Ok(Some(Settled { name: truth.name.clone(), promised_sigma, proposed, random, with_sensor }))
}

/// A sensor that added runs have and the others do not.
pub(super) struct Sensor<'a> {
    pub column: &'a str,
    /// Its noise, if the case states that of its sensors.
    stated_sd: Option<f64>,
}

impl<'a> Sensor<'a> {
    /// `None` where the rig cannot be given it.
    pub fn of(truth: &Truth, column: &'a str) -> Option<Self> {
        let noise = sensor_noise(truth, column)?;
        Some(Self { column, stated_sd: truth.is_noise_stated.then_some(noise.sd) })
    }
}

/// Diagnoses a case again with one run more, from one pair of folders into another; what is there already is kept. The run
/// has a sensor that the others lack, if one is given.
pub(super) fn answer_with(
    truth: &Truth,
    [from, to]: [&Folders; 2],
    (file, sensor): (&str, Option<&Sensor>),
    added: &dyn Fn() -> Result<Recording, ConcealError>,
) -> Result<(), ProofError> {
    let case = to.cases.join(&truth.name);
    let answer = to.answers.join(&truth.name);
    if answer.join("diagnosis.json").is_file() {
        return Ok(());
    }
    add_run(&from.cases.join(&truth.name), &case, (file, &added()?), sensor)?;
    let outcome = diagnose(Case::load(&[case.as_path()], None, &[])?, Options { seed: 1 }, &|_| {})?;
    Ok(write_answer(&outcome, &answer)?)
}

/// Copies the recordings of a case and puts one more run before the others: the last one stays the sealed one.
fn add_run(
    from: &Path,
    to: &Path,
    (file, added): (&str, &Recording),
    sensor: Option<&Sensor>,
) -> Result<(), ProofError> {
    let failed = |file: PathBuf| move |source| ProofError::Write { file, source };
    fs::create_dir_all(to).map_err(failed(to.to_path_buf()))?;
    let entries = fs::read_dir(from).map_err(|source| ProofError::Read { file: from.to_path_buf(), source })?;
    for entry in entries.flatten().filter(|e| e.path().extension().is_some_and(|x| x == "csv")) {
        fs::copy(entry.path(), to.join(entry.file_name())).map_err(failed(entry.path()))?;
    }
    added.write_csv(&to.join(file))?;
    let text = read(&from.join("recordings.toml"))?;
    let path = to.join("recordings.toml");
    write_whole(&path, &described(&text, file, sensor)).map_err(failed(path.clone()))
}

/// The description of a case with the added run before its own, which lack the sensor.
fn described(text: &str, file: &str, sensor: Option<&Sensor>) -> String {
    let (mut channel, mut runs) = (String::new(), text.to_owned());
    if let Some(Sensor { column, stated_sd }) = sensor {
        let noise = stated_sd.map_or(String::new(), |sd| format!("noise_sd = {sd:.4}\n"));
        channel = format!("[[channel]]\ncolumn = \"{column}\"\nrole = \"output\"\n{noise}\n");
        runs = text.replace("[[run]]\n", &format!("[[run]]\nnot_recorded = [\"{column}\"]\n"));
    }
    runs.replacen("[[run]]", &format!("{channel}[[run]]\nfile = \"{file}\"\n\n[[run]]"), 1)
}

fn is_right(row: &Row) -> bool {
    if row.hiding == Hiding::Unlisted {
        return row.verdict == Verdict::UnknownPhysics;
    }
    row.verdict == Verdict::MissingPhysics
        && row.effects.iter().filter(|e| e.probability > 0.5).all(|e| row.secrets.iter().any(|s| e.is(s)))
}

pub(super) fn parse<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, ProofError> {
    serde_json::from_str(&read(path)?)
        .map_err(|e| ProofError::Format { file: path.to_path_buf(), message: e.to_string() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::RecordingSet;

    #[test]
    fn the_added_run_alone_has_the_added_sensor() {
        let text = "format = 1\nscene = \"muscle_bench\"\n\n[[channel]]\ncolumn = \"plunger_mm\"\nrole = \"input\"\n\n\
                    [[channel]]\ncolumn = \"elongation_mm\"\nrole = \"output\"\n\n[[run]]\nfile = \"sine.csv\"\n\n\
                    [[run]]\nfile = \"steps.csv\"\n";
        let parsed = |text: &str| RecordingSet::parse(text, Path::new("recordings.toml")).expect("a description");
        let sensor = Sensor { column: "force_n", stated_sd: Some(0.02) };
        let with = parsed(&described(text, "added.csv", Some(&sensor)));
        let files: Vec<&str> = with.runs.iter().map(|r| r.file.as_str()).collect();
        assert_eq!(files, ["added.csv", "sine.csv", "steps.csv"]);
        assert_eq!(with.runs.iter().map(|r| r.not_recorded.len()).collect::<Vec<_>>(), [0, 1, 1]);
        assert_eq!(with.channels.last().map(|c| (c.column.as_str(), c.noise_sd)), Some(("force_n", Some(0.02))));
        assert_eq!(parsed(&described(text, "added.csv", None)).channels.len(), 2);
    }
}
