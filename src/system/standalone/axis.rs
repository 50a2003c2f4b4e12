//! An axis moved at a recorded position that answers with a force.

use crate::effects::{Effect, Native, find};
use crate::scalar::Scalar;
use crate::scene::{AxisSpec, Scene};
use crate::system::laws::Act;

/// `F = F0 + A p + c v + m a`, with `v` and `a` as central differences of the recorded position over a window `w`:
/// `v = (x(t + w/2) - x(t - w/2))/w`, `a = (x(t + w) - 2 x(t) + x(t - w))/w²`. A window of a few samples keeps the
/// position's quantisation out of them.
#[derive(Clone, Debug)]
pub(in crate::system) struct Axis {
    pub spec: AxisSpec,
    pub position: usize,
    pub pressure: Option<usize>,
    window_s: f64,
}

/// Window without a recording, whose inputs are exact, in steps.
const WINDOW_STEPS: f64 = 2.0;

/// The numbers of an axis, over any scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::system) struct AxisNumbers<D> {
    piston_area_m2: D,
    mass_kg: D,
    damping_n_s_m: D,
    offset_n: D,
}

/// Which number of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisNumber {
    PistonArea,
    Mass,
    Damping,
    Offset,
}

/// The axis at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::system) struct AxisMotion {
    pub position_m: f64,
    pub speed_m_s: f64,
    pub acceleration_m_s2: f64,
    pub pressure_pa: f64,
}

impl Axis {
    /// That of a scene, if it has one.
    pub fn of(scene: &Scene) -> Option<Self> {
        let spec = scene.file.axis.clone()?;
        let input = |name: &str| scene.file.input.iter().position(|i| i.channel == name);
        let position = input(&spec.position_input)?;
        let pressure = spec.pressure_input.as_deref().and_then(input);
        let window_s = spec.derivative_window_s.unwrap_or(WINDOW_STEPS * scene.file.simulation.step_s);
        Some(Self { spec, position, pressure, window_s })
    }

    /// The scene's numbers.
    pub fn numbers<D: Scalar>(&self) -> AxisNumbers<D> {
        AxisNumbers {
            piston_area_m2: D::constant(self.spec.piston_area_m2),
            mass_kg: D::constant(self.spec.mass_kg),
            damping_n_s_m: D::constant(self.spec.damping_n_s_m),
            offset_n: D::constant(self.spec.offset_n),
        }
    }

    /// The motion at a time, from the inputs as functions of time. At the ends of a recorded position, `span_s`, derivatives are those
    /// of the nearest instant whose window lies inside: beyond, nothing is known of it.
    pub fn motion_at(&self, input: impl Fn(usize, f64) -> f64, span_s: Option<(f64, f64)>, time_s: f64) -> AxisMotion {
        let w = self.window_s;
        let x = |t: f64| input(self.position, t);
        let inside = span_s.map(|(begins_s, ends_s)| (begins_s + w, ends_s - w)).filter(|(first, last)| first <= last);
        let near_s = inside.map_or(time_s, |(first, last)| time_s.clamp(first, last));
        AxisMotion {
            position_m: x(time_s),
            speed_m_s: (x(near_s + w / 2.0) - x(near_s - w / 2.0)) / w,
            acceleration_m_s2: (x(near_s + w) - 2.0 * x(near_s) + x(near_s - w)) / (w * w),
            pressure_pa: self.pressure.map_or(0.0, |i| input(i, time_s)),
        }
    }
}

impl<D: Scalar> AxisNumbers<D> {
    /// Replaces one number.
    pub fn put(&mut self, which: AxisNumber, value: D) {
        match which {
            AxisNumber::PistonArea => self.piston_area_m2 = value,
            AxisNumber::Mass => self.mass_kg = value,
            AxisNumber::Damping => self.damping_n_s_m = value,
            AxisNumber::Offset => self.offset_n = value,
        }
    }

    /// Force without friction, N.
    pub fn force_n(&self, m: &AxisMotion) -> D {
        self.offset_n
            + self.piston_area_m2 * m.pressure_pa
            + self.damping_n_s_m * m.speed_m_s
            + self.mass_kg * m.acceleration_m_s2
    }
}

