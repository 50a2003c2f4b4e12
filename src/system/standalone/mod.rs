//! Elements that stand alone: what they show follows from their inputs and time, without coordinates or an integrator.
//!
//! An axis answers a recorded motion with a force, a strip of rubber a recorded stretch, a closed chamber time alone. Each has its
//! constants ([`Standalone`]), its numbers over any scalar, and what it remembers along a run, both in [`Answering`].

mod axis;
mod chamber;
mod laws;
mod strip;

use crate::effects::Effect;
use crate::laws::{Carrier, Law, Port};
use crate::scalar::Scalar;
use crate::scene::Scene;

use axis::{Axis, AxisFriction, AxisMotion, AxisNumbers};
use chamber::{Chamber, ChamberGas};
use laws::AloneLaws;
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
    /// A parameter of a law of the scene on it: both by index.
    Law(usize, usize),
}

/// The element of a scene, with the scene's laws on it.
#[derive(Clone, Debug)]
pub(super) struct Standalone {
    element: Element,
    laws: Vec<Law>,
}

#[derive(Clone, Debug)]
enum Element {
    Axis(Axis),
    Strip(Strip),
    Chamber(Chamber),
}

/// The element along a run; instants must come in order.
#[derive(Clone, Debug)]
pub(super) struct Answering<D> {
    element: AnsweringElement<D>,
    laws: AloneLaws<D>,
}

#[derive(Clone, Debug)]
enum AnsweringElement<D> {
    Axis(Axis, AxisNumbers<D>, AxisFriction<D>),
    Strip(StripRubber<D>),
    Chamber(ChamberGas<D>),
}

impl Standalone {
    /// That of a scene, if it has one.
    pub fn of(scene: &Scene) -> Option<Self> {
        let axis = || Axis::of(scene).map(Element::Axis);
        let strip = || Strip::of(scene).map(Element::Strip);
        let chamber = || scene.file.chamber.clone().map(|spec| Element::Chamber(Chamber { spec }));
        let element = axis().or_else(strip).or_else(chamber)?;
        let laws = scene.laws.iter().filter(|law| stands_alone(law)).cloned().collect();
        Some(Self { element, laws })
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

    /// Whether a port is one of this element.
    pub fn has(&self, port: Port) -> bool {
        let element = match &self.element {
            Element::Axis(_) => "axis",
            Element::Strip(_) => "strip",
            Element::Chamber(_) => "chamber",
        };
        port.spec().element == element
    }

    /// The parameter of one of its laws.
    pub fn number_of_law(&self, name: &str, parameter: &str) -> Option<StandaloneNumber> {
        let law = self.laws.iter().position(|law| law.name == name)?;
        Some(StandaloneNumber::Law(law, self.laws[law].parameter(parameter)?))
    }

    /// The element before its first instant, with numbers that differ from the scene's, and the effects and laws on it.
    pub fn begin<D: Scalar>(
        &self,
        numbers: impl Iterator<Item = (StandaloneNumber, D)> + Clone,
        effects: &[Effect<D>],
    ) -> Answering<D> {
        let laws = AloneLaws::new(&self.laws, numbers.clone(), effects);
        let element = match &self.element {
            Element::Axis(axis) => {
                let mut own: AxisNumbers<D> = axis.numbers();
                numbers.for_each(|(which, value)| {
                    if let StandaloneNumber::Axis(which) = which {
                        own.put(which, value);
                    }
                });
                AnsweringElement::Axis(axis.clone(), own, AxisFriction::of(effects))
            }
            Element::Strip(strip) => {
                let own = numbers.filter_map(|(which, value)| match which {
                    StandaloneNumber::Strip(which) => Some((which, value)),
                    _ => None,
                });
                AnsweringElement::Strip(strip.begin(own, effects))
            }
            Element::Chamber(chamber) => {
                let own = numbers.filter_map(|(which, value)| match which {
                    StandaloneNumber::Chamber(which) => Some((which, value)),
                    _ => None,
                });
                AnsweringElement::Chamber(chamber.begin(own, effects))
            }
        };
        Answering { element, laws }
    }
}

impl<D: Scalar> Answering<D> {
    /// What the element shows at a time, SI, from the inputs as functions of time; `span_s` is where recorded ones begin and end.
    pub fn show(&mut self, input: impl Fn(usize, f64) -> f64, span_s: Option<(f64, f64)>, time_s: f64) -> D {
        let laws = &mut self.laws;
        match &mut self.element {
            AnsweringElement::Axis(axis, numbers, friction) => {
                let motion = axis.motion_at(input, span_s, time_s);
                let reads = motion.reads();
                let force = laws.on(Port::AxisForce, numbers.force_n(&motion), time_s, &reads);
                force + friction.force_n(&motion, laws.acting(Port::AxisFriction, time_s, &reads))
            }
            AnsweringElement::Strip(rubber) => {
                let position_m = input(rubber.position, time_s);
                rubber.force_n(position_m, time_s, laws.acting(Port::StripForce, time_s, &[D::constant(position_m)]))
            }
            AnsweringElement::Chamber(gas) => gas.pressure_pa(time_s, laws),
        }
    }

    /// What the variables of its laws are at a time, in the order of the port's, time last.
    pub fn reads(&self, input: impl Fn(usize, f64) -> f64, span_s: Option<(f64, f64)>, time_s: f64) -> Vec<D> {
        let mut reads = match &self.element {
            AnsweringElement::Axis(axis, ..) => axis.motion_at(input, span_s, time_s).reads().to_vec(),
            AnsweringElement::Strip(rubber) => vec![D::constant(input(rubber.position, time_s))],
            AnsweringElement::Chamber(gas) => vec![gas.shown_pa()],
        };
        reads.push(D::constant(time_s));
        reads
    }

    /// The laws on it.
    pub fn laws(&self) -> &AloneLaws<D> {
        &self.laws
    }

    /// The laws on it, to give their parameters other values.
    pub fn laws_mut(&mut self) -> &mut AloneLaws<D> {
        &mut self.laws
    }
}

impl AxisMotion {
    /// The variables of an axis' laws, in their order, without time.
    fn reads<D: Scalar>(&self) -> [D; 3] {
        [self.position_m, self.speed_m_s, self.pressure_pa].map(D::constant)
    }
}

/// Whether a law acts on an element that stands alone.
fn stands_alone(law: &Law) -> bool {
    law.address.port.spec().carrier == Carrier::Alone
}
