//! A bar of a round length below what the camera looks at.

use nalgebra::Vector3;
use rerun::{LineStrip3D, LineStrips3D, Radius, RecordingStream};

use super::colour::{AXIS, opaque};
use super::error::ViewError;
use super::layer::{Layer, path};
use crate::system::observe::{Frame, SceneGraph};

/// Length of the bar, and how far below the target it lies, over the camera's distance.
const LENGTH_SHARE: f64 = 0.2;
const BELOW_SHARE: f64 = 0.33;

pub(super) struct ScaleBar {
    root: &'static str,
    ends_m: [[f64; 3]; 2],
    length_m: f64,
}

impl ScaleBar {
    /// None without a camera, or for one that looks straight up or down.
    pub(super) fn new(root: &'static str, graph: &SceneGraph) -> Option<Self> {
        let target = Vector3::from(graph.camera_target_m);
        let way = target - Vector3::from(graph.camera_position_m);
        let right = way.cross(&Vector3::z()).try_normalize(1e-9)?;
        let up = right.cross(&way).normalize();
        let length_m = round_length(LENGTH_SHARE * way.norm());
        let middle = target - up * (BELOW_SHARE * way.norm());
        let end = |side: f64| (middle + right * (0.5 * side * length_m)).into();
        Some(Self { root, ends_m: [end(-1.0), end(1.0)], length_m })
    }
}

/// The greatest of 1, 2, 5 times a power of ten that is not above a length.
fn round_length(length_m: f64) -> f64 {
    let decade = 10f64.powf(length_m.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|step| step * decade).find(|l| *l <= length_m).unwrap_or(decade)
}

fn words(length_m: f64) -> String {
    if length_m < 1.0 { format!("{:.3} mm", length_m * 1e3) } else { format!("{length_m:.3} m") }.replace(".000", "")
}

impl Layer for ScaleBar {
    fn begin(&mut self, out: &RecordingStream) -> Result<(), ViewError> {
        let bar = LineStrips3D::new([LineStrip3D::from_iter(self.ends_m)])
            .with_colors([opaque(AXIS)])
            .with_radii([Radius::new_ui_points(1.5)])
            .with_labels([words(self.length_m)])
            .with_show_labels(true);
        out.log_static(path([self.root, "scale"]), &bar)?;
        Ok(())
    }

    fn stretch(&mut self, _: &RecordingStream, _: &[Frame]) -> Result<(), ViewError> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_round() {
        for (length_m, bar) in [(0.0093, "5 mm"), (0.04, "20 mm"), (0.1001, "100 mm"), (1.2, "1 m"), (7e-4, "0.500 mm")]
        {
            assert_eq!(words(round_length(length_m)), bar);
        }
    }

    #[test]
    fn the_bar_lies_across_the_view_below_its_middle() {
        let graph = SceneGraph { camera_position_m: [0.0, -0.2, 0.1], ..SceneGraph::default() };
        let bar = ScaleBar::new("world", &graph).expect("a camera");
        assert!((bar.ends_m[1][0] - bar.ends_m[0][0] - bar.length_m).abs() < 1e-12);
        assert!(bar.ends_m[0][2] < 0.0);
        let above = SceneGraph { camera_position_m: [0.0, 0.0, 0.3], ..SceneGraph::default() };
        assert!(ScaleBar::new("world", &above).is_none());
    }
}
