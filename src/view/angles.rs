//! Joints: a marker in every hinge, and a table of all positions at the cursor.

use rerun::{Points3D, Radius, RecordingStream, TextDocument};

use super::colour::{MARKER, opaque};
use super::error::ViewError;
use super::layer::{Layer, path, time_column};
use crate::system::observe::{Frame, SceneGraph};

/// Rows of the table no closer than this, s: nobody reads faster.
const ROW_EVERY_S: f64 = 0.1;

/// A dot in each hinge; its name shows under the pointer.
pub(super) struct Hinges {
    root: &'static str,
    /// Link that the hinge moves, and the joint's name.
    hinges: Vec<(String, String)>,
}

impl Hinges {
    pub(super) fn new(root: &'static str, graph: &SceneGraph) -> Self {
        let hinges = graph.joints.iter().filter(|j| j.is_angle);
        Self { root, hinges: hinges.map(|j| (graph.links[j.link].clone(), j.name.clone())).collect() }
    }
}

impl Layer for Hinges {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        for (link, joint) in &self.hinges {
            let dot = Points3D::new([[0.0; 3]])
                .with_radii([Radius::new_ui_points(3.0)])
                .with_colors([opaque(MARKER)])
                .with_labels([joint.as_str()])
                .with_show_labels(false);
            out.log_static(path([self.root, "links", link, "hinge"]), &dot)?;
        }
        Ok(())
    }

    fn stretch(&mut self, _: &RecordingStream, _: &[Frame]) -> Result<(), ViewError> {
        Ok(())
    }
}

/// What `smam run --angles` prints, at the cursor.
pub(super) struct Angles {
    graph: SceneGraph,
    last_s: f64,
}

impl Angles {
    /// None if the scene has no joint.
    pub(super) fn new(graph: &SceneGraph) -> Option<Self> {
        (!graph.joints.is_empty()).then(|| Self { graph: graph.clone(), last_s: f64::NEG_INFINITY })
    }

    fn table(&self, frame: &Frame) -> String {
        let rows = self.graph.readings(frame);
        let row = |(name, value, unit): &(String, f64, &str)| format!("| {name} | {value:.2} | {unit} |\n");
        format!("| | | |\n|:---|---:|:---|\n{}", rows.iter().map(row).collect::<String>())
    }
}

impl Layer for Angles {
    fn stretch(&mut self, out: &RecordingStream, frames: &[Frame]) -> Result<(), ViewError> {
        let (mut times_s, mut texts) = (Vec::new(), Vec::new());
        for frame in frames {
            if frame.time_s >= self.last_s + ROW_EVERY_S * (1.0 - 1e-9) {
                self.last_s = frame.time_s;
                times_s.push(frame.time_s);
                texts.push(self.table(frame));
            }
        }
        if texts.is_empty() {
            return Ok(());
        }
        let count = texts.len();
        let documents = TextDocument::update_fields()
            .with_many_text(texts)
            .with_many_media_type(std::iter::repeat_n(rerun::MediaType::markdown(), count));
        out.send_columns("angles", [time_column(times_s)], documents.columns_of_unit_batches()?)?;
        Ok(())
    }
}
