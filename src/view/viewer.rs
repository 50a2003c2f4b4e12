//! The observer: checks frames, keeps a stretch of them, and hands it to the layers.

use std::time::{Duration, Instant};

use rerun::RecordingStream;

use super::angles::{Angles, Hinges};
use super::blueprint;
use super::cables::Cables;
use super::contacts::Contacts;
use super::error::ViewError;
use super::file::{StreamFile, abandon};
use super::headline::{Events, Headline};
use super::layer::{Layer, WORLD};
use super::legend::Legend;
use super::links::Links;
use super::loops::Loop;
use super::muscles::Muscles;
use super::options::{Pace, ViewOptions};
use super::scalars::{Channels, Energies, Joints, Laws};
use super::scale_bar::ScaleBar;
use super::shape;
use super::sink::{Connection, ViewSink};
use super::tip::Tip;
use crate::system::observe::{Frame, Observer, SceneGraph};

/// A stretch is never longer than this, however fast the frames come.
const MAX_STRETCH: usize = 4096;
/// How often a watched loop is redrawn.
const SETTLE_EVERY: Duration = Duration::from_millis(500);
/// How long the last data may take to get through.
const FLUSH: Duration = Duration::from_secs(30);

/// Shows a run while it goes on.
///
/// Give it to a run as its [`Observer`], then call [`Viewer::finish`]. A served run stays available
/// until the `Viewer` is dropped. Dropping without `finish` still sends what was seen to who watches, but
/// swallows errors; a file is then not written.
pub struct Viewer {
    stream: RecordingStream,
    announcement: String,
    pace: Pace,
    options: ViewOptions,
    run: Option<Run>,
    /// Last: the stream lets go of it first.
    file: Option<StreamFile>,
}

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ViewSummary {
    /// Frames shown.
    pub frames: usize,
}

/// A run that has begun.
struct Run {
    graph: SceneGraph,
    layers: Vec<Box<dyn Layer>>,
    frames: Vec<Frame>,
    sent: usize,
    last_sent: Instant,
    last_settled: Instant,
}

impl Viewer {
    /// Opens the file, window or server.
    pub fn open(sink: &ViewSink, options: ViewOptions) -> Result<Self, ViewError> {
        Ok(Viewer::new(sink.open()?, options))
    }

    pub(super) fn new(connection: Connection, options: ViewOptions) -> Self {
        Viewer {
            pace: options.pace.unwrap_or(connection.pace),
            stream: connection.stream,
            announcement: connection.announcement,
            options,
            run: None,
            file: connection.file,
        }
    }

    /// What to tell the user: where the run can be seen and the command that opens it.
    pub fn announcement(&self) -> &str {
        &self.announcement
    }

    /// Sends the rest and waits until it has arrived; a file gets its footer, and then its name.
    pub fn finish(&mut self) -> Result<ViewSummary, ViewError> {
        let frames = match &mut self.run {
            Some(run) => {
                run.send(&self.stream)?;
                run.settle(&self.stream)?;
                run.sent
            }
            None => 0,
        };
        close(&self.stream, self.file.take())?;
        Ok(ViewSummary { frames })
    }

    /// As [`Self::finish`], of a run that failed: a file stands beside its place, by [`crate::files::part_name`].
    ///
    /// # Errors
    /// As [`Self::finish`].
    pub fn finish_as_part(&mut self) -> Result<ViewSummary, ViewError> {
        self.file = self.file.take().map(StreamFile::as_part);
        self.finish()
    }
}

/// Waits until everything has arrived; a file gets its footer, and then its name.
pub(super) fn close(stream: &RecordingStream, file: Option<StreamFile>) -> Result<(), ViewError> {
    if let Err(error) = flush(stream) {
        return Err(match file {
            Some(file) => file.failed(stream, error),
            None => error,
        });
    }
    stream.finalize_deferred_sinks();
    file.map_or(Ok(()), StreamFile::place)
}

/// Waits until everything sent so far has arrived.
pub(super) fn flush(stream: &RecordingStream) -> Result<(), ViewError> {
    stream.flush_with_timeout(FLUSH).map_err(|error| ViewError::unsent(FLUSH.as_secs(), &error))
}

