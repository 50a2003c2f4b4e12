//! Hysteresis loops, and laws over their variable: a curve in a drawn frame with ticks, and a point where the run is now.
//!
//! Rerun has no x-y plot. The points are logged in their own units (vertical axis negated, since
//! the view's points down) under a transform that fits them into the frame, logged when it settles.

use rerun::{EntityPath, LineStrip2D, LineStrips2D, Points2D, Radius, RecordingStream, Transform3D};

use super::channels::axis_title;
use super::colour::{AXIS, NOW, age, opaque};
use super::error::ViewError;
use super::layer::{Layer, path, times};
use super::options::ViewOptions;
use super::ticks::{padded, text, ticks};
use super::trace::Trace;
use crate::system::observe::{Frame, SceneGraph};

/// Size of the drawn frame; its lower left corner is the origin.
pub(super) const FRAME: [f64; 2] = [1.6, 1.0];
const TICK: f64 = 0.02;
/// The curve is cut into this many pieces, dark (early) to bright (late).
const PIECES: usize = 24;

/// What is drawn, by its index in the graph.
#[derive(Clone, Copy)]
enum Shown {
    /// Horizontal and vertical channel.
    Channels(usize, usize),
    /// A law's value over its first variable.
    Law(usize),
}

/// One quantity over another.
pub(super) struct Loop {
    /// Entity under which it stands.
    root: [String; 2],
    shown: Shown,
    titles: [String; 2],
    trace: Trace<2>,
}

impl Loop {
    pub(super) fn all(graph: &SceneGraph, options: &ViewOptions) -> Vec<Self> {
        let new =
            |root: [String; 2], shown, titles| Loop { root, shown, titles, trace: Trace::new(options.loop_points) };
        let of_channels = graph.loops.iter().enumerate().map(|(i, &(x, y))| {
            let titles = [axis_title(&graph.channels[x]), axis_title(&graph.channels[y])];
            new(["loops".to_owned(), (i + 1).to_string()], Shown::Channels(x, y), titles)
        });
        let of_laws = graph.laws.iter().enumerate().filter_map(|(i, law)| {
            let titles = [axis_title(law.variable.as_ref()?), law.name.clone()];
            Some(new(["law_curves".to_owned(), law.name.clone()], Shown::Law(i), titles))
        });
        of_channels.chain(of_laws).collect()
    }

    fn entity(&self, part: &str) -> EntityPath {
        path([&self.root[0], &self.root[1], part])
    }

    fn data_entity(&self, part: &str) -> EntityPath {
        path([&self.root[0], &self.root[1], "data", part])
    }

    fn point(&self, frame: &Frame) -> [f64; 2] {
        match self.shown {
            Shown::Channels(x, y) => [frame.channels[x], frame.channels[y]],
            Shown::Law(i) => [frame.laws[i].variable, frame.laws[i].value],
        }
    }
}

impl Layer for Loop {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let [w, h] = FRAME.map(|size| size as f32);
        let edge = LineStrips2D::new([[(0.0, 0.0), (w, 0.0), (w, -h), (0.0, -h), (0.0, 0.0)]])
            .with_colors([opaque(AXIS)])
            .with_radii([Radius::new_ui_points(0.75)]);
        out.log_static(self.entity("frame"), &edge)?;
        let now = Points2D::update_fields().with_colors([opaque(NOW)]).with_radii([Radius::new_ui_points(5.0)]);
        out.log_static(self.data_entity("now"), &now)?;
        Ok(())
    }

    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        frames.iter().for_each(|frame| self.trace.push(self.point(frame)));
        let now = frames.iter().map(|frame| downwards(&self.point(frame)));
        let points = Points2D::update_fields().with_positions(now);
        let columns = points.columns_of_unit_batches()?;
        out.send_columns(self.data_entity("now"), [times(frames)], columns)?;
        Ok(())
    }

    fn settle(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let Some(range) = self.trace.range() else {
            return Ok(());
        };
        let range = range.map(|[low, high]| padded(low, high));
        out.log_static(self.entity("data"), &fit(range))?;
        let drawn = self.trace.points();
        match self.shown {
            Shown::Channels(..) => out.log_static(self.data_entity("curve"), &curve(drawn))?,
            // Where a run sticks and slips, lines from sample to sample would cut across the law.
            Shown::Law(_) => out.log_static(self.data_entity("curve"), &dots(drawn))?,
        }
        let scales = [Scale::new(range[0]), Scale::new(range[1])];
        out.log_static(self.entity("ticks"), &tick_lines(&scales))?;
        out.log_static(self.entity("labels"), &labels(&scales, &self.titles))?;
        Ok(())
    }
}

