//! The arrangement of views for a scene: mechanism large on the left, plots along the chain on the right.

use rerun::blueprint::components::{BackgroundKind, Corner2D, Eye3DKind, LinkAxis, PanelState};
use rerun::blueprint::components::{LoopMode, PlayState, TextLogColumn, TimelineName};
use rerun::blueprint::datatypes;
use rerun::datatypes::{AbsoluteTimeRange, Range1D, Range2D, TimeInt, TimeRange, TimeRangeBoundary};
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PanelBlueprint, PlotLegend, TextLogColumns, TimeAxis, TimePanelBlueprint,
    ViewportBlueprint, VisualBounds2D,
};
use rerun::{AsComponents, Color, EntityPath, RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

use super::channels::{Group, axis_title, groups, headline, label};
use super::layer::{TIMELINE, WORLD, path};
use super::layout::{Kind, Pane, View, Writer};
use super::legend::{SPACING, strip_count};
use super::loops::FRAME;
use super::scalars::law_entity;
use crate::system::observe::{Frame, SceneGraph};

/// Plots beyond these go into tabs.
const PLOTS_IN_SIGHT: usize = 5;
const GROUND: [u8; 3] = [24, 26, 31];

/// Sends the arrangement for a scene whose first frame is known.
pub(super) fn send(out: &RecordingStream, graph: &SceneGraph, first: &Frame) -> RecordingStreamResult<()> {
    send_page(out, page(graph, first), None)
}

/// Sends an arrangement, side panels hidden. With a stretch of time (s) it is played over and over, else the end is shown.
pub(super) fn send_page(out: &RecordingStream, page: Pane, played_s: Option<[f64; 2]>) -> RecordingStreamResult<()> {
    let Some(info) = out.store_info() else {
        return Ok(());
    };
    let (blueprint, storage) =
        RecordingStreamBuilder::new(info.application_id().clone()).blueprint().enabled(true).memory()?;
    blueprint.set_time_sequence("blueprint", 0);
    log(&blueprint, page, played_s)?;
    let Some(blueprint_id) = blueprint.store_info().map(|info| info.store_id) else {
        return Ok(());
    };
    let activation = BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true };
    out.send_blueprint(storage.take(), activation);
    Ok(())
}

fn log(out: &RecordingStream, page: Pane, played_s: Option<[f64; 2]>) -> RecordingStreamResult<()> {
    let root = Writer::new(out).root(page)?;
    let viewport = ViewportBlueprint::new().with_root_container(root).with_auto_layout(false).with_auto_views(false);
    out.log("viewport", &viewport)?;
    let hidden = PanelBlueprint::new().with_state(PanelState::Hidden);
    out.log("blueprint_panel", &hidden)?;
    out.log("selection_panel", &hidden)?;
    let time = TimePanelBlueprint::new().with_state(PanelState::Collapsed).with_timeline(TimelineName(TIMELINE.into()));
    let time = match played_s {
        None => time.with_play_state(PlayState::Following),
        Some([from_s, to_s]) => time
            .with_play_state(PlayState::Playing)
            .with_loop_mode(LoopMode::Selection)
            .with_time_selection(AbsoluteTimeRange { min: nanoseconds(from_s), max: nanoseconds(to_s) }),
    };
    out.log("time_panel", &time)
}

fn page(graph: &SceneGraph, first: &Frame) -> Pane {
    Pane::Row(vec![(0.46, picture(graph)), (0.54, plots(graph, first))])
}

/// The mechanism; below it the loops, the angle and the colour scales.
fn picture(graph: &SceneGraph) -> Pane {
    let has_space = !graph.links.is_empty() || !graph.cables.is_empty() || !graph.muscles.is_empty();
    let space = has_space.then(|| (0.66, space(graph)));
    let below = below(graph);
    let below = (!below.is_empty()).then_some((0.34, Pane::Row(below)));
    let panes: Vec<_> = space.into_iter().chain(below).collect();
    if panes.is_empty() { Pane::Tabs(vec![events()]) } else { Pane::Column(panes) }
}

