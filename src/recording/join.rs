//! A run whose channels lie in several files, each with a clock of its own, as one recording.
//!
//! The run's own file says when the run begins and ends; the others are shifted into its time, cut to it, and brought to one clock
//! as the topics of a bag are.

use std::path::{Path, PathBuf};

use super::line_up::{LinedUp, Motion, line_up};
use super::one_clock::{Sampled, on_one_clock};
use super::table::{Seen, read_declared, seen};
use super::{
    Channel, ChannelSpec, FileFormat, FileOptions, LoadedRun, Recording, RecordingError, RecordingSet, Role, Run,
};

/// Where the time 0 of a further file lies in the time of its run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// `starts_s` says so, s.
    Stated(f64),
    /// Both files have stamps, s.
    Stamped(f64),
    /// Nothing says so; where its motion is most like that of the run's file.
    Likely(LinedUp),
    /// Nothing says so, and no place is better than another.
    Unknown,
}

impl Start {
    /// The time that is certain, s.
    fn certain_s(self) -> Option<f64> {
        match self {
            Self::Stated(s) | Self::Stamped(s) => Some(s),
            Self::Likely(_) | Self::Unknown => None,
        }
    }
}

/// One of the files.
struct Part {
    name: String,
    path: PathBuf,
    seen: Seen,
    /// The declared channels that it has.
    own: Vec<ChannelSpec>,
    run: LoadedRun,
}

impl RecordingSet {
    /// Where each further file of a run begins.
    ///
    /// # Errors
    /// As [`RecordingSet::load_run`], but for starts that are unknown.
    #[doc(hidden)]
    pub fn starts(&self, run: &Run) -> Result<Vec<Start>, RecordingError> {
        let parts = self.parts(run, &self.channels_of(run))?;
        Ok(starts(run, &parts))
    }

    /// The channels of all files of a run.
    pub(super) fn load_joined(&self, run: &Run, declared: &[ChannelSpec]) -> Result<LoadedRun, RecordingError> {
        let mut parts = self.parts(run, declared)?;
        let starts = starts(run, &parts);
        for (start, part) in starts.iter().zip(&parts[1..]) {
            if start.certain_s().is_none() {
                return Err(unknown_start(*start, part, &parts[0]));
            }
        }
        let notes = parts.iter_mut().flat_map(|part| std::mem::take(&mut part.run.notes)).collect();
        let shifts: Vec<f64> = std::iter::once(0.0).chain(starts.iter().filter_map(|s| s.certain_s())).collect();
        joined(&parts, &shifts, declared, notes)
    }

    /// Each file with the channels that it has; a channel is in one of them.
    fn parts(&self, run: &Run, declared: &[ChannelSpec]) -> Result<Vec<Part>, RecordingError> {
        let layouts = std::iter::once(&run.layout).chain(run.also.iter().map(|also| &also.layout));
        let looked: Vec<(String, PathBuf, Seen, &FileOptions)> = run
            .files()
            .zip(layouts)
            .map(|(name, layout)| {
                let path = self.dir.join(name);
                refuse_bag(&path)?;
                Ok((name.to_owned(), path.clone(), seen(&path, layout)?, layout))
            })
            .collect::<Result<_, RecordingError>>()?;
        for spec in declared {
            let holders: Vec<&str> = looked.iter().filter(|l| l.2.has(spec)).map(|l| l.0.as_str()).collect();
            match holders.as_slice() {
                [_] => {}
                [] => return Err(in_none(spec, &looked[0].1, looked.iter().flat_map(|l| l.2.names.iter()))),
                [first, second, ..] => return Err(in_two(spec, &looked[0].1, first, second)),
            }
        }
        looked.into_iter().map(|(name, path, seen, layout)| part(name, path, seen, layout, declared)).collect()
    }
}

fn part(
    name: String,
    path: PathBuf,
    seen: Seen,
    layout: &FileOptions,
    declared: &[ChannelSpec],
) -> Result<Part, RecordingError> {
    let own: Vec<ChannelSpec> = declared.iter().filter(|spec| seen.has(spec)).cloned().collect();
    if own.is_empty() {
        let problem = format!(
            "has none of the declared channels (found: {})\n  remedy: say name = \"...\" in the [[channel]] that it has, or take the file out",
            seen.names.join(", ")
        );
        return Err(RecordingError::Format { file: path, problem });
    }
    let run = read_declared(&path, &own, layout)?.into_iter().next();
    let run = run.ok_or_else(|| RecordingError::Format { file: path.clone(), problem: "holds no rows".to_owned() })?;
    Ok(Part { name, path, seen, own, run })
}

/// A bag keeps its topics' clocks apart itself.
fn refuse_bag(path: &Path) -> Result<(), RecordingError> {
    match FileFormat::of(path)? {
        FileFormat::Mcap => Err(RecordingError::Format {
            file: path.to_owned(),
            problem: "[[run.also]] joins tables, and this is a bag\n  remedy: record all topics into one bag, or save the topics as CSV"
                .to_owned(),
        }),
        _ => Ok(()),
    }
}

fn in_none<'a>(spec: &ChannelSpec, file: &Path, names: impl Iterator<Item = &'a String>) -> RecordingError {
    let found = names.map(String::as_str).collect::<Vec<_>>().join(", ");
    RecordingError::MissingInRun { file: file.to_owned(), column: spec.name_in_table().to_owned(), found }
}