/// Values along one axis and where they are in the frame, 0..=1.
struct Scale {
    values: Vec<f64>,
    places: Vec<f64>,
}

impl Scale {
    fn new([low, high]: [f64; 2]) -> Self {
        let values = ticks(low, high, 5);
        let places = values.iter().map(|value| (value - low) / (high - low)).collect();
        Scale { values, places }
    }

    fn texts(&self) -> impl Iterator<Item = String> + '_ {
        self.values.iter().map(|value| text(*value, &self.values))
    }
}

/// Transform from the values (vertical ones negated) to the frame.
fn fit([x, y]: [[f64; 2]; 2]) -> Transform3D {
    let scale_x = FRAME[0] / (x[1] - x[0]);
    let scale_y = FRAME[1] / (y[1] - y[0]);
    Transform3D::update_fields()
        .with_translation([(-x[0] * scale_x) as f32, (y[0] * scale_y) as f32, 0.0])
        .with_scale([scale_x as f32, scale_y as f32, 1.0])
}

fn curve(points: &[[f64; 2]]) -> LineStrips2D {
    let length = points.len().div_ceil(PIECES).max(1);
    let starts = (0..points.len()).step_by(length);
    let piece = |start: usize| {
        let end = (start + length + 1).min(points.len());
        LineStrip2D::from_iter(points[start..end].iter().map(downwards))
    };
    let colour = |start: usize| opaque(age(start as f64 / points.len() as f64));
    LineStrips2D::new(starts.clone().map(piece))
        .with_colors(starts.map(colour))
        .with_radii([Radius::new_ui_points(1.25)])
}

/// Every point, coloured like the pieces of a curve.
fn dots(points: &[[f64; 2]]) -> Points2D {
    let colours = (0..points.len()).map(|i| opaque(age(i as f64 / points.len() as f64)));
    Points2D::new(points.iter().map(downwards)).with_colors(colours).with_radii([Radius::new_ui_points(1.5)])
}

fn tick_lines([x, y]: &[Scale; 2]) -> LineStrips2D {
    let below = x.places.iter().map(|place| {
        let at = (place * FRAME[0]) as f32;
        [(at, 0.0), (at, TICK as f32)]
    });
    let left = y.places.iter().map(|place| {
        let at = (-place * FRAME[1]) as f32;
        [(0.0, at), (-TICK as f32, at)]
    });
    LineStrips2D::new(below.chain(left)).with_colors([opaque(AXIS)]).with_radii([Radius::new_ui_points(0.75)])
}

/// Invisible points that carry the texts of ticks and axes.
fn labels([x, y]: &[Scale; 2], [x_title, y_title]: &[String; 2]) -> Points2D {
    let below = x.places.iter().map(|place| [place * FRAME[0], 0.03]);
    let left = y.places.iter().map(|place| [-0.11, -place * FRAME[1] - 0.04]);
    let titles = [[0.5 * FRAME[0], 0.14], [0.0, -FRAME[1] - 0.14]];
    let places = below.chain(left).chain(titles).map(|[x, y]| (x as f32, y as f32));
    let texts = x.texts().chain(y.texts()).chain([x_title.clone(), y_title.clone()]);
    Points2D::new(places)
        .with_labels(texts)
        .with_show_labels(true)
        .with_colors([opaque(AXIS)])
        .with_radii([Radius::new_ui_points(0.0)])
}

fn downwards(&[x, y]: &[f64; 2]) -> (f32, f32) {
    (x as f32, -y as f32)
}
