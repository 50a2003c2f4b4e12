//! Turns recordings into a case: reads folders, decimates runs, holds one out.

use std::path::Path;
use std::sync::Arc;

use crate::effects::Effect;
use crate::identify::{LeadIn, RecordedRun, check_channels, condition_overrides, load_runs, own_settings};
use crate::recording::{Recording, RecordingSet, Role, RunUse, strays};
use crate::scene::{CalibrateSpec, Override, Scene};
use crate::system::{Rom, RomRun};

use super::decimate::thin;
use super::instants::{at_times, with_points_of};
use super::{Case, CaseChannel, CaseParameter, CaseRun, Effort};
use crate::diagnose::error::DiagnoseError;

/// Recordings are averaged down to this interval, s: what moves here is slower.
const LEAST_INTERVAL_S: f64 = 0.01;
/// Initial part of a recording that begins in motion, excluded, s: several times the settling of a slender rod or a
/// sensor lag.
const BEGINNING_S: f64 = 0.2;

impl Case {
    /// Reads the folders; all must be of one scene and have the same channels.
    ///
    /// # Errors
    /// Unreadable or contradictory recordings, a scene without reduced-order model.
    pub fn load(folders: &[&Path], scene: Option<&str>, overrides: &[Override]) -> Result<Self, DiagnoseError> {
        let sets = folders.iter().map(|f| RecordingSet::load(f)).collect::<Result<Vec<_>, _>>()?;
        Self::of_sets(&sets, folders, scene, overrides)
    }

    /// As [`Self::load`], of sets that are read already; `folders` is what they are called.
    ///
    /// # Errors
    /// As [`Self::load`].
    #[doc(hidden)]
    pub fn of_sets(
        sets: &[RecordingSet],
        folders: &[&Path],
        scene: Option<&str>,
        overrides: &[Override],
    ) -> Result<Self, DiagnoseError> {
        let Some(first) = sets.first() else { return Err(DiagnoseError::Nothing) };
        refuse_repeated(sets)?;
        refuse_mixed(sets)?;
        let scene_name = scene.map_or_else(|| first.scene_path(), str::to_owned);
        let base = Scene::load(&scene_name, overrides)?;
        check_channels(first, &base)?;
        let rom = Rom::new(&base)?;
        let mut case = Self {
            channels: channels(first, &base, &rom),
            parameters: parameters(&base, &rom)?,
            known_effects: known_effects(&base),
            scene: base,
            folders: folders.iter().map(|f| f.display().to_string()).collect(),
            runs: Vec::new(),
            notes: Vec::new(),
            has_clock: sets.iter().flat_map(|set| &set.runs).all(|run| !run.layout.counts_rows()),
            effort: Effort::default(),
            without: None,
            scene_name,
        };
        for set in sets {
            case.add_set(set, overrides)?;
        }
        if case.runs.is_empty() {
            return Err(DiagnoseError::Nothing);
        }
        case.leave_out_empty();
        case.leave_out_unrecorded();
        case.seal();
        case.untie();
        Ok(case)
    }

    fn add_set(&mut self, set: &RecordingSet, overrides: &[Override]) -> Result<(), DiagnoseError> {
        let mut notes = Vec::new();
        let runs = load_runs(set, &set.runs, &mut |n| notes.push(n))?;
        self.notes.extend(notes);
        for run in &runs {
            let mut conditions = condition_overrides(&self.scene, &run.run)?;
            conditions.extend(own_settings(&self.scene, &run.recording).map_err(|e| e.in_file(&run.run.file))?);
            conditions.extend(self.chamber_number());
            let scene = match conditions.is_empty() {
                true => self.scene.clone(),
                false => {
                    let all: Vec<Override> = overrides.iter().cloned().chain(conditions).collect();
                    Scene::load(&self.scene_name, &all)?
                }
            };
            self.add_run(run, scene)?;
        }
        Ok(())
    }

    /// Chambers are numbered by their runs.
    fn chamber_number(&self) -> Option<Override> {
        self.scene.file.chamber.as_ref()?;
        Override::parse(&format!("chamber.number={}", self.runs.len() + 1)).ok()
    }

