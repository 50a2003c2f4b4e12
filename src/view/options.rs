//! How a run is drawn.

use std::time::Duration;

/// When buffered frames are sent on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// After this many frames: for files.
    Frames(usize),
    /// After this much wall time (or 4096 frames): for somebody who watches.
    Wall(Duration),
}

/// Scales and sizes of what is drawn. Colours saturate at the scales; the legend shows them.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewOptions {
    /// Tension drawn in full red, N. Default 10.
    pub tension_scale_n: f64,
    /// Cables below this tension count as slack and are grey, N. Default 0.02.
    pub slack_below_n: f64,
    /// Pressure drawn in full yellow, Pa. Default 1 MPa.
    pub pressure_scale_pa: f64,
    /// Length of a contact's arrow per force, m/N. Default 0.005.
    pub contact_arrow_m_per_n: f64,
    /// Points kept of each hysteresis loop; beyond that every second one is dropped. Default 4096.
    pub loop_points: usize,
    /// `None` (the default): 1024 frames for a file, 33 ms for a viewer.
    pub pace: Option<Pace>,
}

impl Default for ViewOptions {
    fn default() -> Self {
        ViewOptions {
            tension_scale_n: 10.0,
            slack_below_n: 0.02,
            pressure_scale_pa: 1e6,
            contact_arrow_m_per_n: 0.005,
            loop_points: 4096,
            pace: None,
        }
    }
}
