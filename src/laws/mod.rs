//! Laws as data: an expression that acts at a port of the chain, written in a scene.
//!
//! A *port* is a named term or coefficient of an element's equation (`muscle.friction`, `line.outflow`, `joint.torque`). A law
//! adds to it or scales it; it may depend on quantities of the element and its neighbours, on time, and on memory of its own.
//! Nothing is compiled anew: the text is read once into a tree, checked for names and units, differentiated, and turned into
//! flat programs over any [`crate::scalar::Scalar`]. `system` asks each port what acts there.
//!
//! ```
//! use smam::laws::{LawTable, Surroundings};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let table = LawTable::parse("joint.torque adds -2e-4 * max(angle_rad/0.37 - 1, 0)", "string").map_err(|(m, _)| m)?;
//! let law = table.law(&Surroundings::default())?;
//! assert_eq!(law.variables().iter().map(|v| v.name()).collect::<Vec<_>>(), ["angle_rad"]);
//! # Ok(())
//! # }
//! ```

mod address;
mod dimension;
mod example;
mod law;
mod port;
mod ports;
mod program;
mod quantity;
mod read;
mod syntax;
mod table;
mod tree;
mod units;

pub use law::{Law, Parameter};
pub use port::{Port, PortSpec};
pub use ports::PORTS;
pub use quantity::{QUANTITIES, Quantity, QuantitySpec};
pub use read::{LawError, Surroundings};
pub use table::{LawTable, ParameterTable, StateTable};

// The program's own: not part of what the documentation offers.
#[doc(hidden)]
pub use {
    address::{Address, nearest_port, numbered},
    dimension::Dimension,
    law::{Memory, Programs, SLOPES, State, Symbol},
    port::Carrier,
    program::Program,
    quantity::Variable,
};

/// What a law does to its port.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Acts {
    /// Its value is added.
    Adds,
    /// The port is multiplied by its value.
    Scales,
}

impl Acts {
    /// Its key in a scene.
    pub fn word(self) -> &'static str {
        match self {
            Self::Adds => "adds",
            Self::Scales => "scales",
        }
    }
}
