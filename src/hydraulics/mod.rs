//! Hydraulics: `plunger -> syringe -> line -> muscle port`, pressures and flows.
//!
//! Pure laws: no input or output, no mechanism. A [`Chain`] is the whole line with its compliances, lumped into
//! `N + 1` pressure nodes and `N` flow segments; the muscle is whatever takes fluid from the last node.

mod chain;
mod fluid;
mod line;
#[cfg(test)]
mod transmission_line_tests;

pub use chain::{Chain, ChainRates, ChainSolver, ChainState, Port};
pub use fluid::Fluid;
pub use line::{Line, Syringe};
