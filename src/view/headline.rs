//! Words: the angle (or what the scene is about instead) in large type, and what happened.

use rerun::{RecordingStream, TextDocument, TextLog};

use super::channels::{headline, label, symbol};
use super::error::ViewError;
use super::layer::{Layer, time_column};
use crate::system::observe::{Frame, SceneGraph};

/// The value at the cursor; a row only when its text changes.
pub(super) struct Headline {
    channel: usize,
    name: String,
    symbol: &'static str,
    last: String,
}

impl Headline {
    /// None if the scene has no output.
    pub(super) fn new(graph: &SceneGraph) -> Option<Self> {
        let channel = headline(&graph.channels, graph.input_count)?;
        let name = &graph.channels[channel];
        Some(Headline { channel, name: label(name), symbol: symbol(name), last: String::new() })
    }

    fn text(&self, frame: &Frame) -> String {
        format!("# {:.1} {}\n{}", frame.channels[self.channel], self.symbol, self.name).replace(" °", "°")
    }
}

impl Layer for Headline {
    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        let (mut times_s, mut texts) = (Vec::new(), Vec::new());
        for frame in frames {
            let text = self.text(frame);
            if text != self.last {
                self.last.clone_from(&text);
                times_s.push(frame.time_s);
                texts.push(text);
            }
        }
        log_texts(out, "headline", times_s, texts)
    }
}

/// Logs a text document's versions with their times, s; none is fine.
pub(super) fn log_texts(
    out: &RecordingStream,
    entity: &str,
    times_s: Vec<f64>,
    texts: Vec<String>,
) -> Result<(), ViewError> {
    if texts.is_empty() {
        return Ok(());
    }
    let kinds = std::iter::repeat_n(rerun::MediaType::markdown(), texts.len());
    let documents = TextDocument::update_fields().with_many_text(texts).with_many_media_type(kinds);
    out.send_columns(entity, [time_column(times_s)], documents.columns_of_unit_batches()?)?;
    Ok(())
}

/// Events as log lines.
pub(super) struct Events;

impl Layer for Events {
    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        let times_s = frames.iter().flat_map(|frame| std::iter::repeat_n(frame.time_s, frame.events.len()));
        let texts: Vec<&str> = frames.iter().flat_map(|frame| frame.events.iter().map(String::as_str)).collect();
        if texts.is_empty() {
            return Ok(());
        }
        let log = TextLog::update_fields().with_many_text(texts);
        out.send_columns("events", [time_column(times_s)], log.columns_of_unit_batches()?)?;
        Ok(())
    }
}
