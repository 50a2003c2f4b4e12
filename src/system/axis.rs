//! An axis moved at a recorded position that answers with a force.

use crate::scene::AxisSpec;

use super::InputSource;

/// `F = F0 + A p + c v + m a`, with `v` and `a` as central differences of the recorded position over a window `w`:
/// `v = (x(t + w/2) - x(t - w/2))/w`, `a = (x(t + w) - 2 x(t) + x(t - w))/w²`. A window of a few samples keeps the
/// position's quantisation out of them.
#[derive(Clone, Debug)]
pub struct Axis {
    pub spec: AxisSpec,
    pub position: usize,
    pub pressure: Option<usize>,
}

impl Axis {
    /// Force at a time, N.
    pub fn force_n(&self, inputs: &[InputSource], time_s: f64) -> f64 {
        let s = &self.spec;
        let w = s.derivative_window_s;
        let x = |t: f64| inputs[self.position].value(t);
        let speed = (x(time_s + w / 2.0) - x(time_s - w / 2.0)) / w;
        let acceleration = (x(time_s + w) - 2.0 * x(time_s) + x(time_s - w)) / (w * w);
        let pressure = self.pressure.map_or(0.0, |i| inputs[i].value(time_s));
        s.offset_n + s.piston_area_m2 * pressure + s.damping_n_s_m * speed + s.mass_kg * acceleration
    }
}
