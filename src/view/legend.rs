//! The colour scales of cables, muscles and loops, drawn as strips with their ends named.

use rerun::{LineStrips2D, Points2D, Radius, RecordingStream};

use super::colour::{self, AXIS, Rgb, opaque};
use super::error::ViewError;
use super::layer::{Layer, path};
use super::options::ViewOptions;
use crate::system::observe::{Frame, SceneGraph};

const STEPS: usize = 48;
/// Height of a strip and the distance between two.
const HEIGHT: f32 = 0.05;
pub(super) const SPACING: f32 = 0.21;

/// One strip: a title, its colours from left to right, texts below both ends.
struct Strip {
    title: String,
    colours: Vec<Rgb>,
    ends: [String; 2],
}

pub(super) struct Legend {
    strips: Vec<Strip>,
}

/// How many strips the scene needs.
pub(super) fn strip_count(graph: &SceneGraph) -> usize {
    usize::from(!graph.cables.is_empty()) + usize::from(shows_pressure(graph)) + usize::from(!graph.loops.is_empty())
}

/// Muscles of a formula have no pressure.
fn shows_pressure(graph: &SceneGraph) -> bool {
    !graph.muscles.is_empty() && graph.channels.iter().any(|c| c.contains("pressure"))
}

impl Legend {
    pub(super) fn new(graph: &SceneGraph, options: &ViewOptions) -> Self {
        let cables = (!graph.cables.is_empty()).then(|| tension_strip(options));
        let muscles = shows_pressure(graph).then(|| pressure_strip(options));
        let loops = (!graph.loops.is_empty()).then(age_strip);
        Legend { strips: cables.into_iter().chain(muscles).chain(loops).collect() }
    }
}

impl Layer for Legend {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        for (number, strip) in self.strips.iter().enumerate() {
            let name = number.to_string();
            let top = number as f32 * SPACING;
            out.log_static(path(["legend", &name, "strip"]), &bar(strip, top))?;
            out.log_static(path(["legend", &name, "texts"]), &texts(strip, top))?;
        }
        Ok(())
    }

    fn stretch(&mut self, _: &RecordingStream, _: &[Frame]) -> Result<(), ViewError> {
        Ok(())
    }
}

fn tension_strip(options: &ViewOptions) -> Strip {
    let (slack, scale) = (options.slack_below_n, options.tension_scale_n);
    let at = |fraction: f64| match fraction {
        fraction if fraction < 0.08 => colour::SLACK,
        fraction => colour::tension((fraction - 0.08) / 0.92 * scale + slack, slack, scale),
    };
    Strip {
        title: "cable tension (N)".into(),
        colours: fractions().map(at).collect(),
        ends: ["slack".into(), format!("≥ {scale}")],
    }
}

fn pressure_strip(options: &ViewOptions) -> Strip {
    let at = |fraction: f64| colour::pressure(fraction, 1.0);
    Strip {
        title: "muscle pressure (kPa)".into(),
        colours: fractions().map(at).collect(),
        ends: ["0".into(), format!("≥ {}", options.pressure_scale_pa / 1e3)],
    }
}

fn age_strip() -> Strip {
    Strip {
        title: "loop".into(),
        colours: fractions().map(colour::age).collect(),
        ends: ["first".into(), "now".into()],
    }
}

fn fractions() -> impl Iterator<Item = f64> {
    (0..STEPS).map(|n| n as f64 / (STEPS - 1) as f64)
}

fn bar(strip: &Strip, top: f32) -> LineStrips2D {
    let width = 1.0 / STEPS as f32;
    let middle = top + 0.5 * HEIGHT;
    let pieces = (0..STEPS).map(|n| {
        let left = n as f32 * width;
        [(left, middle), (left + width, middle)]
    });
    LineStrips2D::new(pieces)
        .with_colors(strip.colours.iter().map(|colour| opaque(*colour)))
        .with_radii([Radius::new_scene_units(0.5 * HEIGHT)])
}

fn texts(strip: &Strip, top: f32) -> Points2D {
    let below = top + HEIGHT;
    let [low, high] = strip.ends.clone();
    Points2D::new([(0.0, below), (0.5, below), (1.0, below)])
        .with_labels([low, strip.title.clone(), high])
        .with_show_labels(true)
        .with_colors([opaque(AXIS)])
        .with_radii([Radius::new_ui_points(0.0)])
}