fn below(graph: &SceneGraph) -> Vec<(f32, Pane)> {
    let loops: Vec<Pane> = (0..graph.loops.len()).map(|number| loop_view(graph, number)).collect();
    let side: Vec<_> = headline_view(graph).into_iter().chain(legend_view(graph)).collect();
    let mut panes = Vec::new();
    match loops.len() {
        0 => {}
        1 | 2 => panes.extend(loops.into_iter().map(|pane| (0.36, pane))),
        _ => panes.push((0.6, Pane::Tabs(loops))),
    }
    if !side.is_empty() {
        panes.push((0.28, Pane::Column(side)));
    }
    panes
}

/// Plots along the chain, then joints, events and energies.
fn plots(graph: &SceneGraph, first: &Frame) -> Pane {
    let mut plots: Vec<Pane> = groups(&graph.channels).into_iter().map(|group| channel_plot(&group)).collect();
    let rest = plots.split_off(plots.len().min(PLOTS_IN_SIGHT));
    let mut tabs = law_views(graph);
    if !graph.joints.is_empty() {
        tabs.push(series("Joints (°; sliders mm)", path(["joints"])));
        tabs.push(view(Kind::Document, "Angles", path(["angles"]), Vec::new()));
    }
    tabs.push(events());
    tabs.extend(rest);
    if !first.energy_j.is_empty() {
        tabs.push(series("Energy (J)", path(["energy"])));
    }
    plots.push(Pane::Tabs(tabs));
    tiles(plots)
}

/// Two columns once one would make the panes too low for the ticks of their axes.
fn tiles(mut panes: Vec<Pane>) -> Pane {
    let width = if panes.len() > 3 { 2 } else { 1 };
    let mut rows = Vec::new();
    while !panes.is_empty() {
        let row = panes.drain(..width.min(panes.len()));
        rows.push((1.0, Pane::Row(row.map(|pane| (1.0, pane)).collect())));
    }
    Pane::Column(rows)
}

fn space(graph: &SceneGraph) -> Pane {
    let title = if graph.name.is_empty() { "Mechanism" } else { &graph.name };
    mechanism(graph, title, WORLD)
}

/// A mechanism under a root of its own, seen as its scene says.
pub(super) fn mechanism(graph: &SceneGraph, title: &str, root: &str) -> Pane {
    let mut properties: Vec<(&'static str, Box<dyn AsComponents>)> =
        vec![("LineGrid3D", Box::new(LineGrid3D::new().with_visible(false))), ("Background", Box::new(ground()))];
    // Without a camera, Rerun looks at everything.
    if graph.camera_position_m != graph.camera_target_m {
        properties.push(("EyeControls3D", Box::new(eye(graph))));
    }
    view(Kind::Space, title, path([root]), properties)
}

pub(super) fn eye(graph: &SceneGraph) -> EyeControls3D {
    EyeControls3D::new()
        .with_kind(Eye3DKind::Orbital)
        .with_position(graph.camera_position_m)
        .with_look_target(graph.camera_target_m)
        .with_eye_up(eye_up(graph))
}

/// Up on the screen: z, unless the camera looks along it.
fn eye_up(graph: &SceneGraph) -> [f64; 3] {
    let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| graph.camera_target_m[axis] - graph.camera_position_m[axis]);
    if x.hypot(y) < 0.05 * z.abs() { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] }
}

fn loop_view(graph: &SceneGraph, number: usize) -> Pane {
    let (x, y) = graph.loops[number];
    let title = format!("Loop: {} over {}", label(&graph.channels[y]), axis_title(&graph.channels[x]));
    plane(&title, path(["loops", &(number + 1).to_string()]), frame_bounds())
}

/// Of each law its value over its first variable, and over time.
fn law_views(graph: &SceneGraph) -> Vec<Pane> {
    let views = graph.laws.iter().map(|law| {
        let over_time = series(&format!("Law: {}", law.text), law_entity(law));
        let Some(variable) = &law.variable else { return over_time };
        let title = format!("{} over {}", law.name, axis_title(variable));
        let curve = plane(&title, path(["law_curves", &law.name]), frame_bounds());
        Pane::Row(vec![(0.4, curve), (0.6, over_time)])
    });
    views.collect()
}