/// Dry friction of the axis' seals: `(F_c + f_p p) z`, `dz/dx = (sgn - z)/s` along the recorded way. What laws add to the level
/// has a seal of its own, with the presliding of the first.
#[derive(Clone, Debug)]
pub(in crate::system) struct AxisFriction<D> {
    seals: Vec<Seal<D>>,
    of_laws: Seal<D>,
    position_m: Option<f64>,
}

#[derive(Clone, Debug)]
struct Seal<D> {
    level_n: D,
    growth_n_pa: D,
    presliding_m: D,
    /// Direction of the force, -1 to 1.
    z: D,
}

impl<D: Scalar> Seal<D> {
    fn of(values: &[D]) -> Option<Self> {
        let &[level_n, growth_n_pa, presliding_m] = values.first_chunk()?;
        Some(Self { level_n, growth_n_pa, presliding_m, z: D::constant(0.0) })
    }

    /// Its direction after a straight way: exact, `z` goes to the way's direction by `exp(-|dx|/s)`.
    fn go_on(&mut self, way_m: f64) -> D {
        let left = (-(self.presliding_m.recip() * way_m.abs())).exp();
        self.z = (self.z - way_m.signum()) * left + way_m.signum();
        self.z
    }
}

impl<D: Scalar> AxisFriction<D> {
    /// The seals among the effects of a scene.
    pub fn of(effects: &[Effect<D>]) -> Self {
        let seals = effects.iter().filter(|e| e.entry.native == Some(Native::SealFriction));
        let seals: Vec<Seal<D>> = seals.filter_map(|e| Seal::of(&e.values)).collect();
        let usual_m = seals.first().map_or_else(|| D::constant(usual_presliding_m()), |seal| seal.presliding_m);
        let zero = D::constant(0.0);
        let of_laws = Seal { level_n: zero, growth_n_pa: zero, presliding_m: usual_m, z: zero };
        Self { seals, of_laws, position_m: None }
    }

    /// Force, N, after the axis went on to its present position; instants must come in order. `laws` act on the level.
    pub fn force_n(&mut self, m: &AxisMotion, laws: Act<D>) -> D {
        let way_m = m.position_m - self.position_m.replace(m.position_m).unwrap_or(m.position_m);
        let mut force = D::constant(0.0);
        for seal in &mut self.seals {
            force += (seal.level_n + seal.growth_n_pa * m.pressure_pa.max(0.0)) * seal.go_on(way_m);
        }
        force * laws.scale + laws.add * self.of_laws.go_on(way_m)
    }
}

/// Presliding of a seal whose own nobody states, m.
fn usual_presliding_m() -> f64 {
    let seal = find("seal_friction").map(|id| id.entry());
    let presliding = seal.and_then(|entry| entry.parameters.iter().find(|p| p.key == "presliding_m"));
    presliding.map_or(1e-4, |p| p.typical)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::PiecewiseLinear;

    /// `x = x0 + v t + a t²/2`, recorded in motion from the first sample to the last: acceleration is exact everywhere, speed but at the ends,
    /// where it is that of half a window inside or more.
    #[test]
    fn ends_in_motion_have_the_derivatives_of_what_is_near() {
        let scene = Scene::load("driven_axis", &[]).expect("a stock scene");
        let axis = Axis { window_s: 0.04, ..Axis::of(&scene).expect("an axis") };
        let times_s: Vec<f64> = (0..200).map(|i| 0.01 * f64::from(i)).collect();
        let position_m: Vec<f64> = times_s.iter().map(|t| 0.003 + 0.02 * t - 0.5 * 0.3 * t * t).collect();
        let line = PiecewiseLinear::new(&times_s, &position_m).expect("even times");
        let at = |t: f64| axis.motion_at(|_, t| line.value(t), Some((0.0, 1.99)), t);
        for &t in &times_s {
            let motion = at(t);
            assert!((motion.acceleration_m_s2 + 0.3).abs() < 1e-9, "{t}: {motion:?}");
            let near_s = t.clamp(0.04, 1.95);
            assert!((motion.speed_m_s - (0.02 - 0.3 * near_s)).abs() < 1e-9, "{t}: {motion:?}");
        }
        // A recording shorter than two windows has no inside.
        let short = axis.motion_at(|_, t| line.value(t), Some((0.0, 0.05)), 0.02);
        assert!((short.acceleration_m_s2 + 0.3).abs() > 1e-3, "{short:?}");
    }
}