    fn add_run(&mut self, run: &RecordedRun, scene: Scene) -> Result<(), DiagnoseError> {
        let run = &self.without_strays(run)?;
        let recording = &self.thinned(run)?;
        let mut lines = Vec::new();
        for input in &self.scene.file.input {
            lines.push(recording.piecewise_si(&input.channel).map_err(|e| e.in_file(&run.run.file))?);
        }
        let times_s = with_points_of(&lines, recording.time_s());
        let inputs = lines.iter().map(|line| times_s.iter().map(|&t| line.value(t)).collect()).collect();
        let measured = self.channels.iter().map(|c| match recording.find(&c.column) {
            Some(channel) => at_times(&times_s, recording.time_s(), &channel.values),
            None => vec![f64::NAN; times_s.len()],
        });
        let measured = self.without_beginning(measured.collect(), &times_s);
        let mut drive = RomRun { times_s, inputs, plan: None };
        let lead_in = self.lead_in(&mut drive);
        self.runs.push(CaseRun {
            file: run.run.file.clone(),
            measured,
            specimen: run.run.specimen.clone(),
            is_held_out: run.run.run_use == Some(RunUse::Holdout),
            slack: Vec::new(),
            open_part: None,
            rom: Arc::new(Rom::new(&scene)?),
            scene: Arc::new(scene),
            drive,
            lead_in,
        });
        Ok(())
    }

    /// Leaves out the first moments of a recording that begins in motion: they depend on what was before them.
    fn without_beginning(&self, mut measured: Vec<Vec<f64>>, times_s: &[f64]) -> Vec<Vec<f64>> {
        if self.scene.file.simulation.recorded_in_motion {
            let count = times_s.iter().take_while(|t| **t < times_s[0] + BEGINNING_S).count();
            measured.iter_mut().for_each(|m| m[..count].fill(f64::NAN));
        }
        measured
    }

    /// Lets a run that does not begin at rest come to where it begins. Returns how many instants.
    fn lead_in(&self, drive: &mut RomRun) -> usize {
        let first: Vec<f64> = drive.inputs.iter().filter_map(|x| x.first()).copied().collect();
        let Some(way) = LeadIn::before(&self.scene, drive.times_s[0], &first) else { return 0 };
        for input in &mut drive.inputs {
            let on_the_way: Vec<f64> = way.values(input[0]).collect();
            input.splice(0..0, on_the_way);
        }
        drive.times_s.splice(0..0, way.times_s().iter().copied());
        way.times_s().len()
    }

    /// Leaves out what an output shows far outside everything else: it would be taken for noise. An input is not changed.
    fn without_strays(&mut self, run: &RecordedRun) -> Result<RecordedRun, DiagnoseError> {
        let mut channels = run.recording.channels().to_vec();
        for channel in channels.iter_mut().filter(|c| self.channels.iter().any(|o| o.column == c.column)) {
            let found = strays(&channel.values);
            found.iter().for_each(|&i| channel.values[i] = f64::NAN);
            if !found.is_empty() {
                let (count, column, file) = (found.len(), &channel.column, &run.run.file);
                self.notes
                    .push(format!("{file}: {count} samples of {column} that lie far outside all others are left out"));
            }
        }
        Ok(RecordedRun { run: run.run.clone(), recording: Recording::new(run.recording.time_s().to_vec(), channels)? })
    }

    /// A recording faster than the muscles need is averaged down. What was stated is the noise of single samples: that of
    /// their means is then estimated.
    fn thinned(&mut self, run: &RecordedRun) -> Result<Recording, DiagnoseError> {
        let Some((thin, count)) = thin(&run.recording, LEAST_INTERVAL_S)? else { return Ok(run.recording.clone()) };
        self.channels.iter_mut().for_each(|c| c.stated_sd = None);
        self.notes.push(format!("{}: averaged over {count} samples each, to {LEAST_INTERVAL_S} s", run.run.file));
        Ok(thin)
    }

    /// Leaves out runs that show none of the outputs, unless none does.
    fn leave_out_empty(&mut self) {
        let shows = |r: &CaseRun| r.measured.iter().flatten().any(|v| v.is_finite());
        if !self.runs.iter().any(shows) {
            return;
        }
        let empty = self.runs.iter().filter(|r| !shows(r));
        self.notes.extend(empty.map(|r| format!("{}: no output was recorded; the run is left out", r.file)));
        self.runs.retain(shows);
    }