fn frame_bounds() -> Range2D {
    let [width, height] = FRAME;
    bounds([-0.2, width + 0.08], [-height - 0.22, 0.3])
}

fn legend_view(graph: &SceneGraph) -> Option<(f32, Pane)> {
    let strips = strip_count(graph);
    let bottom = f64::from(SPACING) * strips as f64;
    let pane = || plane("Colours", path(["legend"]), bounds([-0.15, 1.15], [-0.1, bottom]));
    (strips > 0).then(|| (0.58, pane()))
}

fn headline_view(graph: &SceneGraph) -> Option<(f32, Pane)> {
    let channel = headline(&graph.channels, graph.input_count)?;
    let title = axis_title(&graph.channels[channel]);
    Some((0.42, view(Kind::Document, &title, path(["headline"]), Vec::new())))
}

/// Path and level are the same for all events: only time and text are shown.
pub(super) fn events() -> Pane {
    let body =
        TextLogColumn(datatypes::TextLogColumn { visible: true.into(), kind: datatypes::TextLogColumnKind::Body });
    let columns = TextLogColumns::new().with_text_log_columns([body]);
    let properties: Vec<(&'static str, Box<dyn AsComponents>)> = vec![("TextLogColumns", Box::new(columns))];
    view(Kind::Log, "Events", path(["events"]), properties)
}

/// A single line is named by the plot's title already.
fn channel_plot(group: &Group) -> Pane {
    let legend = PlotLegend::new().with_visible(group.members.len() > 1).with_corner(Corner2D::RightTop);
    let time = TimeAxis::new().with_link(LinkAxis::LinkToGlobal);
    let origin = path(["plots", &group.key]);
    view(Kind::Series, &group.title, origin, vec![("PlotLegend", Box::new(legend)), ("TimeAxis", Box::new(time))])
}

fn series(title: &str, origin: EntityPath) -> Pane {
    series_over(title, origin, TimeAxis::new().with_link(LinkAxis::LinkToGlobal))
}

/// A plot from so long before the cursor to so long after it, s.
pub(super) fn series_near(title: &str, origin: EntityPath, [before_s, after_s]: [f64; 2]) -> Pane {
    let start = TimeRangeBoundary::CursorRelative(nanoseconds(-before_s));
    let end = TimeRangeBoundary::CursorRelative(nanoseconds(after_s));
    series_over(title, origin, TimeAxis::new().with_view_range(TimeRange { start, end }))
}

/// A plot over all there is.
pub(super) fn series_whole(title: &str, origin: EntityPath) -> Pane {
    let everything = TimeRange { start: TimeRangeBoundary::Infinite, end: TimeRangeBoundary::Infinite };
    series_over(title, origin, TimeAxis::new().with_view_range(everything))
}

fn series_over(title: &str, origin: EntityPath, time: TimeAxis) -> Pane {
    let legend = PlotLegend::new().with_corner(Corner2D::RightTop);
    view(Kind::Series, title, origin, vec![("PlotLegend", Box::new(legend)), ("TimeAxis", Box::new(time))])
}

fn nanoseconds(time_s: f64) -> TimeInt {
    TimeInt((1e9 * time_s).round() as i64)
}

fn plane(title: &str, origin: EntityPath, bounds: Range2D) -> Pane {
    view(
        Kind::Plane,
        title,
        origin,
        vec![("VisualBounds2D", Box::new(VisualBounds2D::new(bounds))), ("Background", Box::new(ground()))],
    )
}

fn bounds(x: [f64; 2], y: [f64; 2]) -> Range2D {
    Range2D { x_range: Range1D(x), y_range: Range1D(y) }
}

pub(super) fn ground() -> Background {
    let [red, green, blue] = GROUND;
    Background::new(BackgroundKind::SolidColor).with_color(Color::from_rgb(red, green, blue))
}

pub(super) fn view(
    kind: Kind,
    title: &str,
    origin: EntityPath,
    properties: Vec<(&'static str, Box<dyn AsComponents>)>,
) -> Pane {
    Pane::View(View { kind, title: title.to_owned(), origin: origin.to_string(), properties })
}
