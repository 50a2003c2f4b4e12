//! A sweep that was checked: what stands at each point, and which points a shard has.

use std::fmt::Write as _;
use std::path::PathBuf;

use sha2::{Digest, Sha256};

use super::SweepError;
use super::design::Design;
use super::expression::Measure;
use super::nsga2::Evolution;
use super::plan_checks::{check_duration, check_goals, check_keys, check_names};
use super::point::Row;
use super::sampling::Place;
use super::spec::{SamplingSpec, SweepFile, VarySpec, concern_column};
use super::vocabulary::Vocabulary;
use crate::scene::{OutputSpec, Override, Scene, SceneError, calibration_key};
use crate::stock;
use crate::system::{Concern, Schedule};

/// A sweep ready to run.
///
/// ```
/// use smam::sweep::{Plan, SweepFile};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let file = |key: &str| -> Result<SweepFile, toml::de::Error> {
///     toml::from_str(&format!(
///         "format = 1\nname = 'friction'\nscene = 'muscle_bench'\n\
///          vary = [{{ key = '{key}', from = 0.1, to = 0.2, count = 3 }}]\n\
///          measure = [{{ name = 'range_mm', of = 'range(elongation_mm)' }}]"
///     ))
/// };
/// let plan = Plan::new(file("muscles.friction.m0_n")?)?;
/// assert_eq!((plan.count(), plan.point(2)), (3, vec![0.2]));
/// assert_eq!(plan.columns()[..4], ["index", "muscles.friction.m0_n", "range_mm", "warning_slack_s"]);
/// // A wrong key is found before anything runs.
/// let message = Plan::new(file("muscles.friction.m0n")?).err().map_or_else(String::new, |e| e.to_string());
/// assert!(message.contains("did you mean \"muscles.friction.m0_n\"?"));
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Plan {
    pub file: SweepFile,
    pub measures: Vec<Measure>,
    pub schedule: Schedule,
    /// Values of the keys at every point.
    pub design: Design,
    set: Vec<Override>,
    /// Keys under which the scene has a whole number: they take no other.
    whole: Vec<String>,
    /// What the scene puts out besides its own: what the sweep's file names, and what its measures need.
    outputs: Vec<OutputSpec>,
    /// The scene's file as it was when the sweep began, and where it stands.
    text: String,
    path: PathBuf,
    /// SHA-256 of sweep and scene: two plans with the same one have the same points and rows.
    pub fingerprint: String,
}

impl Plan {
    /// Checks keys, ranges and measures against the scene; nothing is run.
    ///
    /// # Errors
    /// Whatever would fail at every point, with the key or measure and the nearest right name.
    pub fn new(file: SweepFile) -> Result<Self, SweepError> {
        let set: Vec<Override> = file.set.iter().map(|s| Override::parse(s)).collect::<Result<_, _>>()?;
        let base = with_outputs(Scene::load(&file.scene, &set)?, &file.output)?;
        check_duration(&file, &set)?;
        check_names(&file)?;
        check_keys(&file, &base)?;
        let known = Vocabulary::of(&base);
        if file.measure.is_empty() {
            return Err(SweepError::Measure {
                measure: file.name.clone(),
                message: "nothing is measured".to_owned(),
                remedy: format!(
                    "add [[measure]] with name and of, or --measure 'max(CHANNEL)'; the channels are {}",
                    known.channels()
                ),
            });
        }
        let measures: Vec<Measure> = file.measure.iter().map(|m| Measure::new(m, &known)).collect::<Result<_, _>>()?;
        let spec = base.file.simulation;
        let schedule = Schedule::even(file.duration_s.unwrap_or(spec.duration_s), spec.output_interval_s);
        let design = Design::new(file.sampling, &file.vary)?;
        check_goals(&file)?;
        let fingerprint = fingerprint(&file, &base)?;
        let outputs = outputs(&file, &measures);
        let is_whole = |key: &&str| base.value(&calibration_key(key)).is_some_and(|v| v.parse::<i64>().is_ok());
        let whole = file.vary.iter().flat_map(VarySpec::keys).filter(is_whole).map(str::to_owned).collect();
        let path = base.path;
        let text = stock::read_text(&path).map_err(|source| SceneError::Unreadable { file: path.clone(), source })?;
        let plan = Self { file, measures, schedule, design, set, whole, outputs, text, path, fingerprint };
        plan.evolution()?;
        plan.check_ends()?;
        Ok(plan)
    }

    /// Number of points.
    pub fn count(&self) -> u64 {
        self.design.count()
    }

    /// Values of the keys at a point, in the order of `[[vary]]`; of an optimisation those of its first generation.
    pub fn point(&self, index: u64) -> Vec<f64> {
        self.design.point(index)
    }

