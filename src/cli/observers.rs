//! Who watches a run: the file, the recorder for checks, the progress bar, the viewer.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use smam::recording::{Channel, Recording};
use smam::system::observe::{Frame, Observer, SceneGraph};

use super::CliError;
use super::angles::Angles;
use super::interrupt::interrupted;
use super::run_file::RunFile;

/// All observers of one run; those not asked for are absent.
#[derive(Default)]
pub struct Observers {
    pub file: Option<RunFile>,
    pub recorder: Option<Recorder>,
    pub angles: Option<Angles>,
    pub progress: Option<Progress>,
    pub clock: Option<Clock>,
    #[cfg(feature = "viz")]
    pub viewers: Vec<smam::view::Viewer>,
}

impl Observer for Observers {
    type Error = CliError;

    fn begin(&mut self, graph: &SceneGraph) -> Result<(), CliError> {
        if let Some(file) = &mut self.file {
            file.begin(graph)?;
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.begin(graph);
        }
        if let Some(angles) = &mut self.angles {
            angles.begin(graph);
        }
        #[cfg(feature = "viz")]
        for viewer in &mut self.viewers {
            viewer.begin(graph)?;
        }
        Ok(())
    }

    fn frame(&mut self, frame: &Frame) -> Result<(), CliError> {
        if let Some(file) = &mut self.file {
            file.frame(frame)?;
        }
        if let Some(recorder) = &mut self.recorder {
            recorder.frame(frame);
        }
        if let Some(angles) = &mut self.angles {
            angles.frame(frame);
        }
        if let Some(progress) = &mut self.progress {
            progress.frame(frame.time_s);
        }
        if let Some(clock) = &mut self.clock {
            clock.wait(frame.time_s);
        }
        #[cfg(feature = "viz")]
        for viewer in &mut self.viewers {
            viewer.frame(frame)?;
        }
        Ok(())
    }
}

/// Keeps the run in memory, for the checks.
#[derive(Default)]
pub struct Recorder {
    names: Vec<String>,
    time_s: Vec<f64>,
    columns: Vec<Vec<f64>>,
}

impl Recorder {
    pub fn begin(&mut self, graph: &SceneGraph) {
        self.names.clone_from(&graph.channels);
        self.columns = vec![Vec::new(); self.names.len()];
    }

    pub fn frame(&mut self, frame: &Frame) {
        self.time_s.push(frame.time_s);
        self.columns.iter_mut().zip(&frame.channels).for_each(|(c, v)| c.push(*v));
    }

    /// The run so far.
    pub fn finish(self) -> Result<Recording, CliError> {
        let channels = self.names.into_iter().zip(self.columns).map(|(n, v)| Channel::new(n, v));
        Ok(Recording::new(self.time_s, channels.collect())?)
    }
}

/// Holds a run back so that it goes no faster than the clock on the wall.
#[derive(Default)]
pub struct Clock {
    begun: Option<(Instant, f64)>,
}

impl Clock {
    fn wait(&mut self, time_s: f64) {
        let (begun, first_s) = *self.begun.get_or_insert_with(|| (Instant::now(), time_s));
        // A run that falls behind is not hurried afterwards.
        let ahead_s = time_s - first_s - begun.elapsed().as_secs_f64();
        if ahead_s > 0.0 && !interrupted() {
            std::thread::sleep(Duration::from_secs_f64(ahead_s.min(1.0)));
        } else if ahead_s < 0.0 {
            self.begun = Some((Instant::now(), time_s));
        }
    }
}

/// A progress bar on stderr, shown only when the run takes over a second and stderr is a terminal.
pub struct Progress {
    bar: ProgressBar,
    begun: Instant,
    shown: bool,
}

impl Progress {
    pub fn new(end_s: f64) -> Self {
        let bar = ProgressBar::with_draw_target(Some((end_s * 1e3) as u64), ProgressDrawTarget::hidden());
        if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent:>3} % of {msg}, {eta} left") {
            bar.set_style(style);
        }
        bar.set_message(format!("{end_s} s"));
        Self { bar, begun: Instant::now(), shown: false }
    }

    fn frame(&mut self, time_s: f64) {
        if !self.shown && self.begun.elapsed() > Duration::from_secs(1) && std::io::stderr().is_terminal() {
            self.bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(5));
            self.shown = true;
        }
        self.bar.set_position((time_s * 1e3) as u64);
    }

    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}