fn in_two(spec: &ChannelSpec, file: &Path, first: &str, second: &str) -> RecordingError {
    let problem = format!(
        "its column \"{}\" is in {first} and in {second}\n  remedy: rename it in the file whose column is not meant",
        spec.name_in_table()
    );
    RecordingError::Format { file: file.to_owned(), problem }
}

/// Where each further file begins.
fn starts(run: &Run, parts: &[Part]) -> Vec<Start> {
    let Some((main, others)) = parts.split_first() else { return Vec::new() };
    let start = |(also, part): (&super::AlsoFile, &Part)| match (also.starts_s, part.seen.seconds_after(&main.seen)) {
        (Some(stated_s), _) => Start::Stated(stated_s),
        (None, Some(stamped_s)) => Start::Stamped(stamped_s),
        (None, None) => likely(main, part).map_or(Start::Unknown, Start::Likely),
    };
    run.also.iter().zip(others).map(start).collect()
}

/// Where the motion in a file is most like that in the run's own: of all pairs of channels the pair that is most alike.
fn likely(main: &Part, other: &Part) -> Option<LinedUp> {
    let pairs = main.own.iter().flat_map(|a| other.own.iter().map(move |b| (a, b)));
    let lined_up = pairs.filter_map(|(a, b)| line_up(motion(main, a)?, motion(other, b)?));
    lined_up.max_by(|a, b| a.likeness.total_cmp(&b.likeness))
}

fn motion<'a>(part: &'a Part, spec: &ChannelSpec) -> Option<Motion<'a>> {
    let recording = &part.run.recording;
    Some(Motion { time_s: recording.time_s(), values: &recording.find(&spec.column)?.values })
}

fn unknown_start(start: Start, part: &Part, main: &Part) -> RecordingError {
    let remedy = match start {
        Start::Likely(LinedUp { starts_s, likeness, or_s: None }) => format!(
            "add starts_s = {starts_s:.3} to its [[run.also]]: there it moves when {} does (likeness {likeness:.2} of 1; what truly lags is \
             taken for a late clock)",
            main.name
        ),
        Start::Likely(LinedUp { starts_s, or_s: Some(or_s), .. }) => format!(
            "add starts_s = {starts_s:.3} to its [[run.also]], or {or_s:.3}: the motion repeats itself, and both are as likely; a single tap \
             before it begins settles that"
        ),
        _ => format!(
            "add starts_s = 0.5 to its [[run.also]], or whatever it is: nothing in it moves as something in {} does",
            main.name
        ),
    };
    let problem = format!("where its time 0 lies in the time of {} is not known\n  remedy: {remedy}", main.name);
    RecordingError::Format { file: part.path.clone(), problem }
}

/// All channels on one clock, between the first and the last row of the run's own file.
fn joined(
    parts: &[Part],
    shifts: &[f64],
    declared: &[ChannelSpec],
    mut notes: Vec<String>,
) -> Result<LoadedRun, RecordingError> {
    let main = &parts[0];
    let span = main.run.recording.time_s();
    let (from_s, to_s) = (span[0], span[span.len() - 1]);
    let mut sampled = Vec::new();
    for spec in declared {
        let Some((part, shift_s)) = parts.iter().zip(shifts).find(|(part, _)| part.seen.has(spec)) else { continue };
        let recording = &part.run.recording;
        let Some(channel) = recording.find(&spec.column) else { continue };
        let rows = recording.time_s().iter().map(|t| t + shift_s).zip(channel.values.iter().copied());
        let (time_s, values): (Vec<f64>, Vec<f64>) = rows.filter(|(t, _)| (from_s..=to_s).contains(t)).unzip();
        if time_s.is_empty() {
            return Err(outside(part, *shift_s, main));
        }
        sampled.push(Sampled {
            column: spec.column.clone(),
            topic: part.name.clone(),
            is_output: spec.role == Role::Output,
            time_s,
            values,
        });
    }
    let (time_s, values, note) = on_one_clock(&sampled);
    notes.extend(note);
    let channels = sampled.into_iter().zip(values).map(|(s, values)| Channel::new(s.column, values)).collect();
    let recording = Recording::new(time_s, channels).map_err(|e| e.in_file(main.path.display().to_string()))?;
    Ok(LoadedRun { recording, notes })
}

fn outside(part: &Part, shift_s: f64, main: &Part) -> RecordingError {
    let span = |recording: &Recording, shift_s: f64| {
        let t = recording.time_s();
        format!("{:.3} to {:.3} s", t[0] + shift_s, t[t.len() - 1] + shift_s)
    };
    let remedy = match part.seen.seconds_after(&main.seen) {
        Some(stamped_s) if stamped_s == shift_s => {
            "these are not of one run, or the stamps are of clocks that differ: say what is right as starts_s"
                .to_owned()
        }
        Some(_) => format!("correct starts_s, now {shift_s:.3}; left out, the stamps decide"),
        None => format!("correct starts_s, now {shift_s:.3}; left out, it is looked for"),
    };
    let problem = format!(
        "its rows are of {} in the time of {}, which has {}: they have no moment in common\n  remedy: {remedy}",
        span(&part.run.recording, shift_s),
        main.name,
        span(&main.run.recording, 0.0)
    );
    RecordingError::Format { file: part.path.clone(), problem }
}
