//! The places of the chain at which a law can act.

use super::quantity::Quantity as Q;
use super::{Acts, Dimension, Quantity};

/// A named term or coefficient of an element's equation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Port {
    Plunger,
    SyringeFlow,
    SyringeCompliance,
    PressureDrop,
    Resistance,
    Inertance,
    Outflow,
    LineCompliance,
    Pull,
    Wall,
    Coil,
    Friction,
    Damping,
    Area,
    RestLength,
    Tension,
    Stretch,
    CableStiffness,
    Lever,
    Transmission,
    Torque,
    JointStiffness,
    JointDamping,
    AxisForce,
    AxisFriction,
    StripForce,
    ChamberOutflow,
    Sensor,
}

/// What carries a port.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carrier {
    /// Plunger, syringe, line or muscle: there is one of each for every muscle of a rig.
    Muscle,
    Cable,
    Joint,
    /// Axis, strip or chamber: a scene has one, and nothing else.
    Alone,
    Sensor,
}

/// A port as it is described.
#[derive(Clone, Copy, Debug)]
pub struct PortSpec {
    pub port: Port,
    /// `muscle.friction` as element and term; a plunger has no terms.
    pub element: &'static str,
    pub term: &'static str,
    pub carrier: Carrier,
    /// Units of what may be added; empty where nothing may be. A joint that slides has the second one.
    pub adds: &'static [&'static str],
    pub scales: bool,
    /// One line: what it means, and which sign does what.
    pub means: &'static str,
    /// An example: whether it adds or scales, and the expression.
    pub example: (Acts, &'static str),
    /// Whether what stands here takes energy from the rig: a law that gives some is warned about.
    pub dissipates: bool,
}

const MUSCLE: &[Quantity] = &[
    Q::Elongation,
    Q::Speed,
    Q::Pressure,
    Q::SyringePressure,
    Q::Flow,
    Q::Plunger,
    Q::PlungerSpeed,
    Q::FrictionState,
    Q::Tension,
    Q::Angle,
    Q::AngularSpeed,
    Q::Time,
];
const PLUNGER: &[Quantity] = &[Q::Pressure, Q::Plunger, Q::PlungerSpeed, Q::Time];
const CABLE: &[Quantity] = &[
    Q::Stretch,
    Q::Tension,
    Q::Drive,
    Q::DriveSpeed,
    Q::Angle,
    Q::AngularSpeed,
    Q::Elongation,
    Q::Speed,
    Q::Pressure,
    Q::Time,
];
const JOINT: &[Quantity] =
    &[Q::Angle, Q::AngularSpeed, Q::Position, Q::Speed, Q::Tension, Q::Pressure, Q::Elongation, Q::Time];
const AXIS: &[Quantity] = &[Q::Position, Q::Speed, Q::Pressure, Q::Time];
const STRIP: &[Quantity] = &[Q::Position, Q::Time];
const CHAMBER: &[Quantity] = &[Q::Pressure, Q::Time];
const SENSOR: &[Quantity] = &[Q::Reading, Q::Time];

impl Port {
    /// Whether what acts there shows by a rate only: a flow, a drop of pressure, a damping.
    pub(crate) fn is_of_rate(self) -> bool {
        matches!(
            self,
            Self::SyringeFlow
                | Self::PressureDrop
                | Self::Resistance
                | Self::Inertance
                | Self::Outflow
                | Self::Damping
                | Self::JointDamping
        )
    }

    /// Where a law that scales this coefficient can be written as a product: the port of the term, and the variable that the coefficient
    /// multiplies there.
    pub(crate) fn as_product(self) -> Option<(Self, Quantity)> {
        match self {
            Self::Resistance => Some((Self::PressureDrop, Q::Flow)),
            Self::Damping => Some((Self::Pull, Q::Speed)),
            Self::Coil => Some((Self::Pull, Q::Elongation)),
            Self::JointStiffness => Some((Self::Torque, Q::Angle)),
            Self::JointDamping => Some((Self::Torque, Q::AngularSpeed)),
            _ => None,
        }
    }
}

impl PortSpec {
    /// `muscle.friction`.
    pub fn name(&self) -> String {
        if self.term.is_empty() { self.element.to_owned() } else { format!("{}.{}", self.element, self.term) }
    }

    /// What a law here can depend on without a number in the name.
    #[doc(hidden)]
    pub fn variables(&self) -> &'static [Quantity] {
        match self.port {
            Port::Plunger => PLUNGER,
            Port::StripForce => STRIP,
            Port::ChamberOutflow => CHAMBER,
            _ => match self.carrier {
                Carrier::Muscle => MUSCLE,
                Carrier::Cable => CABLE,
                Carrier::Joint => JOINT,
                Carrier::Alone => AXIS,
                Carrier::Sensor => SENSOR,
            },
        }
    }

    /// Whether its elements go by numbers.
    pub(crate) fn is_numbered(&self) -> bool {
        matches!(self.carrier, Carrier::Muscle | Carrier::Cable)
    }

    /// Units of what may be added.
    pub(crate) fn added_units(&self) -> impl Iterator<Item = Dimension> {
        self.adds.iter().filter_map(|unit| Dimension::parse(unit).ok())
    }
}