    /// The optimisation that the sweep is, if it is one.
    ///
    /// # Errors
    /// As [`Evolution::new`].
    #[doc(hidden)]
    pub fn evolution(&self) -> Result<Option<Evolution>, SweepError> {
        let is_one = matches!(self.file.sampling, SamplingSpec::Nsga2 { .. });
        if is_one { Evolution::new(self.file.sampling, &self.file.vary).map(Some) } else { Ok(None) }
    }

    /// A measure of a row by name; NaN where it failed.
    #[doc(hidden)]
    pub fn measured(&self, row: &Row, measure: &str) -> f64 {
        let at = self.measures.iter().position(|m| m.name == measure);
        let measures = row.outcome.as_deref().unwrap_or(&[]);
        at.and_then(|i| measures.get(i)).copied().unwrap_or(f64::NAN)
    }

    /// The scene at a point.
    ///
    /// # Errors
    /// Values that the scene refuses.
    pub fn scene(&self, values: &[f64]) -> Result<Scene, SweepError> {
        let keys = self.file.vary.iter().zip(values).flat_map(|(v, value)| v.keys().map(move |k| (k, *value)));
        let numbers = keys.map(|(key, value)| self.number(key, value));
        let all: Vec<Override> = self.set.iter().cloned().chain(numbers).collect();
        with_outputs(Scene::parse(&self.text, &self.path, &all)?, &self.outputs)
    }

    /// A value for a key; a fraction where the scene has a whole number is left to the scene to refuse.
    fn number(&self, key: &str, value: f64) -> Override {
        let is_whole = value.fract() == 0.0 && value.abs() < 2.0_f64.powi(53);
        match is_whole && self.whole.iter().any(|whole| whole == key) {
            true => Override::whole(key, value as i64),
            false => Override::number(key, value),
        }
    }

    /// Names of the columns: index, keys, measures, times in trouble.
    pub fn columns(&self) -> Vec<String> {
        let keys = self.file.vary.iter().map(|v| v.key.clone());
        let measures = self.measures.iter().map(|m| m.name.clone());
        let concerns = Concern::ALL.map(concern_column);
        std::iter::once("index".to_owned()).chain(keys).chain(measures).chain(concerns).collect()
    }

    /// Loads the scene with each key at either end of its range, the others at the first point: what the scene refuses
    /// there is refused before anything runs. Tails of a distribution may still fail at their points.
    fn check_ends(&self) -> Result<(), SweepError> {
        let first = self.point(0);
        for (i, vary) in self.file.vary.iter().enumerate() {
            for value in ends(vary, self.file.sampling) {
                let mut values = first.clone();
                values[i] = value;
                self.scene(&values)?;
            }
        }
        Ok(())
    }
}

fn ends(vary: &VarySpec, sampling: SamplingSpec) -> Vec<f64> {
    match (sampling, vary.values.is_empty(), vary.count) {
        (SamplingSpec::Grid, false, _) => vary.values.clone(),
        (SamplingSpec::Grid, true, Some(count)) => {
            vec![vary.value(Place::Nth(0)), vary.value(Place::Nth(count.saturating_sub(1)))]
        }
        _ if vary.sd.is_some() => vec![vary.value(Place::Share(0.5))],
        _ => vec![vary.value(Place::Share(0.0)), vary.value(Place::Share(1.0))],
    }
}

fn with_outputs(mut scene: Scene, outputs: &[OutputSpec]) -> Result<Scene, SweepError> {
    if outputs.is_empty() {
        return Ok(scene);
    }
    scene.file.output.extend(outputs.iter().cloned());
    Ok(Scene::from_file(scene.file, &scene.path)?)
}

/// Each once, though several measures need it.
fn outputs(file: &SweepFile, measures: &[Measure]) -> Vec<OutputSpec> {
    let mut all = file.output.clone();
    for output in measures.iter().flat_map(Measure::outputs) {
        if !all.contains(&output) {
            all.push(output);
        }
    }
    all
}

/// Of what sweep and scene hold; not of where they stand, so that shards may be begun from any folder, nor of what is wanted
/// of points that do not depend on it.
fn fingerprint(file: &SweepFile, base: &Scene) -> Result<String, SweepError> {
    let syntax = |e: toml::ser::Error| SweepError::Syntax { file: base.path.clone(), message: e.to_string() };
    let mut anywhere = SweepFile { scene: base.file.name.clone(), ..file.clone() };
    if !matches!(file.sampling, SamplingSpec::Nsga2 { .. }) {
        anywhere.objective.clear();
        anywhere.limit.clear();
    }
    let mut hasher = Sha256::new();
    hasher.update(toml::to_string(&anywhere).map_err(syntax)?);
    hasher.update(toml::to_string(&base.file).map_err(syntax)?);
    Ok(hasher.finalize().iter().fold(String::new(), |mut hex, byte| {
        let _ = write!(hex, "{byte:02x}");
        hex
    }))
}

/// One part of a sweep's points: every `of`-th, from `number` on (counted from 1).
///
/// ```
/// use smam::sweep::Shard;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// assert_eq!(Shard::parse("2/7")?.points(20).collect::<Vec<_>>(), [1, 8, 15]);
/// assert!(Shard::parse("8/7").is_err());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    pub number: u64,
    pub of: u64,
}

