//! The quantities that a law can depend on.

use super::Dimension;

/// A quantity of the rig, SI.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Quantity {
    Elongation,
    Speed,
    Pressure,
    SyringePressure,
    Flow,
    Plunger,
    PlungerSpeed,
    FrictionState,
    Stretch,
    Tension,
    Drive,
    DriveSpeed,
    Angle,
    AngularSpeed,
    Position,
    Reading,
    Time,
}

/// How a quantity is written: `stem_unit`, or `stem_2_unit` for that of the second element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantitySpec {
    pub quantity: Quantity,
    pub stem: &'static str,
    /// Ending of its name; empty for a plain number.
    pub ending: &'static str,
    /// One line: what it is.
    pub is: &'static str,
}

impl QuantitySpec {
    /// Its name, `elongation_m`.
    pub fn name(&self) -> String {
        if self.ending.is_empty() { self.stem.to_owned() } else { format!("{}_{}", self.stem, self.ending) }
    }

    /// Its name on the element of this number (counted from 0), `elongation_2_m`.
    fn numbered(&self, index: usize) -> String {
        if self.ending.is_empty() {
            format!("{}_{}", self.stem, index + 1)
        } else {
            format!("{}_{}_{}", self.stem, index + 1, self.ending)
        }
    }
}

const fn spec(quantity: Quantity, stem: &'static str, ending: &'static str, is: &'static str) -> QuantitySpec {
    QuantitySpec { quantity, stem, ending, is }
}

/// Every quantity, in the order of [`Quantity`].
pub const QUANTITIES: [QuantitySpec; 17] = [
    spec(Quantity::Elongation, "elongation", "m", "how much longer the muscle is than unloaded"),
    spec(Quantity::Speed, "speed", "m_s", "rate of the elongation; of a sliding joint or an axis its speed"),
    spec(
        Quantity::Pressure,
        "pressure",
        "pa",
        "gauge pressure at the element: before the line for the syringe, else after it",
    ),
    spec(Quantity::SyringePressure, "syringe_pressure", "pa", "gauge pressure before the line"),
    spec(Quantity::Flow, "flow", "m3_s", "flow through the line, towards the muscle"),
    spec(Quantity::Plunger, "plunger", "m", "position of the plunger as commanded, inwards"),
    spec(Quantity::PlungerSpeed, "plunger_speed", "m_s", "speed of the plunger as commanded"),
    spec(
        Quantity::FrictionState,
        "friction_state",
        "",
        "z of the muscle's friction, -1 (shortening) to 1 (stretching)",
    ),
    spec(Quantity::Stretch, "stretch", "m", "how much longer the cable is than unloaded; below 0 it is slack"),
    spec(Quantity::Tension, "tension", "n", "tension of the cable; for a law of the cable itself that without laws"),
    spec(Quantity::Drive, "drive", "m", "length of cable that its drive has taken in, as commanded"),
    spec(Quantity::DriveSpeed, "drive_speed", "m_s", "speed at which the drive takes in cable, as commanded"),
    spec(Quantity::Angle, "angle", "rad", "angle of the joint, or the sum over the joints that bend together"),
    spec(Quantity::AngularSpeed, "angular_speed", "rad_s", "rate of that angle"),
    spec(Quantity::Position, "position", "m", "position of a sliding joint, an axis, the crosshead of a strip"),
    spec(Quantity::Reading, "reading", "", "what the channel would show without the law, in SI units"),
    spec(Quantity::Time, "time", "s", "time of the run's clock"),
];

impl Quantity {
    /// How it is written.
    #[doc(hidden)]
    pub fn spec(self) -> &'static QuantitySpec {
        &QUANTITIES[self as usize]
    }

    /// Whether it is time, or goes by it.
    pub(crate) fn is_rate(self) -> bool {
        matches!(
            self,
            Self::Speed | Self::Flow | Self::PlungerSpeed | Self::DriveSpeed | Self::AngularSpeed | Self::Time
        )
    }

    /// Its unit; that of a reading is its channel's.
    #[doc(hidden)]
    pub fn dimension(self) -> Dimension {
        Dimension::of_name(&self.spec().name()).unwrap_or(Dimension::NONE)
    }

    /// Whether there is one for each muscle or cable, and which of the two.
    fn is_numbered(self) -> bool {
        !matches!(self, Self::Angle | Self::AngularSpeed | Self::Position | Self::Reading | Self::Time)
    }
}

/// A quantity of the law's own element, or of the muscle or cable of a number (counted from 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Variable {
    pub quantity: Quantity,
    pub of: Option<usize>,
}

/// Elements that can be told by a number in a name.
const MOST_NUMBERED: usize = 9;

impl Variable {
    /// Reads a name; `own` are the quantities that the law's element has without a number.
    pub fn parse(name: &str, own: &[Quantity]) -> Option<Self> {
        let plain = own.iter().find(|q| q.spec().name() == name);
        if let Some(&quantity) = plain {
            return Some(Self { quantity, of: None });
        }
        let numbered = QUANTITIES.iter().filter(|spec| spec.quantity.is_numbered());
        numbered
            .flat_map(|spec| (0..MOST_NUMBERED).map(move |i| (spec, i)))
            .find(|(spec, i)| spec.numbered(*i) == name)
            .map(|(spec, i)| Self { quantity: spec.quantity, of: Some(i) })
    }

    /// As it is written.
    pub fn name(self) -> String {
        let spec = self.quantity.spec();
        self.of.map_or_else(|| spec.name(), |i| spec.numbered(i))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_list_is_in_order_and_units_are_those_of_the_names() {
        for (i, spec) in QUANTITIES.iter().enumerate() {
            assert_eq!(spec.quantity as usize, i);
            assert!(spec.ending.is_empty() || Dimension::of_name(&spec.name()).is_some(), "{}", spec.name());
        }
        assert_eq!(Quantity::Flow.dimension().to_string(), "m3/s");
    }

    #[test]
    fn variables_go_there_and_back() {
        let own = [Quantity::Pressure, Quantity::Time];
        for (name, of) in [("pressure_pa", None), ("pressure_2_pa", Some(1)), ("friction_state_1", Some(0))] {
            let variable = Variable::parse(name, &own).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((variable.of, variable.name().as_str()), (of, name));
        }
        for wrong in ["angle_rad", "pressure", "pressure_0_pa", "time_1_s"] {
            assert_eq!(Variable::parse(wrong, &own), None, "{wrong}");
        }
    }
}
