//! The arrangement of a diagnosis: both mechanisms and the verdict on the left, traces and residuals on the right.

use super::blueprint::{events, mechanism, series_near, series_whole, view};
use super::channels::axis_title;
use super::diagnosis::{CALIBRATED, CORRECTED};
use super::layer::path;
use super::layout::{Kind, Pane};
use crate::system::observe::SideBySide;

/// Channels beyond these go into tabs.
const CHANNELS_IN_SIGHT: usize = 4;
/// Traces are shown this near to the cursor, s: over all runs the three would lie on each other.
const NEAR_S: f64 = 8.0;

pub(super) fn page(run: &SideBySide) -> Pane {
    Pane::Row(vec![(0.4, left(run)), (0.6, right(run))])
}

fn left(run: &SideBySide) -> Pane {
    let summary = view(Kind::Document, "Verdict", path(["summary"]), Vec::new());
    let texts = Pane::Tabs(vec![summary, events()]);
    let graph = &run.graph;
    if graph.links.is_empty() && graph.cables.is_empty() && graph.muscles.is_empty() {
        return texts;
    }
    let ghost = if run.measured_poses.is_empty() { "" } else { " (green: as measured)" };
    Pane::Column(vec![
        (0.31, mechanism(graph, &format!("Calibrated scene{ghost}"), CALIBRATED)),
        (0.31, mechanism(graph, &format!("Corrected scene{ghost}"), CORRECTED)),
        (0.38, texts),
    ])
}

/// One row per channel, and below all of them where the calibrated scene is off.
fn right(run: &SideBySide) -> Pane {
    let mut rows: Vec<Pane> = run.measured.iter().map(|m| channel(&run.graph.channels[m.channel])).collect();
    let rest = rows.split_off(rows.len().min(CHANNELS_IN_SIGHT));
    let mut panes: Vec<(f32, Pane)> = rows.into_iter().map(|row| (1.0, row)).collect();
    if !rest.is_empty() {
        panes.push((1.0, Pane::Tabs(rest)));
    }
    panes.push((0.55, view(Kind::States, "Runs, and where the calibrated scene is off", path(["states"]), Vec::new())));
    Pane::Column(panes)
}

fn channel(column: &str) -> Pane {
    let title = axis_title(column);
    Pane::Row(vec![
        (0.5, series_near(&format!("{title}, {NEAR_S} s to both sides"), path(["traces", column]), [NEAR_S; 2])),
        (0.5, series_whole(&format!("Residual of {title}, all runs"), path(["residuals", column]))),
    ])
}
