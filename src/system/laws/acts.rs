//! What laws do to the terms of the equations at one instant.

use crate::laws::{Acts as Sense, Port};
use crate::scalar::Scalar;

/// What laws do to one term: `term * scale + add`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Act<D> {
    pub add: D,
    pub scale: D,
}

impl<D: Scalar> Act<D> {
    /// Nothing.
    pub fn neutral() -> Self {
        Self { add: D::constant(0.0), scale: D::constant(1.0) }
    }

    /// The slope of nothing.
    pub fn none() -> Self {
        Self { add: D::constant(0.0), scale: D::constant(0.0) }
    }

    /// The term with what the laws do to it.
    #[inline]
    pub fn on(&self, term: D) -> D {
        term * self.scale + self.add
    }

    /// One law more. Several that scale multiply; what is added is never scaled.
    #[inline]
    pub fn join(&mut self, sense: Sense, value: D) {
        match sense {
            Sense::Adds => self.add += value,
            Sense::Scales => self.scale *= value,
        }
    }

    /// The only law there.
    #[inline]
    pub fn set(&mut self, sense: Sense, value: D) {
        match sense {
            Sense::Adds => self.add = value,
            Sense::Scales => self.scale = value,
        }
    }

    /// Derivative of `term * scale + add`; `slope` is that of the act, `term_slope` that of the term.
    #[inline]
    pub fn slope_on(&self, term: D, term_slope: D, slope: &Self) -> D {
        term_slope * self.scale + term * slope.scale + slope.add
    }
}

/// Number of ports on a muscle with its line and syringe, on a cable, on a joint.
const MUSCLE: usize = Port::RestLength as usize + 1;
const CABLE: usize = Port::Transmission as usize + 1 - MUSCLE;
const JOINT: usize = Port::JointDamping as usize + 1 - MUSCLE - CABLE;

/// Acts on the ports of one element, and at which of them laws stand: a bit for each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ports<D, const P: usize, const FIRST: usize>(pub [Act<D>; P], u32);

pub type MuscleActs<D> = Ports<D, MUSCLE, 0>;
pub type CableActs<D> = Ports<D, CABLE, MUSCLE>;
pub type JointActs<D> = Ports<D, JOINT, { MUSCLE + CABLE }>;

impl<D: Scalar, const P: usize, const FIRST: usize> Ports<D, P, FIRST> {
    /// Nothing at any port.
    pub fn neutral() -> Self {
        Self([Act::neutral(); P], 0)
    }

    /// The slopes of nothing.
    pub fn none() -> Self {
        Self([Act::none(); P], 0)
    }

    /// Notes that laws stand at a port.
    pub fn note(&mut self, port: Port) {
        self.1 |= 1 << (port as usize - FIRST);
    }

    /// Whether no law stands at any port.
    #[inline]
    pub fn is_free(&self) -> bool {
        self.1 == 0
    }

    /// Whether laws stand at one of these ports.
    #[inline]
    pub fn stand_at(&self, ports: &[Port]) -> bool {
        ports.iter().any(|port| self.1 & (1 << (*port as usize - FIRST)) != 0)
    }

    /// At a port, which must be one of this element's.
    #[inline]
    pub fn at(&self, port: Port) -> &Act<D> {
        &self.0[port as usize - FIRST]
    }

    #[inline]
    pub fn at_mut(&mut self, port: Port) -> &mut Act<D> {
        &mut self.0[port as usize - FIRST]
    }
}

/// What all laws do at one instant, and room to evaluate them.
#[derive(Clone, Debug)]
pub struct Acts<D> {
    pub muscles: Vec<MuscleActs<D>>,
    pub cables: Vec<CableActs<D>>,
    /// By site.
    pub joints: Vec<JointActs<D>>,
    /// Of each cable: tension without laws on it, then with them, N; and how much further than its levers say it has gone, m.
    pub tension_n: Vec<D>,
    pub travel_m: Vec<D>,
    /// Of each muscle: what laws of the plunger add to the piston's speed, m/s.
    pub piston_m_s: Vec<D>,
    /// Of each law at each element: its value's program as it was run last, for the slopes at the same instant.
    pub(super) registers: Vec<D>,
    /// For all other programs.
    pub(super) scratch: Vec<D>,
}

impl<D: Scalar> Acts<D> {
    /// Nothing acts.
    pub fn new(muscles: usize, cables: usize, sites: usize) -> Self {
        let zero = D::constant(0.0);
        Self {
            muscles: vec![Ports::neutral(); muscles],
            cables: vec![Ports::neutral(); cables],
            joints: vec![Ports::neutral(); sites],
            tension_n: vec![zero; cables],
            travel_m: vec![zero; cables],
            piston_m_s: vec![zero; muscles],
            registers: Vec::new(),
            scratch: Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn several_laws_multiply_and_add_up() {
        let mut act = Act::neutral();
        for (sense, value) in [(Sense::Adds, 1.0), (Sense::Scales, 2.0), (Sense::Adds, 0.5), (Sense::Scales, 3.0)] {
            act.join(sense, value);
        }
        assert_eq!(act.on(10.0), 61.5);
        assert_eq!(Act::<f64>::neutral().on(7.0), 7.0);
    }

    #[test]
    fn every_port_of_the_plant_has_its_place() {
        for port in crate::laws::PORTS.iter().map(|spec| spec.port) {
            match port.spec().carrier {
                crate::laws::Carrier::Muscle => assert_eq!(*MuscleActs::<f64>::neutral().at(port), Act::neutral()),
                crate::laws::Carrier::Cable => assert_eq!(*CableActs::<f64>::neutral().at(port), Act::neutral()),
                crate::laws::Carrier::Joint => assert_eq!(*JointActs::<f64>::neutral().at(port), Act::neutral()),
                crate::laws::Carrier::Alone | crate::laws::Carrier::Sensor => {}
            }
        }
    }
}
