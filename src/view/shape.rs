//! Checks that a scene graph is consistent and that frames fit it, so that layers may index freely.

use super::error::ViewError;
use crate::system::observe::{Frame, SceneGraph};

/// Every index of the graph exists.
pub(super) fn check_graph(graph: &SceneGraph) -> Result<(), ViewError> {
    for visual in &graph.visuals {
        check_index("a visual's link", visual.link, graph.links.len())?;
    }
    for joint in &graph.joints {
        check_index("a joint's link", joint.link, graph.links.len())?;
    }
    for (x, y) in &graph.loops {
        check_index("a loop's channel", *x, graph.channels.len())?;
        check_index("a loop's channel", *y, graph.channels.len())?;
    }
    Ok(())
}

/// A frame has what its graph promises.
pub(super) fn check_frame(graph: &SceneGraph, frame: &Frame) -> Result<(), ViewError> {
    let joints = frame.joint_positions.len();
    let counts = [
        ("channels", graph.channels.len(), frame.channels.len()),
        ("link poses", graph.links.len(), frame.link_poses.len()),
        ("cables", graph.cables.len(), frame.cables.len()),
        ("muscles", graph.muscles.len(), frame.muscles.len()),
        ("joints", graph.joints.len(), joints),
        ("laws", graph.laws.len(), frame.laws.len()),
    ];
    let time_s = frame.time_s;
    match counts.into_iter().find(|(_, expected, found)| expected != found) {
        Some((what, expected, found)) => Err(ViewError::FrameShape { time_s, what, expected, found }),
        None => Ok(()),
    }
}

fn check_index(what: &'static str, index: usize, count: usize) -> Result<(), ViewError> {
    if index < count {
        return Ok(());
    }
    Err(ViewError::BadIndex { what, index, count })
}
