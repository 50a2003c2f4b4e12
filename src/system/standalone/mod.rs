//! Elements that stand alone: what they show follows from their inputs and time, without coordinates or an integrator.
//!
//! An axis answers a recorded motion with a force, a strip of rubber a recorded stretch, a closed chamber time alone. Each has its
//! constants ([`Standalone`]), its numbers over any scalar, and what it remembers along a run, both in [`Answering`].

mod axis;
mod chamber;
mod strip;

use crate::effects::Effect;
use crate::scalar::Scalar;
use crate::scene::Scene;

use axis::{Axis, AxisFriction, AxisNumbers};
use chamber::{Chamber, ChamberGas};
use strip::{Strip, StripRubber};

pub use axis::AxisNumber;
pub use chamber::ChamberNumber;
pub use strip::StripNumber;

/// A number of an element that stands alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StandaloneNumber {
    Axis(AxisNumber),
    Strip(StripNumber),
    Chamber(ChamberNumber),
}

/// The element of a scene.
#[derive(Clone, Debug)]
pub(super) enum Standalone {
    Axis(Axis),
    Strip(Strip),
    Chamber(Chamber),
}

/// The element along a run; instants must come in order.
#[derive(Clone, Debug)]
pub(super) enum Answering<D> {
    Axis(Axis, AxisNumbers<D>, AxisFriction<D>),
    Strip(StripRubber<D>),
    Chamber(ChamberGas<D>),
}

impl Standalone {
    /// That of a scene, if it has one.
    pub fn of(scene: &Scene) -> Option<Self> {
        let axis = || Axis::of(scene).map(Self::Axis);
        let strip = || Strip::of(scene).map(Self::Strip);
        axis().or_else(strip).or_else(|| scene.file.chamber.clone().map(|spec| Self::Chamber(Chamber { spec })))
    }

    /// The number behind a scene key.
    pub fn number(key: &str) -> Option<StandaloneNumber> {
        use StandaloneNumber as N;
        Some(match key {
            "axis.piston_area_m2" => N::Axis(AxisNumber::PistonArea),
            "axis.damping_n_s_m" => N::Axis(AxisNumber::Damping),
            "axis.offset_n" => N::Axis(AxisNumber::Offset),
            "axis.mass_kg" => N::Axis(AxisNumber::Mass),
            "strip.length_m" => N::Strip(StripNumber::Length),
            "strip.material.c1_pa" => N::Strip(StripNumber::C1),
            "strip.material.c2_pa" => N::Strip(StripNumber::C2),
            "strip.material.c3_pa" => N::Strip(StripNumber::C3),
            "strip.material.mu_pa" => N::Strip(StripNumber::Mu),
            "strip.material.jm" => N::Strip(StripNumber::Jm),
            "chamber.start_pressure_pa" => N::Chamber(ChamberNumber::Start),
            _ => return None,
        })
    }

    /// The element before its first instant, with numbers that differ from the scene's and the effects on it.
    pub fn begin<D: Scalar>(
        &self,
        numbers: impl Iterator<Item = (StandaloneNumber, D)>,
        effects: &[Effect<D>],
    ) -> Answering<D> {
        match self {
            Self::Axis(axis) => {
                let mut own: AxisNumbers<D> = axis.numbers();
                numbers.for_each(|(which, value)| {
                    if let StandaloneNumber::Axis(which) = which {
                        own.put(which, value);
                    }
                });
                Answering::Axis(axis.clone(), own, AxisFriction::of(effects))
            }
            Self::Strip(strip) => {
                let own = numbers.filter_map(|(which, value)| match which {
                    StandaloneNumber::Strip(which) => Some((which, value)),
                    _ => None,
                });
                Answering::Strip(strip.begin(own, effects))
            }
            Self::Chamber(chamber) => {
                let own = numbers.filter_map(|(which, value)| match which {
                    StandaloneNumber::Chamber(which) => Some((which, value)),
                    _ => None,
                });
                Answering::Chamber(chamber.begin(own, effects))
            }
        }
    }
}

impl<D: Scalar> Answering<D> {
    /// What the element shows at a time, SI, from the inputs as functions of time; `span_s` is where recorded ones begin and end.
    pub fn show(&mut self, input: impl Fn(usize, f64) -> f64, span_s: Option<(f64, f64)>, time_s: f64) -> D {
        match self {
            Self::Axis(axis, numbers, friction) => {
                let motion = axis.motion_at(input, span_s, time_s);
                numbers.force_n(&motion) + friction.force_n(&motion)
            }
            Self::Strip(rubber) => rubber.force_n(input(rubber.position, time_s), time_s),
            Self::Chamber(gas) => gas.pressure_pa(time_s),
        }
    }
}