    /// Leaves out channels that are declared and that no run has, unless none is there: nothing that is to be played next would
    /// show them either, but as one more sensor.
    fn leave_out_unrecorded(&mut self) {
        let shows = |c: usize| self.runs.iter().any(|r| r.measured[c].iter().any(|v| v.is_finite()));
        let is_there: Vec<bool> = (0..self.channels.len()).map(shows).collect();
        if !is_there.contains(&true) {
            return;
        }
        let absent = self.channels.iter().zip(&is_there).filter(|(_, is_there)| !**is_there);
        self.notes.extend(absent.map(|(c, _)| format!("{}: no run recorded it; the channel is left out", c.column)));
        keep_those(&mut self.channels, &is_there);
        self.runs.iter_mut().for_each(|r| keep_those(&mut r.measured, &is_there));
    }
}

fn keep_those<T>(items: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    items.retain(|_| keep.next().is_some_and(|k| *k));
}

/// The same runs twice would be fitted and held back at once.
fn refuse_repeated(sets: &[RecordingSet]) -> Result<(), DiagnoseError> {
    let places: Vec<_> = sets.iter().map(|s| s.dir.canonicalize().unwrap_or_else(|_| s.dir.clone())).collect();
    match (1..places.len()).find(|&i| places[..i].contains(&places[i])) {
        Some(i) => Err(DiagnoseError::Repeated { folder: sets[i].dir.clone() }),
        None => Ok(()),
    }
}

/// Runs of one diagnosis are of one rig, with the same channels in whatever order.
fn refuse_mixed(sets: &[RecordingSet]) -> Result<(), DiagnoseError> {
    let [first, others @ ..] = sets else { return Ok(()) };
    for other in others {
        if other.scene != first.scene {
            let (of_first, of_other) = (first.scene.clone(), other.scene.clone());
            return Err(DiagnoseError::Scenes {
                first: first.dir.clone(),
                other: other.dir.clone(),
                of_first,
                of_other,
            });
        }
        let lacks = |a: &RecordingSet, b: &RecordingSet| {
            columns(a).into_iter().find(|c| !columns(b).contains(c)).map(|c| (c.to_owned(), b.dir.clone()))
        };
        if let Some((column, folder)) = lacks(first, other).or_else(|| lacks(other, first)) {
            return Err(DiagnoseError::Undeclared { column, folder });
        }
    }
    Ok(())
}

/// The scene has been checked: every table is an effect.
fn known_effects(scene: &Scene) -> Vec<Effect<f64>> {
    scene.file.effect.iter().filter_map(|t| t.effect().ok()).collect()
}

fn columns(set: &RecordingSet) -> Vec<&str> {
    set.channels.iter().map(|c| c.column.as_str()).collect()
}

fn channels(set: &RecordingSet, scene: &Scene, rom: &Rom) -> Vec<CaseChannel> {
    let outputs: Vec<&str> = rom.columns().collect();
    let found = set.of_role(Role::Output).filter_map(|c| {
        let output = outputs.iter().position(|o| *o == c.column)?;
        Some(CaseChannel {
            column: c.column.clone(),
            output,
            stated_sd: c.noise_sd,
            has_free_zero: scene.file.output[output].counts_from_start,
        })
    });
    found.collect()
}

fn parameters(scene: &Scene, rom: &Rom) -> Result<Vec<CaseParameter>, DiagnoseError> {
    let parameter = |spec: &CalibrateSpec| {
        let parameter = rom
            .parameter(&spec.key)
            .ok_or_else(|| DiagnoseError::Parameter { file: scene.path.clone(), key: spec.key.clone() })?;
        let start = scene.number(&spec.key).unwrap_or((spec.min + spec.max) / 2.0);
        Ok(CaseParameter {
            key: spec.key.clone(),
            parameter,
            specimen: None,
            min: spec.min,
            max: spec.max,
            start: start.clamp(spec.min, spec.max),
        })
    };
    scene.file.calibrate.iter().map(parameter).collect()
}