impl Shard {
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Reads `2/7`.
    ///
    /// # Errors
    /// Anything but two numbers with 1 <= first <= second.
    pub fn parse(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(a, b)| Some((a.trim().parse().ok()?, b.trim().parse().ok()?)));
        match numbers {
            Some((number, of)) if number >= 1 && number <= of => Ok(Self { number, of }),
            _ => Err(format!("\"{text}\" is no shard: write 2/7 for the second of seven")),
        }
    }

    /// Its points of a sweep of `count`.
    pub fn points(self, count: u64) -> impl Iterator<Item = u64> {
        (self.number - 1..count).step_by(usize::try_from(self.of).unwrap_or(usize::MAX))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::spec::LimitSpec;
    use std::collections::BTreeSet;

    #[test]
    fn shards_have_every_point_once() {
        let all: Vec<u64> = (1..=7).flat_map(|number| Shard { number, of: 7 }.points(40)).collect();
        assert_eq!(all.len(), 40);
        assert_eq!(all.into_iter().collect::<BTreeSet<_>>(), (0..40).collect());
        assert!(Shard::parse("0/3").is_err() && Shard::parse("4/3").is_err() && Shard::parse("a").is_err());
        assert_eq!(Shard::parse("2/3"), Ok(Shard { number: 2, of: 3 }));
    }

    fn file(key: &str, from: f64, to: f64, of: &str) -> SweepFile {
        toml::from_str(&format!(
            "format = 1\nname = \"t\"\nscene = \"muscle_bench\"\n[[vary]]\nkey = \"{key}\"\nfrom = {from:?}\nto = {to:?}\ncount = 3\n[[measure]]\nname = \"m\"\nof = \"{of}\"\n"
        ))
        .expect("a sweep")
    }

    #[test]
    fn names_durations_and_limits_that_cannot_be_are_refused() {
        let good = || file("muscles.friction.m0_n", 0.1, 0.2, "range(elongation_mm)");
        let refused = |change: &dyn Fn(&mut SweepFile)| {
            let mut file = good();
            change(&mut file);
            Plan::new(file).err().map_or_else(String::new, |e| e.to_string())
        };
        assert!(refused(&|f| f.name = "../evil".to_owned()).contains("../evil"));
        assert!(refused(&|f| f.vary.push(f.vary[0].clone())).contains("stands twice"));
        assert!(refused(&|f| f.measure.push(f.measure[0].clone())).contains("another column"));
        assert!(refused(&|f| f.duration_s = Some(f64::INFINITY)).contains("duration_s"));
        assert!(refused(&|f| f.duration_s = Some(1e12)).contains("samples"));
        let limit = |min, max| LimitSpec { measure: "m".to_owned(), min, max, label: String::new() };
        assert!(refused(&|f| f.limit.push(limit(Some(5.0), Some(1.0)))).contains("no value"));
        assert!(refused(&|f| f.limit.push(limit(Some(f64::NAN), None))).contains("no value"));
        assert_eq!(refused(&|f| f.limit.push(limit(Some(1.0), Some(5.0)))), "");
    }

    #[test]
    fn wrong_keys_ranges_and_measures_are_refused_before_anything_runs() {
        let good = Plan::new(file("muscles.friction.m0_n", 0.1, 0.2, "range(elongation_mm)")).expect("right");
        assert_eq!((good.count(), good.point(2)), (3, vec![0.2]));
        let warnings = [
            "warning_slack_s",
            "warning_cavitation_s",
            "warning_yield_s",
            "warning_penetration_s",
            "warning_joint_limit_s",
        ];
        assert_eq!(good.columns(), [&["index", "muscles.friction.m0_n", "m"][..], &warnings].concat());
        let wrong =
            |key: &str, from: f64, of: &str| Plan::new(file(key, from, 0.2, of)).expect_err("wrong").to_string();
        let message = wrong("muscles.friction.m0n", 0.1, "max(elongation_mm)");
        assert!(message.contains("did you mean \"muscles.friction.m0_n\"?"), "{message}");
        assert!(wrong("muscles.friction.m0_n", -0.1, "max(elongation_mm)").contains("m0_n"));
        assert!(wrong("muscles.tube.wall", 0.1, "max(elongation_mm)").contains("no number"));
        assert!(wrong("muscles.friction.m0_n", 0.1, "max(elongation_m)").contains("elongation_mm"));
    }
    #[test]
    fn whole_numbers_of_the_scene_are_varied_as_such() {
        let plan = Plan::new(file("simulation.substeps", 10.0, 20.0, "range(elongation_mm)")).expect("right");
        assert_eq!(plan.scene(&[15.0]).expect("whole").file.simulation.substeps, 15);
        assert!(plan.scene(&[15.5]).is_err());
    }
}