impl Observer for Viewer {
    type Error = ViewError;

    fn begin(&mut self, graph: &SceneGraph) -> Result<(), ViewError> {
        if self.run.is_some() {
            return Err(ViewError::AlreadyBegun);
        }
        shape::check_graph(graph)?;
        if !graph.name.is_empty() {
            self.stream.send_recording_name(graph.name.as_str())?;
        }
        self.run = Some(Run::begin(&self.stream, graph, &self.options)?);
        Ok(())
    }

    fn frame(&mut self, frame: &Frame) -> Result<(), ViewError> {
        let run = self.run.as_mut().ok_or(ViewError::NotBegun)?;
        run.keep(frame)?;
        if run.is_due(self.pace) {
            run.send(&self.stream)?;
            if matches!(self.pace, Pace::Wall(_)) && run.last_settled.elapsed() >= SETTLE_EVERY {
                run.settle(&self.stream)?;
            }
        }
        Ok(())
    }
}

impl Drop for Viewer {
    /// A run that stopped with an error is the one whose last frames are wanted. A file would look like that of a whole run.
    fn drop(&mut self) {
        if self.file.is_some() {
            abandon(&self.stream);
        } else if self.run.as_ref().is_some_and(|run| !run.frames.is_empty()) {
            let _ = self.finish();
        }
    }
}

impl Run {
    fn begin(out: &RecordingStream, graph: &SceneGraph, options: &ViewOptions) -> Result<Self, ViewError> {
        let mut layers = layers(graph, options);
        layers.iter_mut().try_for_each(|layer| layer.begin(out))?;
        Ok(Run {
            graph: graph.clone(),
            layers,
            frames: Vec::new(),
            sent: 0,
            last_sent: Instant::now(),
            last_settled: Instant::now(),
        })
    }

    fn keep(&mut self, frame: &Frame) -> Result<(), ViewError> {
        shape::check_frame(&self.graph, frame)?;
        self.frames.push(frame.clone());
        Ok(())
    }

    fn is_due(&self, pace: Pace) -> bool {
        let count = self.frames.len();
        match pace {
            Pace::Frames(frames) => count >= frames.clamp(1, MAX_STRETCH),
            Pace::Wall(interval) => count >= MAX_STRETCH || self.last_sent.elapsed() >= interval,
        }
    }

    fn send(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let Some(first) = self.frames.first() else {
            return Ok(());
        };
        if self.sent == 0 {
            blueprint::send(out, &self.graph, first)?;
        }
        for layer in &mut self.layers {
            layer.stretch(out, &self.frames)?;
        }
        self.sent += self.frames.len();
        self.frames.clear();
        self.last_sent = Instant::now();
        Ok(())
    }

    fn settle(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        self.last_settled = Instant::now();
        self.layers.iter_mut().try_for_each(|layer| layer.settle(out))
    }
}

fn layers(graph: &SceneGraph, options: &ViewOptions) -> Vec<Box<dyn Layer>> {
    let mut layers: Vec<Box<dyn Layer>> = vec![
        Box::new(Links::new(WORLD, graph)),
        Box::new(Cables::new(WORLD, graph, options)),
        Box::new(Muscles::new(WORLD, graph, options)),
        Box::new(Contacts::new(options)),
        Box::new(Channels::new(graph)),
        Box::new(Hinges::new(WORLD, graph)),
        Box::new(Joints::new(graph)),
        Box::new(Laws::new(graph)),
        Box::new(Energies::default()),
        Box::new(Events),
        Box::new(Legend::new(graph, options)),
    ];
    for part in Loop::all(graph, options) {
        layers.push(Box::new(part));
    }
    if let Some(headline) = Headline::new(graph) {
        layers.push(Box::new(headline));
    }
    if let Some(angles) = Angles::new(graph) {
        layers.push(Box::new(angles));
    }
    if let Some(bar) = ScaleBar::new(WORLD, graph) {
        layers.push(Box::new(bar));
    }
    if let Some(tip) = Tip::new(WORLD, graph, options) {
        layers.push(Box::new(tip));
    }
    layers
}
